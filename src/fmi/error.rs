//! What an FMU does wrong.

use std::fmt;

/// Why an FMU cannot be the plant, or ended a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FmuError {
    /// The file cannot be read or unpacked.
    Archive(String),
    /// Its model description is none.
    Description(String),
    /// Its variables are not those of a plant: every reason.
    Variables(Vec<String>),
    /// It has no shared library for this computer.
    NoLibrary {
        /// Where it was looked for in the archive.
        path: String,
    },
    /// The process that runs it cannot be started.
    Process(String),
    /// A call of it failed.
    Call {
        /// Time of the step, s; none before the first one.
        time_s: Option<Instant>,
        /// What it said.
        message: String,
    },
    /// It gave no answer in time.
    Slow {
        /// Time of the step, s; none before the first one.
        time_s: Option<Instant>,
        /// How long it was waited for, s.
        limit_s: u64,
    },
    /// Its process ended by itself.
    Crashed {
        /// Time of the step, s; none before the first one.
        time_s: Option<Instant>,
        /// How it ended.
        status: String,
    },
}

/// A time of the simulation, to the microsecond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instant(u64);

impl Instant {
    pub(super) fn of_s(time_s: f64) -> Self {
        Self((time_s * 1e6).round() as u64)
    }
}

impl fmt::Display for Instant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0 as f64 / 1e6)
    }
}

fn at(time_s: Option<Instant>) -> String {
    time_s.map_or_else(|| "at its start".to_owned(), |time_s| format!("at {time_s} s"))
}

impl fmt::Display for FmuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Archive(why) => write!(f, "it is no FMU: {why}"),
            Self::Description(why) => write!(f, "modelDescription.xml: {why}"),
            Self::Variables(faults) => f.write_str(&faults.join("\n  ")),
            Self::NoLibrary { path } => {
                write!(
                    f,
                    "it has no library for this computer: expected {path}; ask its maker for one, or for its sources"
                )
            }
            Self::Process(why) => write!(f, "its process cannot be started: {why}"),
            Self::Call { time_s, message } => write!(f, "{}: {message}", at(*time_s)),
            Self::Slow { time_s, limit_s } => {
                write!(f, "{}: no answer within {limit_s} s: it was ended", at(*time_s))
            }
            Self::Crashed { time_s, status } => write!(f, "{}: it crashed ({status})", at(*time_s)),
        }
    }
}

impl std::error::Error for FmuError {}
