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

impl Axis {
    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Spindle => "spindle",
            Self::Z => "z",
        }
    }
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

    /// What it means, why it comes, and what to do: `rigidtap check --explain A112`. None for a number that no alarm has.
    #[must_use]
    pub const fn explanation(code: u32) -> Option<&'static str> {
        match code {
            112 => Some(NOT_IN_POSITION),
            _ => None,
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

const NOT_IN_POSITION: &str = "A112: not in position\n\n\
    Before a hole, spindle and Z have to stand within 0.001 rev and 2 um of where they are to rest, for 10 ms; after it the\n\
    spindle within 0.01 rev and Z within 50 um. Within 3 s they did not.\n\n\
    Why it comes: a drive is off, an axis is held by friction that its drive does not overcome, the spindle lost its command\n\
    in the hole and still turns, or an encoder's scale is not what the machine file says.\n\n\
    What to do: look which axis it is and how far it is off. Where the spindle was at its torque limit, lower the torque\n\
    utilisation (--share) or the speed. Both axes are held until the alarm is acknowledged.\n";

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
