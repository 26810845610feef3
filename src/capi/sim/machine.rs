//! The simulated machine behind an opaque pointer.

use core::ffi::{CStr, c_char};
use core::mem::size_of;
use std::fmt::Write;
use std::path::Path;

use super::super::data::{RigidtapHole, RigidtapStatus};
use super::super::exchange::{RigidtapCommanded, RigidtapFeedback};
use super::super::machine::data_of;
use super::super::machine_data::{RigidtapMachineData, takes_of};
use super::super::storage::{given, out};
use super::super::tap::cycle_of;
use super::super::version::API_VERSION;
use super::exchange::{RigidtapSimOptions, RigidtapSimTruth, told};
use crate::config::MachineFile;
use crate::control::machine::{Machine, MachineSpec, Takes};
use crate::control::port::Port;
use crate::sim::{Effects, Plant, PlantOptions};

/// `rigidtap_sim` of the header, opaque there.
#[derive(Debug)]
pub struct RigidtapSim {
    plant: Plant,
    spec: MachineSpec,
    periods: u64,
}

impl RigidtapSim {
    /// What the plant is told of time: its own.
    fn now_s(&self) -> f64 {
        self.periods as f64 * self.spec.control.period_s
    }
}

/// Whether header and library agree: versions, and the sizes that the header's compiler found.
#[unsafe(no_mangle)]
pub extern "C" fn rigidtap_sim_check_version(version: u32, bytes: usize) -> RigidtapStatus {
    let passed = size_of::<RigidtapSimOptions>()
        + size_of::<RigidtapSimTruth>()
        + size_of::<RigidtapFeedback>()
        + size_of::<RigidtapCommanded>()
        + size_of::<RigidtapHole>()
        + size_of::<RigidtapMachineData>();
    if version == API_VERSION && bytes == passed { RigidtapStatus::Ok } else { RigidtapStatus::Version }
}

fn made(options: &RigidtapSimOptions, path: Option<&CStr>) -> Result<RigidtapSim, String> {
    let file = match path {
        None => MachineFile::reference(),
        Some(path) => read(path)?,
    };
    let takes = |number: u32, axis: &str| {
        takes_of(number).ok_or_else(|| format!("{axis}_takes = {number}: expected 0 to {}", Takes::ALL.len() - 1))
    };
    let machine: Machine = if options.takes_given == 0 {
        file.machine
    } else {
        let (spindle, z) = (takes(options.spindle_takes, "spindle")?, takes(options.z_takes, "z")?);
        let changed = file.machine.with(|spec| (spec.drive.spindle_takes, spec.drive.z_takes) = (spindle, z));
        changed.map_err(|error| format!("{}: {:?}", error.key, error.fault))?
    };
    if !options.z_start_mm.is_finite() {
        return Err(format!("z_start_mm = {}: expected a finite number", options.z_start_mm));
    }
    let effects = if options.ideal == 0 { Effects::FULL } else { Effects::IDEAL };
    let options = PlantOptions {
        actual: file.actual,
        effects,
        seed: options.seed,
        z_start_mm: options.z_start_mm,
        ..PlantOptions::default()
    };
    Ok(RigidtapSim { plant: Plant::new(&machine, &options), spec: machine.spec().clone(), periods: 0 })
}

fn read(path: &CStr) -> Result<MachineFile, String> {
    let name = path.to_str().map_err(|error| format!("machine_file is not UTF-8: {error}"))?;
    let bytes = std::fs::read(Path::new(name)).map_err(|error| format!("{name}: {error}"))?;
    MachineFile::read(&bytes).map_err(|faults| {
        faults.iter().fold(String::new(), |mut text, fault| {
            let _ = writeln!(text, "{}", fault.in_file(name));
            text
        })
    })
}

