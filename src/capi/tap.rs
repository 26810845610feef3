//! One hole: planned outside the period, started, then stepped each period.

use super::data::{Refusal, RigidtapFault, RigidtapHole, RigidtapStatus, answer, compensation_of};
use super::exchange::{
    RigidtapCommanded, RigidtapCounters, RigidtapFeedback, RigidtapIdentified, RigidtapResidual, RigidtapSetpoint,
};
use super::machine::HostMachine;
use super::storage::{RigidtapMachine, RigidtapTap, Stored, given, out, read};
use crate::control::cycle::{CyclePlan, Hand, Interrupted, Retract, StrokeKind, TapCycle};
use crate::control::sync::{Scale, Settings, Stage, Standing, Step};
use crate::control::tapping::{RestoredHole, Tapping};
use crate::control::units::rev_from_deg;

/// A machine that is tapped with, and the hole that is planned next.
pub(super) struct HostTap {
    pub(super) tapping: Tapping,
    pub(super) plan: CyclePlan,
    /// The plan is the way out of a hole in which the tap stands.
    pub(super) standing: Option<Standing>,
    pub(super) settings: Settings,
    /// The plan has been started.
    pub(super) started: bool,
}

impl Stored for HostTap {
    const KIND: u64 = 3;
}

pub(super) fn cycle_of(hole: &RigidtapHole) -> Result<TapCycle, RigidtapStatus> {
    let pecks = hole.peck_mm != 0.0;
    let retract =
        if hole.chip_break_mm == 0.0 { Retract::Full } else { Retract::ChipBreak { back_mm: hole.chip_break_mm } };
    Ok(TapCycle {
        x_mm: hole.x_mm,
        y_mm: hole.y_mm,
        r_plane_mm: hole.r_plane_mm,
        bottom_mm: hole.bottom_mm,
        return_mm: hole.return_mm,
        pitch_mm: hole.pitch_mm,
        speed_rpm: hole.speed_rpm,
        out_speed_rpm: if hole.out_speed_rpm == 0.0 { hole.speed_rpm } else { hole.out_speed_rpm },
        hand: match hole.hand {
            0 => Hand::Right,
            1 => Hand::Left,
            _ => return Err(RigidtapStatus::UnknownChoice),
        },
        start_angle_rev: (hole.has_start_angle != 0).then(|| rev_from_deg(hole.start_angle_deg)),
        dwell_s: hole.dwell_s,
        peck_mm: pecks.then_some(hole.peck_mm),
        retract: pecks.then_some(retract),
        tool: hole.tool,
    })
}

pub(super) fn settings_of(hole: &RigidtapHole) -> Result<Settings, RigidtapStatus> {
    Ok(Settings {
        compensation: compensation_of(hole.compensation)?,
        identify: hole.identify != 0,
        learn: hole.learn != 0,
        ..Settings::default()
    })
}

/// Plans a hole: feasible, or refused before anything moves.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_plan(
    tap: *mut RigidtapTap,
    machine: *const RigidtapMachine,
    hole: *const RigidtapHole,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (tap, machine, hole, fault) = unsafe { (out(tap), given(machine), given(hole), fault.as_mut()) };
    let plan = || -> Result<(), Refusal> {
        let HostMachine { machine, law } = machine?.view().ok_or(RigidtapStatus::NotInitialised)?;
        let hole = hole?;
        let settings = settings_of(hole)?;
        let storage = tap?;
        if storage.get::<HostTap>().is_some_and(|host| host.tapping.plan().is_some()) {
            return Err(RigidtapStatus::NotInTurn.into());
        }
        // What a state has measured and learned of the same machine goes on to the next hole.
        if let Some(host) = storage.get::<HostTap>().filter(|host| host.plan.machine() == machine) {
            host.plan = CyclePlan::new(cycle_of(hole)?, machine, *law)?;
            (host.standing, host.settings, host.started) = (None, settings, false);
            return Ok(());
        }
        let plan = CyclePlan::new(cycle_of(hole)?, machine, *law)?;
        storage.put(HostTap { tapping: Tapping::new(machine), plan, standing: None, settings, started: false });
        Ok(())
    };
    answer(plan(), fault)
}

