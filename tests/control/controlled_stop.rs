//! The controlled stop at random moments of random holes, held against checks of its own.

use proptest::prelude::*;
use rigidtap::control::cycle::{CyclePlan, Interrupted, InterruptionError, Retract, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::Feedback;
use rigidtap::control::sync::{Adaptation, Compensation, Mode, Settings, Stage, Synchronizer};

/// For a host whose drives take no force feedforward.
const PLAIN: Settings = Settings {
    mode: Mode::Commanded,
    compensation: Compensation::Uncompensated,
    identify: false,
    learn: false,
    supervise: true,
};

const PERIOD_S: f64 = 0.001;
/// Far below a period, far above the last bit of a hole's time.
const STEP_S: f64 = 1e-5;

fn machine() -> Machine {
    Machine::reference()
}

fn holes() -> impl Strategy<Value = (TapCycle, Law)> {
    let pecks = prop_oneof![
        Just((None, None)),
        (3.0..12.0f64).prop_map(|peck| (Some(peck), Some(Retract::Full))),
        (3.0..12.0f64).prop_map(|peck| (Some(peck), Some(Retract::ChipBreak { back_mm: 0.5 }))),
    ];
    // The laws that keep to the motor's share of 0.8.
    let laws = prop_oneof![Just(Law::TorqueCurve), Just(Law::TorqueLimit), Just(Law::TorqueCurveSmooth)];
    (5.0..35.0f64, 0.5..2.0f64, 300.0..6600.0f64, 0.5..1.2f64, prop_oneof![Just(0.0), Just(0.05)], pecks, laws)
        .prop_map(|(depth_mm, pitch_mm, speed_rpm, out_ratio, dwell_s, (peck_mm, retract), law)| {
            let hole = TapCycle::right_hand(2.0, 2.0 - depth_mm, pitch_mm, speed_rpm);
            (TapCycle { out_speed_rpm: speed_rpm * out_ratio, dwell_s, peck_mm, retract, ..hole }, law)
        })
}

/// What the reference spindle's motor gives at 100 %, in rev/s²: written out here, not asked of the code under test.
fn motor_rev_per_s2(speed_rev_per_s: f64) -> f64 {
    let speed_rpm = speed_rev_per_s.abs() * 60.0;
    let torque_nm = if speed_rpm <= 3000.0 { 20.0 } else { 60_000.0 / speed_rpm };
    torque_nm / (0.004 * 2.0 * std::f64::consts::PI)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn spindle_and_z_brake_hold_and_come_back((hole, law) in holes(), at in 0.0..1.0f64, again in 0.0..1.0f64, resumes: bool, waits: bool) {
        let machine = machine();
        let mut plan = CyclePlan::new(hole, &machine, law).expect("feasible");
        let planned = plan.clone();
        // Stopped, after a while let go, and often stopped once more on the way.
        let stop_s = at * planned.duration_s();
        // Half of them are let go while they still brake.
        let leave_s = stop_s + if waits { 0.5 } else { 0.05 * again };
        let stop_again_s = leave_s + again * 0.4;
        let mut commands = vec![(stop_s, "stop"), (leave_s, if resumes { "resume" } else { "retract" })];
        commands.extend([(stop_again_s, "stop"), (stop_again_s + 0.5, "retract")]);
        commands.reverse();
        let rev = hole.depth_mm() / hole.pitch_mm;
        let mut last = plan.at(0.0).spindle;
        let mut stroke = (0, plan.stroke(0));
        for step in 1.. {
            let t_s = f64::from(step) * STEP_S;
            while let Some((_, command)) = commands.pop_if(|(at_s, _)| *at_s <= t_s) {
                let before = plan.at(t_s).spindle;
                let over = t_s > plan.duration_s();
                match command {
                    "stop" => plan.stop(t_s),
                    _ if over => {}
                    "resume" => plan.resume(t_s).expect("stopped"),
                    _ => plan.retract(t_s).expect("stopped"),
                }
                let after = plan.at(t_s).spindle;
                prop_assert!((after.position - before.position).abs() < 1e-9, "{command} at {t_s}");
                prop_assert!((after.velocity - before.velocity).abs() < 1e-9, "{command} at {t_s}");
            }
            // As the synchronizer does: a stroke is planned when its number comes up.
            let number = plan.stroke_at(t_s);
            if stroke.0 != number {
                stroke = (number, plan.stroke(number));
            }
            let now = stroke.1.at(t_s).spindle;
            let greatest = motor_rev_per_s2(last.velocity.abs().min(now.velocity.abs()));
            let jump = (now.position - last.position - (now.velocity + last.velocity) / 2.0 * STEP_S).abs();
            prop_assert!(jump < greatest * STEP_S * STEP_S, "{t_s}: position jumps by {jump}");
            let change = (now.velocity - last.velocity).abs();
            // Friction helps to brake: 0.6 N·m of 20 at most.
            prop_assert!(change <= (0.8 * greatest + 24.0) * STEP_S * 1.001, "{t_s}: {change} rev/s in a step");
            prop_assert!(change * hole.pitch_mm <= machine.spec().z.max_mm_per_s2 * STEP_S * 1.001);
            prop_assert!((-1e-9..=rev + 1e-9).contains(&now.position), "{t_s}: {} of {rev} rev", now.position);
            if t_s < stop_s {
                prop_assert!(plan.interrupted_at(t_s).is_none() && plan.duration_s() == planned.duration_s());
            } else if t_s > stop_s + 0.4 && t_s < leave_s {
                // The reference spindle brakes from 7000 rpm in 0.29 s.
                prop_assert!(now.velocity == 0.0 && plan.interrupted_at(t_s) == Some(Interrupted::Holding));
            }
            last = now;
            if commands.is_empty() && t_s > plan.duration_s() {
                break;
            }
        }
        prop_assert!(last.velocity == 0.0 && last.position.abs() < 1e-9);
    }

    #[test]
    fn the_synchronizer_stops_holds_and_retracts(at in 0.0..0.99f64, deeper in 0.0..0.001f64) {
        let machine = machine();
        let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 5000.0);
        let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).expect("feasible");
        let stop = 12 + (at * plan.duration_s() / PERIOD_S) as u32;
        let (mut synchronizer, mut adaptation) = (Synchronizer::new(plan, PLAIN, 3.0), Adaptation::new(&machine));
        let mut feedback = Feedback { spindle_counts: 3 * 16_384, ..Feedback::default() };
        let mut held_mm = None;
        let mut ended = false;
        for k in 0..3000 {
            let now_s = f64::from(k) * PERIOD_S + deeper;
            if k == stop {
                prop_assert_eq!(synchronizer.retract(now_s), Err(InterruptionError::NotStopped));
                synchronizer.stop(now_s);
            }
            if k == stop + 500 {
                synchronizer.retract(now_s).expect("held");
            }
            let step = synchronizer.step(now_s, &feedback, &mut adaptation);
            prop_assert!(step.alarm.is_none());
            if (stop + 350..stop + 500).contains(&k) {
                prop_assert!(matches!(step.stage, Stage::Synchronous(_, Some(Interrupted::Holding))));
            }
            ended = step.stage == Stage::Done;
            if ended {
                prop_assert!((step.z.position).abs() < 1e-9 && (step.spindle.position - 3.0).abs() < 1e-9);
                break;
            }
            prop_assert!((step.z.position + (step.spindle.position - 3.0)).abs() < 1e-9, "Z is pitch × spindle");
            prop_assert!(step.error_mm.abs() < 2e-4);
            if (stop + 350..stop + 500).contains(&k) {
                prop_assert_eq!(step.z.position, *held_mm.get_or_insert(step.z.position));
                prop_assert_eq!(step.z.velocity, 0.0);
            }
            feedback.spindle_counts = (step.spindle.position * 16_384.0).round() as i64;
            feedback.z_counts = (step.z.position * 10_000.0).round() as i64;
        }
        prop_assert!(ended && held_mm.is_some());
    }
}

