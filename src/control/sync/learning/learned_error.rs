//! Why a record of what was learned is not taken.

use core::fmt;

/// Why a record of what was learned is not taken, or not written; nothing has changed then.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LearnedError {
    /// It does not begin as such a record does: something else.
    NoRecord,
    /// It ends early, or the buffer has no room for it.
    TooShort {
        /// Bytes that there are.
        found: usize,
        /// Bytes that it takes.
        needed: usize,
    },
    /// The record's sum is not that of its bytes.
    Damaged {
        /// The record's.
        found: u32,
        /// That of its bytes.
        expected: u32,
    },
    /// The record is of another version of this library.
    OtherVersion {
        /// The record's.
        found: u8,
        /// This one's.
        expected: u8,
    },
    /// The record is of a machine whose axes, drives or synchronizer have other data.
    OtherMachine {
        /// The record's [`Machine::motion_fingerprint`](crate::control::machine::Machine::motion_fingerprint).
        found: u64,
        /// This machine's.
        expected: u64,
    },
    /// A number of the record cannot be.
    Invalid {
        /// The number.
        value: f64,
    },
    /// A hole is under way.
    UnderWay,
}

impl fmt::Display for LearnedError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoRecord => f.write_str("it is no record of what was learned"),
            Self::TooShort { found, needed } => write!(f, "it has {found} bytes, and {needed} are needed"),
            Self::Damaged { found, expected } => {
                write!(f, "it is damaged: its sum is {found:08x}, and that of its bytes {expected:08x}")
            }
            Self::OtherVersion { found, expected } => {
                write!(f, "it is of version {found}, and this one reads {expected}")
            }
            Self::OtherMachine { found, expected } => write!(
                f,
                "it was learned on a machine whose axes or drives have other data: {found:016x}, and this one is {expected:016x}"
            ),
            Self::Invalid { value } => write!(f, "it has {value} where that cannot be"),
            Self::UnderWay => f.write_str("a hole is under way"),
        }
    }
}

impl core::error::Error for LearnedError {}
