//! The only loop: a program's actions through the synchronizer against any port, one row per interpolation period.
//!
//! The monitor judges each hole from the rows; the trace writes them to a file through a ring buffer. [`analysis`] finds
//! and judges holes in the counts of real encoders, where nobody says when a hole begins.

pub mod analysis;
mod atomic_file;
mod executor;
mod fault;
mod learned;
mod listener;
pub mod measured_trace;
mod monitor;
mod power_cut;
mod power_loss;
mod program;
mod row;
mod spindle_motion;
pub mod trace;

pub use atomic_file::AtomicFile;
pub use executor::{Executor, RunSettings};
pub use fault::Fault;
pub use learned::Learned;
pub use listener::Listener;
pub use monitor::{HoleOutcome, PhaseOutcome, StrokeOutcome, Verdict};
pub use power_cut::{Lost, PowerCut};
pub use power_loss::{PowerLoss, PowerLossEnd};
pub use program::{ProgramOutcome, ProgramSettings, run_actions, run_program, run_program_learning};
pub use row::{Row, RowStage};
pub(crate) use spindle_motion::SpindleMotion;
