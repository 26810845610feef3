//! How a drive answers to setpoints of which it takes a part: forwards what a drive inverse does backwards.

use super::closed_loop::ClosedLoop;
use crate::control::machine::Takes;
use crate::control::math::poly::State;

/// Steps of a period: the velocity loop is stiff.
const STEPS: u32 = 4;

/// A rigid axis under its drive's loops, without delay, friction or load, as what it takes of its setpoints moves it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveResponse {
    takes: Takes,
    loops: ClosedLoop,
    /// Greatest acceleration that the axis has.
    most: f64,
    period_s: f64,
    position: f64,
    velocity: f64,
    integral: f64,
    last: Option<State>,
}

impl DriveResponse {
    /// For a drive that takes so much, of an axis that has so much acceleration at most.
    #[must_use]
    pub fn new(takes: Takes, loops: ClosedLoop, most: f64, period_s: f64) -> Self {
        Self { takes, loops, most, period_s, position: 0.0, velocity: 0.0, integral: 0.0, last: None }
    }

    /// Where the axis is once the next setpoint acts, one period after the last; the first one stands for all before it. Who takes all
    /// of a setpoint is where it says.
    ///
    /// ```
    /// use rigidtap::control::machine::{Machine, Takes};
    /// use rigidtap::control::math::poly::State;
    /// use rigidtap::control::model::closed_loop::ClosedLoop;
    /// use rigidtap::control::model::drive_response::DriveResponse;
    /// let loops = ClosedLoop::of_z(&Machine::reference().spec().drive);
    /// let mut response = DriveResponse::new(Takes::Position, loops, 1e4, 0.001);
    /// let ramp = |k: i32| State { position: 0.1 * f64::from(k), velocity: 100.0, ..State::default() };
    /// let lag_mm = (0..1000).map(|k| ramp(k).position - response.step(&ramp(k))).last().unwrap();
    /// // By speed over gain: 100 mm/s and 40 1/s.
    /// assert!((lag_mm - 2.5).abs() < 1e-3);
    /// ```
    pub fn step(&mut self, setpoint: &State) -> f64 {
        let Some(last) = self.last.replace(*setpoint) else {
            self.position = setpoint.position;
            return self.position;
        };
        if self.takes == Takes::Torque {
            self.position = setpoint.position;
            return self.position;
        }
        let step_s = self.period_s / f64::from(STEPS);
        let ClosedLoop { position_gain_per_s, velocity_gain_per_s, integral_s } = self.loops;
        for step in 0..STEPS {
            let u = (f64::from(step) + 0.5) / f64::from(STEPS);
            let between = |from: f64, to: f64| from + u * (to - from);
            // All of it in the middle of the step.
            let ahead = between(last.position, setpoint.position) - self.position - 0.5 * step_s * self.velocity;
            let wanted = match self.takes {
                // A speed alone is held until the next.
                Takes::Speed => last.velocity,
                Takes::Position => position_gain_per_s * ahead,
                Takes::Velocity | Takes::Torque => {
                    let fed = between(last.velocity, setpoint.velocity);
                    fed + position_gain_per_s * ahead
                }
            };
            let free = (velocity_gain_per_s * (wanted - self.velocity) + self.integral)
                / (1.0 + 0.5 * step_s * velocity_gain_per_s);
            let acceleration = free.max(-self.most).min(self.most);
            let error = wanted - self.velocity - 0.5 * step_s * acceleration;
            if acceleration == free {
                self.integral += velocity_gain_per_s / integral_s * step_s * error;
            }
            self.position += step_s * (self.velocity + 0.5 * step_s * acceleration);
            self.velocity += step_s * acceleration;
        }
        self.position
    }
}

#[cfg(test)]
mod tests {
    use super::DriveResponse;
    use crate::control::machine::{Machine, Takes};
    use crate::control::math::poly::State;
    use crate::control::model::closed_loop::ClosedLoop;

    const PERIOD_S: f64 = 0.001;

    fn response(takes: Takes, most: f64) -> DriveResponse {
        DriveResponse::new(takes, ClosedLoop::of_z(&Machine::reference().spec().drive), most, PERIOD_S)
    }

    /// Speed after so many periods of a step of speed.
    fn stepped(takes: Takes, most: f64, periods: u32) -> f64 {
        let mut response = response(takes, most);
        let speed = |velocity: f64| State { velocity, ..State::default() };
        response.step(&speed(100.0));
        (0..periods).for_each(|_| {
            response.step(&speed(100.0));
        });
        response.velocity
    }

    #[test]
    fn a_speed_is_reached_as_fast_as_loops_and_motor_allow() {
        // 500 1/s: 63 % after 2 ms and more, since the integrator helps; then it overshoots and settles.
        let early = stepped(Takes::Speed, 1e9, 2);
        assert!((60.0..75.0).contains(&early), "{early}");
        assert!((stepped(Takes::Speed, 1e9, 300) - 100.0).abs() < 0.1);
        assert!((stepped(Takes::Speed, 1000.0, 50) - 50.0).abs() < 1e-9);
    }

    #[test]
    fn acceleration_that_is_not_told_is_a_lag_that_passes() {
        let mut response = response(Takes::Velocity, 1e9);
        let at = |t_s: f64| State { acceleration: 1000.0, ..State::default() }.after(t_s, 0.0);
        let lags: Vec<_> = (0..300_u32)
            .map(|k| {
                let state = at(f64::from(k) * PERIOD_S);
                state.position - response.step(&state)
            })
            .collect();
        let greatest = lags.iter().fold(0.0_f64, |greatest, lag| greatest.max(*lag));
        // a/(Kp·Kv), 50 µm, through the integrator's high-pass of 10 ms and a low-pass of 1/Kp: 0.217 of it at most, and a
        // little for the step at the start.
        assert!((0.010..0.013).contains(&greatest) && lags[299].abs() < 1e-4, "{greatest} {}", lags[299]);
    }

    #[test]
    fn what_takes_all_is_where_it_is_told() {
        let mut response = response(Takes::Torque, 1.0);
        for position in [1.0, 7.0, -3.0] {
            assert_eq!(response.step(&State { position, ..State::default() }), position);
        }
    }
}
