//! The ceiling over a flank: the greatest acceleration at each speed, from below.
//!
//! Under constant jerk j, a² = a₁² + 2·j·(v − v₁): in the plane of speed v and squared acceleration, a segment of
//! constant jerk is a straight line. A motor's limit s + b/v ± k·v is convex there, so its tangents lie below it, while
//! a chord, or a straight line in the plane of v and a, would ask for more torque than there is.

use arrayvec::ArrayVec;

use super::{Builder, ProfileError};
use crate::control::math::{ceil, exp, list::copied, ln, sqrt};
use crate::control::motor::{Friction, Motor};
use crate::control::units::{RAD_PER_REV, rev_per_s_from_rpm, rpm_from_rev_per_s};

/// Most lines of a ceiling: two for each piece of the longest torque curve.
pub(super) const MAX_LINES: usize = 30;
const MAX_CORNERS: usize = MAX_LINES + 1;
/// The acceleration changes by no more than this factor, as a logarithm, between points at which the ceiling touches its
/// limit: then its tangents stay within 0.4 % of it on average.
const STEP: f64 = 0.25;
/// Each try at fewer lines widens the step this much; the tries suffice for one step per piece whatever the curve.
const COARSER: f64 = 1.5;
const MAX_TRIES: u32 = 24;
/// Share of the motor that friction has to leave; the ceiling ends at the speed where it leaves less.
const LEAST_LEFT: f64 = 0.02;

/// Which flank of a stroke, as friction tells them apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Flank {
    Up,
    Down,
}

/// A corner of the ceiling.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Corner {
    speed: f64,
    squared: f64,
    acceleration: f64,
    /// From rest, under the ceiling.
    distance: f64,
}

/// A polyline over speed, in squared acceleration; from rest upwards.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Ceiling {
    corners: ArrayVec<Corner, MAX_CORNERS>,
}

impl Clone for Ceiling {
    fn clone(&self) -> Self {
        Self { corners: copied(&self.corners) }
    }
}

/// A place on the ceiling: one of its lines, and how far along it in speed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Spot {
    line: usize,
    rise: f64,
}

/// A flank's piece of constant jerk, as it runs upwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) speed: f64,
    pub(super) rise: f64,
    /// Acceleration at the lower and at the upper speed.
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) jerk: f64,
}

impl Piece {
    fn duration_s(&self) -> f64 {
        if self.rise > 0.0 { 2.0 * self.rise / (self.low + self.high) } else { 0.0 }
    }

    pub(super) fn distance(&self) -> f64 {
        let t = self.duration_s();
        t * (self.speed + t * (2.0 * self.low + self.high) / 6.0)
    }

