//! `torque-curve-smooth`: the motor's torque curve with bounded jerk.
//!
//! In the plane of speed and squared acceleration (see `ceiling`) the greatest jerk is a greatest slope: a flank is the
//! lowest of the line that rises with it from rest, the ceiling, and the line that falls with it to the peak.

use super::ceiling::{Ceiling, Flank, Piece, Spot};
use super::error::{ProfileError, check_positive};
use super::segments::Profile;
use super::stroke_request::{StrokeRequest, Turns};
use crate::control::math::{root, sqrt};
use crate::control::motor::{Friction, Motor};

/// The law of one motor. Both flanks are alike: friction is left to what the share spares.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueCurveSmoothLaw {
    ceiling: Ceiling,
    jerk: f64,
}

/// Rounding forgiven where a turn's acceleration is as great as the stroke allows.
const ROUNDING: f64 = 1e-12;

impl TorqueCurveSmoothLaw {
    /// Below `share` of a motor's torque, in (0, 1], with a greatest jerk in rev/s³, positive and finite.
    #[must_use]
    pub fn new(motor: &Motor, share: f64, jerk: f64) -> Self {
        let motors = Ceiling::of_motor(motor, Friction::default(), share, Flank::Up);
        Self { ceiling: motors.with_slopes_within(2.0 * jerk), jerk }
    }

    /// Greatest speed, that of the curve's last point; a commanded speed above it is clamped to it.
    #[must_use]
    pub fn top_rev_per_s(&self) -> f64 {
        self.ceiling.top()
    }

    /// Greatest acceleration at rest a₀.
    #[must_use]
    pub fn acceleration_at_rest(&self) -> f64 {
        self.ceiling.at_rest()
    }

    /// The jerk j.
    #[must_use]
    pub fn jerk(&self) -> f64 {
        self.jerk
    }

    /// The greatest acceleration with which this stroke can turn back at one end, the other end at rest without
    /// acceleration: a₀, or less where the stroke is too short or too slow to take it back before its peak.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for a request that is not positive and finite.
    pub fn turn_acceleration(&self, stroke: StrokeRequest) -> Result<f64, ProfileError> {
        let command = self.command(stroke)?;
        let full = self.acceleration_at_rest();
        // The peak up to which the flank at the turn is nothing but its one falling line.
        let falling_only = full * full / (2.0 * self.jerk);
        let resting = Ascent::new(self, 0.0);
        let falling = |peak: f64| ramp(0.0, sqrt(2.0 * self.jerk * peak), 0.0, self.jerk).distance();
        let high = falling_only.min(command);
        let peak = root::increasing(0.0, high, |peak| resting.distance(peak) + falling(peak) - stroke.distance);
        Ok(if peak >= falling_only { full } else { sqrt(2.0 * self.jerk * peak) })
    }

    /// The stroke over a distance, in rev and rev/s; `turns` says which ends it passes with acceleration.
    ///
    /// Acceleration is continuous, its magnitude nowhere above the share of the curve, jerk nowhere above j. It takes at
    /// most 1.05 times [`Motor::fastest_stroke`] of the same share, and 2·a₀/j.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for a request that is not positive and finite, or for a turn's acceleration outside
    /// 0…a₀; [`ProfileError::TooShort`] and [`ProfileError::EndsAboveCommand`] where the stroke cannot take a turn's
    /// acceleration back, see [`TorqueCurveSmoothLaw::turn_acceleration`].
    ///
    /// ```
    /// use rigidtap::control::{machine::Machine, profile::{StrokeRequest, TorqueCurveSmoothLaw, Turns}};
    /// let motor = Machine::reference().motor().clone();
    /// let law = TorqueCurveSmoothLaw::new(&motor, 0.75, 6.4e6 / 60.0);
    /// let request = StrokeRequest { distance: 25.0, command: 7000.0 / 60.0 };
    /// let stroke = law.plan(request, Turns::default()).unwrap();
    /// let bound = motor.fastest_stroke(25.0, 7000.0 / 60.0, 1.0);
    /// assert!(stroke.duration_s() < 1.17 * bound.duration_s);
    /// // Into the hole and out of it again without a pause: one smooth motion through the bottom.
    /// let acceleration = law.turn_acceleration(request).unwrap();
    /// let stroke_in = law.plan(request, Turns { start: 0.0, end: acceleration }).unwrap();
    /// assert_eq!((stroke_in.end().velocity, stroke_in.end().acceleration), (0.0, -acceleration));
    /// ```
    pub fn plan(&self, stroke: StrokeRequest, turns: Turns) -> Result<Profile, ProfileError> {
        let command = self.command(stroke)?;
        let full = self.acceleration_at_rest();
        for value in [turns.start, turns.end] {
            if !(value >= 0.0 && value <= full) {
                return Err(ProfileError::Invalid { value });
            }
        }
        let (up, down) = (Ascent::new(self, turns.start), Ascent::new(self, turns.end));
        let least = up.least_peak().max(down.least_peak());
        if least > command * (1.0 + ROUNDING) {
            return Err(ProfileError::EndsAboveCommand { speed: least, command });
        }
        let flanks = |peak: f64| up.distance(peak) + down.distance(peak);
        let needed = flanks(least);
        if needed > stroke.distance * (1.0 + ROUNDING) {
            return Err(ProfileError::TooShort { distance: stroke.distance, needed });
        }
        let peak = root::increasing(least, command.max(least), |peak| flanks(peak) - stroke.distance);
        Profile::built(0.0, |profile| {
            for piece in up.pieces(peak) {
                piece.push(Flank::Up, profile)?;
            }
            profile.cruise(stroke.distance - flanks(peak), peak, stroke.distance)?;
            for piece in down.pieces(peak).rev() {
                piece.push(Flank::Down, profile)?;
            }
            profile.finish_turning(stroke.distance, turns.end)
        })
    }

