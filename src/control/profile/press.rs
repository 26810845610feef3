//! One revolution of a servo press's crank (servo-press paper, figure 6): the shortest under the slide's acceleration.
//!
//! 1. loading: around top dead centre at w_1; from θ_4 to the next θ_1 the manipulator has T_0
//! 2. idle feed: up to w_m1 and down to w_2, which it reaches at θ_2; θ_1 lies one phase (T_1) into it
//! 3. forming: at w_2 = w_3 from θ_2 to θ_3
//! 4. idle return: up to w_m2 and down to w_1; θ_4 lies one phase (T_14) before its end
//!
//! Each of the four changes of speed is one of `improved-s-curve` with a J of its own. The paper's X_0 is a start value
//! for a solver that it does not name (errata.md); this one solves the key-point conditions themselves:
//!
//! - The angle between its key points gives a leg's peak speed in closed form once its two phase times are known.
//! - Of the leg's time, the share of either change is sought by golden section for the least acceleration of the slide,
//!   and the time by a bracketed root for that acceleration to be the limit.
//! - w_1 follows from T_0 and the part of the changes that T_0 includes, a correction so small that iterating it gains
//!   two digits each time: first with the searches, then, to the last bit, with their times kept.
//!
//! A return is an idle feed filmed backwards, and h(−θ) = h(θ), so one leg serves both. All loops have fixed bounds: about
//! 2000 legs of 264 samples.

use super::error::{ProfileError, check_positive};
use super::improved_s_curve::Change;
use super::segments::Profile;
use crate::control::coupling::SliderCrank;
use crate::control::math::root;

/// What a press has to do in one stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressTask {
    /// Crank and rod.
    pub slide: SliderCrank,
    /// θ_1 in rev, above 0: the manipulator has left the press.
    pub closing_rev: f64,
    /// θ_2 in rev, above θ_1: forming starts.
    pub forming_start_rev: f64,
    /// θ_3 in rev, above θ_2: forming ends.
    pub forming_end_rev: f64,
    /// θ_4 in rev, above θ_3 and below 1: the manipulator may enter.
    pub opening_rev: f64,
    /// w_2 = w_3 in rev/s: the crank's speed while forming.
    pub forming_rev_per_s: f64,
    /// T_0 in s: what the manipulator needs between θ_4 and the next θ_1.
    pub transfer_s: f64,
    /// The slide's greatest acceleration.
    pub slide_mm_per_s2: f64,
}

/// One revolution, from top dead centre to top dead centre.
#[derive(Clone, Debug, PartialEq)]
pub struct PressStroke {
    /// The crank's motion in rev. It starts and ends at w_1, so strokes follow one another without a step.
    pub profile: Profile,
    /// When the crank passes θ_1 to θ_4.
    pub key_points_s: [f64; 4],
    /// J of the four changes of speed, magnitudes in rev/s³.
    pub jerks_rev_per_s3: [f64; 4],
}

/// Why there is no stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PressError {
    /// A number is not finite, not positive, or an angle not above the one before it.
    Invalid {
        /// The number, of an angle its distance from the one before it.
        value: f64,
    },
    /// No motion of this kind spares the slide enough.
    SlideLimit {
        /// Slide acceleration of the slowest motion tried.
        needed_mm_per_s2: f64,
        /// Its limit.
        limit_mm_per_s2: f64,
    },
    /// The changes of speed around top dead centre leave no room for each other.
    NoRoom {
        /// Angle left, negative.
        left_rev: f64,
    },
}

impl From<ProfileError> for PressError {
    fn from(error: ProfileError) -> Self {
        match error {
            ProfileError::Invalid { value } => Self::Invalid { value },
            // A revolution has 19 segments and starts from a speed it also cruises at.
            _ => Self::Invalid { value: f64::NAN },
        }
    }
}

/// Searches of both legs, each with a better w_1: two digits gained each time.
const SEARCHES: u32 = 3;
/// Corrections of w_1 after them, legs' times kept: likewise.
const CORRECTIONS: u32 = 8;
/// Golden sections: the share of the changes to 1e-5, where its optimum is flat.
const SHARE_STEPS: u32 = 24;
const SAMPLES_PER_PHASE: u32 = 32;
/// Kept free below the limit, for the slide's acceleration between two samples.
const MARGIN: f64 = 2e-4;
/// The search for a leg's time ends this close below the limit, relative.
const CLOSE: f64 = 1e-8;

