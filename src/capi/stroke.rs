//! One stroke of the spindle, planned once and asked at any time.

use super::data::{Refusal, RigidtapFault, RigidtapStatus, answer};
use super::exchange::RigidtapState;
use super::machine::HostMachine;
use super::storage::{RigidtapMachine, RigidtapStroke, Stored, given, out};
use crate::control::cycle::CycleError;
use crate::control::profile::{Profile, StrokeRequest};
use crate::control::units::{rev_per_s_from_rpm, rpm_from_rev_per_s};

impl Stored for Profile {
    const KIND: u64 = 2;
}

/// Plans a stroke from rest to rest under the machine's law.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_stroke_plan(
    stroke: *mut RigidtapStroke,
    machine: *const RigidtapMachine,
    distance_rev: f64,
    speed_rpm: f64,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (stroke, machine, fault) = unsafe { (out(stroke), given(machine), fault.as_mut()) };
    let plan = || -> Result<(), Refusal> {
        let HostMachine { machine, law } = machine?.view().ok_or(RigidtapStatus::NotInitialised)?;
        let limit_rpm = machine.spec().spindle.max_rpm;
        if speed_rpm > limit_rpm {
            return Err(CycleError::SpindleTooFast { needed_rpm: speed_rpm, limit_rpm }.into());
        }
        let request = StrokeRequest { distance: distance_rev, command: rev_per_s_from_rpm(speed_rpm) };
        stroke?.put(machine.stroke(*law, request)?);
        Ok(())
    };
    answer(plan(), fault)
}

/// # Safety
/// As the header says of pointers.
unsafe fn of_stroke(stroke: *const RigidtapStroke, value: impl FnOnce(&Profile) -> f64) -> f64 {
    // SAFETY: the header asks for a valid pointer or null.
    let profile = unsafe { given(stroke) }.ok().and_then(|stroke| stroke.view());
    profile.map_or(f64::NAN, value)
}

/// Its duration; NaN where nothing is planned.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_stroke_duration_s(stroke: *const RigidtapStroke) -> f64 {
    // SAFETY: passed on as it came.
    unsafe { of_stroke(stroke, Profile::duration_s) }
}

/// Its greatest speed; NaN where nothing is planned.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_stroke_peak_rpm(stroke: *const RigidtapStroke) -> f64 {
    // SAFETY: passed on as it came.
    unsafe { of_stroke(stroke, |profile| rpm_from_rev_per_s(profile.peak_velocity())) }
}

/// Where the spindle is to be at a time of the stroke.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_stroke_at(
    stroke: *const RigidtapStroke,
    t_s: f64,
    state: *mut RigidtapState,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (stroke, state) = unsafe { (given(stroke), out(state)) };
    let at = || -> Result<(), Refusal> {
        let profile: &Profile = stroke?.view().ok_or(RigidtapStatus::NotInitialised)?;
        *state? = profile.at(t_s).into();
        Ok(())
    };
    answer(at(), None)
}