    fn command(&self, stroke: StrokeRequest) -> Result<f64, ProfileError> {
        stroke.check()?;
        check_positive(self.jerk)?;
        check_positive(self.acceleration_at_rest())?;
        Ok(stroke.command.min(self.top_rev_per_s()))
    }
}

/// The piece of greatest jerk, either way, between two accelerations.
fn ramp(speed: f64, low: f64, high: f64, jerk: f64) -> Piece {
    // Not from two speeds: above a high speed their difference would round a short ramp.
    let rise = (high - low).abs() * (high + low) / (2.0 * jerk);
    Piece { speed, rise, low, high, jerk: jerk.copysign(high - low) }
}

/// All flanks from rest with one acceleration there, as they differ by their peak.
struct Ascent<'a> {
    law: &'a TorqueCurveSmoothLaw,
    /// Acceleration at rest.
    start: f64,
    /// Where the rising line meets the ceiling; none where it stays below up to the top speed.
    entry: Option<Entry>,
}

struct Entry {
    spot: Spot,
    rising: Piece,
    /// Distance that the rising line takes more than the ceiling would.
    extra: f64,
}

impl<'a> Ascent<'a> {
    fn new(law: &'a TorqueCurveSmoothLaw, start: f64) -> Self {
        let entry = law.ceiling.meet_rising(start * start, 2.0 * law.jerk).map(|(spot, acceleration)| {
            let rising = ramp(0.0, start, acceleration.max(start), law.jerk);
            Entry { spot, rising, extra: rising.distance() - law.ceiling.distance(spot) }
        });
        Self { law, start, entry }
    }

    /// The least peak at which the acceleration at rest can be taken back.
    fn least_peak(&self) -> f64 {
        self.start * self.start / (2.0 * self.law.jerk)
    }

    /// Where a flank leaves the ceiling for the falling line to its peak; none where the rising line meets that first.
    fn exit(&self, peak: f64) -> Option<(&Entry, Spot, Piece)> {
        let entry = self.entry.as_ref().filter(|entry| self.apex(peak) > entry.rising.high)?;
        let (exit, acceleration) = self.law.ceiling.meet_falling(peak, 2.0 * self.law.jerk)?;
        Some((entry, exit, self.falling(peak, acceleration)))
    }

    /// Acceleration at which the rising and the falling line meet.
    fn apex(&self, peak: f64) -> f64 {
        sqrt(self.law.jerk * (peak + self.least_peak())).max(self.start)
    }

    fn falling(&self, peak: f64, acceleration: f64) -> Piece {
        let falling = ramp(0.0, acceleration, 0.0, self.law.jerk);
        Piece { speed: peak - falling.rise, ..falling }
    }

    /// Rising and falling line alone.
    fn lines(&self, peak: f64) -> [Piece; 2] {
        let apex = self.apex(peak);
        [ramp(0.0, self.start, apex, self.law.jerk), self.falling(peak, apex)]
    }

    fn distance(&self, peak: f64) -> f64 {
        match self.exit(peak) {
            Some((entry, exit, falling)) => entry.extra + self.law.ceiling.distance(exit) + falling.distance(),
            None => self.lines(peak).iter().map(Piece::distance).sum(),
        }
    }

    fn pieces(&self, peak: f64) -> impl DoubleEndedIterator<Item = Piece> {
        let (rising, along, falling) = match self.exit(peak) {
            Some((entry, exit, falling)) => (entry.rising, Some((entry.spot, exit)), falling),
            None => {
                let [rising, falling] = self.lines(peak);
                (rising, None, falling)
            }
        };
        let ceiling = along.into_iter().flat_map(|(entry, exit)| self.law.ceiling.pieces(entry, exit));
        core::iter::once(rising).chain(ceiling).chain(core::iter::once(falling))
    }
}
