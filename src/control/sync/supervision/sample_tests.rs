//! An encoder that fails in each of its ways, on an axis that goes at a constant speed and then rests.

#[cfg(test)]
mod tests {
    use crate::control::sync::supervision::alarm::{Alarm, Axis};
    use crate::control::sync::supervision::sample::{AxisLimits, Checked, SampleMonitor};

    const COUNTS_PER_REV: f64 = 16_384.0;
    const PERIOD_S: f64 = 0.001;
    /// 3000 rpm: 819 counts a period.
    const FAST_REV_PER_S: f64 = 50.0;
    const LAG_REV: f64 = 0.03;
    const BRIDGE_PERIODS: u32 = 5;
    const LIMITS: AxisLimits = AxisLimits {
        axis: Axis::Spindle,
        counts_per_unit: COUNTS_PER_REV,
        acceleration: 795.0,
        held: 0.002,
        bridge_periods: BRIDGE_PERIODS,
        period_s: PERIOD_S,
    };

    /// An axis under way with its monitor.
    struct Bench {
        monitor: SampleMonitor,
        speed: f64,
        expected: f64,
    }

    impl Bench {
        /// Has run for long enough that its tracking error is known.
        fn at(speed: f64) -> Self {
            let mut bench = Self { monitor: SampleMonitor::new(LIMITS), speed, expected: 0.0 };
            (0..50).for_each(|_| {
                bench.good();
            });
            bench
        }

        /// What the encoder truly counts.
        fn truth(&self) -> i64 {
            ((self.expected - LAG_REV) * COUNTS_PER_REV).round() as i64
        }

        fn period(&mut self, sample: impl FnOnce(i64) -> Option<i64>, may_halt: bool) -> Checked {
            self.expected += self.speed * PERIOD_S;
            self.monitor.check(sample(self.truth()), self.expected, false, may_halt)
        }

        fn sample(&mut self, sample: impl FnOnce(i64) -> i64) -> Checked {
            self.period(|truth| Some(sample(truth)), false)
        }

        fn good(&mut self) -> Checked {
            let checked = self.sample(|truth| truth);
            assert_eq!(checked, Checked { counts: self.truth(), bridged: false, alarm: None });
            checked
        }

        fn assert_bridged(&self, checked: &Checked) {
            let off = checked.counts - self.truth();
            assert!(checked.bridged && off.abs() <= 2, "{checked:?}, off by {off} counts");
        }

        /// Both axes rest, and the alarm is acknowledged.
        fn acknowledge_at_rest(&mut self) {
            self.speed = 0.0;
            (0..100).for_each(|_| {
                self.period(|_| None, false);
            });
            self.monitor.acknowledge();
        }
    }

    #[test]
    fn missing_samples_are_bridged_and_one_too_many_is_lost() {
        for missing in 1..=BRIDGE_PERIODS {
            let mut bench = Bench::at(FAST_REV_PER_S);
            for _ in 0..missing {
                let checked = bench.period(|_| None, false);
                bench.assert_bridged(&checked);
                assert_eq!(checked.alarm, None, "{missing}");
            }
            (0..10).for_each(|_| {
                bench.good();
            });
        }
        let mut bench = Bench::at(FAST_REV_PER_S);
        let alarms: Vec<_> = (0..10).map(|_| bench.period(|_| None, false).alarm).collect();
        let lost = Alarm::SampleLost { axis: Axis::Spindle, periods: 6, limit: BRIDGE_PERIODS };
        assert_eq!(alarms.iter().position(Option::is_some), Some(5));
        assert_eq!((alarms[5], alarms.iter().flatten().count()), (Some(lost), 1));
        assert!(!bench.monitor.is_trusted());
    }

    #[test]
    fn repeated_samples_are_bridged_and_the_fourth_is_a_frozen_encoder() {
        for repeats in 1..=3 {
            let mut bench = Bench::at(FAST_REV_PER_S);
            let last = bench.truth();
            for _ in 0..repeats {
                let checked = bench.sample(|_| last);
                bench.assert_bridged(&checked);
                assert_eq!(checked.alarm, None, "{repeats}");
            }
            (0..10).for_each(|_| {
                bench.good();
            });
        }
        // An encoder that flickers stands still, too.
        for flicker in [[0; 4], [1, -1, 1, -1], [2, 0, -2, 1]] {
            let mut bench = Bench::at(FAST_REV_PER_S);
            let last = bench.truth();
            let alarms = flicker.map(|counts| bench.sample(|_| last + counts).alarm);
            assert_eq!(alarms[..3], [None; 3], "{flicker:?}");
            assert!(matches!(alarms[3], Some(Alarm::EncoderFrozen { periods: 4, .. })), "{flicker:?}: {alarms:?}");
            let checked = bench.sample(|_| last);
            bench.assert_bridged(&checked);
        }
    }

    #[test]
    fn a_whole_frame_that_comes_again_is_bridged() {
        let mut bench = Bench::at(FAST_REV_PER_S);
        let last = bench.truth();
        bench.expected += bench.speed * PERIOD_S;
        assert!(bench.monitor.looks_repeated(last, bench.expected));
        let checked = bench.monitor.check(Some(last), bench.expected, true, false);
        bench.assert_bridged(&checked);
        assert_eq!(checked.alarm, None);
        bench.good();
    }

