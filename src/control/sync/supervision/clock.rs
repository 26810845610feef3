//! The host's clock: how many periods have passed, and what time the control goes by.

use crate::control::math::round;

use super::alarm::Alarm;

/// From this many periods on between two calls, one was left out.
const GAP_PERIODS: f64 = 1.5;

/// One reading of the clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync) struct Tick {
    /// The time that the control goes by.
    pub(in crate::control::sync) now_s: f64,
    /// Periods since the last call, this one included.
    pub(in crate::control::sync) periods: u32,
    /// The clock is not to be trusted.
    pub(in crate::control::sync) alarm: Option<Alarm>,
}

/// Follows the host's clock as long as it is one; from a fault on, its own time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Clock {
    period_s: f64,
    bridge_periods: u32,
    last_s: Option<f64>,
    /// Own time less the host's, once that has failed.
    own_s: Option<f64>,
}

impl Clock {
    pub(super) fn new(period_s: f64, bridge_periods: u32) -> Self {
        Self { period_s, bridge_periods, last_s: None, own_s: None }
    }

    /// The host's clock shows a time.
    pub(super) fn read(&mut self, host_s: f64) -> Tick {
        if let Some(own_s) = &mut self.own_s {
            *own_s += self.period_s;
            return Tick { now_s: *own_s, periods: 1, alarm: None };
        }
        let last_s = match self.last_s {
            Some(last_s) => last_s,
            None if host_s.is_finite() => host_s - self.period_s,
            None => 0.0,
        };
        let elapsed_s = host_s - last_s;
        let most_s = (f64::from(self.bridge_periods) + 0.5) * self.period_s;
        if elapsed_s >= 0.0 && elapsed_s <= most_s {
            self.last_s = Some(host_s);
            let gap = elapsed_s > GAP_PERIODS * self.period_s;
            // At most `bridge_periods`, and no less than one.
            let periods = if gap { round(elapsed_s / self.period_s) as u32 } else { 1 };
            return Tick { now_s: host_s, periods, alarm: None };
        }
        let now_s = last_s + self.period_s;
        self.own_s = Some(now_s);
        Tick { now_s, periods: 1, alarm: Some(Alarm::Clock { elapsed_s, limit_s: most_s }) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Alarm, Clock};

    fn clock() -> Clock {
        let mut clock = Clock::new(0.001, 5);
        assert_eq!((clock.read(10.0).periods, clock.read(10.001).periods), (1, 1));
        clock
    }

    #[test]
    fn jitter_is_one_period_and_a_gap_is_as_many_as_it_took() {
        for (next_s, periods) in [(10.0024, 1), (10.0026, 2), (10.006, 5), (10.001, 1)] {
            let tick = clock().read(next_s);
            assert_eq!((tick.now_s, tick.periods, tick.alarm), (next_s, periods, None));
        }
    }

    #[test]
    fn from_a_fault_on_it_is_its_own_time() {
        for wrong_s in [f64::NAN, f64::INFINITY, 9.0, 10.007] {
            let mut clock = clock();
            let tick = clock.read(wrong_s);
            assert!(matches!(tick.alarm, Some(Alarm::Clock { .. })), "{wrong_s}");
            assert!((tick.now_s - 10.002).abs() < 1e-9 && tick.periods == 1);
            let later = clock.read(10.003);
            assert!((later.now_s - 10.003).abs() < 1e-9 && later.alarm.is_none());
        }
    }
}
