//! Words that several tables share.

pub(in crate::report) use crate::report::words::counted;

use crate::control::sync::{Compensation, Settings};

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
