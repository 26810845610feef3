//! The hard spread's effects on spindle and Z, each by its formula.

use rigidtap::control::cycle::StrokeKind;
use rigidtap::control::machine::Law;
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{Feedback, Setpoint, Truth};
use rigidtap::run::{Row, RowStage};
use rigidtap::sim::{Actual, Effect, Effects, FrictionModel, PlantOptions};
use std::f64::consts::TAU;

use crate::{FINE_S, accelerating, cruising, drive, strongest, tap, with};

/// Without what would hide a small force or travel.
fn quiet() -> Effects {
    let hiding =
        [Effect::ZFriction, Effect::Backlash, Effect::Interpolation, Effect::EncoderJitter, Effect::EncoderLatency];
    hiding.into_iter().fold(Effects::FULL, Effects::without)
}

fn z_at(speed: f64) -> impl Fn(f64) -> Setpoint {
    move |now_s| Setpoint { z: cruising(speed)(now_s), ..Setpoint::default() }
}

/// Mean over the last part of a run.
fn mean_of_last(samples: &[(Feedback, Truth)], of: impl Fn(&(Feedback, Truth)) -> f64) -> f64 {
    let last = &samples[samples.len() / 2..];
    last.iter().map(of).sum::<f64>() / last.len() as f64
}

fn force_n(actual: Actual, effects: Effects, speed: f64) -> f64 {
    let samples = drive(&PlantOptions { actual, ..with(effects) }, 1.0, z_at(speed));
    mean_of_last(&samples, |(_, truth)| truth.z_force_n)
}

#[test]
fn the_drive_carries_the_weight() {
    let actual = Actual { z_weight_n: 600.0, ..Actual::default() };
    for speed in [0.0, 50.0, -50.0] {
        let found_n = force_n(actual, quiet(), speed);
        assert!((found_n - 600.0).abs() < 1.0, "{found_n} N at {speed} mm/s");
    }
    // It hangs on its drive from the first period on: neither falls.
    let samples = drive(&PlantOptions { actual, ..with(Effects::FULL) }, 0.1, z_at(0.0));
    assert!(samples.iter().all(|(_, truth)| truth.z_mm.abs() < 0.003), "Z moved");
}

/// 1000 N on a tip that gives at 160 Hz are 10 µm and more; a tool that was measured as it hangs stands where its axis does.
#[test]
fn a_tool_is_measured_with_its_sag() {
    let actual = Actual { z_weight_n: 1000.0, z_second_resonance_hz: Some(160.0), ..Actual::default() };
    let samples = drive(&PlantOptions { actual, ..with(quiet()) }, 0.1, z_at(0.0));
    let counts_per_mm = 10_000.0;
    for (read, truth) in &samples {
        let off_um = 1e3 * (truth.z_mm - read.z_counts as f64 / counts_per_mm);
        assert!(off_um.abs() < 0.2, "the tip is {off_um} µm beside its axis");
    }
}

#[test]
fn viscous_friction_goes_with_speed() {
    let actual = Actual { z_viscous_n_per_mm_s: 1.5, ..Actual::default() };
    for speed in [20.0, 100.0, -60.0] {
        let found_n = force_n(actual, quiet(), speed);
        assert!((found_n / (1.5 * speed) - 1.0).abs() < 0.01, "{found_n} N at {speed} mm/s");
    }
}

#[test]
fn friction_differs_between_up_and_down() {
    let effects = Effects::FULL.without(Effect::FrictionRipple);
    let actual = Actual { z_friction_asymmetry: 0.2, ..Actual::default() };
    let (up, down) = (force_n(actual, effects, 50.0), -force_n(actual, effects, -50.0));
    assert!(((up - down) / 300.0 - 0.2).abs() < 0.01, "{up} N up, {down} N down");
}

/// Above the Stribeck speed every law slides with 300 N.
#[test]
fn every_friction_law_slides_at_its_level() {
    for z_friction_model in FrictionModel::ALL {
        let actual = Actual { z_friction_model, ..Actual::default() };
        let found_n = force_n(actual, Effects::FULL.without(Effect::FrictionRipple), 50.0);
        assert!((found_n / 300.0 - 1.0).abs() < 0.01, "{}: {found_n} N", z_friction_model.name());
    }
}

