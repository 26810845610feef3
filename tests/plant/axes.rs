//! Spindle and Z by themselves, driven with simple setpoints.

use rigidtap::control::math::poly::State;
use rigidtap::control::port::{Feedback, Setpoint, Truth};
use rigidtap::sim::{Actual, Effect, Effects, PlantOptions};

use crate::{FINE_S, accelerating, cruising, drive, strongest, with};

fn spindle(law: impl Fn(f64) -> State) -> impl Fn(f64) -> Setpoint {
    move |now_s| Setpoint { spindle: law(now_s), ..Setpoint::default() }
}

fn z(law: impl Fn(f64) -> State) -> impl Fn(f64) -> Setpoint {
    move |now_s| Setpoint { z: law(now_s), ..Setpoint::default() }
}

fn slope(positions: &[f64]) -> Vec<f64> {
    positions.windows(2).map(|pair| (pair[1] - pair[0]) / FINE_S).collect()
}

/// How fast the tool turns against the motor after the acceleration has stepped.
fn spindle_ringing(options: &PlantOptions) -> Vec<f64> {
    let samples = drive(options, 0.15, spindle(accelerating(100.0, 0.01)));
    let tool: Vec<_> = samples.iter().map(|(_, truth)| truth.spindle_rev).collect();
    let motor = samples.windows(2).map(|pair| (pair[0].1.spindle_rpm + pair[1].1.spindle_rpm) / 120.0);
    slope(&tool).into_iter().zip(motor).map(|(tool, motor)| tool - motor).skip((0.011 / FINE_S) as usize).collect()
}

#[test]
fn the_spindle_rings_at_its_torsional_resonance() {
    let (hz, amplitude) = strongest(&spindle_ringing(&with(Effects::FULL)), 100.0, 1000.0);
    assert!((hz - 400.0).abs() <= 8.0, "rings at {hz} Hz");
    let rigid = with(Effects::FULL.without(Effect::SpindleResonance));
    let (_, without) = strongest(&spindle_ringing(&rigid), 300.0, 500.0);
    assert!(amplitude > 20.0 * without, "amplitude {amplitude} with, {without} rev/s without the resonance");
    let actual = Actual { spindle_resonance: 0.8, ..Actual::default() };
    let (softer_hz, _) = strongest(&spindle_ringing(&PlantOptions { actual, ..with(Effects::FULL) }), 100.0, 1000.0);
    assert!((softer_hz - 320.0).abs() <= 8.0, "a softer shaft rings at {softer_hz} Hz");
}

/// How far the screw gives under the drive's full force, in counts, without what hides the ringing.
///
/// At its limit the force does not answer to the ringing, so the loops neither damp nor shift it.
fn z_ringing(actual: Actual, resonance: bool) -> Vec<f64> {
    let hiding = [Effect::ZFriction, Effect::Backlash, Effect::Interpolation, Effect::EncoderJitter];
    let effects = hiding.into_iter().fold(Effects::FULL, Effects::without);
    let effects = if resonance { effects } else { effects.without(Effect::ZResonance) };
    let options = PlantOptions { actual, ..with(effects) };
    let samples = drive(&options, 0.1, z(accelerating(-1e6, 0.01)));
    let twist = samples.iter().map(|(read, _)| (read.z_motor_counts.expect("simulated") - read.z_counts) as f64);
    twist.skip((0.015 / FINE_S) as usize).collect()
}

/// 100 Hz with the motor held; both sides free, as under a constant force, 100·√(1 + 200/400).
#[test]
fn z_rings_at_its_axial_resonance() {
    let free_hz = 100.0 * 1.5_f64.sqrt();
    let (hz, amplitude) = strongest(&z_ringing(Actual::default(), true), 60.0, 400.0);
    assert!((hz - free_hz).abs() <= 4.0, "rings at {hz} Hz");
    let (_, without) = strongest(&z_ringing(Actual::default(), false), 100.0, 150.0);
    assert!(amplitude > 20.0 * without, "amplitude {amplitude} with, {without} counts without the resonance");
    let (softer_hz, _) = strongest(&z_ringing(Actual { z_resonance: 0.7, ..Actual::default() }, true), 60.0, 400.0);
    assert!((softer_hz - 0.7 * free_hz).abs() <= 4.0, "a softer screw rings at {softer_hz} Hz");
}

/// An ideal machine with one effect.
fn only(one: Effect) -> Effects {
    Effect::ALL.into_iter().filter(|effect| *effect != one).fold(Effects::FULL, Effects::without)
}

