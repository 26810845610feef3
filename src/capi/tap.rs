//! One hole: planned outside the period, started, then stepped each period.

use super::data::{
    Refusal, RigidtapFault, RigidtapFeedback, RigidtapHole, RigidtapSetpoint, RigidtapStatus, answer, compensation_of,
};
use super::machine::HostMachine;
use super::storage::{RigidtapMachine, RigidtapTap, Stored, given, out};
use crate::control::cycle::{CyclePlan, Hand, Interrupted, LegKind, Retract, TapCycle};
use crate::control::machine::Machine;
use crate::control::port::{AxisStatus, Feedback};
use crate::control::sync::{Adaptation, Settings, Stage, Step, Tapping};

/// A hole that is planned.
struct Planned {
    plan: CyclePlan,
    machine: Machine,
    settings: Settings,
    adaptation: Adaptation,
}

/// A hole that is under way or done.
struct Started {
    tapping: Tapping,
    machine: Machine,
}

impl Stored for Planned {
    const KIND: u64 = 3;
}

impl Stored for Started {
    const KIND: u64 = 4;
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
        dwell_s: hole.dwell_s,
        peck_mm: pecks.then_some(hole.peck_mm),
        retract: pecks.then_some(retract),
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

/// What a state knows of a machine from the holes before.
fn adaptation_of(tap: &RigidtapTap, machine: &Machine) -> Adaptation {
    let planned = tap.view::<Planned>().filter(|planned| planned.machine == *machine);
    let started = || tap.view::<Started>().filter(|started| started.machine == *machine);
    let before = planned
        .map(|planned| planned.adaptation.clone())
        .or_else(|| started().map(|started| started.tapping.clone().into_adaptation()));
    let mut adaptation = before.unwrap_or_else(|| Adaptation::new(machine));
    adaptation.note_gap();
    adaptation
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
        let plan = CyclePlan::new(cycle_of(hole)?, machine, *law)?;
        let tap = tap?;
        let adaptation = adaptation_of(tap, machine);
        tap.put(Planned { plan, machine: machine.clone(), settings, adaptation });
        Ok(())
    };
    answer(plan(), fault)
}

/// Time from the first to the last synchronous period; infinite while stopped, NaN where nothing is planned.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_duration_s(tap: *const RigidtapTap) -> f64 {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(tap) = (unsafe { given(tap) }) else { return f64::NAN };
    let planned = tap.view::<Planned>().map(|planned| &planned.plan);
    planned
        .or_else(|| tap.view().map(|started: &Started| started.tapping.plan()))
        .map_or(f64::NAN, CyclePlan::duration_s)
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
        let tap = tap?;
        let Planned { plan, machine, settings, adaptation } = tap.view().ok_or(RigidtapStatus::NotInTurn)?;
        let spindle_rev = spindle_counts as f64 / machine.spec().spindle.encoder_counts_per_rev;
        let tapping = Tapping::start(plan.clone(), machine, *settings, now_s, spindle_rev, spindle_rpm)?;
        let started = Started { tapping: tapping.adapted(adaptation.clone()), machine: machine.clone() };
        tap.put(started);
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
        let Started { tapping, .. } = tap?.get().ok_or(RigidtapStatus::NotInTurn)?;
        let step = tapping.step(now_s, &feedback_of(feedback?))?;
        *setpoint? = told(&step, tapping.interrupted_at(now_s));
        Ok(())
    };
    answer(step(), fault)
}

fn told(step: &Step, interrupted: Option<Interrupted>) -> RigidtapSetpoint {
    let (stage, leg) = numbers_of(step.stage, interrupted);
    RigidtapSetpoint {
        spindle: step.spindle.into(),
        z: step.z.into(),
        spindle_torque_nm: step.spindle_torque_nm,
        z_force_n: step.z_force_n,
        error_mm: step.error_mm,
        correction_mm: step.correction_mm,
        stage,
        leg,
    }
}

/// The header's numbers of a stage and a leg.
pub(super) fn numbers_of(stage: Stage, interrupted: Option<Interrupted>) -> (u32, u32) {
    let leg = match stage {
        Stage::Settling => return (1, 0),
        Stage::Done => return (6, 0),
        Stage::Synchronous(leg) => match leg.kind {
            LegKind::In => 1,
            LegKind::Dwell => 2,
            LegKind::Out => 3,
        },
    };
    let stage = match interrupted {
        None | Some(Interrupted::Resuming) => 2,
        Some(Interrupted::Braking) => 3,
        Some(Interrupted::Holding) => 4,
        Some(Interrupted::Retracting) => 5,
    };
    (stage, leg)
}

pub(super) fn feedback_of(feedback: &RigidtapFeedback) -> Feedback {
    Feedback {
        spindle_counts: feedback.spindle_counts,
        z_counts: feedback.z_counts,
        z_motor_counts: (feedback.z_motor_counts != 0).then_some(feedback.z_motor_counts),
        spindle_torque_nm: (feedback.spindle_torque_nm != 0.0).then_some(feedback.spindle_torque_nm),
        z_force_n: (feedback.z_force_n != 0.0).then_some(feedback.z_force_n),
        spindle: AxisStatus { saturated: Some(feedback.torque_saturated != 0), ..AxisStatus::default() },
        z: AxisStatus::default(),
    }
}

/// # Safety
/// As the header says of pointers.
unsafe fn interrupt(
    tap: *mut RigidtapTap,
    act: impl FnOnce(&mut Tapping) -> Result<(), RigidtapStatus>,
) -> RigidtapStatus {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(tap) = (unsafe { out(tap) }) else { return RigidtapStatus::Null };
    let Some(Started { tapping, .. }) = tap.get() else { return RigidtapStatus::NotInTurn };
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
