//! The synchronous stop of a spindle that does not follow its command: it brakes with what torque there is, and Z follows
//! where it really is.

use crate::control::math::poly::State;
use crate::control::motor::Motor;
use crate::control::sync::frame::AxisCommands;
use crate::control::sync::observer::SpindleObserver;

/// The command stays so near to the measured spindle that its drive brakes with all it has, and does not run after it later.
const LEASH_REV: f64 = 0.02;
/// At rest below this speed, for so many periods.
const REST_REV_PER_S: f64 = 0.05;
const REST_PERIODS: u32 = 10;

/// What a followed stop is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct StopConfig {
    pub(super) motor: Motor,
    pub(super) pitch_mm: f64,
    pub(super) period_s: f64,
    /// From a sample of the spindle to the instant that Z acts on it.
    pub(super) horizon_s: f64,
}

/// A followed stop under way, positive into the hole.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FollowedStop {
    spindle: State,
    /// Z's reference beside the spindle's travel, as it was before the fault.
    z_beside_mm: f64,
    z_force_n: f64,
    rest_periods: u32,
    /// Where Z is held once both rest: counts that flicker move nothing.
    held_mm: Option<f64>,
}

impl FollowedStop {
    /// Begins from the spindle's last command, with what Z's reference and force had beside it.
    pub(super) fn new(spindle: State, z_beside_mm: f64, z_force_n: f64) -> Self {
        Self { spindle, z_beside_mm, z_force_n, rest_periods: 0, held_mm: None }
    }

    /// Where the spindle is commanded to be.
    pub(super) fn spindle_rev(&self) -> f64 {
        self.spindle.position
    }

    /// One period.
    pub(super) fn step(&mut self, config: &StopConfig, observer: &SpindleObserver) -> AxisCommands {
        let StopConfig { motor, pitch_mm, period_s, horizon_s } = config;
        if let Some(position) = self.held_mm {
            let z = State { position, ..State::default() };
            let spindle = State { position: self.spindle.position, ..State::default() };
            return AxisCommands { spindle, z, z_force_n: self.z_force_n, ..AxisCommands::default() };
        }
        let actual = observer.predict(*horizon_s);
        let direction = if self.spindle.velocity < 0.0 { -1.0 } else { 1.0 };
        let braked = motor.acceleration_rev_per_s2(self.spindle.velocity.abs(), 1.0) * *period_s;
        // It never rises: a command that took over the measured speed would drive what it follows.
        let actual_speed = (direction * actual.velocity).max(0.0);
        let speed = (self.spindle.velocity.abs() - braked).max(0.0).min(actual_speed);
        let velocity = direction * speed;
        let free = self.spindle.position + 0.5 * (self.spindle.velocity + velocity) * *period_s;
        let position = free.max(actual.position - LEASH_REV).min(actual.position + LEASH_REV);
        let acceleration = (velocity - self.spindle.velocity) / *period_s;
        self.spindle = State { position, velocity, acceleration, jerk: 0.0 };
        let rests = velocity.abs() < REST_REV_PER_S && actual.velocity.abs() < REST_REV_PER_S;
        self.rest_periods = if rests { self.rest_periods.saturating_add(1) } else { 0 };
        let z = State {
            position: pitch_mm * actual.position + self.z_beside_mm,
            velocity: pitch_mm * actual.velocity,
            acceleration: pitch_mm * actual.acceleration,
            jerk: 0.0,
        };
        self.held_mm = (self.rest_periods >= REST_PERIODS).then_some(z.position);
        AxisCommands { spindle: self.spindle, z, spindle_torque_nm: 0.0, z_force_n: self.z_force_n }
    }
}