/// Time constant of an effort's way to its limit: from 1 − 1/e of it to 1 − 1/e².
fn time_constant_s(samples: &[(Feedback, Truth)], effort: fn(&Truth) -> f64, limit: f64) -> f64 {
    let shares: Vec<_> = samples.iter().map(|(_, truth)| effort(truth) / limit).collect();
    let reached_s = |level: f64| {
        let after = shares.iter().position(|share| *share >= level).expect("the effort rises");
        let part = (level - shares[after - 1]) / (shares[after] - shares[after - 1]);
        (after as f64 - 1.0 + part) * FINE_S
    };
    reached_s(1.0 - (-2.0_f64).exp()) - reached_s(1.0 - (-1.0_f64).exp())
}

#[test]
fn torque_and_force_lag_behind_their_commands() {
    // Commanded far more than the drive has: at its limit the loops cannot hurry the effort on.
    let options = with(only(Effect::TorqueLag));
    let samples = drive(&options, 0.03, spindle(accelerating(50_000.0, 0.01)));
    let spindle_s = time_constant_s(&samples, |truth| truth.spindle_torque_nm, 20.0);
    assert!((spindle_s / 0.000_65 - 1.0).abs() < 0.05, "the spindle's torque lags {spindle_s} s");
    let samples = drive(&options, 0.03, z(accelerating(1e6, 0.01)));
    let z_s = time_constant_s(&samples, |truth| truth.z_force_n, 8829.0);
    assert!((z_s / 0.0004 - 1.0).abs() < 0.05, "Z's force lags {z_s} s");
}

#[test]
fn spindle_friction_takes_its_torque_at_constant_speed() {
    let torque_nm = |options: &PlantOptions| {
        let samples = drive(options, 1.0, spindle(cruising(50.0)));
        let last = &samples[samples.len() - 1000..];
        last.iter().map(|(_, truth)| truth.spindle_torque_nm).sum::<f64>() / last.len() as f64
    };
    let full_nm = torque_nm(&with(Effects::FULL));
    assert!((full_nm - (0.3 + 0.3 * 3000.0 / 8000.0)).abs() < 0.01, "{full_nm} N·m at 3000 rpm");
    let actual = Actual { friction: 2.0, ..Actual::default() };
    let double_nm = torque_nm(&PlantOptions { actual, ..with(Effects::FULL) });
    assert!((double_nm / full_nm - 2.0).abs() < 0.02, "{double_nm} N·m with twice the friction");
    let without_nm = torque_nm(&with(Effects::FULL.without(Effect::SpindleFriction)));
    assert!(without_nm.abs() < 0.01, "{without_nm} N·m without friction");
}

#[test]
fn encoders_read_what_was_a_latency_ago() {
    let age_s = |actual: Actual| {
        let options = PlantOptions { actual, ..with(Effects::FULL.without(Effect::ZResonance)) };
        let both = |now_s| Setpoint { spindle: cruising(50.0)(now_s), z: cruising(50.0)(now_s), ..Setpoint::default() };
        let samples = drive(&options, 1.0, both);
        let last = &samples[samples.len() - 2000..];
        let mean = |behind: fn(&(Feedback, Truth)) -> f64| last.iter().map(behind).sum::<f64>() / last.len() as f64;
        let z_mm = mean(|(read, truth)| truth.z_mm - read.z_counts as f64 / 10_000.0);
        let spindle_rev = mean(|(read, truth)| truth.spindle_rev - read.spindle_counts as f64 / 16_384.0);
        [z_mm / 50.0, spindle_rev / 50.0]
    };
    for (axis, found_s) in age_s(Actual::default()).into_iter().enumerate() {
        assert!((found_s - 50e-6).abs() < 1e-6, "axis {axis}: {found_s} s old");
    }
    for found_s in age_s(Actual { encoder_latency_s: Some(200e-6), ..Actual::default() }) {
        assert!((found_s - 200e-6).abs() < 2e-6, "{found_s} s old");
    }
}

/// Full power for long: the supply gives up to 5 % less of it, and takes about 20 ms to get there.
#[test]
fn the_supply_sags_under_full_power() {
    // Far more than the motor has above 3000 rpm, so that it stands at its limit.
    let power = |effects: Effects| -> Vec<f64> {
        let samples = drive(&with(effects), 0.2, spindle(accelerating(640.0, 0.0)));
        samples.iter().map(|(_, truth)| truth.spindle_torque_nm * truth.spindle_rpm / 60_000.0).collect()
    };
    let (sagging, stiff) = (power(Effects::FULL), power(Effects::FULL.without(Effect::SupplySag)));
    let at = |time_s: f64| (time_s / FINE_S) as usize;
    assert!((stiff[at(0.18)] - 1.0).abs() < 0.01, "{} of the power without sag", stiff[at(0.18)]);
    assert!((sagging[at(0.18)] - 0.95).abs() < 0.01, "{} of the power with sag", sagging[at(0.18)]);
}
