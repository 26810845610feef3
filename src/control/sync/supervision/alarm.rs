//! The alarms, each with its code and its numbers.

use core::fmt;

/// Settle timeout: a machine that is not in position by then has a fault.
pub(in crate::control::sync) const SETTLE_TIMEOUT_S: f64 = 3.0;

/// A fault at run time. It is latched: the hole does not go on, and never ends as done.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Alarm {
    /// A112: spindle or Z did not come into position at the start or the end of a hole.
    NotInPosition {
        /// Seconds waited.
        waited_s: f64,
        /// The spindle's distance from its rest angle.
        spindle_rev: f64,
        /// Z's distance from its target, positive above it.
        z_mm: f64,
    },
}

/// Which axis an alarm is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The spindle.
    Spindle,
    /// Z.
    Z,
}

/// Beyond this share of a revolution it is the spindle that is not in position.
const SPINDLE_OFF_REV: f64 = 0.001;

impl Alarm {
    /// The axis that it is of.
    #[must_use]
    pub fn axis(&self) -> Axis {
        match self {
            Self::NotInPosition { spindle_rev, .. } if spindle_rev.abs() > SPINDLE_OFF_REV => Axis::Spindle,
            Self::NotInPosition { .. } => Axis::Z,
        }
    }

    /// What was measured and the limit that it broke: of A112 seconds.
    #[must_use]
    pub fn value_and_limit(&self) -> (f64, f64) {
        match self {
            Self::NotInPosition { waited_s, .. } => (*waited_s, SETTLE_TIMEOUT_S),
        }
    }

    /// The number that C hosts, HAL and `check --explain` know it by.
    ///
    /// ```
    /// use rigidtap::control::sync::Alarm;
    /// let alarm = Alarm::NotInPosition { waited_s: 3.001, spindle_rev: 0.0, z_mm: -0.5 };
    /// assert_eq!(alarm.code(), 112);
    /// assert_eq!(
    ///     alarm.to_string(),
    ///     "A112: not in position after 3.0 s: spindle 0.0000 rev, Z -0.5000 mm from where they are to rest",
    /// );
    /// ```
    #[must_use]
    pub const fn code(&self) -> u32 {
        match self {
            Self::NotInPosition { .. } => 112,
        }
    }
}

impl fmt::Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "A{}: ", self.code())?;
        match self {
            Self::NotInPosition { waited_s, spindle_rev, z_mm } => write!(
                f,
                "not in position after {waited_s:.1} s: spindle {spindle_rev:.4} rev, Z {z_mm:.4} mm from where they are to rest"
            ),
        }
    }
}

impl core::error::Error for Alarm {}
