//! What a stroke asks of a law.

use super::error::{ProfileError, check_positive};

/// What a stroke asks of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeRequest {
    /// Distance S, positive.
    pub distance: f64,
    /// Commanded speed, positive; the peak is lower where the distance is too short for it.
    pub command: f64,
}

/// Magnitudes of the acceleration with which a stroke starts from rest, and comes to it: 0 but where it turns back
/// without a pause, which then is one smooth motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turns {
    /// At the start, forwards.
    pub start: f64,
    /// At the end, backwards.
    pub end: f64,
}

impl StrokeRequest {
    /// Refuses what is not a positive finite number.
    pub(crate) fn check(&self) -> Result<(), ProfileError> {
        check_positive(self.distance)?;
        check_positive(self.command)
    }
}
