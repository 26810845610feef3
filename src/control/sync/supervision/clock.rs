//! The host's clock: how many periods have passed, and what time the control goes by.

use crate::control::math::round;

use super::alarm::Alarm;

/// From this many periods on between two calls, one was left out.
const GAP_PERIODS: f64 = 1.5;
/// Share of a period that a difference of times may be off by rounding.
const ROUNDING: f64 = 1e-6;

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

    fn most_s(&self) -> f64 {
        (f64::from(self.bridge_periods) + 0.5) * self.period_s
    }

    /// The time of an order that the host gives between two readings: the coming period's, where the host's is none.
    pub(super) fn of_order(&self, host_s: f64) -> f64 {
        match (self.own_s, self.last_s) {
            (Some(own_s), _) => own_s + self.period_s,
            (None, Some(last_s)) if !(0.0..=self.most_s()).contains(&(host_s - last_s)) => last_s + self.period_s,
            _ => host_s,
        }
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
        let most_s = self.most_s();
        if elapsed_s.abs() <= ROUNDING * self.period_s {
            // The last time again: a period has passed all the same.
            let now_s = last_s + self.period_s;
            self.last_s = Some(now_s);
            return Tick { now_s, periods: 1, alarm: None };
        }
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
    use super::{Alarm, Clock, Tick};

    fn clock() -> Clock {
        let mut clock = Clock::new(0.001, 5);
        assert_eq!((clock.read(10.0).periods, clock.read(10.001).periods), (1, 1));
        clock
    }

    #[test]
    fn jitter_is_one_period_and_a_gap_is_as_many_as_it_took() {
        for (next_s, periods) in [(10.0011, 1), (10.0024, 1), (10.0026, 2), (10.006, 5)] {
            let tick = clock().read(next_s);
            assert_eq!((tick.now_s, tick.periods, tick.alarm), (next_s, periods, None));
        }
    }

    #[test]
    fn a_time_that_comes_again_is_the_coming_periods_and_the_next_one_is_a_fault() {
        let mut stands = clock();
        let again = stands.read(10.001);
        assert!((again.now_s - 10.002).abs() < 1e-9 && again.alarm.is_none());
        let mut goes_on = stands;
        assert_eq!(goes_on.read(10.003), Tick { now_s: 10.003, periods: 1, alarm: None });
        let fault = stands.read(10.001);
        assert!((fault.now_s - 10.003).abs() < 1e-9 && fault.alarm.is_some());
    }

    #[test]
    fn from_a_fault_on_it_is_its_own_time() {
        for wrong_s in [f64::NAN, f64::INFINITY, 9.0, 10.007] {
            let mut clock = clock();
            let tick = clock.read(wrong_s);
            assert!(matches!(tick.alarm, Some(Alarm::Clock { .. })), "{wrong_s}");
            assert!((tick.now_s - 10.002).abs() < 1e-9 && tick.periods == 1);
            // Orders are of the same time, whatever the host's clock shows by then.
            assert!([wrong_s, 0.0, 10.003].iter().all(|host_s| (clock.of_order(*host_s) - 10.003).abs() < 1e-9));
            let later = clock.read(10.003);
            assert!((later.now_s - 10.003).abs() < 1e-9 && later.alarm.is_none());
        }
    }
    #[test]
    fn an_order_is_of_the_time_that_it_tells_if_that_is_one() {
        let clock = clock();
        assert_eq!([10.001, 10.0015, 10.005].map(|host_s| clock.of_order(host_s)), [10.001, 10.0015, 10.005]);
        for wrong_s in [f64::NAN, f64::NEG_INFINITY, 0.0, 10.0, 11.0] {
            assert!((clock.of_order(wrong_s) - 10.002).abs() < 1e-9, "{wrong_s}");
        }
    }
}
