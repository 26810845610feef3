//! A motor's ceiling: tangents below what its torque curve and friction leave.
//!
//! The limit s + b/v ± k·v is convex in the plane of speed and squared acceleration (see `ceiling`), so its tangents lie
//! below it, while a chord there, or a straight line in the plane of v and a, would ask for more torque than there is.

use arrayvec::ArrayVec;

use super::ceiling::{Ceiling, Flank};
use super::segments::MAX_LINES;
use crate::control::math::{ceil, exp, ln, root};
use crate::control::motor::{Friction, MAX_POINTS, Motor};
use crate::control::units::{RAD_PER_REV, rev_per_s_from_rpm, rpm_from_rev_per_s};

/// The acceleration changes by no more than this factor, as a logarithm, between points at which the ceiling touches its
/// limit: then its tangents stay within 0.4 % of it on average.
const STEP: f64 = 0.25;
/// Each try at fewer lines widens the step this much; the tries suffice for one step per piece whatever the curve.
const COARSER: f64 = 1.5;
const MAX_TRIES: u32 = 24;
/// Share of the motor that friction has to leave; the ceiling ends at the speed where it leaves less.
const LEAST_LEFT: f64 = 0.02;

/// A limit a = constant + inverse/v + linear·v on [`low`, `high`].
#[derive(Clone, Copy, Debug)]
struct Limit {
    low: f64,
    high: f64,
    constant: f64,
    inverse: f64,
    linear: f64,
}

impl Limit {
    fn at(&self, v: f64) -> f64 {
        self.constant + self.linear * v + if self.inverse == 0.0 { 0.0 } else { self.inverse / v }
    }

    /// Slope of the limit's square over speed.
    fn slope(&self, v: f64) -> f64 {
        let slope = self.linear - if self.inverse == 0.0 { 0.0 } else { self.inverse / (v * v) };
        2.0 * self.at(v) * slope
    }

    fn is_flat(&self) -> bool {
        self.inverse == 0.0 && self.linear == 0.0
    }

    /// Where torque rises with speed the limit is concave: each chord is below it, and its square convex again.
    fn chord(&self) -> Self {
        let linear = (self.at(self.high) - self.at(self.low)) / (self.high - self.low);
        Self { constant: self.at(self.low) - linear * self.low, inverse: 0.0, linear, ..*self }
    }

    /// Factor by which the limit changes on its way, rises and falls added up, as a logarithm.
    fn change(&self) -> f64 {
        let by_torque = if self.inverse == 0.0 { 0.0 } else { self.inverse.abs() * (1.0 / self.low - 1.0 / self.high) };
        let by_friction = self.linear.abs() * (self.high - self.low);
        ln(1.0 + (by_torque + by_friction) / self.at(self.low).min(self.at(self.high)))
    }

    fn steps(&self, step: f64) -> usize {
        // A chord lies further off than a tangent.
        let step = if self.inverse < 0.0 { step / 2.0 } else { step };
        if self.is_flat() { 1 } else { (ceil(self.change() / step) as usize).clamp(1, MAX_LINES) }
    }

    fn lines(&self, step: f64) -> usize {
        if self.is_flat() {
            1
        } else if self.inverse > 0.0 {
            self.steps(step) + 1
        } else {
            2 * self.steps(step)
        }
    }

    /// The upper ends of `steps` parts between which the torque changes by like factors.
    fn cuts(self, steps: usize) -> impl Iterator<Item = f64> {
        let Self { low, high, constant, inverse, .. } = self;
        // Of the torque alone, so that the speed follows from it; friction's own change is cut evenly in speed.
        let torque = move |v: f64| constant + inverse / v;
        let change = if inverse == 0.0 { 0.0 } else { ln(torque(high) / torque(low)) };
        let even = change.abs() <= STEP / 2.0;
        (1..=steps).map(move |index| {
            let share = index as f64 / steps as f64;
            if index == steps {
                high
            } else if even {
                low + (high - low) * share
            } else {
                (inverse / (torque(low) * exp(change * share) - constant)).max(low).min(high)
            }
        })
    }
}

impl Ceiling {
    /// The ceiling under `share` of a motor's torque, less or plus friction; empty where friction leaves nothing at rest.
    pub(super) fn of_motor(motor: &Motor, friction: Friction, share: f64, flank: Flank) -> Self {
        let per_nm = 1.0 / (motor.inertia_kg_m2 * RAD_PER_REV);
        let sign = match flank {
            Flank::Up => -per_nm,
            Flank::Down => per_nm,
        };
        let limits = motor.curve.pieces().map(move |([low_rpm, high_rpm], slope_nm, power_nm_rpm)| Limit {
            low: rev_per_s_from_rpm(low_rpm),
            high: rev_per_s_from_rpm(high_rpm),
            constant: share * slope_nm * per_nm + sign * friction.coulomb_nm,
            inverse: share * rev_per_s_from_rpm(power_nm_rpm) * per_nm,
            linear: sign * rpm_from_rev_per_s(friction.viscous_nm_per_rpm),
        });
        let left = |limit: &Limit, v: f64| {
            let torque = share * motor.curve.torque_nm(rpm_from_rev_per_s(v)) * per_nm;
            limit.at(v) - LEAST_LEFT * torque
        };
        let mut kept = ArrayVec::<Limit, MAX_POINTS>::new();
        for limit in limits {
            if !(left(&limit, limit.low) > 0.0) {
                break;
            }
            let high = root::increasing(limit.low, limit.high, |v| -left(&limit, v));
            // As many as there are points at most.
            let _ = kept.try_push(Limit { high, ..limit });
            if high < limit.high {
                break;
            }
        }
        Self::below(&kept)
    }

    /// The ceiling below limits that join each other.
    fn below(limits: &[Limit]) -> Self {
        let mut step = STEP;
        for _ in 0..MAX_TRIES {
            if limits.iter().map(|limit| limit.lines(step)).sum::<usize>() <= MAX_LINES {
                break;
            }
            step *= COARSER;
        }
        let mut ceiling = Self::default();
        if let Some(first) = limits.first() {
            ceiling.push(first.low, first.at(first.low) * first.at(first.low));
        }
        for limit in limits.iter().filter(|limit| limit.high > limit.low) {
            let mut low = limit.low;
            for high in limit.cuts(limit.steps(step)) {
                let part = Limit { low, high, ..*limit };
                ceiling.push_tangents(&if limit.inverse < 0.0 { part.chord() } else { part }, limit.high);
                low = high;
            }
        }
        ceiling
    }

    /// The tangents at both ends of a limit, up to their intersection and on from it.
    fn push_tangents(&mut self, part: &Limit, piece_high: f64) {
        let Limit { low, high, .. } = *part;
        let (at_low, at_high) = (part.at(low) * part.at(low), part.at(high) * part.at(high));
        let (slope_low, slope_high) = (part.slope(low), part.slope(high));
        if !part.is_flat() {
            let apart = slope_high - slope_low;
            let rise = (slope_high * (high - low) - (at_high - at_low)) / apart;
            // Tangents all but parallel: they are the line itself.
            if apart > 0.0 && rise > 0.0 && rise < high - low {
                self.push(low + rise, at_low + slope_low * rise);
            }
        }
        // Between parts of one smooth piece the tangent runs on.
        if part.inverse == 0.0 || high >= piece_high {
            self.push(high, at_high);
        }
    }
}
