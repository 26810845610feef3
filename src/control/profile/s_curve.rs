//! `s-curve`: seven segments of constant jerk (multi-axis paper, section 2 and figure 1), with every degenerate case.

use super::error::{ProfileError, check_positive};
use super::segments::{Builder, Profile};
use super::stroke_request::StrokeRequest;
use crate::control::math::{cbrt, root, sqrt};

/// The law with one acceleration A and one jerk J for all speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurveLaw {
    /// Greatest acceleration A, positive.
    pub acceleration: f64,
    /// Jerk J, positive.
    pub jerk: f64,
}

/// A change of speed: jerk up, constant acceleration, jerk down.
#[derive(Clone, Copy)]
struct Ramp {
    jerk_s: f64,
    constant_s: f64,
    acceleration: f64,
}

impl Ramp {
    fn duration_s(&self) -> f64 {
        2.0 * self.jerk_s + self.constant_s
    }
}

impl SCurveLaw {
    /// The stroke from rest to rest.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for anything not positive and finite.
    ///
    /// ```
    /// use rigidtap::control::profile::{SCurveLaw, StrokeRequest};
    /// let law = SCurveLaw { acceleration: 10.0, jerk: 100.0 };
    /// let stroke = law.plan(StrokeRequest { distance: 10.0, command: 5.0 }).unwrap();
    /// // S/V + V/A + A/J, eq. 17 on either side of the cruise.
    /// assert!((stroke.duration_s() - 2.6).abs() < 1e-12);
    /// ```
    pub fn plan(&self, stroke: StrokeRequest) -> Result<Profile, ProfileError> {
        let mut profile = Profile::default();
        self.plan_into(stroke, &mut profile)?;
        Ok(profile)
    }

    /// As [`SCurveLaw::plan`], into the caller's storage: a profile is some kilobytes that need not be moved.
    ///
    /// # Errors
    /// As [`SCurveLaw::plan`]; the profile is then not to be used.
    pub fn plan_into(&self, stroke: StrokeRequest, profile: &mut Profile) -> Result<(), ProfileError> {
        self.check()?;
        stroke.check()?;
        let peak = stroke.command.min(self.rest_to_rest_peak(stroke.distance));
        self.assemble(profile, stroke.distance, [0.0, peak, 0.0])
    }

    /// The stroke that starts and ends with speeds of its own, both with zero acceleration.
    ///
    /// The peak has no closed form where the two ramps differ in kind; it is a bracketed root in bounded steps.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for anything negative or not finite; [`ProfileError::EndsAboveCommand`];
    /// [`ProfileError::TooShort`] where not even start speed → end speed fits.
    pub fn plan_between(&self, stroke: StrokeRequest, start: f64, end: f64) -> Result<Profile, ProfileError> {
        self.check()?;
        stroke.check()?;
        for speed in [start, end] {
            if !(speed >= 0.0 && speed.is_finite()) {
                return Err(ProfileError::Invalid { value: speed });
            }
        }
        let ends = start.max(end);
        if ends > stroke.command {
            return Err(ProfileError::EndsAboveCommand { speed: ends, command: stroke.command });
        }
        let flanks = |peak: f64| self.ramp_distance(start, peak) + self.ramp_distance(peak, end);
        let needed = flanks(ends);
        if needed > stroke.distance {
            return Err(ProfileError::TooShort { distance: stroke.distance, needed });
        }
        // A change from the ends covers no less than the same change from rest: this bound keeps the bracket narrow.
        let highest = stroke.command.min(ends + self.rest_to_rest_peak(stroke.distance));
        let peak = root::increasing(ends, highest, |peak| flanks(peak) - stroke.distance);
        let mut profile = Profile::default();
        self.assemble(&mut profile, stroke.distance, [start, peak, end])?;
        Ok(profile)
    }

    fn check(&self) -> Result<(), ProfileError> {
        check_positive(self.acceleration)?;
        check_positive(self.jerk)
    }

    /// The peak that a distance from rest to rest allows without cruise.
    fn rest_to_rest_peak(&self, distance: f64) -> f64 {
        let (a, j) = (self.acceleration, self.jerk);
        if distance * j * j >= 2.0 * a * a * a {
            // A is reached: v²/A + v·A/J = S, solved without cancellation.
            let ramp_s = a / j;
            2.0 * distance / (ramp_s + sqrt(ramp_s * ramp_s + 4.0 * distance / a))
        } else {
            // A is not reached: 2·v·√(v/J) = S.
            cbrt(distance * distance * j / 4.0)
        }
    }

    /// Eq. 14 to 17; where the change is too small for A, the constant part vanishes and the peak acceleration is √(J·ΔV).
    fn ramp(&self, from: f64, to: f64) -> Ramp {
        let change = (to - from).abs();
        let sign = if to < from { -1.0 } else { 1.0 };
        if change * self.jerk >= self.acceleration * self.acceleration {
            let jerk_s = self.acceleration / self.jerk;
            Ramp { jerk_s, constant_s: change / self.acceleration - jerk_s, acceleration: sign * self.acceleration }
        } else {
            let jerk_s = sqrt(change / self.jerk);
            Ramp { jerk_s, constant_s: 0.0, acceleration: sign * self.jerk * jerk_s }
        }
    }

    /// A ramp is symmetrical about its middle, so it covers its mean speed times its time.
    fn ramp_distance(&self, from: f64, to: f64) -> f64 {
        (from + to) / 2.0 * self.ramp(from, to).duration_s()
    }

    #[inline]
    fn assemble(&self, profile: &mut Profile, distance: f64, speeds: [f64; 3]) -> Result<(), ProfileError> {
        let [start, peak, end] = speeds;
        let (up, down) = (self.ramp(start, peak), self.ramp(peak, end));
        let cruise = distance - self.ramp_distance(start, peak) - self.ramp_distance(peak, end);
        profile.rebuild(start, |profile| {
            self.push_ramp(profile, up)?;
            // A cruise shorter than this would only hold the rounding of the distances.
            if cruise > f64::EPSILON * 8.0 * distance {
                profile.push(cruise / peak, 0.0, 0.0, 0.0)?;
            }
            self.push_ramp(profile, down)?;
            profile.finish(distance, end)
        })
    }

    #[inline]
    fn push_ramp(&self, profile: &mut Builder<'_>, ramp: Ramp) -> Result<(), ProfileError> {
        let jerk = self.jerk.copysign(ramp.acceleration);
        profile.push(ramp.jerk_s, 0.0, jerk, 0.0)?.push(ramp.constant_s, ramp.acceleration, 0.0, 0.0)?.push(
            ramp.jerk_s,
            ramp.acceleration,
            -jerk,
            0.0,
        )?;
        Ok(())
    }
}
