//! `improved-s-curve`: changes of speed without constant acceleration and with a rounded cusp (servo-press paper,
//! figure 5 and eq. 10 to 21).
//!
//! Acceleration is continuous. Jerk is not: it steps from 0 to J where a change starts, and from −J to 0 where it ends.

use super::error::{ProfileError, check_positive};
use super::segments::{Builder, Profile};
use super::stroke_request::StrokeRequest;
use crate::control::math::sqrt;

/// The law: every change of speed reaches the same acceleration, as eq. 15 and 16 have it.
///
/// Its jerk is a result, not a limit: J = 44·a²/(27·ΔV), eq. 14. The smaller a change, the steeper it is, and the two
/// changes of a stroke whose ends differ have a J each; [`TenPhases`] is the paper's run with one J.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImprovedSCurveLaw {
    /// Acceleration and deceleration that each change of speed peaks at, a_max in units/s², positive.
    pub acceleration: f64,
}

/// A change of speed in four phases of equal length, symmetrical about its middle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Change {
    /// Speed gained, negative downwards.
    pub(super) gain: f64,
    /// One phase, T_2 = T_3 = T_4 = T_5.
    pub(super) phase_s: f64,
}

impl Change {
    /// Eq. 15 and 16.
    pub(super) fn peaking_at(gain: f64, acceleration: f64) -> Self {
        Self { gain, phase_s: 9.0 * gain.abs() / (22.0 * acceleration) }
    }

    /// J of eq. 13, with the change's sign; zero for no change.
    pub(super) fn jerk(&self) -> f64 {
        if self.phase_s > 0.0 { 3.0 * self.gain / (11.0 * self.phase_s * self.phase_s) } else { 0.0 }
    }

    pub(super) fn duration_s(&self) -> f64 {
        4.0 * self.phase_s
    }

    /// Appends the four phases: eq. 10 to 12.
    pub(super) fn push(&self, profile: &mut Builder<'_>) -> Result<(), ProfileError> {
        let (j, t) = (self.jerk(), self.phase_s);
        let bend = j / t;
        profile.push(t, 0.0, j, 0.0)?.push(t, j * t, j, -bend)?.push(t, 1.5 * j * t, 0.0, -bend)?.push(
            t,
            j * t,
            -j,
            0.0,
        )?;
        Ok(())
    }
}

impl ImprovedSCurveLaw {
    /// The stroke from rest to rest.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for anything not positive and finite.
    ///
    /// ```
    /// use rigidtap::control::profile::{ImprovedSCurveLaw, StrokeRequest};
    /// let law = ImprovedSCurveLaw { acceleration: 18.0 };
    /// let stroke = law.plan(StrokeRequest { distance: 10.0, command: 5.5 }).unwrap();
    /// // S/V + 4·T_2, T_2 = 9·V/(22·a): a change takes 18/11 of what constant acceleration would.
    /// assert!((stroke.duration_s() - (10.0 / 5.5 + 0.5)).abs() < 1e-12);
    /// ```
    pub fn plan(&self, stroke: StrokeRequest) -> Result<Profile, ProfileError> {
        self.plan_between(stroke, 0.0, 0.0)
    }

