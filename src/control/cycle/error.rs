//! Why a hole cannot be tapped on this machine.

use core::fmt;

use crate::control::profile::ProfileError;

/// Why a hole cannot be tapped on this machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleError {
    /// The bottom is not below the R plane.
    NoStroke {
        /// R plane.
        r_plane_mm: f64,
        /// Bottom.
        bottom_mm: f64,
    },
    /// A number that has to be positive and finite is not: pitch, speed, dwell or peck.
    Invalid {
        /// The number.
        value: f64,
    },
    /// Commanded speed beyond the spindle's.
    SpindleTooFast {
        /// Commanded speed.
        needed_rpm: f64,
        /// The spindle's greatest.
        limit_rpm: f64,
    },
    /// Pitch × speed beyond Z's speed.
    PitchTooFast {
        /// Speed that Z would need.
        needed_mm_per_s: f64,
        /// Z's greatest.
        limit_mm_per_s: f64,
    },
    /// Pitch × acceleration beyond Z's acceleration.
    PitchTooSharp {
        /// Acceleration that Z would need.
        needed_mm_per_s2: f64,
        /// Z's greatest.
        limit_mm_per_s2: f64,
    },
    /// The time law has no profile for a stroke.
    Law(ProfileError),
    /// The peck is so shallow that the hole takes too many.
    TooManyPecks {
        /// Pecks that the hole would take.
        needed: f64,
        /// Most that there can be.
        limit: usize,
    },
}

impl fmt::Display for CycleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NoStroke { r_plane_mm, bottom_mm } => {
                write!(f, "the bottom Z{bottom_mm} is not below the R plane {r_plane_mm}")
            }
            Self::Invalid { value } => write!(f, "{value} is not a positive finite number"),
            Self::SpindleTooFast { needed_rpm, limit_rpm } => {
                write!(f, "S{needed_rpm} is beyond the spindle's {limit_rpm} rpm")
            }
            Self::PitchTooFast { needed_mm_per_s, limit_mm_per_s } => write!(
                f,
                "pitch × speed takes Z {needed_mm_per_s:.1} mm/s, and the machine has {limit_mm_per_s:.1} mm/s"
            ),
            Self::PitchTooSharp { needed_mm_per_s2, limit_mm_per_s2 } => write!(
                f,
                "pitch × the law's acceleration takes Z {needed_mm_per_s2:.0} mm/s², and the machine has {limit_mm_per_s2:.0} mm/s²"
            ),
            Self::Law(error) => write!(f, "the time law has no stroke: {error}"),
            Self::TooManyPecks { needed, limit } => {
                write!(f, "the hole takes {needed:.0} pecks, and at most {limit} are planned")
            }
        }
    }
}

impl core::error::Error for CycleError {}
