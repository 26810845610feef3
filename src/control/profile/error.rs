//! Why there is no profile.

use core::fmt;

/// Why there is no profile.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ProfileError {
    /// A number is not finite, or not positive where it has to be.
    Invalid {
        /// The number.
        value: f64,
    },
    /// The distance is too short even to get from the start speed to the end speed.
    TooShort {
        /// Distance asked.
        distance: f64,
        /// Least distance.
        needed: f64,
    },
    /// The start or end speed is above the commanded speed.
    EndsAboveCommand {
        /// Start or end speed.
        speed: f64,
        /// Commanded speed, after clamping to the law's top.
        command: f64,
    },
    /// More segments than a profile holds.
    TooManySegments,
}

impl fmt::Display for ProfileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Invalid { value } => write!(f, "{value} is not a positive finite number"),
            Self::TooShort { distance, needed } => {
                write!(f, "the travel of {distance} is too short: from start to end speed alone takes {needed:.4}")
            }
            Self::EndsAboveCommand { speed, command } => {
                write!(f, "the law's start or end speed {speed} is above the commanded speed {command}")
            }
            Self::TooManySegments => write!(f, "the law has more segments than a profile holds"),
        }
    }
}

impl core::error::Error for ProfileError {}

/// Refuses what is not a positive finite number.
pub(crate) fn check_positive(value: f64) -> Result<(), ProfileError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ProfileError::Invalid { value }) }
}
