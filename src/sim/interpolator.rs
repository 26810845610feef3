//! How a drive fills the time between setpoints, and what it does without one.

use crate::control::machine::Takes;
use crate::control::math::poly::State;

/// Setpoints kept: enough for the greatest latency that a machine file allows, a bus that is later than the file says, and one to
/// interpolate to.
const KEPT: usize = 18;

/// The last setpoints of one axis, evaluated some periods late.
#[derive(Clone, Debug)]
pub(crate) struct Interpolator {
    /// Newest first, each with its effort feedforward.
    setpoints: [(State, f64); KEPT],
    takes: Takes,
    period_s: f64,
    latency_periods: f64,
}

impl Interpolator {
    /// Of a drive that takes so much of a setpoint; the rest is never seen by it.
    pub(crate) fn at_rest(position: f64, takes: Takes, period_s: f64, latency_periods: f64) -> Self {
        let rest = State { position, ..State::default() };
        let latency_periods = latency_periods.clamp(0.0, (KEPT - 2) as f64);
        Self { setpoints: [(rest, 0.0); KEPT], takes, period_s, latency_periods }
    }

    /// The drive is switched on and holds its axis.
    pub(crate) fn hold(&mut self, position: f64) {
        self.setpoints = [(State { position, ..State::default() }, 0.0); KEPT];
    }

    /// The setpoint of a new period.
    pub(crate) fn push(&mut self, setpoint: State, effort: f64) {
        let State { position, velocity, .. } = setpoint;
        let taken = match self.takes {
            Takes::Torque => (setpoint, effort),
            Takes::Velocity => (State { position, velocity, ..State::default() }, 0.0),
            Takes::Position => (State { position, ..State::default() }, 0.0),
            Takes::Speed => (State { velocity, ..State::default() }, 0.0),
        };
        self.setpoints.rotate_right(1);
        self.setpoints[0] = taken;
    }

    /// A period without a setpoint: the drive carries the last one on by all that it took.
    pub(crate) fn push_missing(&mut self) {
        let [(newest, effort), (before, _), ..] = self.setpoints;
        let carried = match self.takes {
            Takes::Torque | Takes::Velocity => newest.after(self.period_s, 0.0),
            Takes::Position => State { position: 2.0 * newest.position - before.position, ..newest },
            Takes::Speed => newest,
        };
        self.setpoints.rotate_right(1);
        self.setpoints[0] = (carried, effort);
    }

    /// The command `since_s` after the newest setpoint came, with its effort.
    ///
    /// With velocities a cubic through both positions and velocities, and straight in acceleration and effort; positions
    /// alone are joined by straight lines, which give no velocity feedforward; a speed alone is held. With less than one
    /// period of latency the newest setpoint is carried on.
    pub(crate) fn at(&self, since_s: f64) -> (State, f64) {
        let age = self.latency_periods - since_s / self.period_s;
        if age <= 0.0 {
            return self.carried_on(-age * self.period_s);
        }
        let newer = (age as usize).min(KEPT - 2);
        let ((from, from_effort), (to, to_effort)) = (&self.setpoints[newer + 1], &self.setpoints[newer]);
        let u = (1.0 - (age - newer as f64)).clamp(0.0, 1.0);
        let t = self.period_s;
        let step = to.position - from.position;
        if matches!(self.takes, Takes::Position | Takes::Speed) {
            return self.between(from, to, u);
        }
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

    /// The share `u` of the way between two setpoints that are one number each.
    #[cold]
    fn between(&self, from: &State, to: &State, u: f64) -> (State, f64) {
        let position = from.position + u * (to.position - from.position);
        match self.takes {
            Takes::Speed => (if u < 1.0 { *from } else { *to }, 0.0),
            _ => (State { position, ..State::default() }, 0.0),
        }
    }

    fn carried_on(&self, by_s: f64) -> (State, f64) {
        let [(newest, effort), (before, _), ..] = &self.setpoints;
        let carried = match self.takes {
            Takes::Torque | Takes::Velocity => newest.after(by_s, 0.0),
            Takes::Position => {
                let slope = (newest.position - before.position) / self.period_s;
                State { position: newest.position + slope * by_s, ..State::default() }
            }
            Takes::Speed => *newest,
        };
        (carried, *effort)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const T: f64 = 0.001;

    fn moving(takes: Takes, latency_periods: f64) -> Interpolator {
        let mut interpolator = Interpolator::at_rest(0.0, takes, T, latency_periods);
        for period in 0..20 {
            interpolator.push(truth(f64::from(period) * T), 3.0);
        }
        interpolator
    }

    /// A parabola: 1 unit/s at time 0, 4 units/s².
    fn truth(time_s: f64) -> State {
        State { velocity: 1.0, acceleration: 4.0, ..State::default() }.after(time_s, 0.0)
    }

    #[test]
    fn what_a_drive_takes_is_all_that_it_sees() {
        // The newest setpoint is that of 19 T; one period late, 18 T is in force when it comes.
        let (full, effort) = moving(Takes::Torque, 1.0).at(0.25 * T);
        assert!((full.position - truth(18.25 * T).position).abs() < 1e-12 && (full.acceleration - 4.0).abs() < 1e-12);
        assert_eq!(effort, 3.0);
        let (no_acceleration, effort) = moving(Takes::Velocity, 1.0).at(0.25 * T);
        assert!((no_acceleration.position - full.position).abs() < 1e-12);
        assert_eq!((no_acceleration.velocity, no_acceleration.acceleration, effort), (full.velocity, 0.0, 0.0));
        let (straight, _) = moving(Takes::Position, 1.0).at(0.25 * T);
        let chord = 0.75 * truth(18.0 * T).position + 0.25 * truth(19.0 * T).position;
        assert!((straight.position - chord).abs() < 1e-15 && straight.velocity == 0.0);
        let (held, _) = moving(Takes::Speed, 1.0).at(0.25 * T);
        assert_eq!(held.velocity, truth(18.0 * T).velocity);
    }

    #[test]
    fn a_missing_setpoint_is_carried_on() {
        for (takes, off) in [(Takes::Torque, 0.0), (Takes::Velocity, 2e-6), (Takes::Position, 4e-6)] {
            let mut interpolator = moving(takes, 1.0);
            interpolator.push_missing();
            let (state, _) = interpolator.at(T);
            let error = truth(20.0 * T).position - state.position;
            assert!((error - off).abs() < 1e-12, "{takes:?}: {error}");
        }
        let mut interpolator = moving(Takes::Speed, 1.0);
        interpolator.push_missing();
        assert_eq!(interpolator.at(T).0.velocity, truth(19.0 * T).velocity);
    }

    #[test]
    fn less_than_a_period_of_latency_is_an_extrapolation() {
        let (state, _) = moving(Takes::Torque, 0.9).at(0.95 * T);
        assert!((state.position - truth(19.05 * T).position).abs() < 1e-12);
        let (state, _) = moving(Takes::Torque, 0.9).at(0.0);
        assert!((state.position - truth(18.1 * T).position).abs() < 1e-12);
    }
}