/// Under a force that creeps up, dry friction holds to the last and the others give before: travel at 90 % of the motor
/// side's breakaway, 1.3 × 150 N.
#[test]
fn only_stick_does_not_move_before_it_breaks_away() {
    let travel_um = |z_friction_model| {
        let actual = Actual { z_friction_model, ..Actual::default() };
        let effects = Effects::FULL.without(Effect::Backlash).without(Effect::FrictionRipple);
        let options = PlantOptions { actual, ..with(effects) };
        // The drive's position loop is what pushes; its force is what counts.
        let creeping = |now_s: f64| {
            let z = State { position: 0.05 * now_s, ..State::default() };
            Setpoint { z, ..Setpoint::default() }
        };
        let samples = drive(&options, 2.0, creeping);
        let at = samples.iter().find(|(_, truth)| truth.z_force_n > 0.9 * 195.0).expect("the force rises");
        1000.0 * at.1.z_mm
    };
    let stick_um = travel_um(FrictionModel::Stick);
    assert!(stick_um.abs() < 0.05, "{stick_um} µm under stick");
    for model in [FrictionModel::Stribeck, FrictionModel::LuGre, FrictionModel::Gms] {
        let found_um = travel_um(model);
        assert!(found_um > 0.5, "{found_um} µm under {}", model.name());
    }
}

/// Amplitude of a signal at a known number of turns for each sample, over whole turns of it.
fn amplitude_at(signal: &[(f64, f64)]) -> f64 {
    let mean = signal.iter().map(|(_, value)| value).sum::<f64>() / signal.len() as f64;
    let part = |of: fn(f64) -> f64| signal.iter().map(|(turns, value)| (value - mean) * of(TAU * turns)).sum::<f64>();
    2.0 * part(f64::cos).hypot(part(f64::sin)) / signal.len() as f64
}

#[test]
fn the_screw_errs_once_in_each_lead() {
    for lead_mm in [10.0, 16.0] {
        let actual = Actual { screw_error_um: 3.0, screw_lead_mm: lead_mm, ..Actual::default() };
        let samples = drive(&PlantOptions { actual, ..with(quiet()) }, 2.4, z_at(40.0));
        let counts = |read: &Feedback| (read.z_counts - read.z_motor_counts.expect("simulated")) as f64 / 10.0;
        let from_s = 0.5;
        let whole = (5.0 * lead_mm / 40.0).min(lead_mm / 40.0 * ((2.4 - from_s) * 40.0 / lead_mm).floor());
        let (first, count) = ((from_s / FINE_S) as usize, (whole / FINE_S) as usize);
        let of = |lead: f64| -> f64 {
            amplitude_at(
                &samples[first..first + count]
                    .iter()
                    .map(|(read, truth)| (truth.z_mm / lead, counts(read)))
                    .collect::<Vec<_>>(),
            )
        };
        assert!((of(lead_mm) - 3.0).abs() < 0.1, "{} µm over {lead_mm} mm", of(lead_mm));
        assert!(of(lead_mm / 2.0) < 0.1, "a second harmonic of {} µm", of(lead_mm / 2.0));
    }
}

#[test]
fn a_screw_that_grows_draws_the_motor_back() {
    let actual = Actual { thermal_um_per_s: 0.5, ..Actual::default() };
    let samples = drive(&PlantOptions { actual, ..with(quiet()) }, 2.0, z_at(0.0));
    let lost_um = |time_s: f64| {
        let (read, _) = &samples[(time_s / FINE_S) as usize];
        (read.z_counts - read.z_motor_counts.expect("simulated")) as f64 / 10.0
    };
    assert!((lost_um(1.9) - lost_um(0.9) - 0.5).abs() < 0.15, "{} µm in a second", lost_um(1.9) - lost_um(0.9));
}

