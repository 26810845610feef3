//! Drives that take less of a setpoint than all of it, and drives with other gains.

use rigidtap::control::machine::{Machine, Takes};
use rigidtap::control::math::poly::State;
use rigidtap::control::port::Setpoint;
use rigidtap::sim::{Actual, Effect, Effects, PlantOptions};

use crate::{cruising, drive_on, with};

fn machine(takes: Takes) -> Machine {
    Machine::reference()
        .with(|spec| {
            (spec.drive.spindle_takes, spec.drive.z_takes) =
                (takes, if takes == Takes::Speed { Takes::Torque } else { takes })
        })
        .expect("valid")
}

/// Nothing but drives whose gains are not as told.
fn ideal_but_for_the_drives() -> Effects {
    Effect::ALL.into_iter().filter(|effect| *effect != Effect::DriveGain).fold(Effects::FULL, Effects::without)
}

/// How far Z and the spindle lag behind what the bus and its latency make of a constant speed of 50.
fn lags(takes: Takes, actual: Actual) -> [f64; 2] {
    let both = |now_s| Setpoint { spindle: cruising(50.0)(now_s), z: cruising(50.0)(now_s), ..Setpoint::default() };
    let samples = drive_on(&machine(takes), &PlantOptions { actual, ..with(ideal_but_for_the_drives()) }, 1.5, both);
    let last = &samples[samples.len() - 800..];
    // One period of 125 µs late, and read before the setpoint of the same instant.
    let first = samples.len() - last.len();
    let mean = |of: &dyn Fn(usize) -> f64| (0..last.len()).map(of).sum::<f64>() / last.len() as f64;
    let commanded = |index: usize| cruising(50.0)((first + index) as f64 * 125e-6 - 2.0 * 125e-6).position;
    [mean(&|index| commanded(index) - last[index].1.z_mm), mean(&|index| commanded(index) - last[index].1.spindle_rev)]
}

/// A position loop without velocity feedforward lags by speed over gain; with it by nothing.
#[test]
fn a_drive_that_takes_positions_alone_lags_by_speed_over_gain() {
    for drive_gain in [1.0, 0.8] {
        let actual = Actual { drive_gain, ..Actual::default() };
        for lag in lags(Takes::Position, actual) {
            assert!((lag / (50.0 / (40.0 * drive_gain)) - 1.0).abs() < 0.01, "{lag} at gain {drive_gain}");
        }
    }
    for takes in [Takes::Velocity, Takes::Torque] {
        for lag in lags(takes, Actual::default()) {
            assert!(lag.abs() < 0.01, "{takes:?}: {lag}");
        }
    }
}

/// Without acceleration feedforward the velocity loop's integral must find the torque of a step of acceleration a: the
/// speed that is lost on the way there sums to a·Ti/gain, 0.02 rev at 200 rev/s², of which the position loop gives some
/// back at once.
#[test]
fn acceleration_is_fed_forward_only_where_it_is_taken() {
    let behind_rev = |takes| {
        let ramp = |now_s: f64| State { acceleration: 200.0, ..State::default() }.after(now_s, 0.0);
        let spindle = |now_s| Setpoint { spindle: ramp(now_s), ..Setpoint::default() };
        let samples = drive_on(&machine(takes), &with(Effects::IDEAL), 0.03, spindle);
        let time_s = (samples.len() - 1) as f64 * 125e-6;
        ramp(time_s).position - samples[samples.len() - 1].1.spindle_rev
    };
    let lost_rev = behind_rev(Takes::Velocity) - behind_rev(Takes::Torque);
    assert!((0.004..0.02).contains(&lost_rev), "{lost_rev} rev");
}

/// Without a position loop an error of position stays for good, while the speed is the commanded one.
#[test]
fn a_spindle_that_takes_a_speed_alone_has_the_speed_alone() {
    let pushed = |takes| {
        let setpoint = |now_s: f64| {
            let command = cruising(50.0)(now_s);
            Setpoint { spindle: State { position: command.position + 3.0, ..command }, ..Setpoint::default() }
        };
        let samples = drive_on(&machine(takes), &with(Effects::IDEAL), 1.5, setpoint);
        let (first, last) = (samples[samples.len() - 1601].1, samples[samples.len() - 1].1);
        let off_rev = cruising(50.0)((samples.len() - 1) as f64 * 125e-6).position + 3.0 - last.spindle_rev;
        ((last.spindle_rev - first.spindle_rev) / 0.2, off_rev)
    };
    let (speed, off_rev) = pushed(Takes::Speed);
    assert!((speed - 50.0).abs() < 0.01 && (off_rev - 3.0).abs() < 0.2, "{speed} rev/s, {off_rev} rev off");
    let (speed, off_rev) = pushed(Takes::Torque);
    assert!((speed - 50.0).abs() < 0.01 && off_rev.abs() < 0.1, "{speed} rev/s, {off_rev} rev off");
}
