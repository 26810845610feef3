//! `trapezoid-jerk`: fifteen phases of constant snap, so that jerk, too, has no step (trapezoid-jerk paper, figure 1).
//!
//! Each of the limits speed, acceleration and jerk is reached or not, in all eight combinations, of which the paper
//! names three. Every one of them has a closed form without cancellation.

use super::error::{ProfileError, check_positive};
use super::quantise::{self, Shape};
use super::segments::Profile;
use super::stroke_request::StrokeRequest;
use crate::control::math::{cbrt, sqrt};

/// The law with one acceleration, one jerk and one snap for all speeds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrapezoidJerkLaw {
    /// Greatest acceleration a_max in units/s², positive.
    pub acceleration: f64,
    /// Greatest jerk j_max in units/s³, positive.
    pub jerk: f64,
    /// Slope l of the jerk in units/s⁴, positive.
    pub snap: f64,
    /// Where given, positive: each phase takes a whole number of these interpolation periods T (eq. 8 and 9).
    pub quantised_s: Option<f64>,
}

impl TrapezoidJerkLaw {
    /// The stroke from rest to rest: the fastest under the limits, or with [`quantised_s`](Self::quantised_s) one of
    /// whole periods, longer by a few of them.
    ///
    /// Whole periods are found by rounding the fastest stroke's phases, after which snap, jerk, acceleration and speed
    /// are scaled to the exact distance. The paper's eq. 8 and 9 round without scaling and miss their targets.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for anything not positive and finite.
    ///
    /// ```
    /// use rigidtap::control::profile::{StrokeRequest, TrapezoidJerkLaw};
    /// let law = TrapezoidJerkLaw { acceleration: 10.0, jerk: 100.0, snap: 2000.0, quantised_s: None };
    /// let stroke = law.plan(StrokeRequest { distance: 10.0, command: 5.0 }).unwrap();
    /// // S/V + V/a_max + a_max/j_max + j_max/l: errata of eq. 11, which drops the last.
    /// assert!((stroke.duration_s() - 2.65).abs() < 1e-12);
    /// assert_eq!(stroke.segments().len(), 15);
    /// ```
    pub fn plan(&self, stroke: StrokeRequest) -> Result<Profile, ProfileError> {
        check_positive(self.acceleration)?;
        check_positive(self.jerk)?;
        check_positive(self.snap)?;
        stroke.check()?;
        let peak = stroke.command.min(self.peak(stroke.distance));
        let shape = self.shape(peak);
        let cruise_s = (stroke.distance - peak * shape.duration_s()) / peak;
        // A cruise shorter than this would only hold the rounding of the distances.
        let cruise_s = if cruise_s * peak > f64::EPSILON * 8.0 * stroke.distance { cruise_s } else { 0.0 };
        match self.quantised_s {
            None => assemble(stroke.distance, peak, shape, cruise_s),
            Some(period_s) => {
                check_positive(period_s)?;
                let limits = quantise::Limits {
                    command: stroke.command,
                    acceleration: self.acceleration,
                    jerk: self.jerk,
                    snap: self.snap,
                };
                let (shape, cruise_s) = quantise::whole_periods(stroke.distance, period_s, &limits, shape);
                assemble(stroke.distance, stroke.distance / (shape.duration_s() + cruise_s), shape, cruise_s)
            }
        }
    }

    /// Phases within which the jerk, and acceleration with it, are as great as they may be.
    ///
    /// Where j_max is not reached, √(a_max/l) takes the place of eq. 7 and 10: errata.
    fn full_acceleration(&self) -> Shape {
        let Self { acceleration: a, jerk: j, snap: l, .. } = *self;
        if a * l >= j * j {
            Shape { snap_s: j / l, jerk_s: a / j - j / l, constant_s: 0.0 }
        } else {
            Shape { snap_s: sqrt(a / l), jerk_s: 0.0, constant_s: 0.0 }
        }
    }

    /// The quickest change from rest to a speed.
    fn shape(&self, speed: f64) -> Shape {
        let Self { acceleration: a, jerk: j, snap: l, .. } = *self;
        let full = self.full_acceleration();
        let constant_s = speed / a - full.acceleration_s();
        if constant_s >= 0.0 {
            return Shape { constant_s, ..full };
        }
        let snap_s = j / l;
        // v = j·u·(u + t_j), u the time from the first jerk to the end of its constant part.
        let rise_s = 2.0 * speed / (j * snap_s + sqrt(j * j * snap_s * snap_s + 4.0 * j * speed));
        if rise_s >= snap_s {
            Shape { snap_s, jerk_s: rise_s - snap_s, constant_s: 0.0 }
        } else {
            // v = 2·l·t³
            Shape { snap_s: cbrt(speed / (2.0 * l)), jerk_s: 0.0, constant_s: 0.0 }
        }
    }

    /// The peak that a distance from rest to rest allows without cruise, S = v · duration of one change of speed.
    fn peak(&self, distance: f64) -> f64 {
        let Self { acceleration: a, jerk: j, snap: l, .. } = *self;
        let full = self.full_acceleration();
        let full_speed = a * full.acceleration_s();
        if full_speed * full.duration_s() <= distance {
            // v²/a + v·(2·t_j + constant jerk) = S, solved without cancellation.
            let rise_s = 2.0 * full.snap_s + full.jerk_s;
            return 2.0 * distance / (rise_s + sqrt(rise_s * rise_s + 4.0 * distance / a));
        }
        let snap_s = j / l;
        // j just reached: v = 2·l·t_j³ over 4·t_j.
        if 8.0 * j * snap_s * snap_s * snap_s <= distance {
            // S = 2·j·(w − t_j)·w², w half the change's time. A cubic with one real root, by Cardano; both cube roots
            // are of positive numbers, and their product is (t_j/3)², so nothing cancels.
            let third = snap_s / 3.0;
            let (r, d) = (third * third * third, distance / (4.0 * j));
            let root = cbrt(r + d + sqrt(d * (d + 2.0 * r)));
            let half_s = third + root + third * third / root;
            distance / (2.0 * half_s)
        } else {
            // S = 8·l·t⁴, v = S/(4·t)
            distance / (4.0 * sqrt(sqrt(distance / (8.0 * l))))
        }
    }
}

/// The stroke of two changes of speed around a cruise; snap, jerk and acceleration are what this peak makes of the times.
#[inline]
fn assemble(distance: f64, peak: f64, shape: Shape, cruise_s: f64) -> Result<Profile, ProfileError> {
    let acceleration = peak / shape.acceleration_s();
    let jerk = acceleration / shape.jerk_rise_s();
    let snap = jerk / shape.snap_s;
    // Acceleration gained while the jerk rises.
    let low = jerk * shape.snap_s / 2.0;
    let high = acceleration - low;
    Profile::built(0.0, |profile| {
        for (sign, pause_s) in [(1.0, cruise_s), (-1.0, 0.0)] {
            let (a, j, l) = (sign * acceleration, sign * jerk, sign * snap);
            profile
                .push(shape.snap_s, 0.0, 0.0, l)?
                .push(shape.jerk_s, sign * low, j, 0.0)?
                .push(shape.snap_s, sign * high, j, -l)?
                .push(shape.constant_s, a, 0.0, 0.0)?
                .push(shape.snap_s, a, 0.0, -l)?
                .push(shape.jerk_s, sign * high, -j, 0.0)?
                .push(shape.snap_s, sign * low, -j, l)?
                .push(pause_s, 0.0, 0.0, 0.0)?;
        }
        profile.finish(distance, 0.0)
    })
}
