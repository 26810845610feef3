//! A tap that jams: the spindle falls behind its command faster than its motor alone explains, or with all of its torque.

use super::seen::{Followed, FollowingLimits, SpindleEffort};
use crate::control::math::filter_share;
use crate::control::sync::supervision::alarm::Alarm;
use crate::control::units::rpm_from_rev_per_s;

/// A jam's slowing against the motor's own greatest acceleration.
const JAM_ACCELERATION: f64 = 2.0;
/// Share of the speed that a sample's jitter may seem to change it by.
const JAM_JITTER_SHARE: f64 = 0.08;
/// Counts by which a change of speed may seem greater than it is: of a coarse encoder that is more than what its motor explains.
const SEEMING_COUNTS: f64 = 4.0;
/// A single sample that falls behind by so many times what samples scatter is a jam, too.
const SCATTERS: f64 = 8.0;
/// Memory of that scatter.
const SCATTER_S: f64 = 0.05;
/// Periods over which a sudden jam is looked at.
const JAM_WINDOW: usize = 2;
/// Seconds for which torque stands at its limit while the speed falls.
const SLOW_JAM_S: f64 = 0.006;

/// How the spindle fell behind of late.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct JamMonitor {
    jamming: u32,
    /// How much slower than expected the spindle was in the last periods, rev/s.
    lags: [f64; JAM_WINDOW],
    /// Mean change of that lag from period to period, rev/s.
    scatter: f64,
    speed: f64,
    /// Sense in which the spindle was to turn, ±1.
    direction: f64,
}

