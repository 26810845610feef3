//! Who looks on while a program runs.

use super::monitor::HoleOutcome;
use super::row::Row;

/// What is seen of a run while it goes on.
pub trait Listener {
    /// A period, with the pitch of its hole; 0 between holes.
    fn row(&mut self, pitch_mm: f64, row: &Row);
    /// A hole is done.
    fn hole(&mut self, _outcome: &HoleOutcome) {}
    /// An alarm ends the run in this hole, which is judged as far as it came.
    fn unfinished(&mut self, _outcome: &HoleOutcome) {}
}

/// Nobody looks.
impl Listener for () {
    fn row(&mut self, _pitch_mm: f64, _row: &Row) {}
}
