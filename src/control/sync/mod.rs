//! Spindle and Z held together through one hole: feedback in, setpoint out, each period.

mod error;
mod synchronizer;
mod tapping;

pub use error::{ErrorBand, spindle_rev_from_error_um, synchronisation_error_mm};
pub use synchronizer::{Alarm, Compensation, Mode, Settings, Stage, Step, Synchronizer};
pub use tapping::Tapping;
