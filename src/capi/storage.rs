//! State that lives in memory of the caller's: sized words, with a mark that tells whether they hold what they should.

use core::mem::{MaybeUninit, align_of, size_of};

use super::data::RigidtapStatus;
use super::version::API_VERSION;

/// A caller's words, and what they hold once marked.
#[repr(C, align(16))]
#[derive(Debug)]
pub struct Storage<const WORDS: usize> {
    mark: u64,
    size: u64,
    words: [MaybeUninit<u64>; WORDS],
}

/// `rigidtap_machine` of the header.
pub type RigidtapMachine = Storage<1024>;
/// `rigidtap_stroke` of the header.
pub type RigidtapStroke = Storage<512>;
/// `rigidtap_tap` of the header.
pub type RigidtapTap = Storage<12288>;

/// `rigidtap_block` of the header.
pub type RigidtapBlock = Storage<14336>;

/// A word that memory seldom holds by chance, with the version of the interface in it; each kind of content adds its own.
const MARK: u64 = 0x7269_6769_6474_6170 ^ ((API_VERSION as u64) << 32);

/// What a storage can hold.
pub(super) trait Stored: Sized {
    /// Tells the kinds apart.
    const KIND: u64;
}

impl<const WORDS: usize> Storage<WORDS> {
    const fn fits<T>() {
        assert!(size_of::<T>() <= WORDS * size_of::<u64>() && align_of::<T>() <= 16);
    }

    fn place<T: Stored>(&mut self) -> *mut T {
        const { Self::fits::<T>() }
        self.words.as_mut_ptr().cast()
    }

    /// Puts a value there; what was there needs no dropping, as nothing in the core owns anything.
    pub(super) fn put<T: Stored>(&mut self, value: T) {
        // SAFETY: large and aligned enough as checked when this is compiled, and borrowed exclusively.
        unsafe { self.place::<T>().write(value) };
        self.size = size_of::<T>() as u64;
        self.mark = MARK ^ T::KIND;
    }

    /// The value there, if there is one of this kind.
    pub(super) fn get<T: Stored>(&mut self) -> Option<&mut T> {
        if self.mark != MARK ^ T::KIND || self.size != size_of::<T>() as u64 {
            return None;
        }
        // SAFETY: the mark says that `put` wrote a value of this type, whose size agrees; borrowed exclusively.
        Some(unsafe { &mut *self.place::<T>() })
    }

    /// The value there for reading.
    pub(super) fn view<T: Stored>(&self) -> Option<&T> {
        const { Self::fits::<T>() }
        if self.mark != MARK ^ T::KIND || self.size != size_of::<T>() as u64 {
            return None;
        }
        // SAFETY: as in `get`, borrowed shared.
        Some(unsafe { &*self.words.as_ptr().cast::<T>() })
    }
}

/// A caller's pointer to write through.
///
/// # Safety
/// It is null, or aligned and valid for as long as the call that it came with.
pub(super) unsafe fn out<'a, T>(pointer: *mut T) -> Result<&'a mut T, RigidtapStatus> {
    // SAFETY: as the caller promises; null is what `as_mut` asks for.
    unsafe { pointer.as_mut() }.ok_or(RigidtapStatus::Null)
}

/// A caller's pointer to read through.
///
/// # Safety
/// As [`out`].
pub(super) unsafe fn given<'a, T>(pointer: *const T) -> Result<&'a T, RigidtapStatus> {
    // SAFETY: as the caller promises; null is what `as_ref` asks for.
    unsafe { pointer.as_ref() }.ok_or(RigidtapStatus::Null)
}

/// Answers a question about a value in a storage.
///
/// # Safety
/// As [`out`] for both pointers.
pub(super) unsafe fn read<const WORDS: usize, T: Stored, A>(
    storage: *const Storage<WORDS>,
    answer: *mut A,
    value: impl FnOnce(&T) -> A,
) -> RigidtapStatus {
    // SAFETY: passed on as they came.
    let (Ok(storage), Ok(answer)) = (unsafe { (given(storage), out(answer)) }) else { return RigidtapStatus::Null };
    let Some(stored) = storage.view() else { return RigidtapStatus::NotInTurn };
    *answer = value(stored);
    RigidtapStatus::Ok
}
