//! Why no bands can be tuned.

use core::fmt;

use crate::control::machine::MachineError;
use crate::control::profile::MAX_BANDS;

/// Why no bands can be tuned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TuneError {
    /// No band, or more than [`MAX_BANDS`].
    BandCount {
        /// Bands asked for.
        count: usize,
    },
    /// No stroke to tune for.
    NoStrokes,
    /// A stroke that is not positive and finite.
    Stroke {
        /// Its distance.
        distance_rev: f64,
    },
    /// A motor share outside (0, 1].
    Share {
        /// The share.
        share: f64,
    },
    /// A greatest speed that is not positive and finite.
    Speed {
        /// The speed.
        max_rpm: f64,
    },
    /// Band tops that do not rise from zero to the greatest speed.
    Tops,
    /// The machine does not take the bands.
    Machine(MachineError),
}

impl fmt::Display for TuneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BandCount { count } => write!(f, "the number of bands is {count}, expected 1 to {MAX_BANDS}"),
            Self::NoStrokes => f.write_str("no stroke to tune for"),
            Self::Stroke { distance_rev } => write!(f, "a stroke of {distance_rev} rev, expected more than 0"),
            Self::Share { share } => write!(f, "the motor share is {share}, expected above 0 up to 1"),
            Self::Speed { max_rpm } => write!(f, "the greatest speed is {max_rpm} rpm, expected more than 0"),
            Self::Tops => f.write_str("band tops have to rise from above 0 to the greatest speed"),
            Self::Machine(error) => write!(f, "{error}"),
        }
    }
}