/// The higher mode of three free masses: 400, 120 and 80 kg on the springs of 100 Hz (200 kg) and 220 Hz (80 kg).
#[test]
fn the_tip_rings_at_the_second_axial_mode() {
    let spring = |kg: f64, hz: f64| kg * (TAU * hz).powi(2);
    let (m1, m2, m3, k1, k2) = (400.0, 120.0, 80.0, spring(200.0, 100.0), spring(80.0, 220.0));
    let b = k1 * (m1 + m2) / (m1 * m2) + k2 * (m2 + m3) / (m2 * m3);
    let c = k1 * k2 * (m1 + m2 + m3) / (m1 * m2 * m3);
    let mode_hz = |sign: f64| ((b + sign * (b * b - 4.0 * c).sqrt()) / 2.0).sqrt() / TAU;
    let actual = Actual { z_second_resonance_hz: Some(220.0), ..Actual::default() };
    // At its limit the force does not answer to the ringing.
    let far = |now_s| Setpoint { z: accelerating(-1e6, 0.01)(now_s), ..Setpoint::default() };
    let samples = drive(&PlantOptions { actual, ..with(quiet()) }, 0.1, far);
    let tip: Vec<f64> = samples.iter().map(|(read, truth)| truth.z_mm - read.z_counts as f64 / 10_000.0).collect();
    let ringing = &tip[(0.015 / FINE_S) as usize..];
    let (high_hz, _) = strongest(ringing, 200.0, 500.0);
    assert!((high_hz - mode_hz(1.0)).abs() <= 6.0, "{high_hz} for {} Hz", mode_hz(1.0));
    let twist: Vec<f64> =
        samples.iter().map(|(read, _)| (read.z_motor_counts.expect("simulated") - read.z_counts) as f64).collect();
    let (low_hz, _) = strongest(&twist[(0.015 / FINE_S) as usize..], 60.0, 200.0);
    assert!((low_hz - mode_hz(-1.0)).abs() <= 6.0, "{low_hz} for {} Hz", mode_hz(-1.0));
}

/// Mean of a deep part of a stroke.
fn deep(rows: &[Row], kind: StrokeKind, of: fn(&Truth) -> f64) -> f64 {
    let truths = rows.iter().filter(|row| row.stage == RowStage::Stroke(kind)).filter_map(|row| row.truth);
    let values: Vec<_> = truths.filter(|truth| (-20.0..-10.0).contains(&truth.z_mm)).map(|truth| of(&truth)).collect();
    values.iter().sum::<f64>() / values.len() as f64
}

/// Drawn in by 100 N on the way in, and out by 30 % of that on the way out, for both hands alike.
#[test]
fn the_tap_draws_z_along_its_travel() {
    let rows = |tap_axial_n| {
        let actual = Actual { tap_axial_n, ..Actual::default() };
        tap(Law::TorqueCurve, 1000.0, &PlantOptions { actual, ..with(quiet()) }).1
    };
    let (with_it, without) = (rows(100.0), rows(0.0));
    for (kind, expected_n) in [(StrokeKind::In, 100.0), (StrokeKind::Out, -30.0)] {
        let found_n = deep(&with_it, kind, |truth| truth.z_force_n) - deep(&without, kind, |truth| truth.z_force_n);
        assert!((found_n / expected_n - 1.0).abs() < 0.1, "{kind:?}: {found_n} N");
    }
}

#[test]
fn an_eccentric_encoder_errs_once_a_revolution() {
    // A thousandth of a revolution, a hundred times what is usual, so that it stands out of the counts.
    let actual = Actual { spindle_eccentricity_arcsec: 1296.0, ..Actual::default() };
    let effects = [Effect::SpindleResonance, Effect::TorqueRipple].into_iter().fold(quiet(), Effects::without);
    let turning = |now_s| Setpoint { spindle: cruising(20.0)(now_s), ..Setpoint::default() };
    let samples = drive(&PlantOptions { actual, ..with(effects) }, 1.5, turning);
    let signal: Vec<_> = samples[(0.5 / FINE_S) as usize..]
        .iter()
        .map(|(read, truth)| (truth.spindle_rev, read.spindle_counts as f64 / 16_384.0 - truth.spindle_rev))
        .collect();
    let found_rev = amplitude_at(&signal);
    assert!((found_rev / 0.001 - 1.0).abs() < 0.02, "{found_rev} rev");
}

#[test]
fn torque_per_current_falls_with_speed() {
    let actual = Actual { torque_constant_fall: 0.2, ..Actual::default() };
    for (rev_per_s, left) in [(10.0, 0.985), (100.0, 0.85)] {
        let turning = |now_s| Setpoint { spindle: cruising(rev_per_s)(now_s), ..Setpoint::default() };
        let samples = drive(&PlantOptions { actual, ..PlantOptions::default() }, 1.0, turning);
        let known_nm = mean_of_last(&samples, |(read, _)| read.spindle_torque_nm.expect("reported"));
        let true_nm = mean_of_last(&samples, |(_, truth)| truth.spindle_torque_nm);
        assert!((true_nm / known_nm / left - 1.0).abs() < 0.005, "{} at {rev_per_s} rev/s", true_nm / known_nm);
    }
}