/// One period between holes: shows the machine's motion, and tells what the last hole left beside Z's setpoints.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_observe(
    tap: *mut RigidtapTap,
    now_s: f64,
    feedback: *const RigidtapFeedback,
    residual: *mut RigidtapResidual,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (tap, feedback, residual) = unsafe { (out(tap), given(feedback), residual.as_mut()) };
    let observe = || -> Result<(), Refusal> {
        let host: &mut HostTap = tap?.get().ok_or(RigidtapStatus::NotInTurn)?;
        if host.tapping.plan().is_some() {
            return Err(RigidtapStatus::NotInTurn.into());
        }
        let left = host.tapping.observe(now_s, &feedback?.into());
        match residual {
            Some(residual) => *residual = RigidtapResidual { z: left.z.into(), z_force_n: left.z_force_n },
            // Who does not ask for it cannot add it.
            None => host.tapping.discard_residual(),
        }
        Ok(())
    };
    answer(observe(), None)
}

/// What was commanded for the period that was observed last.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_note_commanded(
    tap: *mut RigidtapTap,
    commanded: *const RigidtapCommanded,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (tap, commanded) = unsafe { (out(tap), given(commanded)) };
    let note = || -> Result<(), Refusal> {
        let host: &mut HostTap = tap?.get().ok_or(RigidtapStatus::NotInTurn)?;
        if host.tapping.plan().is_some() {
            return Err(RigidtapStatus::NotInTurn.into());
        }
        host.tapping.note_commanded(&(*commanded?).into());
        Ok(())
    };
    answer(note(), None)
}

/// Time from the first to the last synchronous period; infinite while stopped, NaN where nothing is planned.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_duration_s(tap: *const RigidtapTap) -> f64 {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(tap) = (unsafe { given(tap) }) else { return f64::NAN };
    tap.view().map_or(f64::NAN, |host: &HostTap| host.tapping.plan().unwrap_or(&host.plan).duration_s())
}

/// Starts a planned hole, Z at rest on the R plane, the spindle as it turns.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_start(
    tap: *mut RigidtapTap,
    now_s: f64,
    spindle_counts: i64,
    spindle_rpm: f64,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (tap, fault) = unsafe { (out(tap), fault.as_mut()) };
    let start = || -> Result<(), Refusal> {
        let host: &mut HostTap =
            tap?.get().filter(|host: &&mut HostTap| !host.started).ok_or(RigidtapStatus::NotInTurn)?;
        if let Some(standing) = host.standing {
            let hole = RestoredHole { plan: host.plan.clone(), standing };
            host.tapping.restore(hole, host.settings, now_s)?;
            host.started = true;
            return Ok(());
        }
        let spindle_rev = Scale::of(host.plan.machine()).spindle_rev(spindle_counts);
        host.tapping.start(host.plan.clone(), host.settings, now_s, spindle_rev, spindle_rpm)?;
        host.started = true;
        Ok(())
    };
    answer(start(), fault)
}

/// One period: what the encoders read at `now_s`, and the setpoint for that time.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_step(
    tap: *mut RigidtapTap,
    now_s: f64,
    feedback: *const RigidtapFeedback,
    setpoint: *mut RigidtapSetpoint,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (tap, feedback, setpoint, fault) = unsafe { (out(tap), given(feedback), out(setpoint), fault.as_mut()) };
    let step = || -> Result<(), Refusal> {
        let (host, feedback): (&mut HostTap, _) = (tap?.get().ok_or(RigidtapStatus::NotInTurn)?, feedback?);
        let setpoint = setpoint?;
        *setpoint = answered(&host.tapping.step(now_s, &feedback.into()).ok_or(RigidtapStatus::NotInTurn)?);
        Ok(())
    };
    answer(step(), fault)
}

