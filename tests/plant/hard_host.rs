//! The hard spread's effects between host and drives, each by its formula.

use rigidtap::control::cycle::TapCycle;
use rigidtap::control::machine::Machine;
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{Feedback, Port, Setpoint, Truth};
use rigidtap::sim::{Actual, Effect, Effects, Plant, PlantOptions};
use std::f64::consts::TAU;

use crate::{FINE_S, accelerating, cruising, drive, with};

const SPEED: f64 = 50.0;

fn both(now_s: f64) -> Setpoint {
    Setpoint { spindle: cruising(SPEED)(now_s), z: cruising(SPEED)(now_s), ..Setpoint::default() }
}

fn cruise(actual: Actual, effects: Effects) -> Vec<(Feedback, Truth)> {
    let samples = drive(&PlantOptions { actual, ..with(effects) }, 1.0, both);
    samples[samples.len() - 2000..].to_vec()
}

fn mean(samples: &[(Feedback, Truth)], of: impl Fn(&(Feedback, Truth)) -> f64) -> f64 {
    samples.iter().map(of).sum::<f64>() / samples.len() as f64
}

#[test]
fn setpoints_act_later_or_earlier_than_told() {
    let quiet = Effects::FULL.without(Effect::FrictionRipple);
    let told = cruise(Actual::default(), quiet);
    for (setpoint_latency_s, setpoint_latency_periods) in [(40e-6, 0.0), (-60e-6, 0.0), (0.0, 1.0), (20e-6, 2.0)] {
        let actual = Actual { setpoint_latency_s, setpoint_latency_periods, ..Actual::default() };
        let late = cruise(actual, quiet);
        let expected_s = setpoint_latency_s + setpoint_latency_periods * FINE_S;
        for (axis, of) in [
            ("Z", (|(_, truth)| truth.z_mm) as fn(&(Feedback, Truth)) -> f64),
            ("spindle", |(_, truth)| truth.spindle_rev),
        ] {
            let found_s = (mean(&told, of) - mean(&late, of)) / SPEED;
            assert!((found_s - expected_s).abs() < 1e-6, "{axis}: {found_s} for {expected_s} s");
        }
    }
}

/// Both axes are read at the same late instant, evenly ± the jitter: a standard deviation of J/√3.
#[test]
fn the_hosts_jitter_moves_both_readings_alike() {
    let quiet = [Effect::EncoderJitter, Effect::Interpolation].into_iter().fold(Effects::FULL, Effects::without);
    let jitter_s = 20e-6;
    let samples = cruise(Actual { host_jitter_s: jitter_s, ..Actual::default() }, quiet);
    let z_s = |(read, truth): &(Feedback, Truth)| (read.z_counts as f64 / 10_000.0 - truth.z_mm) / SPEED;
    let spindle_s =
        |(read, truth): &(Feedback, Truth)| (read.spindle_counts as f64 / 16_384.0 - truth.spindle_rev) / SPEED;
    let mean_s = mean(&samples, z_s);
    let deviation_s = mean(&samples, |sample| (z_s(sample) - mean_s).powi(2)).sqrt();
    assert!((deviation_s / (jitter_s / 3f64.sqrt()) - 1.0).abs() < 0.05, "{deviation_s} s");
    let apart_s = mean(&samples, |sample| (z_s(sample) - spindle_s(sample)).powi(2)).sqrt();
    // Half a count of each axis, 1 µs.
    assert!(apart_s < 1.2e-6, "{apart_s} s between the axes");
}

/// A stroke of 25 mm each way in half a second each; what was read, and the plant after it.
fn stroke(actual: Actual) -> (Vec<Feedback>, Plant) {
    let machine = Machine::reference();
    let quiet = [Effect::EncoderJitter, Effect::Interpolation].into_iter().fold(Effects::FULL, Effects::without);
    let mut plant = Plant::new(&machine, &PlantOptions { actual, ..with(quiet) });
    plant.begin_hole(&TapCycle::right_hand(0.0, -25.0, 1.0, 5000.0));
    let read = (0..=1000_u32).map(|period| {
        let now_s = f64::from(period) * 0.001;
        let (sine, cosine) = (TAU * now_s).sin_cos();
        let spindle = State {
            position: 12.5 * (1.0 - cosine),
            velocity: 12.5 * TAU * sine,
            acceleration: 12.5 * TAU * TAU * cosine,
            jerk: 0.0,
        };
        let z = State {
            position: -spindle.position,
            velocity: -spindle.velocity,
            acceleration: -spindle.acceleration,
            jerk: 0.0,
        };
        let feedback = plant.read(now_s);
        plant.write(now_s, &Setpoint { spindle, z, ..Setpoint::default() });
        feedback
    });
    (read.collect(), plant)
}

