//! A delay line read through a cubic B-spline: the last values of a signal, between and behind them, without steps.

use crate::control::math::{floor, poly::State, round};

/// Values kept.
const KEPT: usize = 128;
/// Periods from one control point to the next at most.
const WIDEST: f64 = 16.0;

/// Values one period apart, read through a cubic B-spline whose knots are `spacing` periods apart: close to the values, with a
/// continuous rate and second rate. A step takes four spacings (Biagiotti and Melchiorri, Trajectory Planning for Automatic
/// Machines and Robots, 2008, B-splines and their use as filters).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DelayLine {
    period_s: f64,
    /// Periods from knot to knot.
    spacing: usize,
    values: [f64; KEPT],
    newest: usize,
}

/// Periods from knot to knot for a step that takes a time.
fn spacing(period_s: f64, step_s: f64) -> usize {
    round(0.25 * step_s / period_s).clamp(1.0, WIDEST) as usize
}

/// Half of what a step takes, in periods: a value counts so long before it, and has to be known so long ahead.
pub(in crate::control::sync) fn half_width_periods(period_s: f64, step_s: f64) -> u32 {
    2 * spacing(period_s, step_s) as u32
}

impl DelayLine {
    /// A signal that has been constant, and whose steps take a time; four periods at least.
    pub(super) fn constant(value: f64, period_s: f64, step_s: f64) -> Self {
        Self { period_s, spacing: spacing(period_s, step_s), values: [value; KEPT], newest: 0 }
    }

    pub(super) fn push(&mut self, value: f64) {
        self.newest = (self.newest + 1) % KEPT;
        if let Some(slot) = self.values.get_mut(self.newest) {
            *slot = value;
        }
    }

    fn ago(&self, periods: usize) -> f64 {
        self.values.get((self.newest + KEPT - periods % KEPT) % KEPT).copied().unwrap_or_default()
    }

    pub(super) fn newest(&self) -> f64 {
        self.ago(0)
    }

    /// Value, rate and its rate a time before the newest: half a width at least, and no more than is kept.
    pub(super) fn at(&self, ago_s: f64) -> State {
        let wide = self.spacing as f64;
        let periods = (ago_s / self.period_s).max(2.0 * wide).min((KEPT - 1) as f64 - 2.0 * wide);
        let mut sum = State::default();
        // From the newest value within half a width on.
        let first = floor(periods - 2.0 * wide) as usize + 1;
        for index in first..first + 4 * self.spacing {
            let (value, away) = (self.ago(index), (index as f64 - periods) / wide);
            let (near, rest) = (away.abs(), 2.0 - away.abs());
            let [weight, slope, bend] = if near < 1.0 {
                [(4.0 - near * near * (6.0 - 3.0 * near)) / 6.0, near * (1.5 * near - 2.0), 3.0 * near - 2.0]
            } else {
                [rest * rest * rest / 6.0, -rest * rest / 2.0, rest]
            };
            sum.position += weight * value;
            // Older values lie further back, and time runs the other way.
            sum.velocity += slope * away.signum() * value;
            sum.acceleration += bend * value;
        }
        let knot_s = wide * self.period_s;
        State {
            position: sum.position / wide,
            velocity: sum.velocity / (wide * knot_s),
            acceleration: sum.acceleration / (wide * knot_s * knot_s),
            jerk: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DelayLine, half_width_periods};
    use crate::control::math::poly::State;

    const PERIOD_S: f64 = 0.001;

    fn half_width_s(step_s: f64) -> f64 {
        f64::from(half_width_periods(PERIOD_S, step_s)) * PERIOD_S
    }

    fn of(step_s: f64, values: impl IntoIterator<Item = f64>) -> DelayLine {
        let mut delay_line = DelayLine::constant(0.0, PERIOD_S, step_s);
        values.into_iter().for_each(|value| delay_line.push(value));
        delay_line
    }

    #[test]
    fn straight_lines_are_read_as_they_are() {
        for step_s in [0.0, 0.004, 0.013, 0.1] {
            let delay_line = of(step_s, (0..200).map(|k| 3.0 + 0.02 * f64::from(k)));
            for ago_s in [half_width_s(step_s), half_width_s(step_s) + 0.0123] {
                let State { position, velocity, acceleration, .. } = delay_line.at(ago_s);
                assert!((position - (3.0 + 20.0 * (0.199 - ago_s))).abs() < 1e-9, "{step_s} {ago_s}: {position}");
                assert!(
                    (velocity - 20.0).abs() < 1e-9 && acceleration.abs() < 1e-6,
                    "{step_s}: {velocity} {acceleration}"
                );
            }
        }
    }

    #[test]
    fn rates_are_those_of_the_value() {
        let delay_line = of(0.012, (0..100).map(|k| f64::from(k % 17)));
        let near_s = 1e-6;
        for ago_s in [0.0071, 0.0134, 0.0305] {
            let [before, at, after] = [ago_s + near_s, ago_s, ago_s - near_s].map(|ago_s| delay_line.at(ago_s));
            let rate = |from: f64, to: f64| (to - from) / (2.0 * near_s);
            assert!((rate(before.position, after.position) - at.velocity).abs() < 1e-3, "{at:?}");
            assert!((rate(before.velocity, after.velocity) - at.acceleration).abs() < 1.0, "{at:?}");
        }
    }

    #[test]
    fn a_step_takes_its_time_and_not_more() {
        for (step_s, takes_s) in [(0.0, 0.004), (0.004, 0.004), (0.012, 0.012), (1.0, 0.064)] {
            let delay_line = of(step_s, (0..128).map(|k| if k < 64 { 0.0 } else { 1.0 }));
            assert!((2.0 * half_width_s(step_s) - takes_s).abs() < 1e-12);
            // Between the two values that differ.
            let middle_s = 0.0635;
            let around = |share: f64| delay_line.at(middle_s - share * (0.5 * takes_s + 0.5 * PERIOD_S));
            assert_eq!((around(-1.0).position, around(-1.0).velocity), (0.0, 0.0));
            assert!((around(1.0).position - 1.0).abs() < 1e-12 && around(1.0).velocity.abs() < 1e-9, "{step_s}");
            assert!((around(0.0).position - 0.5).abs() < 1e-12);
            let rising = (-20..20).map(|k| around(f64::from(k) / 20.0).position).collect::<Vec<_>>();
            assert!(rising.windows(2).all(|pair| pair[1] > pair[0] - 1e-12), "{rising:?}");
        }
    }

    #[test]
    fn beyond_what_is_kept_the_nearest_is_read() {
        let delay_line = of(0.004, [1.0, 2.0, 5.0]);
        assert_eq!(delay_line.newest(), 5.0);
        assert_eq!(delay_line.at(0.0), delay_line.at(half_width_s(0.004)));
        assert_eq!(delay_line.at(10.0).position, 0.0);
    }
}
