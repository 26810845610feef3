//! What a recording is once it is read, and what a reader has to know beside the file.

use core::fmt;

use crate::link::plausibility::{Axis, Jump, Limits};
use crate::link::sample::Scale;

/// What a file was read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The trace of `simulate`.
    Trace,
    /// LinuxCNC's halsampler.
    Halsampler,
    /// A CSV with a map.
    Mapped,
}

impl Format {
    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trace => "trace",
            Self::Halsampler => "halsampler",
            Self::Mapped => "mapped",
        }
    }
}

/// Why a reading cannot be one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Corruption {
    /// A position that the axis cannot have.
    Position(Jump),
    /// A time that neither follows the row before nor leads to the row after.
    Time,
}

/// A corrupt reading, at its place. `Display` says what is wrong, without the place.
#[derive(Clone, Debug, PartialEq)]
pub struct Corrupt {
    /// Line, from 1.
    pub line: usize,
    /// Column of the table, from 1.
    pub column: usize,
    /// The column's heading, or `#` and its number.
    pub name: String,
    /// What stands there.
    pub value: String,
    /// Why it cannot be.
    pub why: Corruption,
}

impl fmt::Display for Corrupt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, value, .. } = self;
        match self.why {
            Corruption::Position(Jump { axis, counts, most_counts, seconds }) => {
                let (axis, keys) = match axis {
                    Axis::Spindle => ("spindle", "spindle.max_rpm, spindle.torque_curve and spindle.inertia_kg_m2"),
                    Axis::Z => ("Z", "z.max_mm_per_s, z.force_limit_n and z.mass_kg"),
                };
                if !counts.is_finite() {
                    return write!(f, "{name} is {value}: expected a count that the {axis} encoder can show");
                }
                write!(
                    f,
                    "{name} is {value}, {:.0} counts in {:.3} ms: expected at most {most_counts:.0}, by {keys} of the \
                     machine file",
                    counts.abs(),
                    seconds * 1e3
                )
            }
            Corruption::Time => {
                write!(f, "{name} is {value}: expected a time that follows the row before and leads to the row after")
            }
        }
    }
}

/// What a recording is, and what was odd about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What it was read as.
    pub format: Format,
    /// Its readings: those that became samples.
    pub readings: u64,
    /// What their counts are.
    pub scale: Scale,
    /// Usual step of time: the median of the first hundred thousand.
    pub period_s: f64,
    /// Greatest deviation from it, gaps apart.
    pub jitter_s: f64,
    /// Places where readings are missing.
    pub gaps: u64,
    /// Readings missing there, by the usual step.
    pub missing: u64,
    /// Rows whose time is that of the row before; not used.
    pub repeated: u64,
    /// Times that time went back.
    pub restarts: u64,
    /// Times that the spindle's position was reset.
    pub resets: u64,
    /// Readings that cannot be: no hole of this recording is passed.
    pub corrupt: u64,
    /// The first of them.
    pub first_corrupt: Vec<Corrupt>,
}

/// What a reader has to know beside the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Context {
    /// Counts of the machine's encoders: a trace's, and what angles and lengths are turned into.
    pub scale: Scale,
    /// Step of time of a file without any.
    pub period_s: f64,
    /// What spindle and Z can do from one row to the next.
    pub limits: Limits,
}
