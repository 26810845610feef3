//! Learning over holes of several kinds, and the record that keeps it.

#[cfg(test)]
mod tests {
    use crate::control::cycle::{CyclePlan, TapCycle};
    use crate::control::machine::{Law, Machine, MachineSpec, SyncSpec};
    use crate::control::sync::identification::restart::IDENTIFICATION_NUMBERS;
    use crate::control::sync::learning::ilc::Learning;
    use crate::control::sync::learning::kind::HoleKind;
    use crate::control::sync::learning::learned_error::LearnedError;
    use crate::control::sync::learning::record::LEARNED_BYTES;

    const PERIOD_S: f64 = 0.001;
    const DURATION_S: f64 = 0.5;
    const NUMBERS: [f64; IDENTIFICATION_NUMBERS] = [0.75; IDENTIFICATION_NUMBERS];
    /// Where a record's first kind begins.
    const FIRST: usize = 16 + 8 * IDENTIFICATION_NUMBERS;

    fn sync() -> SyncSpec {
        MachineSpec::reference().sync
    }

    fn hole() -> TapCycle {
        TapCycle::right_hand(0.0, -10.0, 1.0, 3000.0)
    }

    fn kind(cycle: TapCycle, duration_s: f64) -> HoleKind {
        let plan = CyclePlan::new(cycle, &Machine::reference(), Law::TorqueCurve).unwrap();
        HoleKind { duration_s, ..HoleKind::of(&plan) }
    }

    /// One more hole of a kind, with an error that depends on the plan's time.
    fn teach(learning: &mut Learning, cycle: TapCycle, duration_s: f64, error_mm: impl Fn(usize) -> f64) {
        learning.begin_kind(kind(cycle, duration_s));
        for k in 0..=(duration_s / PERIOD_S) as usize + 10 {
            learning.observe(k as f64 * PERIOD_S, error_mm(k));
        }
        learning.finish();
    }

    fn taught(holes: usize, duration_s: f64, error_mm: impl Fn(usize) -> f64) -> Learning {
        let mut learning = Learning::new(sync(), PERIOD_S);
        (0..holes).for_each(|_| teach(&mut learning, hole(), duration_s, &error_mm));
        learning
    }

    /// What the next hole of a kind begins with.
    fn next(learning: &Learning, cycle: TapCycle, duration_s: f64, plan_s: f64) -> f64 {
        let mut learning = learning.clone();
        learning.begin_kind(kind(cycle, duration_s));
        learning.correction(plan_s).position
    }

    fn at(learning: &Learning, plan_s: f64) -> f64 {
        next(learning, hole(), DURATION_S, plan_s)
    }

    /// Corrections are whole nm.
    fn assert_near_mm(actual: f64, expected: f64) {
        assert!((actual - expected).abs() < 1.5e-6, "{actual} {expected}");
    }

    #[test]
    fn takes_off_its_share_of_the_error() {
        let gain = sync().learning_gain;
        assert_near_mm(at(&taught(1, DURATION_S, |_| 0.01), 0.25), -gain * 0.01);
        let twice = -gain * 0.01 * (1.0 + sync().learning_forgetting);
        assert_near_mm(at(&taught(2, DURATION_S, |_| 0.01), 0.25), twice);
        // Longer than there are points of a period each.
        assert_near_mm(next(&taught(1, 5.0, |_| 0.01), hole(), 5.0, 4.5), -gain * 0.01);
    }

    #[test]
    fn nothing_at_the_start_and_what_it_was_after_the_end() {
        let learning = taught(20, DURATION_S, |_| 0.01);
        for plan_s in [-0.001, 0.0] {
            assert_near_mm(at(&learning, plan_s), 0.0);
        }
        for plan_s in [DURATION_S, DURATION_S + 0.005, 100.0] {
            assert_near_mm(at(&learning, plan_s), at(&learning, 0.25));
        }
        let learning = taught(1, DURATION_S, |_| 0.01);
        let halfway_s = 0.5 * sync().learning_taper_s;
        assert_near_mm(at(&learning, halfway_s), 0.5 * at(&learning, 0.25));
    }

    #[test]
    fn bounded() {
        for error_mm in [5.0, -5.0] {
            assert_near_mm(at(&taught(3, DURATION_S, |_| error_mm), 0.25), -0.03_f64.copysign(error_mm));
        }
    }