    /// The stroke that starts and ends with speeds of its own, both with zero acceleration. Its two changes of speed
    /// meet at a cruise or, where the distance is too short for the commanded speed, at a peak calculated back from it.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for anything negative or not finite; [`ProfileError::EndsAboveCommand`];
    /// [`ProfileError::TooShort`] where not even start speed → end speed fits.
    pub fn plan_between(&self, stroke: StrokeRequest, start: f64, end: f64) -> Result<Profile, ProfileError> {
        check_positive(self.acceleration)?;
        stroke.check()?;
        for speed in [start, end] {
            if !(speed >= 0.0 && speed.is_finite()) {
                return Err(ProfileError::Invalid { value: speed });
            }
        }
        let (low, ends) = (start.min(end), start.max(end));
        if ends > stroke.command {
            return Err(ProfileError::EndsAboveCommand { speed: ends, command: stroke.command });
        }
        // A change covers its mean speed times its time: as much as under this constant acceleration.
        let mean = 11.0 / 18.0 * self.acceleration;
        let needed = (ends - low) * (ends + low) / (2.0 * mean);
        if needed > stroke.distance {
            return Err(ProfileError::TooShort { distance: stroke.distance, needed });
        }
        let rest = stroke.distance - needed;
        // (v² − ends²)/mean = rest, solved for the rise above the ends: the sum alone would round a small one away.
        let gained = mean * rest;
        let free = gained / (ends + sqrt(ends * ends + gained));
        let rise = free.min(stroke.command - ends);
        let cruise = if rise < free { rest - rise * (2.0 * ends + rise) / mean } else { 0.0 };
        let change = |from: f64| Change::peaking_at((ends - from) + rise, self.acceleration);
        Profile::built(start, |profile| {
            change(start).push(profile)?;
            profile.push(cruise / (ends + rise), 0.0, 0.0, 0.0)?;
            let down = change(end);
            Change { gain: -down.gain, ..down }.push(profile)?;
            profile.finish(stroke.distance, end)
        })
    }
}

/// The paper's run of ten phases: cruise at v_s, up to v_max, down to v_e with the same J, cruise at v_e.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TenPhases {
    /// Start speed v_s in units/s, not negative.
    pub start: f64,
    /// Greatest speed v_max in units/s, above both ends.
    pub peak: f64,
    /// End speed v_e in units/s, not negative.
    pub end: f64,
    /// Greatest acceleration a_max in units/s², positive.
    pub acceleration: f64,
    /// Time of all ten phases T_f, no less than both changes take.
    pub duration_s: f64,
}

impl TenPhases {
    /// Jerk J, eq. 14.
    #[must_use]
    pub fn jerk(&self) -> f64 {
        Change::peaking_at(self.peak - self.start, self.acceleration).jerk()
    }

    /// Greatest deceleration a_min, eq. 14 and 17: negative. It differs from a_max where v_e differs from v_s.
    #[must_use]
    pub fn deceleration(&self) -> f64 {
        -self.acceleration * sqrt((self.peak - self.end) / (self.peak - self.start))
    }

    /// The run, with T_1 = T_10 by eq. 18.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for a value outside its range, with the cruise T_1 where `duration_s` is too short.
    ///
    /// ```
    /// use rigidtap::control::profile::TenPhases;
    /// let run = TenPhases { start: 1.0, peak: 12.0, end: 1.0, acceleration: 18.0, duration_s: 3.0 };
    /// let profile = run.plan().unwrap();
    /// // T_2 = 9·11/(22·18) = 0.25, so 4·T_2 up, as much down, and half a second before and after.
    /// assert!((profile.distance() - (2.0 * 6.5 + 1.0)).abs() < 1e-12);
    /// ```
    pub fn plan(&self) -> Result<Profile, ProfileError> {
        for speed in [self.start, self.end] {
            if !(speed >= 0.0) {
                return Err(ProfileError::Invalid { value: speed });
            }
            check_positive(self.peak - speed)?;
        }
        check_positive(self.acceleration)?;
        let up = Change::peaking_at(self.peak - self.start, self.acceleration);
        let down = Change::peaking_at(self.end - self.peak, self.deceleration().abs());
        let cruise_s = (self.duration_s - up.duration_s() - down.duration_s()) / 2.0;
        if !(cruise_s >= 0.0 && cruise_s.is_finite()) {
            return Err(ProfileError::Invalid { value: cruise_s });
        }
        Profile::built(self.start, |profile| {
            profile.push(cruise_s, 0.0, 0.0, 0.0)?;
            up.push(profile)?;
            down.push(profile)?;
            profile.push(cruise_s, 0.0, 0.0, 0.0)?;
            let distance = profile.state.position;
            profile.finish(distance, self.end)
        })
    }
}
