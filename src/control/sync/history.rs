//! The last values of a signal, read between and behind them without steps.

use crate::control::math::{floor, poly::State, round};

/// Values kept.
const KEPT: usize = 128;
/// Periods from one control point to the next at most.
const WIDEST: f64 = 16.0;

/// Values one period apart, seen through a cubic B-spline: near them, and with a rate and a rate of that which are
/// continuous whatever they do. A step takes four spacings of its knots.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct History {
    period_s: f64,
    /// Periods from knot to knot.
    spacing: usize,
    values: [f64; KEPT],
    newest: usize,
}

impl History {
    /// A signal that has been 0, and whose steps take a time; four periods at least.
    pub(super) fn smoothed(period_s: f64, step_s: f64) -> Self {
        let spacing = round(0.25 * step_s / period_s).clamp(1.0, WIDEST) as usize;
        Self { period_s, spacing, values: [0.0; KEPT], newest: 0 }
    }

    /// A signal that has been constant.
    pub(super) fn fill(&mut self, value: f64) {
        self.values = [value; KEPT];
    }

    /// Half of what a step takes: a value counts so long before it.
    pub(super) fn half_width_s(&self) -> f64 {
        f64::from(self.half_width_periods()) * self.period_s
    }

    /// The same in periods.
    pub(super) fn half_width_periods(&self) -> u32 {
        2 * self.spacing as u32
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
    use super::History;
    use crate::control::math::poly::State;

    const PERIOD_S: f64 = 0.001;

    fn of(step_s: f64, values: impl IntoIterator<Item = f64>) -> History {
        let mut history = History::smoothed(PERIOD_S, step_s);
        values.into_iter().for_each(|value| history.push(value));
        history
    }

    #[test]
    fn straight_lines_are_read_as_they_are() {
        for step_s in [0.0, 0.004, 0.013, 0.1] {
            let history = of(step_s, (0..200).map(|k| 3.0 + 0.02 * f64::from(k)));
            for ago_s in [history.half_width_s(), history.half_width_s() + 0.0123] {
                let State { position, velocity, acceleration, .. } = history.at(ago_s);
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
        let history = of(0.012, (0..100).map(|k| f64::from(k % 17)));
        let near_s = 1e-6;
        for ago_s in [0.0071, 0.0134, 0.0305] {
            let [before, at, after] = [ago_s + near_s, ago_s, ago_s - near_s].map(|ago_s| history.at(ago_s));
            let rate = |from: f64, to: f64| (to - from) / (2.0 * near_s);
            assert!((rate(before.position, after.position) - at.velocity).abs() < 1e-3, "{at:?}");
            assert!((rate(before.velocity, after.velocity) - at.acceleration).abs() < 1.0, "{at:?}");
        }
    }

    #[test]
    fn a_step_takes_its_time_and_not_more() {
        for (step_s, takes_s) in [(0.0, 0.004), (0.004, 0.004), (0.012, 0.012), (1.0, 0.064)] {
            let history = of(step_s, (0..128).map(|k| if k < 64 { 0.0 } else { 1.0 }));
            assert!((2.0 * history.half_width_s() - takes_s).abs() < 1e-12);
            // Between the two values that differ.
            let middle_s = 0.0635;
            let around = |share: f64| history.at(middle_s - share * (0.5 * takes_s + 0.5 * PERIOD_S));
            assert_eq!((around(-1.0).position, around(-1.0).velocity), (0.0, 0.0));
            assert!((around(1.0).position - 1.0).abs() < 1e-12 && around(1.0).velocity.abs() < 1e-9, "{step_s}");
            assert!((around(0.0).position - 0.5).abs() < 1e-12);
            let rising = (-20..20).map(|k| around(f64::from(k) / 20.0).position).collect::<Vec<_>>();
            assert!(rising.windows(2).all(|pair| pair[1] > pair[0] - 1e-12), "{rising:?}");
        }
    }

    #[test]
    fn beyond_what_is_kept_the_nearest_is_read() {
        let history = of(0.004, [1.0, 2.0, 5.0]);
        assert_eq!(history.newest(), 5.0);
        assert_eq!(history.at(0.0), history.at(history.half_width_s()));
        assert_eq!(history.at(10.0).position, 0.0);
    }
}