#[test]
fn a_stale_reading_is_the_whole_one_before() {
    let repeated = |actual| {
        let (read, _) = stroke(actual);
        // Before the first setpoint acts the machine rests, and its readings are alike.
        read[10..].windows(2).filter(|pair| pair[0] == pair[1]).count()
    };
    assert_eq!(repeated(Actual::default()), 0);
    assert_eq!(repeated(Actual { stale_samples_per_hole: 3.0, ..Actual::default() }), 3);
}

/// The machine is ahead of its host by what was missed, and both axes were carried on.
#[test]
fn a_missed_period_passes_on_the_machine_alone() {
    let (told, plant) = stroke(Actual::default());
    assert!((plant.time_s() - 1.001).abs() < 1e-9);
    let (read, mut plant) = stroke(Actual { missed_periods_per_hole: 2.0, ..Actual::default() });
    assert!((plant.time_s() - 1.003).abs() < 1e-9, "{} s", plant.time_s());
    assert!((plant.clock_s(1.001) - 1.003).abs() < 1e-9);
    // Between two readings the spindle turned for two periods: many counts more than between those before.
    let leaps = |read: &[Feedback]| {
        let steps: Vec<_> =
            read.windows(2).map(|pair| (pair[1].spindle_counts - pair[0].spindle_counts).abs()).collect();
        steps.windows(2).filter(|pair| pair[1] - pair[0] > 200).count()
    };
    // One of them may fall where the spindle hardly turns.
    assert_eq!(leaps(&told), 0);
    assert!((1..=2).contains(&leaps(&read)), "{} leaps", leaps(&read));
}

#[test]
fn a_drive_that_computes_longer_acts_later() {
    let reached_s = |drive_delay_periods: f64| {
        let actual = Actual { drive_delay_periods, ..Actual::default() };
        let spindle = |now_s| Setpoint { spindle: accelerating(1000.0, 0.01)(now_s), ..Setpoint::default() };
        let samples = drive(&PlantOptions { actual, ..with(Effects::FULL) }, 0.03, spindle);
        let torque = |index: usize| samples[index].1.spindle_torque_nm;
        let after = (0..samples.len()).find(|index| torque(*index) > 5.0).expect("the torque rises");
        let part = (5.0 - torque(after - 1)) / (torque(after) - torque(after - 1));
        (after as f64 - 1.0 + part) * FINE_S
    };
    for periods in [0.4, 1.0, 2.0] {
        let later_s = reached_s(periods) - reached_s(0.0);
        assert!((later_s - periods * FINE_S).abs() < 12e-6, "{later_s} s for {periods} drive periods");
    }
}

#[test]
fn reports_come_in_steps_or_not_at_all() {
    let samples = cruise(Actual { effort_resolution: 0.01, ..Actual::default() }, Effects::FULL);
    let whole = |value: f64, step: f64| ((value / step).round() - value / step).abs() < 1e-9;
    assert!(samples.iter().all(|(read, _)| whole(read.spindle_torque_nm.expect("reported"), 0.2)));
    assert!(samples.iter().all(|(read, _)| whole(read.z_force_n.expect("reported"), 88.29)));
    let silent = cruise(Actual { reports_effort: false, ..Actual::default() }, Effects::FULL);
    assert!(silent.iter().all(|(read, _)| read.spindle_torque_nm.is_none() && read.z_force_n.is_none()));
    // What they do is the same, and that they stand at a limit is in their status word.
    assert!(silent.iter().all(|(read, _)| read.spindle.saturated == Some(false)));
}
