//! `torque-limit`: the fastest stroke that the motor's torque curve, its share and friction allow.

use super::ceiling::{Ceiling, Flank, Spot};
use super::error::{ProfileError, check_positive};
use super::segments::Profile;
use super::stroke_request::StrokeRequest;
use crate::control::math::root;
use crate::control::motor::{Friction, Motor};

/// The law of one motor. Acceleration steps from one limit to the other; jerk is unbounded there.
#[derive(Clone, Debug, PartialEq)]
pub struct TorqueLimitLaw {
    up: Ceiling,
    down: Ceiling,
}

impl TorqueLimitLaw {
    /// For `share` of a motor's torque, in (0, 1]. Friction hinders speeding up and helps braking; the motor's own
    /// torque keeps to its share in both.
    ///
    /// Speeds end where the curve does, or where friction leaves less than 2 % of the motor's share.
    #[must_use]
    pub fn new(motor: &Motor, friction: Friction, share: f64) -> Self {
        let ceiling = |flank| Ceiling::of_motor(motor, friction, share, flank);
        Self { up: ceiling(Flank::Up), down: ceiling(Flank::Down) }
    }

    /// Greatest speed; a commanded speed above it is clamped to it.
    #[must_use]
    pub fn top_rev_per_s(&self) -> f64 {
        self.up.top().min(self.down.top())
    }

    /// The stroke from rest to rest, in rev and rev/s.
    ///
    /// Within 1 % of the bound that integrating the limit gives, [`Motor::fastest_stroke`] where there is no friction.
    /// The motor's torque is nowhere above its share of the curve.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for a request that is not positive and finite, and where friction leaves no acceleration.
    ///
    /// ```
    /// use rigidtap::control::{machine::Machine, motor::Friction};
    /// use rigidtap::control::profile::{StrokeRequest, TorqueLimitLaw};
    /// let motor = Machine::reference().motor().clone();
    /// let law = TorqueLimitLaw::new(&motor, Friction::default(), 0.8);
    /// let stroke = law.plan(StrokeRequest { distance: 25.0, command: 7000.0 / 60.0 }).unwrap();
    /// let bound = motor.fastest_stroke(25.0, 7000.0 / 60.0, 0.8);
    /// assert!((1.0..1.005).contains(&(stroke.duration_s() / bound.duration_s)));
    /// ```
    pub fn plan(&self, stroke: StrokeRequest) -> Result<Profile, ProfileError> {
        stroke.check()?;
        check_positive(self.up.at_rest())?;
        let command = stroke.command.min(self.top_rev_per_s());
        let flanks = |peak: f64| self.up.distance(self.up.spot(peak)) + self.down.distance(self.down.spot(peak));
        let peak = root::increasing(0.0, command, |peak| flanks(peak) - stroke.distance);
        Profile::built(0.0, |profile| {
            for piece in self.up.pieces(Spot::default(), self.up.spot(peak)) {
                piece.push(Flank::Up, profile)?;
            }
            profile.cruise(stroke.distance - flanks(peak), peak, stroke.distance)?;
            for piece in self.down.pieces(Spot::default(), self.down.spot(peak)).rev() {
                piece.push(Flank::Down, profile)?;
            }
            profile.finish(stroke.distance, 0.0)
        })
    }

    /// From a speed in rev/s to rest in the shortest way, braking nowhere harder than `greatest` rev/s². Above the
    /// curve's end the braking of its end is kept.
    ///
    /// # Errors
    /// [`ProfileError::Invalid`] for a speed below 0, for a `greatest` that is not positive, and where there is no torque.
    ///
    /// ```
    /// use rigidtap::control::machine::Machine;
    /// let machine = Machine::reference();
    /// let braking = machine.torque_limit().brake(7000.0 / 60.0, f64::INFINITY).unwrap();
    /// // 0.253 s without friction, which helps.
    /// assert!((0.23..0.253).contains(&braking.duration_s()));
    /// assert_eq!(braking.end().velocity, 0.0);
    /// let gently = machine.torque_limit().brake(50.0, 100.0).unwrap();
    /// assert!((gently.distance() - 12.5).abs() < 1e-9);
    /// ```
    pub fn brake(&self, speed: f64, greatest: f64) -> Result<Profile, ProfileError> {
        if !(speed >= 0.0 && speed.is_finite()) {
            return Err(ProfileError::Invalid { value: speed });
        }
        if !(greatest > 0.0) {
            return Err(ProfileError::Invalid { value: greatest });
        }
        check_positive(self.down.at_rest())?;
        let top = self.down.top().min(speed);
        Profile::built(speed, |profile| {
            let at_top = self.down.acceleration(top).min(greatest);
            profile.push((speed - top) / at_top, -at_top, 0.0, 0.0)?;
            for piece in self.down.pieces(Spot::default(), self.down.spot(top)).rev() {
                for part in piece.capped(greatest).into_iter().rev().flatten() {
                    part.push(Flank::Down, profile)?;
                }
            }
            profile.finish_here(0.0)
        })
    }
}
