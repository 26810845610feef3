//! What holes taught, in bytes of the caller's that it keeps over a restart.

use super::data::{Refusal, RigidtapFault, RigidtapStatus, answer};
use super::storage::{RigidtapBlock, RigidtapTap, given, out};
use super::tap::HostTap;
use crate::control::sync::LearnedError;
use crate::control::tapping::{Block, Tapping};

/// # Safety
/// `bytes` is null, or valid for `size` bytes for as long as the call that it came with.
unsafe fn bytes_in<'a>(bytes: *const u8, size: u64) -> Result<&'a [u8], RigidtapStatus> {
    let size = usize::try_from(size).ok().filter(|size| isize::try_from(*size).is_ok());
    let size = size.filter(|_| !bytes.is_null()).ok_or(RigidtapStatus::Null)?;
    // SAFETY: as the caller promises; not null, and no longer than any object can be.
    Ok(unsafe { core::slice::from_raw_parts(bytes, size) })
}

/// # Safety
/// As [`bytes_in`], for writing.
unsafe fn bytes_out<'a>(bytes: *mut u8, size: u64) -> Result<&'a mut [u8], RigidtapStatus> {
    let size = usize::try_from(size).ok().filter(|size| isize::try_from(*size).is_ok());
    let size = size.filter(|_| !bytes.is_null()).ok_or(RigidtapStatus::Null)?;
    // SAFETY: as the caller promises; not null, and no longer than any object can be.
    Ok(unsafe { core::slice::from_raw_parts_mut(bytes, size) })
}

/// Writes what is known, and tells how many bytes it is.
///
/// # Safety
/// As the header says of pointers.
unsafe fn save(
    save: impl FnOnce(&mut [u8]) -> Result<Result<usize, LearnedError>, RigidtapStatus>,
    bytes: *mut u8,
    size: u64,
    written: *mut u64,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (bytes, written, fault) = unsafe { (bytes_out(bytes, size), out(written), fault.as_mut()) };
    let saved = || -> Result<(), Refusal> {
        let written = written?;
        *written = save(bytes?)?? as u64;
        Ok(())
    };
    answer(saved(), fault)
}

/// # Safety
/// As the header says of pointers.
unsafe fn load(
    load: impl FnOnce(&[u8]) -> Result<Result<(), LearnedError>, RigidtapStatus>,
    bytes: *const u8,
    size: u64,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let (bytes, fault) = unsafe { (bytes_in(bytes, size), fault.as_mut()) };
    let loaded = || -> Result<(), Refusal> { Ok(load(bytes?)??) };
    answer(loaded(), fault)
}

fn tapping(tap: Result<&RigidtapTap, RigidtapStatus>) -> Result<&Tapping, RigidtapStatus> {
    Ok(&tap?.view::<HostTap>().ok_or(RigidtapStatus::NotInTurn)?.tapping)
}

/// Writes what the holes of a state taught.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_save_learned(
    tap: *const RigidtapTap,
    bytes: *mut u8,
    size: u64,
    written: *mut u64,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let tap = unsafe { given(tap) };
    // SAFETY: passed on as they came.
    unsafe { save(|bytes| Ok(tapping(tap)?.save_learned(bytes)), bytes, size, written, fault) }
}

/// Takes over what holes taught before a restart.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_tap_load_learned(
    tap: *mut RigidtapTap,
    bytes: *const u8,
    size: u64,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let tap = unsafe { out(tap) };
    let into = |bytes: &[u8]| {
        let host: &mut HostTap = tap?.get().ok_or(RigidtapStatus::NotInTurn)?;
        Ok(host.tapping.load_learned(bytes))
    };
    // SAFETY: passed on as they came.
    unsafe { load(into, bytes, size, fault) }
}

/// Writes what the holes of a block taught.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_save_learned(
    block: *const RigidtapBlock,
    bytes: *mut u8,
    size: u64,
    written: *mut u64,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let block = unsafe { given(block) };
    let from = |bytes: &mut [u8]| {
        let block: &Block = block?.view().ok_or(RigidtapStatus::NotInTurn)?;
        Ok(block.save_learned(bytes))
    };
    // SAFETY: passed on as they came.
    unsafe { save(from, bytes, size, written, fault) }
}

/// Takes over what holes taught before a restart.
///
/// # Safety
/// As the header says of pointers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn rigidtap_block_load_learned(
    block: *mut RigidtapBlock,
    bytes: *const u8,
    size: u64,
    fault: *mut RigidtapFault,
) -> RigidtapStatus {
    // SAFETY: the header asks for valid pointers or null.
    let block = unsafe { out(block) };
    let into = |bytes: &[u8]| {
        let block: &mut Block = block?.get().ok_or(RigidtapStatus::NotInTurn)?;
        Ok(block.load_learned(bytes))
    };
    // SAFETY: passed on as they came.
    unsafe { load(into, bytes, size, fault) }
}
