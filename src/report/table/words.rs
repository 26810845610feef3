//! Words that several tables share.

use crate::control::sync::{Compensation, Settings};

/// A number of things, in the singular where it is one.
pub(in crate::report) fn counted(number: usize, thing: &str) -> String {
    if number == 1 { format!("1 {thing}") } else { format!("{number} {thing}s") }
}

pub(super) fn percent(share: f64) -> String {
    format!("{:.0} %", share * 100.0)
}

pub(super) const fn yes(so: bool) -> &'static str {
    if so { "yes" } else { "" }
}

/// How spindle and Z were synchronised, as the command line's words have it.
pub(super) fn settings(sync: Settings) -> String {
    let mut words = format!("{}, compensation {}", sync.mode.name(), sync.compensation.name());
    if sync.compensation == Compensation::ModelBased {
        if !sync.identify {
            words += ", not identified";
        }
        if sync.learn {
            words += ", learning";
        }
    }
    words
}
