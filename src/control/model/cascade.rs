//! The drive: position loop around a velocity loop with integral part, feedforward, and anti-windup.

use crate::control::math::{filter_share, poly::State};

/// Gains of one drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CascadeGains {
    /// Period of both loops.
    pub period_s: f64,
    /// Kp of the position loop.
    pub position_gain_per_s: f64,
    /// Gain of the velocity loop: acceleration per velocity error.
    pub velocity_gain_per_s: f64,
    /// Integral time of the velocity loop.
    pub integral_s: f64,
    /// Time constant of the filter on measured velocity, 0 for none.
    pub velocity_filter_s: f64,
    /// Effort that accelerates the axis by one unit/s².
    pub effort_per_acceleration: f64,
}

/// What a drive measures at one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// Position that closes the position loop.
    pub position: f64,
    /// Position of the motor, which closes the velocity loop.
    pub motor_position: f64,
}

/// What a drive answers with.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Effort {
    /// Effort commanded, within the limit.
    pub effort: f64,
    /// The limit cut it.
    pub saturated: bool,
}

/// One drive with its state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cascade {
    gains: CascadeGains,
    filter_share: f64,
    integral: f64,
    velocity: f64,
    last_motor_position: f64,
}

impl Cascade {
    /// A drive at rest at a motor position.
    #[must_use]
    pub fn new(gains: CascadeGains, motor_position: f64) -> Self {
        let filter_share = filter_share(gains.period_s, gains.velocity_filter_s);
        Self { gains, filter_share, integral: 0.0, velocity: 0.0, last_motor_position: motor_position }
    }

    /// The drive is switched on at rest at a motor position: nothing of before is left in its loops.
    pub fn restart(&mut self, motor_position: f64) {
        (self.integral, self.velocity, self.last_motor_position) = (0.0, 0.0, motor_position);
    }

    /// One tick of both loops, with an effort feedforward beyond the command's acceleration.
    ///
    /// The integral holds while the limit cuts the effort and the error would drive it further in, so it cannot wind up.
    #[must_use]
    pub fn step(&mut self, command: &State, offset: f64, measured: Measured, limit: f64) -> Effort {
        let gains = &self.gains;
        let raw = (measured.motor_position - self.last_motor_position) / gains.period_s;
        self.last_motor_position = measured.motor_position;
        self.velocity += self.filter_share * (raw - self.velocity);

        let reference = command.velocity + gains.position_gain_per_s * (command.position - measured.position);
        let error = reference - self.velocity;
        let integral = self.integral + gains.velocity_gain_per_s * error * gains.period_s / gains.integral_s;
        let wanted = |integral: f64| {
            gains.effort_per_acceleration * (gains.velocity_gain_per_s * error + integral + command.acceleration)
                + offset
        };
        let effort = wanted(integral);
        let saturated = effort.abs() > limit;
        if !saturated || effort * error < 0.0 {
            self.integral = integral;
        }
        Effort { effort: wanted(self.integral).min(limit).max(-limit), saturated }
    }
}
