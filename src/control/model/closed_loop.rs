//! A drive's loops as they answer a tracking error: what the control predicts with. Units are the axis's: rev or mm, and s.

use crate::control::machine::{DriveSpec, Takes};

/// Gain of a position loop around a drive that takes a speed alone, over its velocity loop's.
const SPEED_LOOP_SHARE: f64 = 0.2;

/// Position loop around a velocity loop with integral part, closed around a rigid axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosedLoop {
    /// Kp of the position loop, 1/s.
    pub position_gain_per_s: f64,
    /// Gain of the velocity loop, 1/s.
    pub velocity_gain_per_s: f64,
    /// Integral time of the velocity loop, s.
    pub integral_s: f64,
}

/// A tracking error with its rate, and the accelerations that change it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoopState {
    /// Tracking error.
    pub position: f64,
    /// Its rate.
    pub velocity: f64,
    /// Acceleration that the drive's integrator gives.
    pub integral: f64,
    /// Acceleration that the drive knows nothing of: wrong inertia, cutting, friction.
    pub disturbance: f64,
}

impl ClosedLoop {
    /// The spindle's drive. A spindle that takes a speed alone has its position loop in the control, so much slower than its
    /// velocity loop that their delays do not make it ring.
    #[must_use]
    pub fn of_spindle(drive: &DriveSpec) -> Self {
        Self {
            position_gain_per_s: match drive.spindle_takes {
                Takes::Speed => SPEED_LOOP_SHARE * drive.spindle_velocity_gain_per_s,
                _ => drive.spindle_position_gain_per_s,
            },
            velocity_gain_per_s: drive.spindle_velocity_gain_per_s,
            integral_s: drive.spindle_integral_s,
        }
    }

    /// Z's drive.
    #[must_use]
    pub fn of_z(drive: &DriveSpec) -> Self {
        Self {
            position_gain_per_s: drive.z_position_gain_per_s,
            velocity_gain_per_s: drive.z_velocity_gain_per_s,
            integral_s: drive.z_integral_s,
        }
    }

    /// The state after a step; the velocity loop implicitly, since it is stiff.
    #[must_use]
    pub fn after(&self, from: LoopState, step_s: f64) -> LoopState {
        let kv = self.velocity_gain_per_s;
        let driven = from.disturbance - kv * self.position_gain_per_s * from.position - from.integral;
        let velocity = (from.velocity + step_s * driven) / (1.0 + step_s * kv);
        let mean_velocity = 0.5 * (from.velocity + velocity);
        let position = from.position + step_s * mean_velocity;
        let error = mean_velocity + self.position_gain_per_s * 0.5 * (from.position + position);
        LoopState { position, velocity, integral: from.integral + kv / self.integral_s * step_s * error, ..from }
    }
}
