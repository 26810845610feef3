//! What is seen of both axes in a period, and what they are held to.

use crate::control::motor::Motor;

/// Limits of the spindle's and Z's following.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync::supervision) struct FollowingLimits {
    pub(in crate::control::sync::supervision) motor: Motor,
    /// Friction of the spindle at any speed.
    pub(in crate::control::sync::supervision) coulomb_nm: f64,
    pub(in crate::control::sync::supervision) spindle_rev: f64,
    pub(in crate::control::sync::supervision) z_mm: f64,
    /// Gains of the spindle's drive, 1/s; none of the position where it takes a speed alone.
    pub(in crate::control::sync::supervision) position_gain_per_s: f64,
    pub(in crate::control::sync::supervision) velocity_gain_per_s: f64,
    /// By how much later than told the spindle may be for its speed: a period, and a lag by gains that are not as told.
    pub(in crate::control::sync::supervision) delay_s: f64,
    /// Travel of one count of its encoder.
    pub(in crate::control::sync::supervision) count_rev: f64,
    pub(in crate::control::sync::supervision) period_s: f64,
}

impl FollowingLimits {
    /// The greatest torque of the motor.
    pub(super) fn rated_nm(&self) -> f64 {
        self.motor.curve.torque_nm(0.0)
    }
}

/// One axis in a period, machine coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::control::sync::supervision) struct Followed {
    /// Measured less expected, and its rate per second.
    pub(in crate::control::sync::supervision) error: f64,
    pub(in crate::control::sync::supervision) error_rate: f64,
    /// Measured and expected speed.
    pub(in crate::control::sync::supervision) speed: f64,
    pub(in crate::control::sync::supervision) expected_speed: f64,
    /// The counts are to be gone by.
    pub(in crate::control::sync::supervision) is_trusted: bool,
    /// The counts came to a halt from one sample to the next: it may be the encoder that stands.
    pub(in crate::control::sync::supervision) may_be_frozen: bool,
    /// The drive says that it is not ready, or that its effort stood at the limit.
    pub(in crate::control::sync::supervision) is_not_ready: bool,
    pub(in crate::control::sync::supervision) is_saturated: bool,
}

/// The spindle's effort in a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync::supervision) struct SpindleEffort {
    /// As the drive reports it.
    pub(in crate::control::sync::supervision) reported_nm: Option<f64>,
    /// Least and greatest of the torques, acceleration and feedforward, that were commanded when it may have been given.
    pub(in crate::control::sync::supervision) commanded_nm: [f64; 2],
}
