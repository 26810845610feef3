//! The machine: its data from the host, checked once.

use core::mem::size_of;

use super::API_VERSION;
use super::data::{
    Refusal, RigidtapAxes, RigidtapBlockRequest, RigidtapFault, RigidtapFeedback, RigidtapMachineData,
    RigidtapSetpoint, RigidtapStatus, answer, law_of,
};
use super::storage::{RigidtapBlock, RigidtapMachine, RigidtapStroke, RigidtapTap, Stored, given, out};
use crate::control::machine::{Law, Machine, MachineSpec, SyncSpec};
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

/// Share of the spindle's inertia at the tool: what the reference machine has; hosts do not say.
const TOOL_SHARE: f64 = 0.3;
/// Drive periods in an interpolation period, where the host does not say.
const DRIVE_PERIODS: f64 = 10.0;

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
        + size_of::<RigidtapAxes>();
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
    let spec = MachineSpec::reference();
    let mut torque_curve = <[super::RigidtapTorquePoint; crate::control::motor::MAX_POINTS]>::default();
    for (to, from) in torque_curve.iter_mut().zip(&spec.spindle.torque_curve) {
        (to.speed_rpm, to.torque_nm) = (from.speed_rpm, from.torque_nm);
    }
    *data = RigidtapMachineData {
        period_s: spec.control.period_s,
        latency_periods: spec.drive.latency_periods,
        spindle_max_rpm: spec.spindle.max_rpm,
        spindle_inertia_kg_m2: spec.spindle.inertia_kg_m2,
        spindle_coulomb_nm: spec.spindle.coulomb_nm,
        spindle_viscous_nm_per_rpm: spec.spindle.viscous_nm_per_rpm,
        spindle_counts_per_rev: spec.spindle.encoder_counts_per_rev,
        torque_curve,
        torque_points: spec.spindle.torque_curve.len() as u32,
        law: Law::ALL.iter().position(|law| *law == Law::TorqueLimit).unwrap_or_default() as u32,
        motor_share: spec.law.motor_share,
        jerk_rpm_per_s2: spec.law.torque_curve_smooth.jerk_rpm_per_s2,
        z_max_mm_per_s: spec.z.max_mm_per_s,
        z_max_mm_per_s2: spec.z.max_mm_per_s2,
        z_max_mm_per_s3: spec.z.max_mm_per_s3,
        z_counts_per_mm: spec.z_axis.encoder_counts_per_mm,
        xy_max_mm_per_s: spec.x.max_mm_per_s,
        xy_max_mm_per_s2: spec.x.max_mm_per_s2,
        xy_max_mm_per_s3: spec.x.max_mm_per_s3,
        spindle_torque_lag_s: spec.spindle.torque_lag_s,
        spindle_position_gain_per_s: spec.drive.spindle_position_gain_per_s,
        z_mass_kg: spec.z_axis.mass_kg,
        z_resonance_hz: spec.z_axis.resonance_hz,
        z_torque_lag_s: spec.z_axis.torque_lag_s,
        z_coulomb_n: spec.z_axis.coulomb_n,
        z_backlash_um: spec.z_axis.backlash_um,
        z_motor_counts_per_mm: spec.z_axis.motor_counts_per_mm,
        z_position_gain_per_s: spec.drive.z_position_gain_per_s,
        z_velocity_gain_per_s: spec.drive.z_velocity_gain_per_s,
        velocity_filter_s: spec.drive.velocity_filter_s,
        encoder_latency_s: spec.drive.encoder_latency_s,
        tap_kc_n_per_mm2: spec.tap.kc_n_per_mm2,
        tap_surface_below_r_mm: spec.tap.surface_below_r_mm,
    };
    RigidtapStatus::Ok
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
    spec.control.period_s = data.period_s;
    spec.drive.period_s = data.period_s / DRIVE_PERIODS;
    spec.drive.latency_periods = data.latency_periods;
    spec.spindle.max_rpm = data.spindle_max_rpm;
    spec.spindle.inertia_kg_m2 = data.spindle_inertia_kg_m2;
    spec.spindle.tool_inertia_kg_m2 = TOOL_SHARE * data.spindle_inertia_kg_m2;
    spec.spindle.coulomb_nm = data.spindle_coulomb_nm;
    spec.spindle.viscous_nm_per_rpm = data.spindle_viscous_nm_per_rpm;
    spec.spindle.encoder_counts_per_rev = data.spindle_counts_per_rev;
    spec.spindle.torque_curve.clear();
    let points = data.torque_curve.get(..data.torque_points as usize).ok_or(RigidtapStatus::MachineTorqueCurve)?;
    for point in points {
        // As many as there is room for: the slice is of an array of that length.
        let point = TorquePoint { speed_rpm: point.speed_rpm, torque_nm: point.torque_nm };
        let _ = spec.spindle.torque_curve.try_push(point);
    }
    spec.law.motor_share = data.motor_share;
    spec.law.torque_curve_smooth.jerk_rpm_per_s2 = data.jerk_rpm_per_s2;
    spec.z.max_mm_per_s = data.z_max_mm_per_s;
    spec.z.max_mm_per_s2 = data.z_max_mm_per_s2;
    spec.z.max_mm_per_s3 = data.z_max_mm_per_s3;
    spec.z_axis.encoder_counts_per_mm = data.z_counts_per_mm;
    for axis in [&mut spec.x, &mut spec.y] {
        axis.max_mm_per_s = data.xy_max_mm_per_s;
        axis.max_mm_per_s2 = data.xy_max_mm_per_s2;
        axis.max_mm_per_s3 = data.xy_max_mm_per_s3;
    }
    spec.spindle.torque_lag_s = data.spindle_torque_lag_s;
    spec.drive.spindle_position_gain_per_s = data.spindle_position_gain_per_s;
    spec.z_axis.mass_kg = data.z_mass_kg;
    spec.z_axis.resonance_hz = data.z_resonance_hz;
    spec.z_axis.torque_lag_s = data.z_torque_lag_s;
    spec.z_axis.coulomb_n = data.z_coulomb_n;
    spec.z_axis.backlash_um = data.z_backlash_um;
    spec.z_axis.motor_counts_per_mm = data.z_motor_counts_per_mm;
    spec.drive.z_position_gain_per_s = data.z_position_gain_per_s;
    spec.drive.z_velocity_gain_per_s = data.z_velocity_gain_per_s;
    spec.drive.velocity_filter_s = data.velocity_filter_s;
    spec.drive.encoder_latency_s = data.encoder_latency_s;
    spec.tap.kc_n_per_mm2 = data.tap_kc_n_per_mm2;
    spec.tap.surface_below_r_mm = data.tap_surface_below_r_mm;
    let law = law_of(data.law)?;
    // A period so long that the rules leave their range is none for `full`, but still one for the rest.
    let sync = SyncSpec::by_rules(&spec);
    let ruled = Machine::check(MachineSpec { sync, ..spec.clone() });
    let machine = ruled.or_else(|error| if error.key.starts_with("sync.") { Machine::check(spec) } else { Err(error) });
    Ok(HostMachine { machine: machine?, law })
}
