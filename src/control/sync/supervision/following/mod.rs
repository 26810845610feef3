//! Whether the axes follow their commands: tracking errors, drives that are not ready, a tap that jams, and an encoder whose
//! travel the drive's effort contradicts.

mod contradiction;
#[cfg(test)]
mod examples;
mod jam;
mod seen;
mod tracking;

use super::alarm::Alarm;
use contradiction::ContradictionMonitor;
use jam::JamMonitor;
pub(super) use seen::{Followed, FollowingLimits, SpindleEffort};
use tracking::TrackingMonitor;

/// All of them, with the limits that they share.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FollowingMonitor {
    limits: FollowingLimits,
    tracking: TrackingMonitor,
    jam: JamMonitor,
    contradiction: ContradictionMonitor,
}

impl FollowingMonitor {
    pub(super) fn new(limits: FollowingLimits) -> Self {
        Self {
            limits,
            tracking: TrackingMonitor::default(),
            jam: JamMonitor::default(),
            contradiction: ContradictionMonitor::default(),
        }
    }

    /// Counts from nothing.
    pub(super) fn acknowledge(&mut self) {
        *self = Self::new(self.limits.clone());
    }

    /// One period of both axes: the alarm that is due.
    pub(super) fn check(&mut self, spindle: &Followed, z: &Followed, effort: &SpindleEffort) -> Option<Alarm> {
        let Self { limits, tracking, jam, contradiction } = self;
        let not_ready = tracking.not_ready(spindle, z);
        let jam = jam.check(limits, spindle, effort);
        let contradiction = contradiction.check(limits, spindle, effort);
        let over = tracking.over(limits, spindle, z);
        not_ready.or(jam).or(contradiction).or(over)
    }
}
