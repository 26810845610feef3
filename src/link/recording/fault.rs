//! Why a file is no recording.

use core::fmt;

use super::headings::{DRIVE, TRACE};

/// Why a file is no recording; with its place, from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingError {
    /// What is wrong.
    pub kind: RecordingErrorKind,
    /// Line.
    pub line: usize,
    /// Column in characters.
    pub column: usize,
}

/// What can be wrong with a recording.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordingErrorKind {
    /// It has no rows.
    Empty,
    /// It cannot be read to its end; the system's own words.
    Unreadable(String),
    /// Its first line is none of the known formats'.
    UnknownFormat,
    /// No column has this heading.
    NoHeading(String),
    /// The row ends before the column that is needed, from 1.
    ShortRow(usize),
    /// Something else than a number.
    NotANumber(String),
    /// A recording of the drives, too, lacks this column.
    NoDriveHeading(&'static str),
    /// Rows are this far apart instead of the interpolation period.
    Period {
        /// Usual step of time.
        found_s: f64,
        /// The machine's period.
        expected_s: f64,
    },
}

impl fmt::Display for RecordingErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "no readings here: expected rows of numbers"),
            Self::Unreadable(why) => write!(f, "it cannot be read further: {why}"),
            Self::UnknownFormat => write!(
                f,
                "neither a trace with the headings {}, nor halsampler's numbers: name the columns with --map",
                TRACE.join(", ")
            ),
            Self::NoHeading(name) => write!(f, "no column is headed `{name}`; a file without headings needs #1, #2 …"),
            Self::ShortRow(column) => write!(f, "the row ends here: expected a number in column {column}"),
            Self::NotANumber(found) => write!(f, "found `{found}`: expected a number"),
            Self::NoDriveHeading(name) => write!(
                f,
                "no column is headed `{name}`: expected a trace as simulate writes it, with at least {}",
                DRIVE.join(", ")
            ),
            Self::Period { found_s, expected_s } => write!(
                f,
                "rows are {found_s:.6} s apart: expected the machine's control.period_s = {expected_s:.6} s, each period one row"
            ),
        }
    }
}
