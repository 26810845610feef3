//! The last stage of every step: whatever came before, what leaves it is finite, within the machine's limits and smooth.
//!
//! It is a pure function of the setpoint before and the one that is wanted. One that obeys the limits passes as it is.

use crate::control::math::{poly::State, sqrt};

/// Limits of an axis' setpoints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AxisBounds {
    /// Least and greatest position.
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) speed: f64,
    pub(super) acceleration: f64,
}

/// Share of the acceleration with which a wanted position is caught up, so that the end is not overrun.
const CATCH_UP_SHARE: f64 = 0.5;
/// Numbers closer than this are the same but for rounding.
const ROUNDING: f64 = 1e-9;

/// What is sent of one axis, and what its next setpoint is judged by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Bounded {
    /// The setpoint.
    pub(super) state: State,
    /// Its position less that before, by the time between.
    pub(super) speed: f64,
}

impl Bounded {
    /// A setpoint at rest.
    pub(super) fn at_rest(position: f64) -> Self {
        Self { state: State { position, ..State::default() }, speed: 0.0 }
    }
}

impl AxisBounds {
    /// The setpoint that comes `elapsed_s` after `before`, as near to the wanted one as the limits allow.
    pub(super) fn next(&self, before: &Bounded, wanted: &State, elapsed_s: f64) -> Bounded {
        let wanted =
            if is_finite(wanted) { *wanted } else { State { position: before.state.position, ..State::default() } };
        let from = before.state.position;
        let wanted_speed = (wanted.position - from) / elapsed_s;
        let speed_change = self.acceleration * elapsed_s;
        let passes = (self.low..=self.high).contains(&wanted.position)
            && wanted_speed.abs() <= self.speed
            && (wanted_speed - before.speed).abs() <= speed_change
            && wanted.velocity.abs() <= self.speed
            && wanted.acceleration.abs() <= self.acceleration
            && self.can_stop(wanted.position, wanted_speed, elapsed_s);
        if passes {
            return Bounded { state: wanted, speed: wanted_speed };
        }
        let target = wanted.position.max(self.low).min(self.high);
        let caught_up = wanted.velocity + self.approach(target - from, CATCH_UP_SHARE, elapsed_s);
        let lowest = (before.speed - speed_change).max(-self.speed);
        let highest = (before.speed + speed_change).min(self.speed);
        let inside = caught_up
            .min(self.approach(self.high - from, 1.0, elapsed_s).max(0.0))
            .max(self.approach(self.low - from, 1.0, elapsed_s).min(0.0));
        let speed = inside.max(lowest).min(highest);
        let position = from + speed * elapsed_s;
        let acceleration = (speed - before.speed) / elapsed_s;
        Bounded { state: State { position, velocity: speed, acceleration, jerk: 0.0 }, speed }
    }

    /// The speed from which a way can still be braked to an end, in steps of `elapsed_s`.
    fn approach(&self, way: f64, share: f64, elapsed_s: f64) -> f64 {
        let step = share * self.acceleration * elapsed_s;
        let half_step = 0.5 * step;
        let speed = sqrt(half_step * half_step + 2.0 * share * self.acceleration * way.abs()) - half_step;
        // The last step ends on it.
        let speed = speed.min(way.abs() / elapsed_s).max(0.0);
        if way < 0.0 { -speed } else { speed }
    }

    /// Whether the axis can stop before it leaves its range.
    fn can_stop(&self, position: f64, speed: f64, elapsed_s: f64) -> bool {
        let way = if speed > 0.0 { self.high - position } else { position - self.low };
        speed.abs() <= self.approach(way, 1.0, elapsed_s) + self.acceleration * elapsed_s + ROUNDING
    }
}

fn is_finite(State { position, velocity, acceleration, .. }: &State) -> bool {
    position.is_finite() && velocity.is_finite() && acceleration.is_finite()
}
