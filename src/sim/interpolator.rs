//! How a drive fills the time between setpoints.

use crate::control::math::poly::State;

/// Setpoints kept: enough for the greatest latency that a machine file allows, and one to interpolate to.
const KEPT: usize = 10;

/// The last setpoints of one axis, evaluated some periods late.
#[derive(Clone, Debug)]
pub(crate) struct Interpolator {
    /// Newest first, each with its effort feedforward.
    setpoints: [(State, f64); KEPT],
    period_s: f64,
    latency_periods: f64,
}

impl Interpolator {
    pub(crate) fn at_rest(position: f64, period_s: f64, latency_periods: f64) -> Self {
        let rest = State { position, ..State::default() };
        Self { setpoints: [(rest, 0.0); KEPT], period_s, latency_periods }
    }

    pub(crate) fn push(&mut self, setpoint: State, effort: f64) {
        self.setpoints.rotate_right(1);
        self.setpoints[0] = (setpoint, effort);
    }

    /// The command `since_s` after the newest setpoint came: cubic in position through both positions and velocities,
    /// straight in acceleration and effort. With less than one period of latency the newest setpoint is carried on.
    pub(crate) fn at(&self, since_s: f64) -> (State, f64) {
        let age = self.latency_periods - since_s / self.period_s;
        if age <= 0.0 {
            let (newest, effort) = &self.setpoints[0];
            return (newest.after(-age * self.period_s, 0.0), *effort);
        }
        let newer = (age as usize).min(KEPT - 2);
        let ((from, from_effort), (to, to_effort)) = (&self.setpoints[newer + 1], &self.setpoints[newer]);
        let u = (1.0 - (age - newer as f64)).clamp(0.0, 1.0);
        let t = self.period_s;
        let step = to.position - from.position;
        let (u2, u3) = (u * u, u * u * u);
        let state = State {
            position: from.position
                + step * (3.0 * u2 - 2.0 * u3)
                + t * (from.velocity * (u3 - 2.0 * u2 + u) + to.velocity * (u3 - u2)),
            velocity: step / t * 6.0 * (u - u2)
                + from.velocity * (3.0 * u2 - 4.0 * u + 1.0)
                + to.velocity * (3.0 * u2 - 2.0 * u),
            acceleration: from.acceleration + u * (to.acceleration - from.acceleration),
            jerk: 0.0,
        };
        (state, from_effort + u * (to_effort - from_effort))
    }
}
