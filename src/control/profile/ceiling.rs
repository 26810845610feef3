//! The ceiling over a flank: the greatest acceleration at each speed.
//!
//! Under constant jerk j, a² = a₁² + 2·j·(v − v₁): in the plane of speed v and squared acceleration, a segment of
//! constant jerk is a straight line, so a polyline there is a flank whose segments are exact.

use arrayvec::ArrayVec;

use super::error::ProfileError;
use super::segments::{Builder, MAX_LINES};
use crate::control::math::{list::copied, sqrt};

const MAX_CORNERS: usize = MAX_LINES + 1;

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

    /// The same rise in speed with no acceleration above `greatest`, upwards: one part, or two where the piece crosses it.
    pub(super) fn capped(self, greatest: f64) -> [Option<Self>; 2] {
        let flat = |speed: f64, rise: f64| Self { speed, rise, low: greatest, high: greatest, jerk: 0.0 };
        if self.low <= greatest && self.high <= greatest {
            return [Some(self), None];
        }
        if self.low >= greatest && self.high >= greatest {
            return [Some(flat(self.speed, self.rise)), None];
        }
        let below = ((greatest * greatest - self.low * self.low) / (2.0 * self.jerk)).max(0.0).min(self.rise);
        let (speed, rest) = (self.speed + below, self.rise - below);
        if self.low < greatest {
            [Some(Self { rise: below, high: greatest, ..self }), Some(flat(speed, rest))]
        } else {
            [Some(flat(self.speed, below)), Some(Self { speed, rise: rest, low: greatest, ..self })]
        }
    }

    /// Appends the piece to an upward flank as it is, to a downward one played backwards.
    pub(super) fn push(&self, flank: Flank, profile: &mut Builder<'_>) -> Result<(), ProfileError> {
        let acceleration = match flank {
            Flank::Up => self.low,
            // No negative zero.
            Flank::Down => 0.0 - self.high,
        };
        profile.push(self.duration_s(), acceleration, self.jerk, 0.0).map(|_| ())
    }
}

impl Ceiling {
    /// Appends a corner.
    pub(super) fn push(&mut self, speed: f64, squared: f64) {
        let mut corner = Corner { speed, squared, acceleration: sqrt(squared), distance: 0.0 };
        if let Some(below) = self.corners.last() {
            corner.distance = below.distance + Piece::between(below, &corner).distance();
        }
        // Whoever builds a ceiling counts its lines.
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

    /// Acceleration at a speed up to the greatest.
    pub(super) fn acceleration(&self, speed: f64) -> f64 {
        let spot = self.spot(speed);
        self.piece(spot.line, 0.0, spot.rise).map_or(0.0, |piece| piece.high)
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
