//! Tracking errors over their limits, and drives that are not ready.

use super::seen::{Followed, FollowingLimits};
use crate::control::sync::supervision::alarm::{Alarm, Axis, NOT_READY_PERIODS};

/// Periods for which a limit has to be broken.
const OVER_PERIODS: u32 = 3;

/// Counts the periods of each.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TrackingMonitor {
    spindle_over: u32,
    z_over: u32,
    spindle_not_ready: u32,
    z_not_ready: u32,
}

impl TrackingMonitor {
    pub(super) fn not_ready(&mut self, spindle: &Followed, z: &Followed) -> Option<Alarm> {
        let count = |periods: &mut u32, is_not_ready: bool, axis: Axis| {
            *periods = if is_not_ready { periods.saturating_add(1) } else { 0 };
            (*periods >= NOT_READY_PERIODS).then_some(Alarm::DriveNotReady { axis, periods: *periods })
        };
        let of_spindle = count(&mut self.spindle_not_ready, spindle.is_not_ready, Axis::Spindle);
        count(&mut self.z_not_ready, z.is_not_ready, Axis::Z).or(of_spindle)
    }

    pub(super) fn over(&mut self, limits: &FollowingLimits, spindle: &Followed, z: &Followed) -> Option<Alarm> {
        let FollowingLimits { spindle_rev, z_mm, period_s, .. } = *limits;
        // A period more or less of delay is no tracking error.
        let limit_rev = spindle_rev + spindle.speed.abs() * period_s;
        let limit_mm = z_mm + z.speed.abs() * period_s;
        let count = |periods: &mut u32, followed: &Followed, limit: f64| {
            let over = followed.is_trusted && followed.error.abs() > limit;
            *periods = if over { periods.saturating_add(1) } else { 0 };
            *periods >= OVER_PERIODS
        };
        let spindle_is_over = count(&mut self.spindle_over, spindle, limit_rev);
        if count(&mut self.z_over, z, limit_mm) {
            return Some(Alarm::ZFollowing { error_mm: z.error, limit_mm });
        }
        spindle_is_over.then_some(Alarm::SpindleFollowing { error_rev: spindle.error, limit_rev })
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::{SPINDLE_LIMIT_REV, Z_LIMIT_MM, good, limits, slower};
    use super::{Followed, TrackingMonitor};
    use crate::control::sync::supervision::alarm::{Alarm, Axis};

    /// The first alarm over some periods of a spindle, and its period from 0.
    fn of_spindle(spindle: impl Fn(u32) -> Followed, periods: u32) -> Option<(u32, Alarm)> {
        let (mut monitor, limits) = (TrackingMonitor::default(), limits());
        (0..periods).find_map(|k| {
            let not_ready = monitor.not_ready(&spindle(k), &good());
            not_ready.or(monitor.over(&limits, &spindle(k), &good())).map(|alarm| (k, alarm))
        })
    }

    #[test]
    fn a_drive_may_be_not_ready_for_two_periods() {
        let not_ready = Followed { is_not_ready: true, ..good() };
        let in_pairs = |k: u32| if k % 3 == 2 { good() } else { not_ready };
        assert_eq!(of_spindle(in_pairs, 1000), None);
        let alarm = Alarm::DriveNotReady { axis: Axis::Spindle, periods: 3 };
        assert_eq!(of_spindle(|_| not_ready, 10), Some((2, alarm)));
        // Where both fail, it is Z's that leaves the least.
        let mut monitor = TrackingMonitor::default();
        let alarms = [(); 3].map(|()| monitor.not_ready(&not_ready, &not_ready));
        assert_eq!(alarms, [None, None, Some(Alarm::DriveNotReady { axis: Axis::Z, periods: 3 })]);
    }

    #[test]
    fn a_tracking_error_over_its_limit_is_an_alarm_in_the_third_period() {
        let off = |error: f64| Followed { error, ..good() };
        assert_eq!(of_spindle(|_| off(0.249), 1000), None);
        assert_eq!(of_spindle(|k| off(if k % 3 == 2 { 0.249 } else { 0.251 }), 1000), None);
        assert_eq!(of_spindle(|_| Followed { is_trusted: false, ..off(9.0) }, 1000), None);
        for error_rev in [0.251, -0.251] {
            let alarm = Alarm::SpindleFollowing { error_rev, limit_rev: SPINDLE_LIMIT_REV };
            assert_eq!(of_spindle(|_| off(error_rev), 10), Some((2, alarm)));
            let (mut monitor, limits) = (TrackingMonitor::default(), limits());
            let alarms = [(); 3].map(|()| monitor.over(&limits, &good(), &off(error_rev)));
            let of_z = Alarm::ZFollowing { error_mm: error_rev, limit_mm: Z_LIMIT_MM };
            assert_eq!(alarms, [None, None, Some(of_z)]);
        }
        // A period of travel more or less is a delay: 0.05 rev at this speed.
        let fast = |error: f64| Followed { error, ..slower(0.0) };
        assert_eq!(of_spindle(|_| fast(-0.299), 1000), None);
        assert!(of_spindle(|_| fast(-0.301), 10).is_some());
    }
}