    #[test]
    fn an_encoder_that_halts_between_two_samples_is_not_gone_by() {
        // Of 0.8 of a period's travel it cannot be told yet: a tap that jams comes to rest like that, too.
        for (share, period) in [(0.1, 3), (0.5, 3), (0.8, 4)] {
            let mut bench = Bench::at(FAST_REV_PER_S);
            let halt = bench.truth() + (share * FAST_REV_PER_S * PERIOD_S * COUNTS_PER_REV) as i64;
            let checks: Vec<_> = (0..6).map(|_| bench.sample(|_| halt)).collect();
            assert_eq!(checks.iter().position(|checked| checked.alarm.is_some()), Some(period), "{share}: {checks:?}");
            assert!(matches!(checks[period].alarm, Some(Alarm::EncoderFrozen { .. })), "{share}");
            let off = checks[5].counts - bench.truth();
            // The sample that was taken in has told the model of a tracking error that is none.
            assert!(checks[5].bridged && off.abs() <= if period == 3 { 2 } else { 820 }, "{share}: {off} counts");
        }
    }

    #[test]
    fn a_jump_or_a_wrap_is_refused_in_its_first_period() {
        for jump in [1000, -1000, 1_000_000, -(1 << 24), i64::MAX / 2, i64::MIN, i64::from(i32::MIN)] {
            let mut bench = Bench::at(FAST_REV_PER_S);
            let checked = bench.sample(|truth| truth.wrapping_add(jump));
            assert!(matches!(checked.alarm, Some(Alarm::CountJump { axis: Axis::Spindle, .. })), "{jump}: {checked:?}");
            bench.assert_bridged(&checked);
            for _ in 0..100 {
                let later = bench.sample(|truth| truth.wrapping_add(jump));
                assert!(later.bridged && later.alarm.is_none());
                assert!((later.counts - bench.truth()).abs() <= 5, "the model goes on");
            }
        }
    }

    #[test]
    fn what_torque_and_jitter_explain_is_no_jump() {
        // 795 rev/s² move 13 counts a period more than before; a jitter of 20 µs is worth 16.
        let mut bench = Bench::at(FAST_REV_PER_S);
        for off in [13, -13, 16, -16, 0] {
            let checked = bench.sample(|truth| truth + off);
            assert!(!checked.bridged && checked.alarm.is_none(), "{off}: {checked:?}");
        }
    }

    #[test]
    fn an_encoder_that_counts_backwards_is_a_mismatch() {
        let mut bench = Bench::at(FAST_REV_PER_S);
        let onset = bench.truth();
        let checked = bench.sample(|truth| 2 * onset - truth);
        assert!(matches!(checked.alarm, Some(Alarm::TravelMismatch { axis: Axis::Spindle, .. })), "{checked:?}");
        bench.assert_bridged(&checked);
    }

    /// 5 counts a period: no single sample looks repeated.
    #[test]
    fn at_creep_an_encoder_is_frozen_once_counts_are_missed() {
        let mut bench = Bench::at(5.0 / COUNTS_PER_REV / PERIOD_S);
        let last = bench.truth();
        let alarmed = (1..=100).find_map(|period| bench.sample(|_| last).alarm.map(|alarm| (period, alarm)));
        // 8 counts, and 0.002 rev that friction may hold: 41 counts, of which the first period shows none.
        let Some((period, Alarm::EncoderFrozen { periods, expected_counts, .. })) = alarmed else {
            panic!("{alarmed:?}")
        };
        assert_eq!((period, periods), (10, 10));
        assert!((expected_counts - 45.0).abs() < 1.0, "{expected_counts}");
    }

    #[test]
    fn an_axis_at_rest_may_stand_still() {
        let mut bench = Bench::at(0.0);
        for k in 0..20_000_i64 {
            let checked = bench.sample(|truth| truth + k % 3 - 1);
            assert!(!checked.bridged && checked.alarm.is_none(), "{k}: {checked:?}");
        }
    }

    #[test]
    fn after_an_acknowledge_a_jumped_encoder_is_read_with_its_shift() {
        let mut bench = Bench::at(FAST_REV_PER_S);
        let jumped = |truth: i64| truth + 1_000_000;
        assert!(bench.sample(jumped).alarm.is_some());
        bench.acknowledge_at_rest();
        let first = bench.sample(jumped);
        let off = first.counts - bench.truth();
        assert!(!first.bridged && first.alarm.is_none() && off.abs() <= 5, "{first:?}, off by {off}");
        // From then on every count is one of the axis.
        for speed in [0.1, 0.5, 1.0, 0.5, 0.0, -0.5] {
            bench.speed = speed;
            let checked = bench.sample(jumped);
            assert_eq!(checked, Checked { counts: bench.truth() + off, bridged: false, alarm: None }, "{speed}");
        }
    }

    #[test]
    fn after_an_acknowledge_a_sound_encoder_is_read_as_it_is() {
        let mut bench = Bench::at(FAST_REV_PER_S);
        while bench.period(|_| None, false).alarm.is_none() {}
        bench.acknowledge_at_rest();
        // The axis came to rest a few counts from where the model was.
        let checked = bench.sample(|truth| truth + 6);
        assert_eq!(checked, Checked { counts: bench.truth() + 6, bridged: false, alarm: None });
        assert!(bench.monitor.is_trusted());
    }

    #[test]
    fn an_axis_that_no_longer_follows_may_halt() {
        let mut bench = Bench::at(FAST_REV_PER_S);
        // It comes to rest in three periods, and stands there while its command goes on.
        let mut counts = bench.truth();
        for step in [600, 300, 100, 0, 0, 0, 0, 0, 0, 0] {
            counts += step;
            let checked = bench.period(|_| Some(counts), true);
            assert_eq!(checked, Checked { counts, bridged: false, alarm: None }, "{step}");
        }
        // A jump is still none of its travels.
        assert!(bench.period(|_| Some(counts + 100_000), true).alarm.is_some());
    }
}
