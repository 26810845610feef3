//! Why parts do not make a sweep.

use std::fmt;

use super::shard::Shard;

/// Why a file is no part of the sweep that is merged.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PartFault {
    /// It cannot be read.
    Unreadable(String),
    /// No part of any sweep.
    NoPart,
    /// Of another form.
    Format {
        /// Its form's version.
        found: u64,
        /// The one that this program reads.
        expected: u32,
    },
    /// Of another sweep.
    Other {
        /// In what it differs.
        what: &'static str,
        /// As the part has it.
        found: String,
        /// As the merged sweep has it.
        expected: String,
    },
    /// Cut short or changed.
    Damaged,
    /// This program draws another machine than the part has.
    DrawnOtherwise {
        /// Number of the machine.
        run: u32,
    },
}

impl fmt::Display for PartFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unreadable(error) => write!(f, "it cannot be read: {error}"),
            Self::NoPart => f.write_str("it is no part of a sweep: expected a file that sweep --shard wrote"),
            Self::Format { found, expected } => {
                write!(f, "its form is of version {found}, expected {expected}: run the part again with this rigidtap")
            }
            Self::Other { what, found, expected } => {
                write!(f, "it is a part of another sweep: its {what} is {found}, expected {expected}")
            }
            Self::Damaged => f.write_str("it is cut short or damaged: copy it again, or run this part again"),
            Self::DrawnOtherwise { run } => {
                write!(f, "this rigidtap draws another machine {run} than the part has: run the part again")
            }
        }
    }
}

/// Why parts do not make a sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MergeFault {
    /// One of them is no part of it.
    Part {
        /// Name of the file.
        name: String,
        /// Why.
        fault: PartFault,
    },
    /// Two of them have the same machines.
    Overlap {
        /// Names of the files.
        names: [String; 2],
        /// First and last machine that both have.
        runs: [u32; 2],
    },
    /// Machines that no part has.
    Missing {
        /// First and last of them.
        runs: [u32; 2],
        /// The part that has them, where the others tell.
        shard: Option<Shard>,
    },
}

impl fmt::Display for MergeFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Part { name, fault } => write!(f, "{name}: {fault}"),
            Self::Overlap { names: [one, other], runs: [first, last] } => {
                write!(f, "{one} and {other} both have machines {first} to {last}: leave one of them out")
            }
            Self::Missing { runs: [first, last], shard: Some(shard) } => write!(
                f,
                "part {shard} is missing, machines {first} to {last}: run it again with --shard {shard}, or name its file"
            ),
            Self::Missing { runs: [first, last], shard: None } => {
                write!(f, "machines {first} to {last} are in no part")
            }
        }
    }
}