impl PressTask {
    /// The shortest stroke.
    ///
    /// # Errors
    /// [`PressError`].
    pub fn plan(&self) -> Result<PressStroke, PressError> {
        self.check()?;
        let loading_span = 1.0 - self.opening_rev + self.closing_rev;
        let leg = |near_rev, far_rev, loading| LegTask { press: self, near_rev, far_rev, loading };
        let corrected =
            |feed: &Leg, back: &Leg| (loading_span - feed.outside_gain() - back.outside_gain()) / self.transfer_s;
        let mut loading = loading_span / self.transfer_s;
        let (mut feed, mut back) = (Leg::default(), Leg::default());
        for _ in 0..SEARCHES {
            feed = leg(self.closing_rev, self.forming_start_rev, loading).fastest()?;
            back = leg(1.0 - self.opening_rev, 1.0 - self.forming_end_rev, loading).fastest()?;
            loading = corrected(&feed, &back);
        }
        // The times now stand; what is left moves the slide's acceleration by less than the margin.
        for _ in 0..CORRECTIONS {
            feed = leg(self.closing_rev, self.forming_start_rev, loading).leg(feed.near.phase_s, feed.far.phase_s);
            back = leg(1.0 - self.opening_rev, 1.0 - self.forming_end_rev, loading)
                .leg(back.near.phase_s, back.far.phase_s);
            loading = corrected(&feed, &back);
        }
        self.assemble(&feed, &back)
    }

    fn check(&self) -> Result<(), PressError> {
        let angles = [0.0, self.closing_rev, self.forming_start_rev, self.forming_end_rev, self.opening_rev, 1.0];
        for (below, above) in angles.iter().zip(angles.iter().skip(1)) {
            check_positive(above - below)?;
        }
        check_positive(self.forming_rev_per_s)?;
        check_positive(self.transfer_s)?;
        Ok(check_positive(self.slide_mm_per_s2)?)
    }

    fn assemble(&self, feed: &Leg, back: &Leg) -> Result<PressStroke, PressError> {
        let loading = feed.loading;
        let (before_rev, after_rev) =
            (self.closing_rev - feed.outside_rev(), 1.0 - self.opening_rev - back.outside_rev());
        if before_rev.min(after_rev) < 0.0 {
            return Err(PressError::NoRoom { left_rev: before_rev.min(after_rev) });
        }
        let forming_s = (self.forming_end_rev - self.forming_start_rev) / self.forming_rev_per_s;
        let (up, down) = back.reversed();
        let mut key_points_s = [0.0; 4];
        let profile = Profile::built(loading, |profile| {
            profile.push(before_rev / loading, 0.0, 0.0, 0.0)?;
            let closing_s = profile.time_s + feed.near.phase_s;
            feed.near.push(profile)?;
            feed.far.push(profile)?;
            let forming_start_s = profile.time_s;
            profile.push(forming_s, 0.0, 0.0, 0.0)?;
            let forming_end_s = profile.time_s;
            up.push(profile)?;
            down.push(profile)?;
            key_points_s = [closing_s, forming_start_s, forming_end_s, profile.time_s - down.phase_s];
            profile.push(after_rev / loading, 0.0, 0.0, 0.0)?;
            profile.finish(1.0, loading)
        })?;
        Ok(PressStroke {
            profile,
            key_points_s,
            jerks_rev_per_s3: [feed.near, feed.far, up, down].map(|change| change.jerk().abs()),
        })
    }
}

/// One leg: from one phase before the near key point at loading speed, over a peak, to the far one at forming speed.
struct LegTask<'a> {
    press: &'a PressTask,
    near_rev: f64,
    far_rev: f64,
    loading: f64,
}

/// The two changes of speed of a leg.
#[derive(Clone, Copy, Default)]
struct Leg {
    near: Change,
    far: Change,
    loading: f64,
}

