//! What a recording is once it is read, and what a reader has to know beside the file.

use crate::link::receiver::Fastest;
use crate::link::sample::{Sample, Scale};

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

/// A recording as samples, and what was odd about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What it was read as.
    pub format: Format,
    /// Its samples.
    pub samples: Vec<Sample>,
    /// What their counts are.
    pub scale: Scale,
    /// Usual step of time: the median.
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
}

/// What a reader has to know beside the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Context {
    /// Counts of the machine's encoders: a trace's, and what angles and lengths are turned into.
    pub scale: Scale,
    /// Step of time of a file without any.
    pub period_s: f64,
    /// A spindle that goes further in one step was reset.
    pub fastest: Fastest,
}