#[test]
fn a_stop_before_the_first_synchronous_period_moves_nothing() {
    let machine = machine();
    let plan =
        CyclePlan::new(TapCycle::right_hand(0.0, -25.0, 1.0, 5000.0), &machine, Law::TorqueCurve).expect("feasible");
    let (mut synchronizer, mut adaptation) = (Synchronizer::new(plan, PLAIN, 0.0), Adaptation::new(&machine));
    synchronizer.stop(0.0);
    for k in 0..100 {
        let step = synchronizer.step(f64::from(k) * PERIOD_S, &Feedback::default(), &mut adaptation);
        assert_eq!((step.z.position, step.spindle.position), (0.0, 0.0));
    }
    synchronizer.retract(0.1).expect("stopped");
    let stages = (100..120).map(|k| synchronizer.step(f64::from(k) * PERIOD_S, &Feedback::default(), &mut adaptation));
    assert_eq!(stages.map(|step| step.stage).last(), Some(Stage::Done));
}

#[test]
fn a_resumed_hole_is_later_by_its_pause_alone() {
    let machine = machine();
    let hole = TapCycle { dwell_s: 0.05, ..TapCycle::right_hand(0.0, -25.0, 1.0, 3000.0) };
    let mut plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).expect("feasible");
    let before_s = plan.duration_s();
    plan.stop(0.3);
    plan.resume(1.0).expect("stopped");
    let bottom = plan.strokes().find(|stroke| stroke.kind.name() == "dwell").expect("it dwells");
    assert!((plan.at(bottom.start_s + 0.025).spindle.position - 25.0).abs() < 1e-9);
    let later_s = plan.duration_s() - before_s;
    assert!((0.7..0.9).contains(&later_s), "{later_s} s for a pause of 0.7 s, braking and running up");
}
