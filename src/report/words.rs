//! Words that several reports share.

/// A number of things, in the singular where it is one.
pub(in crate::report) fn counted(number: usize, thing: &str) -> String {
    if number == 1 { format!("1 {thing}") } else { format!("{number} {thing}s") }
}