/// Makes a machine at rest; null where it cannot, and `message` says why.
///
/// # Safety
/// As the header says of pointers; `message` has room for `message_bytes`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_new(
    options: *const RigidtapSimOptions,
    message: *mut c_char,
    message_bytes: usize,
) -> *mut RigidtapSim {
    // SAFETY: the header asks for a valid pointer or null, and for a zero-terminated name or null.
    let made = unsafe { given(options) }.map_err(|_| "options is null".to_owned()).and_then(|options| {
        let path = (!options.machine_file.is_null()).then(|| unsafe { CStr::from_ptr(options.machine_file) });
        made(options, path)
    });
    match made {
        Ok(sim) => Box::into_raw(Box::new(sim)),
        Err(text) => {
            if !message.is_null() && message_bytes > 0 {
                let bytes = text.trim_end().as_bytes();
                let count = bytes.len().min(message_bytes - 1);
                // SAFETY: the header asks for so much room.
                unsafe {
                    core::ptr::copy_nonoverlapping(bytes.as_ptr().cast(), message, count);
                    message.add(count).write(0);
                }
            }
            core::ptr::null_mut()
        }
    }
}

/// Frees a machine; null is none.
///
/// # Safety
/// The pointer is of `rigidtap_sim_new` and not used any more.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_free(sim: *mut RigidtapSim) {
    if !sim.is_null() {
        // SAFETY: `rigidtap_sim_new` made it of a box.
        drop(unsafe { Box::from_raw(sim) });
    }
}

/// What the encoders and drives report at the start of a period.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_read(sim: *mut RigidtapSim, feedback: *mut RigidtapFeedback) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (Ok(sim), Ok(feedback)) = (unsafe { (out(sim), out(feedback)) }) else { return RigidtapStatus::Null };
    let now_s = sim.now_s();
    *feedback = told(&sim.plant.read(now_s));
    RigidtapStatus::Ok
}

/// Hands the drives a setpoint; the machine moves on by one period.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_write(
    sim: *mut RigidtapSim,
    setpoint: *const RigidtapCommanded,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (Ok(sim), Ok(setpoint)) = (unsafe { (out(sim), given(setpoint)) }) else { return RigidtapStatus::Null };
    let now_s = sim.now_s();
    sim.plant.write(now_s, &(*setpoint).into());
    sim.periods += 1;
    RigidtapStatus::Ok
}

/// What the host's clock shows at the start of this period, s from the machine's start; NaN for null.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_clock_s(sim: *mut RigidtapSim) -> f64 {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(sim) = (unsafe { out(sim) }) else { return f64::NAN };
    let now_s = sim.now_s();
    sim.plant.clock_s(now_s)
}

/// Where spindle and Z truly are.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_truth(sim: *const RigidtapSim, truth: *mut RigidtapSimTruth) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (Ok(sim), Ok(truth)) = (unsafe { (given(sim), out(truth)) }) else { return RigidtapStatus::Null };
    *truth = sim.plant.truth().map(Into::into).unwrap_or_default();
    RigidtapStatus::Ok
}

/// A new hole lies under the tap: the work piece's surface is `tap.surface_below_r_mm` below its R plane.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_begin_hole(sim: *mut RigidtapSim, hole: *const RigidtapHole) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (Ok(sim), Ok(hole)) = (unsafe { (out(sim), given(hole)) }) else { return RigidtapStatus::Null };
    match cycle_of(hole) {
        Ok(cycle) if cycle.pitch_mm > 0.0 && cycle.depth_mm() > 0.0 => {
            sim.plant.begin_hole(&cycle);
            RigidtapStatus::Ok
        }
        Ok(_) => RigidtapStatus::Invalid,
        Err(status) => status,
    }
}

/// The drives lose their power and the axes coast (0), or have it back and hold them where they are.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_set_power(sim: *mut RigidtapSim, is_on: u32) -> RigidtapStatus {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(sim) = (unsafe { out(sim) }) else { return RigidtapStatus::Null };
    sim.plant.set_power(is_on != 0);
    RigidtapStatus::Ok
}

/// What the machine's file says of it, as the control is told it.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_sim_machine_data(
    sim: *const RigidtapSim,
    data: *mut RigidtapMachineData,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (Ok(sim), Ok(data)) = (unsafe { (given(sim), out(data)) }) else { return RigidtapStatus::Null };
    *data = data_of(&sim.spec);
    RigidtapStatus::Ok
}
