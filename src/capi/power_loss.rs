//! What is left of a hole when the power fails, and the way out of it after the restart.

use super::data::{Refusal, RigidtapFault, RigidtapStatus, answer, compensation_of};
use super::exchange::RigidtapFeedback;
use super::machine::HostMachine;
use super::storage::{RigidtapBlock, RigidtapMachine, RigidtapTap, given, out};
use super::tap::HostTap;
use crate::control::sync::Settings;
use crate::control::tapping::{Block, PowerLossRecord, RestoredHole, Tapping};

/// `rigidtap_record` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RigidtapRecord {
    /// As [`PowerLossRecord::to_bytes`] has them.
    pub bytes: [u8; PowerLossRecord::BYTES],
}

/// The record of the hole under way, by the absolute encoder of Z.
fn told(
    found: Option<PowerLossRecord>,
    z_offset_counts: i64,
    record: Result<&mut RigidtapRecord, RigidtapStatus>,
) -> Result<(), Refusal> {
    let found = found.ok_or(RigidtapStatus::NotInTurn)?;
    record?.bytes = found.with_z_offset(z_offset_counts).to_bytes();
    Ok(())
}

/// The record of the hole under way.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_record(
    tap: *const RigidtapTap,
    z_offset_counts: i64,
    record: *mut RigidtapRecord,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (tap, record) = unsafe { (given(tap), out(record)) };
    let found = tap.map(|tap| tap.view().and_then(|host: &HostTap| host.tapping.power_loss_record()));
    answer(found.map_err(Refusal::from).and_then(|found| told(found, z_offset_counts, record)), None)
}

/// The record of a block's hole under way.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_record(
    block: *const RigidtapBlock,
    z_offset_counts: i64,
    record: *mut RigidtapRecord,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (block, record) = unsafe { (given(block), out(record)) };
    let found = block.map(|block| block.view().and_then(Block::power_loss_record));
    answer(found.map_err(Refusal::from).and_then(|found| told(found, z_offset_counts, record)), None)
}

/// Plans the way out of a hole from its record and from what the encoders read after the restart.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_plan_retract(
    tap: *mut RigidtapTap,
    machine: *const RigidtapMachine,
    record: *const RigidtapRecord,
    feedback: *const RigidtapFeedback,
    speed_rpm: f64,
    compensation: u32,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (tap, machine, record) = unsafe { (out(tap), given(machine), given(record)) };
    // SAFETY: likewise.
    let (feedback, fault) = unsafe { (given(feedback), fault.as_mut()) };
    let plan = || -> Result<(), Refusal> {
        let HostMachine { machine, law } = machine?.view().ok_or(RigidtapStatus::NotInitialised)?;
        let (record, feedback, storage) = (PowerLossRecord::from_bytes(&record?.bytes)?, feedback?, tap?);
        let settings = Settings { compensation: compensation_of(compensation)?, ..Settings::default() };
        if storage.get::<HostTap>().is_some_and(|host| host.tapping.plan().is_some()) {
            return Err(RigidtapStatus::NotInTurn.into());
        }
        let speed_rpm = (speed_rpm != 0.0).then_some(speed_rpm);
        let RestoredHole { plan, standing } = RestoredHole::plan(&record, machine, *law, speed_rpm, &feedback.into())?;
        let (standing, tapping) = (Some(standing), Tapping::new(machine));
        storage.put(HostTap { tapping, plan, standing, settings, started: false });
        Ok(())
    };
    answer(plan(), fault)
}
