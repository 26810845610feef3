//! What can be wrong with a machine file; [`wording`](super::wording) says it in words.

use super::keys;
use super::slips::Slip;
use crate::control::machine::{MachineError, MachineFault, MachineWarning, MachineWarningKind};

/// What is wrong, or unwise, at one place of a machine file. `Display` says it, [`ConfigFault::hint`] what to do.
#[derive(Clone, Debug, PartialEq)]
pub enum ConfigFault {
    /// Far longer than any machine file.
    TooLong {
        /// Bytes found.
        bytes: usize,
        /// Most that are read.
        limit: usize,
    },
    /// Not text.
    NotUtf8 {
        /// The first byte that is not UTF-8.
        byte: u8,
    },
    /// Not TOML.
    Syntax {
        /// The TOML reader's own words.
        message: String,
    },
    /// A key or table that stands twice.
    Duplicate {
        /// Its name.
        name: String,
    },
    /// A key or table that nobody reads.
    UnknownKey {
        /// The table it stands in, empty at the top of the file.
        table: &'static str,
        /// Its name.
        name: String,
    },
    /// A key of an earlier version. It is a warning: the value is read under the new name.
    Renamed {
        /// The key.
        old: &'static str,
        /// Its new name; none where it is not needed any more.
        new: Option<&'static str>,
    },
    /// A value of another kind.
    WrongType {
        /// The key.
        key: String,
        /// What the key takes.
        expected: Expected,
        /// What stands there.
        found: Found,
    },
    /// A word that is none of the key's.
    UnknownWord {
        /// The key.
        key: &'static str,
        /// The word.
        word: String,
        /// The key's words.
        known: &'static [&'static str],
    },
    /// A range whose ends are the wrong way round.
    RangeOrder {
        /// The key.
        key: &'static str,
        /// The first end.
        low: f64,
        /// The second end.
        high: f64,
    },
    /// A band without its speed, or without both its times or both its accelerations.
    BandIncomplete {
        /// Band, from 0.
        index: usize,
        /// What is missing.
        missing: &'static str,
    },
    /// A band with a time and an acceleration.
    BandMixed {
        /// Band, from 0.
        index: usize,
    },
    /// More bands than a law can have.
    TooManyBands {
        /// Bands given.
        count: usize,
    },
    /// A value that no machine has, or that contradicts another.
    Value(MachineError),
    /// A share of machines that is none.
    Ratio {
        /// The key whose ratio it is.
        key: &'static str,
        /// The value.
        ratio: f64,
    },
    /// A value and a factor on the file's own in place of each other.
    Both {
        /// The value's key.
        key: &'static str,
        /// The factor's key.
        other: &'static str,
    },
    /// Runs, but is unwise.
    Unwise(MachineWarning),
    /// Possible, but probably meant otherwise. It is a warning.
    Slip(Slip),
    /// More was found than is worth reading.
    More {
        /// What is left out.
        count: usize,
    },
}

impl ConfigFault {
    /// Whether the file can be used all the same.
    #[must_use]
    pub const fn is_warning(&self) -> bool {
        matches!(self, Self::Unwise(_) | Self::Slip(_) | Self::Renamed { .. })
    }
}

/// The kind of value that a key takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// A number.
    Number,
    /// `true` or `false`
    Switch,
    /// One of some words.
    Word(&'static [&'static str]),
    /// `[low, high]`, `{ any = [low, high], ratio = x }` or `{ one_of = [a, b] }`
    Range,
    /// The list of a choice.
    Choices,
    /// `{ one_of = ["a", "b"] }`
    Words,
    /// A table.
    Table,
    /// `[[rpm, N·m], …]`
    Points,
    /// `[rpm, N·m]`
    Point,
    /// A list of bands.
    Bands,
    /// One band.
    Band,
}

/// A value of the wrong kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Found {
    /// What TOML calls it, with its article.
    pub kind: &'static str,
    /// The value as it stands in the file, shortened.
    pub text: String,
}

/// The keys between which a fault lies, the one to change first.
pub(super) fn involved(error: &MachineError) -> Vec<&'static str> {
    let other: &[&'static str] = match error.fault {
        MachineFault::TorqueCurveEnd { .. } => &["spindle.max_rpm"],
        MachineFault::PartNotBelowWhole { .. } => &["spindle.inertia_kg_m2"],
        MachineFault::SpeedAboveBands { .. } => &[keys::BANDS],
        MachineFault::PeriodsDisagree { .. } => &["control.period_s"],
        MachineFault::HoleNotBelowMajor { .. } | MachineFault::TapIncomplete => &["tap.major_mm", "tap.hole_mm"],
        MachineFault::OutOfRange { .. }
        | MachineFault::TorqueCurve(_)
        | MachineFault::BandOrder { .. }
        | MachineFault::NoBands
        | MachineFault::EncoderTooCoarse { .. } => &[],
    };
    core::iter::once(error.key).chain(other.iter().copied().filter(|key| *key != error.key)).collect()
}

/// The keys between which a warning lies, likewise.
pub(super) fn warned_of(warning: &MachineWarning) -> Vec<&'static str> {
    let other: &[&'static str] = match warning.kind {
        MachineWarningKind::AboveMotor { .. } => &["spindle.torque_curve", "spindle.inertia_kg_m2"],
        MachineWarningKind::EndsBelowMax { .. } | MachineWarningKind::ZSlowForSpindle { .. } => &["spindle.max_rpm"],
    };
    core::iter::once(warning.key).chain(other.iter().copied()).collect()
}