fn answered(step: &Step) -> RigidtapSetpoint {
    let (stage, stroke) = numbers_of(step.stage);
    RigidtapSetpoint {
        spindle: step.spindle.into(),
        z: step.z.into(),
        spindle_torque_nm: step.spindle_torque_nm,
        z_force_n: step.z_force_n,
        error_mm: step.error_mm,
        correction_mm: step.correction_mm,
        path_rate: step.path_rate,
        // A warning stands there as the hole is done.
        alarm: step.alarm.or(step.warning).into(),
        stage,
        stroke,
    }
}

/// The header's numbers of a stage and a stroke.
pub(super) fn numbers_of(stage: Stage) -> (u32, u32) {
    let (state, interrupted) = match stage {
        Stage::Synchronous(state, interrupted) => (state, interrupted),
        Stage::Done => return (6, 0),
        Stage::Held => return (7, 0),
        Stage::SynchronousStop => return (8, 0),
        Stage::ModelStop => return (9, 0),
        Stage::ZLost => return (10, 0),
        _ => return (1, 0),
    };
    let stroke = match state.kind {
        StrokeKind::In => 1,
        StrokeKind::Dwell => 2,
        StrokeKind::Out => 3,
    };
    let stage = match interrupted {
        None | Some(Interrupted::Resuming) => 2,
        Some(Interrupted::Braking) => 3,
        Some(Interrupted::Holding) => 4,
        Some(Interrupted::Retracting) => 5,
    };
    (stage, stroke)
}

/// # Safety
/// As the header says of pointers.
unsafe fn interrupt(
    tap: *mut RigidtapTap,
    act: impl FnOnce(&mut Tapping) -> Result<(), RigidtapStatus>,
) -> RigidtapStatus {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(tap) = (unsafe { out(tap) }) else { return RigidtapStatus::Null };
    let Some(HostTap { tapping, .. }) = tap.get() else { return RigidtapStatus::NotInTurn };
    if tapping.plan().is_none() {
        return RigidtapStatus::NotInTurn;
    }
    act(tapping).err().unwrap_or(RigidtapStatus::Ok)
}

/// Brakes spindle and Z together from this period on, and holds them.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_stop(tap: *mut RigidtapTap, now_s: f64) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe {
        interrupt(tap, |tapping| {
            tapping.stop(now_s);
            Ok(())
        })
    }
}

/// Brings a stopped tap back to the R plane in synchronism.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_retract(tap: *mut RigidtapTap, now_s: f64) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe { interrupt(tap, |tapping| Ok(tapping.retract(now_s)?)) }
}

/// Lets a stopped tap go on.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_resume(tap: *mut RigidtapTap, now_s: f64) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe { interrupt(tap, |tapping| Ok(tapping.resume(now_s)?)) }
}

/// Forgets the latched alarm.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_acknowledge(tap: *mut RigidtapTap) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe { interrupt(tap, |tapping| tapping.acknowledge().then_some(()).ok_or(RigidtapStatus::AlarmLatched)) }
}

/// Nothing of the last hole is left beside Z's setpoints.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_discard_residual(tap: *mut RigidtapTap) -> RigidtapStatus {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(tap) = (unsafe { out(tap) }) else { return RigidtapStatus::Null };
    let Some(HostTap { tapping, .. }) = tap.get() else { return RigidtapStatus::NotInTurn };
    tapping.discard_residual();
    RigidtapStatus::Ok
}

/// Gives up the hole under way.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_release(tap: *mut RigidtapTap) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe {
        interrupt(tap, |tapping| {
            tapping.release();
            Ok(())
        })
    }
}

/// What is known of the machine by now.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_identified(
    tap: *const RigidtapTap,
    identified: *mut RigidtapIdentified,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    unsafe { read(tap, identified, |host: &HostTap| host.tapping.identified().into()) }
}

/// What was counted so far.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_counters(
    tap: *const RigidtapTap,
    counters: *mut RigidtapCounters,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    unsafe { read(tap, counters, |host: &HostTap| host.tapping.counters().into()) }
}
