//! The motion that was commanded of late, at any instant between its periods.

use crate::control::math::poly::State;

/// Periods kept. Delays of drives and encoders are a few periods; one that is longer reads the oldest.
const KEPT: usize = 256;

/// A delay line of a planned motion, one state a period.
///
/// Between two periods it is the quintic with both ends' position, velocity and acceleration: exact wherever a time law has
/// constant snap, and within 0.02·h²·Δa where the acceleration steps by Δa inside a period h.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync) struct CommandedMotion {
    period_s: f64,
    /// Position, velocity and acceleration, in a ring.
    states: [[f64; 3]; KEPT],
    newest: usize,
}

impl CommandedMotion {
    /// A motion that has rested at a position.
    pub(in crate::control::sync) fn at_rest(period_s: f64, position: f64) -> Self {
        Self { period_s, states: [[position, 0.0, 0.0]; KEPT], newest: 0 }
    }

    /// One period: what is commanded now.
    pub(in crate::control::sync) fn push(&mut self, state: &State) {
        self.newest = (self.newest + 1) % KEPT;
        if let Some(slot) = self.states.get_mut(self.newest) {
            *slot = [state.position, state.velocity, state.acceleration];
        }
    }

    fn ago(&self, periods: usize) -> [f64; 3] {
        self.states.get((self.newest + KEPT - periods % KEPT) % KEPT).copied().unwrap_or_default()
    }

    /// The motion at a time of 0 or more before the newest; jerk is not kept.
    pub(in crate::control::sync) fn at(&self, ago_s: f64) -> State {
        let h = self.period_s;
        let periods = (ago_s / h).max(0.0).min((KEPT - 2) as f64);
        let whole = periods as usize;
        let t = 1.0 - (periods - whole as f64);
        let ([p0, v0, a0], [p1, v1, a1]) = (self.ago(whole + 1), self.ago(whole));
        let (v0_h, a0_h2) = (v0 * h, a0 * h * h);
        let d0 = p1 - p0 - v0_h - 0.5 * a0_h2;
        let d1 = v1 * h - v0_h - a0_h2;
        let d2 = a1 * h * h - a0_h2;
        let c3 = 10.0 * d0 - 4.0 * d1 + 0.5 * d2;
        let c4 = 7.0 * d1 - 15.0 * d0 - d2;
        let c5 = 6.0 * d0 - 3.0 * d1 + 0.5 * d2;
        State {
            position: p0 + t * (v0_h + t * (0.5 * a0_h2 + t * (c3 + t * (c4 + t * c5)))),
            velocity: v0 + t * (a0_h2 + t * (3.0 * c3 + t * (4.0 * c4 + t * 5.0 * c5))) / h,
            acceleration: a0 + t * (6.0 * c3 + t * (12.0 * c4 + t * 20.0 * c5)) / (h * h),
            jerk: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{CommandedMotion, KEPT};
    use crate::control::math::poly::State;

    const PERIOD_S: f64 = 0.001;

    fn of(motion: impl Fn(f64) -> State, periods: u32) -> CommandedMotion {
        let mut commanded = CommandedMotion::at_rest(PERIOD_S, 0.0);
        (0..periods).for_each(|k| commanded.push(&motion(f64::from(k) * PERIOD_S)));
        commanded
    }

    /// Constant snap, as all time laws have.
    #[test]
    fn quartics_are_exact() {
        let start = State { position: 3.0, velocity: -2.0, acceleration: 400.0, jerk: 6e4 };
        let motion = |t_s: f64| start.after(t_s, -3e6);
        let commanded = of(motion, 60);
        for ago_s in [0.0, 0.000_1, 0.000_65, 0.001, 0.003_7, 0.04] {
            let (found, expected) = (commanded.at(ago_s), motion(0.059 - ago_s));
            assert!((found.position - expected.position).abs() < 1e-11, "{ago_s}: {found:?} {expected:?}");
            assert!((found.velocity - expected.velocity).abs() < 1e-8, "{ago_s}: {found:?} {expected:?}");
            assert!((found.acceleration - expected.acceleration).abs() < 1e-4, "{ago_s}: {found:?} {expected:?}");
        }
    }

    /// The acceleration steps by 1000 rev/s² between two periods: 0.02·h²·Δa is 2e-5 rev.
    #[test]
    fn a_step_of_acceleration_stays_within_its_bound() {
        let motion = |t_s: f64| {
            let left_s = (t_s - 0.030_4).max(0.0);
            let acceleration = if t_s > 0.030_4 { 1000.0 } else { 0.0 };
            State { position: 500.0 * left_s * left_s, velocity: 1000.0 * left_s, acceleration, jerk: 0.0 }
        };
        let commanded = of(motion, 40);
        for fine in 0..120 {
            let ago_s = 0.006 + f64::from(fine) * 1e-4 / 3.0;
            let off = commanded.at(ago_s).position - motion(0.039 - ago_s).position;
            assert!(off.abs() < 2e-5, "{ago_s}: {off}");
        }
    }

    #[test]
    fn beyond_what_is_kept_the_oldest_is_read() {
        let commanded = of(|t_s| State { position: t_s, velocity: 1.0, ..State::default() }, 1000);
        let oldest_s = 0.999 - (KEPT - 2) as f64 * PERIOD_S;
        assert!((commanded.at(10.0).position - oldest_s).abs() < 1e-12);
        assert_eq!(CommandedMotion::at_rest(PERIOD_S, 0.0).at(0.0123), State::default());
    }
}
