//! Copies of fixed-capacity lists.

use arrayvec::ArrayVec;

/// A copy of a list. `ArrayVec`'s own `clone` counts against its capacity and panics where that is passed: never, but
/// the compiler cannot know, and the core is to link without any panic.
pub(crate) fn copied<T: Copy, const N: usize>(list: &ArrayVec<T, N>) -> ArrayVec<T, N> {
    ArrayVec::try_from(list.as_slice()).unwrap_or_default()
}
