//! The machine: its data from the host, checked once.

use core::mem::size_of;

use super::data::{Refusal, RigidtapFault, RigidtapStatus, answer, law_of};
use super::exchange::{
    RigidtapAxes, RigidtapBlockRequest, RigidtapCommanded, RigidtapCounters, RigidtapFeedback, RigidtapIdentified,
    RigidtapResidual, RigidtapSetpoint,
};
use super::machine_data::{RigidtapMachineData, RigidtapSpeedBand, takes_of};
use super::storage::{RigidtapBlock, RigidtapMachine, RigidtapStroke, RigidtapTap, Stored, given, out};
use super::version::API_VERSION;
use crate::control::machine::{BandSpec, Law, Machine, MachineSpec, Ramp, SyncSpec, Takes};
use crate::control::motor::TorquePoint;

/// A checked machine with the law of its strokes.
#[derive(Debug)]
pub(super) struct HostMachine {
    pub(super) machine: Machine,
    pub(super) law: Law,
}

impl Stored for HostMachine {
    const KIND: u64 = 1;
}

/// Whether header and library agree: versions, and the sizes that the header's compiler found.
#[unsafe(no_mangle)]
pub extern "C" fn rigidtap_check_version(
    version: u32,
    machine_bytes: usize,
    stroke_bytes: usize,
    tap_bytes: usize,
    block_bytes: usize,
    data_bytes: usize,
) -> RigidtapStatus {
    let passed = size_of::<RigidtapMachineData>()
        + size_of::<RigidtapBlockRequest>()
        + size_of::<RigidtapFeedback>()
        + size_of::<RigidtapSetpoint>()
        + size_of::<RigidtapAxes>()
        + size_of::<RigidtapResidual>()
        + size_of::<RigidtapIdentified>()
        + size_of::<RigidtapCounters>()
        + size_of::<RigidtapCommanded>();
    let agree = version == API_VERSION
        && machine_bytes == size_of::<RigidtapMachine>()
        && stroke_bytes == size_of::<RigidtapStroke>()
        && tap_bytes == size_of::<RigidtapTap>()
        && block_bytes == size_of::<RigidtapBlock>()
        && data_bytes == passed;
    if agree { RigidtapStatus::Ok } else { RigidtapStatus::Version }
}

/// Fills in the reference machine's data, for the host to change what differs.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_machine_reference(data: *mut RigidtapMachineData) -> RigidtapStatus {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(data) = (unsafe { out(data) }) else { return RigidtapStatus::Null };
    *data = data_of(&MachineSpec::reference());
    RigidtapStatus::Ok
}

/// Greatest band of e(k) that a thread of this pitch bears, µm; NaN where neither the machine nor a standard says it.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_machine_tolerance_um(machine: *const RigidtapMachine, pitch_mm: f64) -> f64 {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(machine) = (unsafe { given(machine) }) else { return f64::NAN };
    machine.view().and_then(|host: &HostMachine| host.machine.sync_tolerance_um(pitch_mm)).unwrap_or(f64::NAN)
}

/// What a host tells of a machine: all that the control uses of it, with the law that holds for any.
pub(super) fn data_of(spec: &MachineSpec) -> RigidtapMachineData {
    let mut data = RigidtapMachineData::numbers_of(spec);
    data.law = Law::ALL.iter().position(|law| *law == Law::TorqueLimit).unwrap_or_default() as u32;
    for (to, from) in data.torque_curve.iter_mut().zip(&spec.spindle.torque_curve) {
        (to.speed_rpm, to.torque_nm) = (from.speed_rpm, from.torque_nm);
    }
    data.torque_points = spec.spindle.torque_curve.len() as u32;
    let mut bottom_rpm = 0.0;
    for (to, band) in data.bands.iter_mut().zip(&spec.law.torque_curve.bands) {
        let (accel_s, decel_s) = band.times_s(bottom_rpm);
        *to = RigidtapSpeedBand { to_rpm: band.to_rpm, accel_s, decel_s };
        bottom_rpm = band.to_rpm;
    }
    data.band_count = spec.law.torque_curve.bands.len() as u32;
    data
}

/// Checks the data and makes a machine of them; nothing after it checks them again.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_machine_init(
    machine: *mut RigidtapMachine,
    data: *const RigidtapMachineData,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (machine, data, fault) = unsafe { (out(machine), given(data), fault.as_mut()) };
    let init = || -> Result<(), Refusal> {
        machine?.put(checked(data?)?);
        Ok(())
    };
    answer(init(), fault)
}

fn checked(data: &RigidtapMachineData) -> Result<HostMachine, Refusal> {
    let mut spec = MachineSpec::reference();
    data.write_numbers(&mut spec);
    spec.spindle.torque_curve.clear();
    let points = data.torque_curve.get(..data.torque_points as usize).ok_or(RigidtapStatus::MachineTorqueCurve)?;
    for point in points {
        // As many as there is room for: the slice is of an array of that length.
        let point = TorquePoint { speed_rpm: point.speed_rpm, torque_nm: point.torque_nm };
        let _ = spec.spindle.torque_curve.try_push(point);
    }
    spec.law.torque_curve.bands.clear();
    let bands = data.bands.get(..data.band_count as usize).ok_or(RigidtapStatus::MachineContradiction)?;
    for RigidtapSpeedBand { to_rpm, accel_s, decel_s } in bands.iter().copied() {
        let _ = spec.law.torque_curve.bands.try_push(BandSpec { to_rpm, ramp: Ramp::Time { accel_s, decel_s } });
    }
    let law = law_of(data.law)?;
    spec.drive.spindle_takes = takes_of(data.spindle_takes).ok_or(RigidtapStatus::UnknownChoice)?;
    let z_takes = takes_of(data.z_takes).filter(|takes| *takes != Takes::Speed);
    spec.drive.z_takes = z_takes.ok_or(RigidtapStatus::UnknownChoice)?;
    // A period so long that the rules leave their range is none for `full`, but still one for the rest.
    let sync = SyncSpec::by_rules(&spec);
    let ruled = Machine::check(MachineSpec { sync, ..spec.clone() });
    let machine = ruled.or_else(|error| if error.key.starts_with("sync.") { Machine::check(spec) } else { Err(error) });
    Ok(HostMachine { machine: machine?, law })
}