    /// Appends the piece to an upward flank as it is, to a downward one played backwards.
    pub(super) fn push(&self, flank: Flank, profile: &mut Builder) -> Result<(), ProfileError> {
        let acceleration = match flank {
            Flank::Up => self.low,
            // No negative zero.
            Flank::Down => 0.0 - self.high,
        };
        profile.push(self.duration_s(), acceleration, self.jerk, 0.0).map(|_| ())
    }
}

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
        let mut kept = ArrayVec::<Limit, { crate::control::motor::MAX_POINTS }>::new();
        for limit in limits {
            if !(left(&limit, limit.low) > 0.0) {
                break;
            }
            let high = crate::control::math::root::increasing(limit.low, limit.high, |v| -left(&limit, v));
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

    fn push(&mut self, speed: f64, squared: f64) {
        let mut corner = Corner { speed, squared, acceleration: sqrt(squared), distance: 0.0 };
        if let Some(below) = self.corners.last() {
            corner.distance = below.distance + Piece::between(below, &corner).distance();
        }
        // `below` has counted the lines.
        let _ = self.corners.try_push(corner);
    }

    /// The highest ceiling below this one whose slopes are no steeper than `slope`, either way.
    pub(super) fn with_slopes_within(&self, slope: f64) -> Self {
        let points = self.corners.iter().map(|corner| (corner.speed, corner.squared));
        let rising = limit_rise(points, slope);
        let both = limit_rise(rising.iter().rev().copied(), slope);
        let mut limited = Self::default();
        for (speed, squared) in both.iter().rev() {
            limited.push(*speed, *squared);
        }
        limited
    }

    /// Where a line that rises with `slope` from `squared` at rest meets the ceiling, and the acceleration there; `slope`
    /// is at least the ceiling's steepest.
    pub(super) fn meet_rising(&self, squared: f64, slope: f64) -> Option<(Spot, f64)> {
        let above = self.corners.iter().position(|corner| corner.squared <= squared + slope * corner.speed);
        let line = above.unwrap_or(self.corners.len()).saturating_sub(1);
        let (corner, whole) = (self.corners.get(line)?, self.piece(line, 0.0, f64::INFINITY)?);
        let gap = corner.squared - squared - slope * corner.speed;
        self.at_rise(line, gap / (slope - 2.0 * whole.jerk), whole)
    }

    /// Where a line that falls with `slope` to zero at `peak` leaves the ceiling, and the acceleration there; `slope` as
    /// above. None where the line lies below the ceiling from rest on.
    pub(super) fn meet_falling(&self, peak: f64, slope: f64) -> Option<(Spot, f64)> {
        let below = self.corners.partition_point(|corner| corner.squared <= slope * (peak - corner.speed));
        let line = below.checked_sub(1)?;
        let (corner, whole) = (self.corners.get(line)?, self.piece(line, 0.0, f64::INFINITY)?);
        let gap = slope * (peak - corner.speed) - corner.squared;
        self.at_rise(line, gap / (slope + 2.0 * whole.jerk), whole)
    }

    fn at_rise(&self, line: usize, rise: f64, whole: Piece) -> Option<(Spot, f64)> {
        // A line parallel to the ceiling's own may give no number at all; its lower corner is as good as any.
        let rise = if rise > 0.0 { rise.min(whole.rise) } else { 0.0 };
        self.piece(line, 0.0, rise).map(|piece| (Spot { line, rise }, piece.high))
    }

    /// Greatest speed; 0 where there is no acceleration at all.
    pub(super) fn top(&self) -> f64 {
        self.corners.last().map_or(0.0, |corner| corner.speed)
    }

    /// Acceleration at rest; 0 where there is none.
    pub(super) fn at_rest(&self) -> f64 {
        self.corners.first().map_or(0.0, |corner| corner.acceleration)
    }

    /// The place at a speed.
    pub(super) fn spot(&self, speed: f64) -> Spot {
        let line = self.corners.partition_point(|corner| corner.speed < speed).saturating_sub(1);
        self.corners.get(line).map_or(Spot::default(), |corner| Spot { line, rise: speed - corner.speed })
    }

    /// Distance from rest to a place.
    pub(super) fn distance(&self, spot: Spot) -> f64 {
        let below = self.corners.get(spot.line).map_or(0.0, |corner| corner.distance);
        below + self.piece(spot.line, 0.0, spot.rise).map_or(0.0, |piece| piece.distance())
    }

    /// The pieces from one place up to another.
    pub(super) fn pieces(&self, from: Spot, to: Spot) -> impl DoubleEndedIterator<Item = Piece> {
        (from.line..=to.line).filter_map(move |line| {
            let low = if line == from.line { from.rise } else { 0.0 };
            let high = if line == to.line { to.rise } else { f64::INFINITY };
            self.piece(line, low, high)
        })
    }

    /// The part of a line between two rises from its lower corner.
    fn piece(&self, line: usize, low: f64, high: f64) -> Option<Piece> {
        let (below, above) = (self.corners.get(line)?, self.corners.get(line + 1)?);
        let whole = Piece::between(below, above);
        let at = |rise: f64| {
            if rise == 0.0 {
                below.acceleration
            } else if rise >= whole.rise {
                above.acceleration
            } else {
                sqrt((below.squared + 2.0 * whole.jerk * rise).max(0.0))
            }
        };
        let high = high.min(whole.rise);
        Some(Piece { speed: below.speed + low, rise: high - low, low: at(low), high: at(high), jerk: whole.jerk })
    }
}

/// The highest polyline below one that rises no steeper than `slope` along its way, which may lead up or down in speed.
/// It has no more corners than the one given.
fn limit_rise(points: impl Iterator<Item = (f64, f64)>, slope: f64) -> ArrayVec<(f64, f64), MAX_CORNERS> {
    let mut limited = ArrayVec::new();
    // The last point of the polyline given, and the limited value there.
    let mut last: Option<((f64, f64), f64)> = None;
    for (speed, squared) in points {
        let Some(((last_speed, last_squared), reached)) = last else {
            let _ = limited.try_push((speed, squared));
            last = Some(((speed, squared), squared));
            continue;
        };
        let way = (speed - last_speed).abs();
        let most = reached + slope * way;
        if squared > most {
            // Too steep all the way: its end is a corner only once the polyline is met again.
            last = Some(((speed, squared), most));
            continue;
        }
        if reached < last_squared {
            let met = (last_squared - reached) / (slope * way + last_squared - squared);
            let corner = (last_speed + (speed - last_speed) * met, reached + slope * way * met);
            let _ = limited.try_push(corner);
        }
        let _ = limited.try_push((speed, squared));
        last = Some(((speed, squared), squared));
    }
    if let Some(((speed, squared), reached)) = last
        && reached < squared
    {
        let _ = limited.try_push((speed, reached));
    }
    limited
}

impl Piece {
    fn between(below: &Corner, above: &Corner) -> Self {
        let rise = above.speed - below.speed;
        let jerk = if rise > 0.0 { (above.squared - below.squared) / (2.0 * rise) } else { 0.0 };
        Self { speed: below.speed, rise, low: below.acceleration, high: above.acceleration, jerk }
    }
}
