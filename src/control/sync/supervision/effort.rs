//! Reported efforts: those that no drive can have are dropped, and three in a row are an alarm.

use super::alarm::{Alarm, Axis};

/// So many in a row are no longer a single bad sample.
const DROPPED_IN_A_ROW: u32 = 3;

/// The reports of one drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct EffortMonitor {
    axis: Axis,
    limit: f64,
    dropped: u32,
}

impl EffortMonitor {
    /// `limit` is the greatest effort that the drive can have.
    pub(super) fn new(axis: Axis, limit: f64) -> Self {
        Self { axis, limit, dropped: 0 }
    }

    /// One period: what is left of a report, and the alarm where nothing is for too long.
    pub(super) fn check(&mut self, reported: Option<f64>) -> (Option<f64>, Option<Alarm>) {
        let Some(effort) = reported else { return (None, None) };
        if effort.abs() <= self.limit {
            self.dropped = 0;
            return (reported, None);
        }
        self.dropped = self.dropped.saturating_add(1);
        let Self { axis, limit, dropped } = *self;
        (None, (dropped == DROPPED_IN_A_ROW).then_some(Alarm::EffortImplausible { axis, effort, limit }))
    }

    pub(super) fn acknowledge(&mut self) {
        self.dropped = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::{Axis, EffortMonitor};

    #[test]
    fn two_are_dropped_and_the_third_is_an_alarm() {
        for wrong in [f64::NAN, f64::INFINITY, -31.0] {
            let mut monitor = EffortMonitor::new(Axis::Spindle, 30.0);
            assert_eq!(monitor.check(Some(29.0)), (Some(29.0), None));
            assert_eq!([monitor.check(Some(wrong)).1, monitor.check(Some(wrong)).1], [None; 2]);
            let (left, alarm) = monitor.check(Some(wrong));
            assert_eq!((left, alarm.map(|alarm| alarm.code())), (None, Some(110)));
            assert_eq!(monitor.check(Some(1.0)), (Some(1.0), None));
        }
        assert_eq!(EffortMonitor::new(Axis::Z, 1.0).check(None), (None, None));
    }
}