impl Leg {
    /// Angle of the first phase, which lies outside the key points: w_1·T_1 + J·T_1³/6.
    fn outside_rev(&self) -> f64 {
        self.loading * self.near.phase_s + self.outside_gain()
    }

    /// What that phase covers beyond loading speed.
    fn outside_gain(&self) -> f64 {
        self.near.gain * self.near.phase_s / 22.0
    }

    /// Filmed backwards: the far change first, each the other way.
    fn reversed(&self) -> (Change, Change) {
        let back = |change: Change| Change { gain: -change.gain, ..change };
        (back(self.far), back(self.near))
    }
}

impl LegTask<'_> {
    fn fastest(&self) -> Result<Leg, PressError> {
        let limit = self.press.slide_mm_per_s2;
        let kept = limit * (1.0 - MARGIN);
        let span = self.far_rev - self.near_rev;
        // At the slow end there is hardly a peak, at the fast end it is far beyond any press.
        let slow = self.loading.max(self.press.forming_rev_per_s) / span;
        let pace = root::increasing(slow, 100.0 * slow, |pace| {
            let excess = self.gentlest(1.0 / pace).1 - kept;
            if excess <= 0.0 && excess > -CLOSE * kept { 0.0 } else { excess }
        });
        let (leg, needed_mm_per_s2) = self.gentlest(1.0 / pace);
        if needed_mm_per_s2 > kept {
            return Err(PressError::SlideLimit { needed_mm_per_s2, limit_mm_per_s2: limit });
        }
        Ok(leg)
    }

    /// The leg of a given time between its key points that spares the slide most, with the slide's acceleration.
    fn gentlest(&self, duration_s: f64) -> (Leg, f64) {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let tried = |share: f64| {
            let leg = self.leg(duration_s * share / 3.0, duration_s * (1.0 - share) / 4.0);
            (leg, self.slide_mm_per_s2(&leg))
        };
        let (mut low, mut high) = (0.02, 0.98);
        let (mut left, mut right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (mut at_left, mut at_right) = (tried(left), tried(right));
        for _ in 0..SHARE_STEPS {
            if at_left.1 <= at_right.1 {
                (high, right, at_right) = (right, left, at_left);
                left = high - GOLDEN * (high - low);
                at_left = tried(left);
            } else {
                (low, left, at_left) = (left, right, at_right);
                right = low + GOLDEN * (high - low);
                at_right = tried(right);
            }
        }
        if at_left.1 <= at_right.1 { at_left } else { at_right }
    }

    /// The leg of these phase times: its peak is where the angle between the key points is right,
    /// 2·(w_1 + w_m)·T_near − outside + 2·(w_m + w_2)·T_far.
    fn leg(&self, near_s: f64, far_s: f64) -> Leg {
        let (loading, forming) = (self.loading, self.press.forming_rev_per_s);
        let span = self.far_rev - self.near_rev;
        let fixed = loading * near_s * (1.0 + 1.0 / 22.0) + 2.0 * forming * far_s;
        let peak = (span - fixed) / ((2.0 - 1.0 / 22.0) * near_s + 2.0 * far_s);
        Leg {
            near: Change { gain: peak - loading, phase_s: near_s },
            far: Change { gain: forming - peak, phase_s: far_s },
            loading,
        }
    }

    /// The slide's greatest acceleration in a leg, sampled.
    fn slide_mm_per_s2(&self, leg: &Leg) -> f64 {
        let start_rev = self.near_rev - leg.outside_rev();
        let built = Profile::built(leg.loading, |profile| {
            leg.near.push(profile)?;
            leg.far.push(profile)?;
            profile.finish(profile.state.position, profile.state.velocity)
        });
        let Ok(profile) = built else { return f64::INFINITY };
        let mut greatest = 0.0_f64;
        for segment in profile.segments() {
            for sample in 0..=SAMPLES_PER_PHASE {
                let share = f64::from(sample) / f64::from(SAMPLES_PER_PHASE);
                let mut crank = segment.start.after(share * segment.duration_s, segment.snap);
                crank.position += start_rev;
                greatest = greatest.max(self.press.slide.follow(&crank).acceleration.abs());
            }
        }
        greatest
    }
}
