//! What ended a run before its end.

use crate::control::sync::Alarm;

/// A fault that ended a run, with its period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// Period, from 0 at the program's start.
    pub k: u64,
    /// Its time.
    pub time_s: f64,
    /// Hole, from 1.
    pub hole: u32,
    /// Periods so far in which the spindle's drive stood at its torque limit.
    pub saturated_periods: u64,
    /// What happened.
    pub alarm: Alarm,
}