impl JamMonitor {
    pub(super) fn check(
        &mut self,
        limits: &FollowingLimits,
        spindle: &Followed,
        effort: &SpindleEffort,
    ) -> Option<Alarm> {
        let FollowingLimits { motor, count_rev, period_s, .. } = limits;
        let direction = if spindle.expected_speed < 0.0 { -1.0 } else { 1.0 };
        let lag = direction * (spindle.expected_speed - spindle.speed);
        let [older, newer] = self.lags;
        let before = self.speed;
        (self.lags, self.speed) = ([newer, lag], spindle.speed);
        // What was behind is ahead once the command turns round: no jam, but another sign.
        let turns = core::mem::replace(&mut self.direction, direction) != direction;
        let fastest = JAM_ACCELERATION * motor.acceleration_rev_per_s2(0.0, 1.0);
        // A weak motor that is to turn back already still slows with all it has: nothing holds it.
        let reverses = before * direction < -fastest * period_s;
        // A tap that jams takes some periods to halt the spindle: counts that stand at once are the encoder's.
        if !spindle.is_trusted || spindle.may_be_frozen || reverses || turns {
            (self.lags, self.jamming) = ([lag; JAM_WINDOW], 0);
            return None;
        }
        let seeming = SEEMING_COUNTS * count_rev / period_s;
        let explained =
            (JAM_WINDOW as f64 * fastest * period_s).max(seeming) + JAM_JITTER_SHARE * spindle.expected_speed.abs();
        let grown = lag - older;
        let over_window = grown > explained && newer > older && lag > newer && lag > explained;
        let at_once = lag - newer > (2.0 * fastest * period_s).max(seeming) + SCATTERS * self.scatter;
        self.scatter += filter_share(*period_s, SCATTER_S) * ((lag - newer).abs() - self.scatter);
        let sudden = over_window || at_once;
        let pushes = spindle.is_saturated && effort.commanded_nm.iter().all(|nm| nm * direction >= 0.0);
        let slows = before.abs() > spindle.speed.abs();
        self.jamming = if pushes && slows && lag > newer { self.jamming.saturating_add(1) } else { 0 };
        let slow = f64::from(self.jamming) * period_s >= SLOW_JAM_S;
        (sudden || slow)
            .then(|| Alarm::Jam { lag_rpm: rpm_from_rev_per_s(lag), limit_rpm: rpm_from_rev_per_s(explained) })
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::{FAST_REV_PER_S, UNTOLD, effort, good, limits, slower};
    use super::{Followed, JamMonitor, SpindleEffort};
    use crate::control::sync::supervision::alarm::Alarm;

    /// The first alarm over some periods of a spindle, and its period from 0.
    fn first(effort: SpindleEffort, spindle: impl Fn(u32) -> Followed, periods: u32) -> Option<(u32, Alarm)> {
        let (mut monitor, limits) = (JamMonitor::default(), limits());
        (0..periods).find_map(|k| monitor.check(&limits, &spindle(k), &effort).map(|alarm| (k, alarm)))
    }

    /// The speed loop of a frequency converter is 50 rpm behind where its command turns round.
    #[test]
    fn a_slow_drive_that_turns_round_is_not_jammed() {
        let turning = |k: u32| {
            let expected_speed = 0.04 * (50.0 - f64::from(k));
            Followed { speed: expected_speed + 0.8, expected_speed, ..good() }
        };
        assert_eq!(first(UNTOLD, turning, 100), None);
    }

    #[test]
    fn a_spindle_that_falls_behind_faster_than_its_motor_explains_is_jammed() {
        // Twice what the motor gives, 1.6 rev/s a period, and 8 % of the speed are explained.
        assert_eq!(first(UNTOLD, |k| slower(f64::from(k.min(60)) * 0.7), 100), None);
        assert_eq!(first(UNTOLD, |k| slower(if k % 2 == 0 { 1.5 } else { -1.5 }), 1000), None);
        for sense in [1.0, -1.0] {
            let jam = |k: u32| {
                let lag = f64::from(k.saturating_sub(49)) * 4.0;
                Followed { speed: sense * (FAST_REV_PER_S - lag), expected_speed: sense * FAST_REV_PER_S, ..good() }
            };
            let Some((k, Alarm::Jam { lag_rpm, limit_rpm })) = first(UNTOLD, jam, 100) else { panic!("none") };
            assert!((50..=51).contains(&k) && lag_rpm > 200.0 && limit_rpm > 400.0, "{k}: {lag_rpm} {limit_rpm}");
        }
        let blind = |k| Followed { is_trusted: false, ..slower(f64::from(k) * 4.0) };
        assert_eq!(first(UNTOLD, blind, 100), None);
    }

    #[test]
    fn counts_that_stand_at_once_are_no_jam() {
        let stands = |may_be_frozen| {
            move |k| if k < 50 { slower(0.0) } else { Followed { may_be_frozen, ..slower(FAST_REV_PER_S) } }
        };
        assert_eq!(first(UNTOLD, stands(true), 100), None);
        assert!(first(UNTOLD, stands(false), 100).is_some());
    }

    #[test]
    fn a_jam_against_all_of_the_torque_is_seen_within_10_ms() {
        let pushing = effort(1.0, None);
        let slowing = |k: u32| Followed { is_saturated: true, ..slower(0.5 * f64::from(k)) };
        let Some((k, Alarm::Jam { .. })) = first(pushing, slowing, 20) else { panic!("none") };
        assert!(k < 10, "{k}");
        // At its limit to brake, or as fast as before, it is no jam.
        assert_eq!(first(effort(-1.0, None), slowing, 20), None);
        assert_eq!(first(pushing, |_| Followed { is_saturated: true, ..slower(0.5) }, 100), None);
    }

    /// It is to turn back already, and still slows with all of its torque.
    #[test]
    fn a_weak_motor_that_reverses_is_not_jammed() {
        let late = |k: u32| {
            let expected_speed = -0.8 * f64::from(k);
            Followed { is_saturated: true, speed: 20.0 - 0.4 * f64::from(k), expected_speed, ..good() }
        };
        assert_eq!(first(effort(-16.0, None), late, 100), None);
    }
}
