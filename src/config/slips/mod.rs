//! Plausibility: values that a machine can have and that were yet probably meant otherwise, each with what was likely
//! meant. Nothing here rejects a file.

mod relations;
mod slip;
mod usual;

pub use slip::Slip;
pub(super) use usual::{likely_speed_unit, likely_units};

use super::keys::Draft;

/// Reports what is improbable among the keys that the file gives: the reference machine's values are nobody's slip.
///
/// A value that is improbable by itself is not held against others as well: one slip, one warning.
pub(super) fn find(draft: &Draft, given: &dyn Fn(&str) -> bool, report: &mut dyn FnMut(Slip)) {
    let mut alone = Vec::new();
    usual::find(draft, given, &mut |slip| alone.push(slip));
    let odd = |key: &str| alone.iter().any(|slip| slip.key == key);
    relations::find(draft, given, &odd, report);
    alone.into_iter().for_each(report);
}