    /// One error comes back as a triangle about where it was, earlier by the lead.
    #[test]
    fn smoothing_has_no_phase() {
        let learning = taught(1, DURATION_S, |k| if k == 250 { 0.0012 } else { 0.0 });
        let (lead, width) = (3, 2);
        assert_eq!(sync().learning_lead_s, f64::from(lead) * PERIOD_S);
        assert_eq!(sync().learning_smoothing_s, f64::from(width) * PERIOD_S);
        for offset in -4_i32..=4 {
            let share = f64::from((width + 1 - offset.abs()).max(0)) / 9.0;
            let plan_s = f64::from(250 - lead + offset) * PERIOD_S;
            assert_near_mm(at(&learning, plan_s), -sync().learning_gain * 0.0012 * share);
        }
    }

    #[test]
    fn rate_is_that_of_the_correction() {
        let mut learning = taught(1, DURATION_S, |k| 0.01 * (k as f64 * 0.02).sin());
        learning.begin_kind(kind(hole(), DURATION_S));
        let (before, after) = (learning.correction(0.2502), learning.correction(0.2508));
        let rate = (after.position - before.position) / 0.0006;
        assert!(rate.abs() > 1e-3 && (before.velocity - rate).abs() < 1e-9, "{rate} {before:?}");
    }

    #[test]
    fn kept_for_the_same_hole_elsewhere_and_for_no_other() {
        let learned = taught(1, DURATION_S, |_| 0.01);
        let after = |cycle: TapCycle| next(&learned, cycle, DURATION_S, 0.25);
        // A work piece that is clamped a little higher shifts the last bits of the depth, too.
        let higher = TapCycle { r_plane_mm: 0.123, bottom_mm: 0.123 - 10.0, ..hole() };
        for alike in [TapCycle { x_mm: 7.0, y_mm: 8.0, return_mm: 20.0, ..hole() }, higher] {
            assert_eq!(after(alike), at(&learned, 0.25));
        }
        let others = [
            TapCycle { bottom_mm: -11.0, ..hole() },
            TapCycle { pitch_mm: 1.25, ..hole() },
            TapCycle { speed_rpm: 2000.0, ..hole() },
            TapCycle { dwell_s: 0.1, ..hole() },
            TapCycle { tool: 2, ..hole() },
            // The screw is off by something else there.
            TapCycle { r_plane_mm: 5.0, bottom_mm: -5.0, ..hole() },
        ];
        for other in others {
            assert_eq!(after(other), 0.0, "{other:?}");
        }
        assert_eq!(next(&learned, hole(), 0.6, 0.25), 0.0, "another time law");
    }

    #[test]
    fn kinds_are_kept_beside_each_other_and_the_oldest_gives_way() {
        let tool = |tool| TapCycle { tool, ..hole() };
        let mut learning = Learning::new(sync(), PERIOD_S);
        for number in 1..=8 {
            teach(&mut learning, tool(number), DURATION_S, |_| 0.001 * f64::from(number));
        }
        let known =
            |learning: &Learning, number| -next(learning, tool(number), DURATION_S, 0.25) / sync().learning_gain;
        for number in 1..=8 {
            assert!((known(&learning, number) - 0.001 * f64::from(number)).abs() < 5e-6);
        }
        // Tool 1 is used again, so that tool 2 gives way to the ninth.
        teach(&mut learning, tool(1), DURATION_S, |_| 0.0);
        teach(&mut learning, tool(9), DURATION_S, |_| 0.009);
        assert!(known(&learning, 9) > 0.0089 && known(&learning, 1) > 0.0009 && known(&learning, 2) == 0.0);
    }

    /// A hole of which some periods are off by far more, and one that is wholly off.
    #[test]
    fn a_hole_that_differs_teaches_little() {
        let usual = |k: usize| if k.is_multiple_of(2) { 0.002 } else { -0.002 };
        let mut learning = taught(10, DURATION_S, usual);
        let before = at(&learning, 0.25);
        let mut partly = learning.clone();
        teach(&mut partly, hole(), DURATION_S, |k| if (240..280).contains(&k) { 0.2 } else { usual(k) });
        // 0.2 mm would have taught the full 30 µm.
        assert!((at(&partly, 0.25) - before).abs() < 0.003, "{} {before}", at(&partly, 0.25));
        teach(&mut learning, hole(), DURATION_S, |_| 0.2);
        assert!((at(&learning, 0.25) - before).abs() < 0.005, "{} {before}", at(&learning, 0.25));
        // Where the machine has changed it is learned all the same.
        let changed = |k| if (240..280).contains(&k) { 0.012 } else { usual(k) };
        (0..10).for_each(|_| teach(&mut partly, hole(), DURATION_S, changed));
        assert!(at(&partly, 0.25) < -0.012, "{}", at(&partly, 0.25));
    }

