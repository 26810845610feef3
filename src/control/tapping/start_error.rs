//! Why nothing new is started.

use core::fmt;

use crate::control::cycle::CycleError;

/// Why nothing new is started.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum StartError {
    /// A hole is under way: it has to end or be retracted first.
    UnderWay,
    /// The hole, or a move to it, is not feasible.
    Cycle(CycleError),
}

impl From<CycleError> for StartError {
    fn from(error: CycleError) -> Self {
        Self::Cycle(error)
    }
}

impl fmt::Display for StartError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnderWay => f.write_str("a hole is under way: it has to end or be retracted first"),
            Self::Cycle(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for StartError {}
