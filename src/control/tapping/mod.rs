//! What a host calls: hole after hole ([`Tapping`]), or a whole block with the moves between its holes ([`Block`]).
//!
//! Both go through the same sequence. On the approach each period is observed, so that the machine is measured while it moves. The
//! spindle is braked to rest, spindle and Z come into position, the strokes run, Z is handed over without a bump, and what was
//! measured and learned goes on to the next hole.

use core::fmt;

use crate::control::cycle::CycleError;

mod block;
mod hole;

pub use block::{Block, BlockRequest, BlockStage, BlockStep};
pub use hole::{Counters, Tapping};

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
