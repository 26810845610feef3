//! The synchronizer alone, against encoders that a test makes up.

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::Feedback;
use rigidtap::control::sync::{Adaptation, Alarm, Compensation, Settings, Stage, Step, Synchronizer};

const PERIOD_S: f64 = 0.001;
const COUNTS_PER_MM: f64 = 10_000.0;
const COUNTS_PER_REV: f64 = 16_384.0;

fn synchronizer(compensation: Compensation) -> (Synchronizer, Adaptation) {
    let machine = Machine::reference();
    let plan = CyclePlan::new(TapCycle::right_hand(0.0, -10.0, 1.0, 3000.0), &machine, Law::TorqueCurve).unwrap();
    // Made-up encoders do what no machine can.
    let settings = Settings { compensation, supervise: false, ..Settings::default() };
    (Synchronizer::new(plan, settings, 0.0), Adaptation::new(&machine))
}

/// Encoders that read just what was commanded, Z a little deeper.
fn reading(step: &Step, z_leads_mm: f64, spindle_off_rev: f64) -> Feedback {
    Feedback {
        spindle_counts: ((step.spindle.position + spindle_off_rev) * COUNTS_PER_REV).round() as i64,
        z_counts: ((step.z.position + step.correction_mm - z_leads_mm) * COUNTS_PER_MM).round() as i64,
        ..Feedback::default()
    }
}

/// Corrections of three synchronous periods under a constant e(k), as steps from period to period in µm.
fn correction_steps_um(compensation: Compensation, error_mm: f64) -> Vec<f64> {
    let (mut synchronizer, mut adaptation) = synchronizer(compensation);
    let mut feedback = Feedback::default();
    let mut corrections_um = Vec::new();
    for k in 0..200 {
        let step = synchronizer.step(f64::from(k) * PERIOD_S, &feedback, &mut adaptation);
        if matches!(step.stage, Stage::Synchronous(..)) {
            corrections_um.push(step.correction_mm * 1000.0);
            feedback = reading(&step, error_mm, 0.0);
        }
    }
    corrections_um.windows(2).skip(2).take(3).map(|pair| pair[1] - pair[0]).collect()
}

#[test]
fn paper_corrects_by_gain_error_and_period_up_to_its_limit() {
    // 50 1/s × 0.02 mm × 1 ms is 1 µm a period, against the error; one count of either encoder is 0.005 µm of it.
    for step_um in correction_steps_um(Compensation::Integral, 0.02) {
        assert!((step_um + 1.0).abs() < 0.01, "{step_um}");
    }
    for step_um in correction_steps_um(Compensation::Integral, -1.0) {
        assert!((step_um - 5.0).abs() < 1e-9, "{step_um}");
    }
    assert!(correction_steps_um(Compensation::Uncompensated, 1.0).iter().all(|step_um| *step_um == 0.0));
}

#[test]
fn z_is_let_go_only_from_a_spindle_that_rests() {
    let (mut synchronizer, mut adaptation) = synchronizer(Compensation::Uncompensated);
    let (mut feedback, mut started) = (Feedback::default(), false);
    for k in 0.. {
        let step = synchronizer.step(f64::from(k) * PERIOD_S, &feedback, &mut adaptation);
        if let Some(Alarm::NotInPosition { waited_s, spindle_rev, .. }) = step.alarm {
            assert!(started && waited_s > 3.0 && (spindle_rev - 2.0).abs() < 1e-3);
            break;
        }
        started |= matches!(step.stage, Stage::Synchronous(..));
        assert_ne!(step.stage, Stage::Done, "the spindle is two turns away");
        feedback = reading(&step, 0.0, if started { 2.0 } else { 0.0 });
    }
}

#[test]
fn a_spindle_that_never_rests_is_an_alarm_before_anything_is_synchronous() {
    let (mut synchronizer, mut adaptation) = synchronizer(Compensation::Uncompensated);
    let turning = Feedback { spindle_counts: 16_384, ..Feedback::default() };
    let mut steps = (0..4000).map(|k| synchronizer.step(f64::from(k) * PERIOD_S, &turning, &mut adaptation));
    let alarmed = steps.find(|step| step.stage != Stage::Settling).unwrap();
    assert!(matches!(alarmed.alarm, Some(Alarm::NotInPosition { .. })) && alarmed.stage == Stage::Held, "{alarmed:?}");
}

#[test]
fn an_alarm_is_latched_until_it_is_acknowledged() {
    let (mut synchronizer, mut adaptation) = synchronizer(Compensation::ModelBased);
    let turning = Feedback { spindle_counts: 16_384, ..Feedback::default() };
    let mut k = 0;
    let mut step = |synchronizer: &mut Synchronizer, feedback: &Feedback| {
        k += 1;
        synchronizer.step(f64::from(k) * PERIOD_S, feedback, &mut adaptation)
    };
    while step(&mut synchronizer, &turning).alarm.is_none() {}
    for _ in 0..500 {
        // In position by now, and held all the same, where it is to rest.
        let held = step(&mut synchronizer, &Feedback::default());
        assert_eq!((held.stage, held.spindle.position, held.z.position), (Stage::Held, 0.0, held.z.position));
        assert!(held.alarm.is_some() && held.z.position.abs() < 1e-6);
    }
    synchronizer.acknowledge();
    let started =
        (0..500).map(|_| step(&mut synchronizer, &Feedback::default())).find(|step| step.stage != Stage::Settling);
    assert!(matches!(started.unwrap().stage, Stage::Synchronous(..)));
}