    #[test]
    fn a_record_brings_back_what_was_learned() {
        let mut learning = taught(3, DURATION_S, |k| 0.01 * (k as f64 * 0.02).sin());
        let other = TapCycle {
            tool: 3,
            hand: crate::control::cycle::Hand::Left,
            peck_mm: Some(4.0),
            retract: Some(crate::control::cycle::Retract::ChipBreak { back_mm: 1.0 }),
            start_angle_rev: Some(0.25),
            dwell_s: 0.1,
            ..hole()
        };
        teach(&mut learning, other, 1.5, |k| -0.003 * (k as f64 * 0.01).cos());
        let mut bytes = [0; LEARNED_BYTES];
        let size = learning.save(7, &NUMBERS, &mut bytes).unwrap();
        assert!(size < LEARNED_BYTES / 3, "{size}");
        let mut restarted = taught(1, 0.7, |_| 0.02);
        assert_eq!(restarted.load(7, &bytes[..size]), Ok(NUMBERS));
        for k in 0..1600 {
            let plan_s = f64::from(k) * PERIOD_S;
            assert_eq!(at(&restarted, plan_s), at(&learning, plan_s));
            assert_eq!(next(&restarted, other, 1.5, plan_s), next(&learning, other, 1.5, plan_s));
        }
        assert_eq!(next(&restarted, hole(), 0.7, 0.25), 0.0, "what it knew before is forgotten");
        // And the next hole teaches both the same.
        for learning in [&mut learning, &mut restarted] {
            teach(learning, hole(), DURATION_S, |_| 0.004);
        }
        assert_eq!(at(&restarted, 0.25), at(&learning, 0.25));
        let mut again = [0; LEARNED_BYTES];
        let size_again = restarted.save(7, &NUMBERS, &mut again).unwrap();
        assert_eq!(again[..size_again].len(), size);
    }

    #[test]
    fn a_record_that_is_none_is_refused_and_changes_nothing() {
        let learning = taught(3, DURATION_S, |_| 0.01);
        let mut bytes = [0; LEARNED_BYTES];
        let size = learning.save(7, &NUMBERS, &mut bytes).unwrap();
        let bytes = &bytes[..size];
        let mut other = taught(1, DURATION_S, |_| 0.002);
        let before = other.clone();
        let mut refusal = |machine, bytes: &[u8]| {
            let found = other.load(machine, bytes).unwrap_err();
            assert_eq!(other, before);
            found
        };
        assert_eq!(refusal(8, bytes), LearnedError::OtherMachine { found: 7, expected: 8 });
        assert_eq!(refusal(7, b"pitch,depth\n1,10\n"), LearnedError::NoRecord);
        assert_eq!(refusal(7, b""), LearnedError::NoRecord);
        assert!(matches!(refusal(7, &bytes[..10]), LearnedError::TooShort { found: 10, .. }));
        for length in 20..size {
            assert!(matches!(refusal(7, &bytes[..length]), LearnedError::Damaged { .. }));
        }
        for index in 5..size {
            let mut flipped = bytes.to_vec();
            flipped[index] ^= 0x10;
            assert!(matches!(refusal(7, &flipped), LearnedError::Damaged { .. }), "byte {index}");
        }
        let mut newer = bytes.to_vec();
        newer[4] = 3;
        assert_eq!(refusal(7, &newer), LearnedError::OtherVersion { found: 3, expected: 2 });
        // Numbers that cannot be, under a sum that is right.
        let with = |index: usize, number: &[u8]| {
            let mut changed = bytes.to_vec();
            changed[index..index + number.len()].copy_from_slice(number);
            let end = changed.len() - 4;
            let sum = crate::control::bytes::sum(&changed[..end]);
            changed[end..].copy_from_slice(&sum.to_le_bytes());
            changed
        };
        for changed in [
            with(5, &[9]),
            with(5, &[2]),
            with(6, &[1, 0]),
            with(16, &f64::NAN.to_le_bytes()),
            with(FIRST, &f64::INFINITY.to_le_bytes()),
            with(FIRST, &(-1.0_f64).to_le_bytes()),
            with(FIRST + 108, &2000_u16.to_le_bytes()),
            with(FIRST + 112, &i16::MAX.to_le_bytes()),
        ] {
            let found = refusal(7, &changed);
            assert!(matches!(found, LearnedError::Invalid { .. } | LearnedError::TooShort { .. }), "{found:?}");
        }
        let mut small = [0; 100];
        assert_eq!(learning.save(7, &NUMBERS, &mut small), Err(LearnedError::TooShort { found: 100, needed: size }));
    }
}
