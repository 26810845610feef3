//! Spindle and Z held together through one hole: feedback in, setpoint out, each period.

mod block;
mod error;
mod synchronizer;
mod tapping;

pub use block::{Block, BlockRequest, BlockStage, BlockStep};
pub use error::{ErrorBand, spindle_rev_from_error_um, synchronisation_error_mm};
pub use synchronizer::{Alarm, Compensation, Mode, Settings, Stage, Step, Synchronizer};
pub use tapping::Tapping;
