//! A whole tapping block: X, Y, Z and spindle, from where they stand to the return level of the last hole.

use super::data::{Refusal, RigidtapFault, RigidtapStatus, answer};
use super::exchange::{RigidtapAxes, RigidtapBlockRequest, RigidtapCounters, RigidtapFeedback, RigidtapIdentified};
use super::machine::HostMachine;
use super::storage::{RigidtapBlock, RigidtapMachine, Stored, given, out, read};
use super::tap::{cycle_of, numbers_of, settings_of};
use crate::control::sync::Scale;
use crate::control::tapping::{Block, BlockRequest, BlockStage};

impl Stored for Block {
    const KIND: u64 = 5;
}

/// Plans a block: every way and stroke of it feasible, or refused before anything moves.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_plan(
    block: *mut RigidtapBlock,
    machine: *const RigidtapMachine,
    request: *const RigidtapBlockRequest,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (block, machine, request, fault) = unsafe { (out(block), given(machine), given(request), fault.as_mut()) };
    let plan = || -> Result<(), Refusal> {
        let HostMachine { machine, law } = machine?.view().ok_or(RigidtapStatus::NotInitialised)?;
        let request = request?;
        let spindle_rev = Scale::of(machine).spindle_rev(request.spindle_counts);
        let asked = BlockRequest {
            hole: cycle_of(&request.hole)?,
            start_mm: [request.start_x_mm, request.start_y_mm, request.start_z_mm],
            holes: request.holes,
            step_mm: [request.step_x_mm, request.step_y_mm],
        };
        let settings = settings_of(&request.hole)?;
        let storage = block?;
        if storage.get::<Block>().is_some_and(|block| block.is_tapping()) {
            return Err(RigidtapStatus::NotInTurn.into());
        }
        // What an earlier block of the same machine measured and learned goes on to this one.
        if let Some(block) = storage.get::<Block>().filter(|block| block.machine() == machine) {
            block.plan_next(asked, *law, settings, spindle_rev, request.spindle_rpm)?;
        } else {
            storage.put(Block::plan(asked, machine, *law, settings, spindle_rev, request.spindle_rpm)?);
        }
        Ok(())
    };
    answer(plan(), fault)
}

/// One period of all axes.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_step(
    block: *mut RigidtapBlock,
    now_s: f64,
    feedback: *const RigidtapFeedback,
    axes: *mut RigidtapAxes,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (block, feedback, axes, fault) = unsafe { (out(block), given(feedback), out(axes), fault.as_mut()) };
    let step = || -> Result<(), Refusal> {
        let block: &mut Block = block?.get().ok_or(RigidtapStatus::NotInTurn)?;
        let step = block.step(now_s, &feedback?.into());
        let (stage, stroke) = match step.stage {
            BlockStage::Positioning => (0, 0),
            BlockStage::Hole(stage) => numbers_of(stage),
            BlockStage::Done => (6, 0),
        };
        *axes? = RigidtapAxes {
            spindle: step.setpoint.spindle.into(),
            x: step.setpoint.x.into(),
            y: step.setpoint.y.into(),
            z: step.setpoint.z.into(),
            spindle_torque_nm: step.setpoint.spindle_torque_nm,
            z_force_n: step.setpoint.z_force_n,
            error_mm: step.error_mm,
            correction_mm: step.correction_mm,
            path_rate: step.path_rate,
            alarm: step.alarm.or(step.warning).into(),
            stage,
            stroke,
            hole: step.hole,
            reserved: 0,
        };
        Ok(())
    };
    answer(step(), fault)
}

/// # Safety
/// As the header says of pointers.
unsafe fn interrupt(
    block: *mut RigidtapBlock,
    act: impl FnOnce(&mut Block) -> Result<(), RigidtapStatus>,
) -> RigidtapStatus {
    // SAFETY: the header asks for a valid pointer or null.
    let Ok(block) = (unsafe { out(block) }) else { return RigidtapStatus::Null };
    let Some(block) = block.get() else { return RigidtapStatus::NotInTurn };
    act(block).err().unwrap_or(RigidtapStatus::Ok)
}

/// In a hole a controlled stop; between holes the axes end their way and stand.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_stop(block: *mut RigidtapBlock, now_s: f64) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe {
        interrupt(block, |block| {
            block.stop(now_s);
            Ok(())
        })
    }
}

/// Brings a stopped tap back to R, and ends the block on the return level.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_retract(block: *mut RigidtapBlock, now_s: f64) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe { interrupt(block, |block| Ok(block.retract(now_s)?)) }
}

/// Lets a stopped block go on.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_resume(block: *mut RigidtapBlock, now_s: f64) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe { interrupt(block, |block| Ok(block.resume(now_s)?)) }
}

/// Forgets the latched alarm.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_acknowledge(block: *mut RigidtapBlock) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe { interrupt(block, |block| block.acknowledge().then_some(()).ok_or(RigidtapStatus::AlarmLatched)) }
}

/// Gives up the block under way.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_release(block: *mut RigidtapBlock) -> RigidtapStatus {
    // SAFETY: passed on as it came.
    unsafe {
        interrupt(block, |block| {
            block.release();
            Ok(())
        })
    }
}

/// What is known of the machine by now.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_identified(
    block: *const RigidtapBlock,
    identified: *mut RigidtapIdentified,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    unsafe { read(block, identified, |block: &Block| block.identified().into()) }
}

/// What was counted so far.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_counters(
    block: *const RigidtapBlock,
    counters: *mut RigidtapCounters,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    unsafe { read(block, counters, |block: &Block| block.counters().into()) }
}
