//! The only loop: a program's actions through the synchronizer against any port, one row per interpolation period.
//!
//! The monitor judges each hole from the rows; the trace writes them to a file through a ring buffer.

mod executor;
mod monitor;
mod row;
mod spindle_motion;
pub mod trace;

pub use executor::{Executor, Fault, RunSettings};
pub use monitor::{HoleOutcome, PhaseOutcome, StrokeOutcome, Verdict};
pub use row::{Row, RowStage};
