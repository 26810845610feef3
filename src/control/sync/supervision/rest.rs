//! Whether an axis rests: by its travel over some time, so that counts that flicker are rest.

/// A spindle slower than this rests, once it does so for [`RESTING_S`].
const RESTING_REV_PER_S: f64 = 0.1;
const RESTING_S: f64 = 0.02;
/// An encoder may flicker by so many counts.
const FLICKER_COUNTS: f64 = 3.0;

/// Watches the spindle's travel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RestMonitor {
    /// Travel that is still rest, rev.
    within_rev: f64,
    needed_periods: u32,
    since_rev: f64,
    periods: u32,
}

impl RestMonitor {
    pub(super) fn new(counts_per_rev: f64, period_s: f64) -> Self {
        let within_rev = (RESTING_REV_PER_S * RESTING_S).max(FLICKER_COUNTS / counts_per_rev);
        Self { within_rev, needed_periods: (RESTING_S / period_s) as u32 + 1, since_rev: 0.0, periods: 0 }
    }

    /// One period.
    pub(super) fn observe(&mut self, spindle_rev: f64) {
        if (spindle_rev - self.since_rev).abs() <= self.within_rev {
            self.periods = self.periods.saturating_add(1);
        } else {
            (self.since_rev, self.periods) = (spindle_rev, 0);
        }
    }

    pub(super) fn is_at_rest(&self) -> bool {
        self.periods >= self.needed_periods
    }
}

#[cfg(test)]
mod tests {
    use super::RestMonitor;

    fn rests(counts_per_rev: f64, spindle_rev: impl Fn(u32) -> f64) -> bool {
        let mut monitor = RestMonitor::new(counts_per_rev, 0.001);
        (0..1000).any(|k| {
            monitor.observe(spindle_rev(k));
            monitor.is_at_rest()
        })
    }

    #[test]
    fn what_creeps_does_not_rest_and_what_flickers_does() {
        assert!(!rests(16_384.0, |k| 1.0 + 0.000_11 * f64::from(k)));
        assert!(rests(16_384.0, |k| 1.0 + 0.000_09 * f64::from(k)));
        for counts_per_rev in [1024.0, 16_384.0, 1e6] {
            assert!(rests(counts_per_rev, |k| 5.0 + f64::from(k % 3) / counts_per_rev));
        }
    }
}
