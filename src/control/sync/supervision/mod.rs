//! Run-time faults: typed alarms, latched until the host acknowledges them at rest.

mod alarm;

pub(super) use alarm::SETTLE_TIMEOUT_S;
pub use alarm::{Alarm, Axis};

/// Keeps the first alarm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Supervision {
    alarm: Option<Alarm>,
}

impl Supervision {
    /// Takes in an alarm; one that is latched already stays.
    pub(super) fn raise(&mut self, alarm: Alarm) {
        self.alarm.get_or_insert(alarm);
    }

    pub(super) fn alarm(&self) -> Option<Alarm> {
        self.alarm
    }

    /// Forgets the alarm.
    pub(super) fn acknowledge(&mut self) {
        self.alarm = None;
    }
}

#[cfg(test)]
mod tests {
    use super::{Alarm, Supervision};

    #[test]
    fn the_first_alarm_stays_until_acknowledged() {
        let alarm = |waited_s| Alarm::NotInPosition { waited_s, spindle_rev: 0.0, z_mm: 0.0 };
        let mut supervision = Supervision::default();
        supervision.raise(alarm(3.0));
        supervision.raise(alarm(4.0));
        assert_eq!(supervision.alarm(), Some(alarm(3.0)));
        supervision.acknowledge();
        assert_eq!(supervision.alarm(), None);
    }
}
