//! A tap that is stopped, retracted and stopped again while it still begins to move: nothing leaps.
//!
//! Whoever read the plan's time across an interruption sent Z 6 mm off in a period here.

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::math::poly::State;
use rigidtap::control::port::Port;
use rigidtap::control::sync::{Compensation, Settings, Stage};
use rigidtap::control::tapping::Tapping;
use rigidtap::control::units::um_from_mm;
use rigidtap::sim::{Plant, PlantOptions};

/// Greatest change of a velocity in a period: 10 m/s², and five quarters of 20 N·m on 0.004 kg·m².
const Z_MM_PER_S: f64 = 10.0;
const SPINDLE_REV_PER_S: f64 = 0.001 * 1.25 * 20.0 / (0.004 * std::f64::consts::TAU);
/// What a sound hole stays within.
const MOST_UM: f64 = 50.0;

/// Stopped after some synchronous periods, retracted or resumed 0.3 s later, stopped once more 30 ms after that, and retracted.
fn interrupted(compensation: Compensation, speed_rpm: f64, stop_at: u32, resumes: bool) {
    let machine = Machine::reference();
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, speed_rpm);
    let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).expect("feasible");
    let mut plant = Plant::new(&machine, &PlantOptions::default());
    plant.begin_hole(&hole);
    let mut tapping = Tapping::new(&machine);
    let settings = Settings { compensation, ..Settings::default() };
    tapping.start(plan, settings, 0.0, 0.0, 0.0).expect("a number");
    let place = |k: u32| format!("{} S{speed_rpm}, stopped in period {stop_at}, period {k}", compensation.name());
    let (mut periods, mut last, mut speeds) = (0, None::<[f64; 2]>, [0.0; 2]);
    for k in 0..6000 {
        let now_s = f64::from(k) * 0.001;
        let feedback = plant.read(now_s);
        let step = tapping.step(now_s, &feedback).expect("under way");
        assert_eq!(step.alarm, None, "{}", place(k));
        let positions = [step.spindle.position, step.z.position];
        if let Some(before) = last {
            let now = [0, 1].map(|axis| (positions[axis] - before[axis]) / 0.001);
            for (axis, most) in [SPINDLE_REV_PER_S, Z_MM_PER_S].into_iter().enumerate() {
                let change = (now[axis] - speeds[axis]).abs();
                assert!(change <= most + 1e-6, "{}: axis {axis} changes its speed by {change}", place(k));
            }
            speeds = now;
        }
        last = Some(positions);
        if step.stage == Stage::Done {
            assert!(step.z.position.abs() < 0.05 && step.spindle.position.abs() < 0.01, "{}: {step:?}", place(k));
            return;
        }
        if matches!(step.stage, Stage::Synchronous(..)) {
            assert!(um_from_mm(step.error_mm).abs() < MOST_UM, "{}: {} µm", place(k), um_from_mm(step.error_mm));
            periods += 1;
            match periods {
                _ if periods == stop_at || periods == stop_at + 330 => tapping.stop(now_s),
                _ if periods == stop_at + 300 && resumes => tapping.resume(now_s).expect("held"),
                _ if periods == stop_at + 300 || periods == stop_at + 700 => tapping.retract(now_s).expect("held"),
                _ => {}
            }
        }
        plant.write(now_s, &step.setpoint(State::default(), State::default()));
    }
    panic!("{}: the tap did not come back", place(6000));
}

#[test]
fn stopping_a_retract_that_has_just_begun_is_continuous() {
    for compensation in Compensation::ALL {
        // The stroke in takes 580 ms.
        for stop_at in (8..580).step_by(13) {
            interrupted(compensation, 3000.0, stop_at, false);
        }
    }
}

#[test]
fn stopping_a_hole_that_has_just_been_resumed_is_continuous() {
    for compensation in Compensation::ALL {
        for (speed_rpm, stroke) in [(1000.0, 1500), (7000.0, 440)] {
            for stop_at in (8..stroke).step_by(stroke as usize / 12) {
                interrupted(compensation, speed_rpm, stop_at, true);
            }
        }
    }
}
