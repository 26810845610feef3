//! `linear`: one acceleration up to the peak and down again, the papers' baseline.

use super::error::{ProfileError, check_positive};
use super::segments::Profile;
use super::stroke_request::StrokeRequest;
use super::torque_curve::{SpeedBand, TorqueCurveLaw};

/// The law with one acceleration for all speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearLaw {
    /// Acceleration and deceleration, positive.
    pub acceleration: f64,
}

impl LinearLaw {
    /// The stroke from rest to rest: a torque-curve stroke whose one band reaches the commanded speed.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for anything not positive and finite.
    pub fn plan(&self, stroke: StrokeRequest) -> Result<Profile, ProfileError> {
        check_positive(self.acceleration)?;
        stroke.check()?;
        let band = SpeedBand {
            to_rev_per_s: stroke.command,
            accel_rev_per_s2: self.acceleration,
            decel_rev_per_s2: self.acceleration,
        };
        TorqueCurveLaw::from_rest(&[band])?.plan(stroke)
    }
}
