//! What the data let one guess is what was put into them, and none of it is taken off e(k).

use rigidtap::run::analysis::Estimates;

use super::*;

/// Constant acceleration for 0.2 s, constant speed, and back, with what the estimates name built in.
fn hole(pitch_ratio: f64, z_lag_s: f64, backlash_mm: f64, eccentricity_rev: f64) -> MeasuredHole {
    const PERIOD_S: f64 = 1e-3;
    let way = |now_s: f64| {
        let (ramp_s, even_s, speed) = (0.2, 0.2, 50.0);
        let law = |t: f64| {
            let t = t.clamp(0.0, 2.0 * ramp_s + even_s);
            let left = 2.0 * ramp_s + even_s - t;
            let whole = speed * (ramp_s + even_s);
            if t < ramp_s {
                speed / ramp_s * t * t / 2.0
            } else if left < ramp_s {
                whole - speed / ramp_s * left * left / 2.0
            } else {
                speed * (t - ramp_s / 2.0)
            }
        };
        law(now_s) - law(now_s - 0.6)
    };
    let scale = Scale { counts_per_rev: 16_384.0, counts_per_mm: 10_000.0, motor_counts_per_mm: 10_000.0 };
    let samples = (0..1500u32).map(|k| {
        let now_s = f64::from(k) * PERIOD_S - 0.1;
        let true_rev = way(now_s);
        let shown_rev = true_rev + eccentricity_rev * (std::f64::consts::TAU * true_rev).sin();
        let turned_back = now_s > 0.6;
        let z_mm = pitch_ratio * way(now_s - z_lag_s) + if turned_back { backlash_mm } else { 0.0 };
        Sample {
            k: k.into(),
            time_s: f64::from(k) * PERIOD_S,
            spindle_counts: (shown_rev * scale.counts_per_rev).round(),
            z_counts: (-z_mm * scale.counts_per_mm).round(),
            ..Sample::default()
        }
    });
    let found = monitored(AnalysisSettings { scale, pitch_mm: 1.0, tolerance_um: Some(53.0) }, samples);
    assert_eq!(found.holes.len(), 1);
    found.holes[0].clone()
}

#[test]
fn each_cause_is_found_and_stays_in_the_error() {
    let close = |found: f64, due: f64, within: f64| assert!((found - due).abs() <= within, "{found}, due {due}");
    for (ratio, lag_s, backlash_um, eccentricity_deg) in [
        (1.0, 0.0, 0.0, 0.0),
        (1.001, 0.0, 0.0, 0.0),
        (1.0, 0.0005, 0.0, 0.0),
        (1.0, 0.0, 8.0, 0.0),
        (1.0, 0.0, 0.0, 1.0),
        (0.9995, 0.001, 5.0, 2.0),
    ] {
        let hole = hole(ratio, lag_s, backlash_um / 1000.0, eccentricity_deg / 360.0);
        let found = hole.estimates.unwrap();
        close(found.pitch_ratio, ratio, 2e-5);
        close(found.z_lag_s, lag_s, 2e-5);
        close(found.backlash_um, backlash_um, 1.0);
        close(found.eccentricity_deg, eccentricity_deg, 0.05);
        let least_um = 2.0 * 50.0 * lag_s * 1000.0;
        assert!(hole.error_um.peak_to_peak() >= least_um, "e(k) is not freed of its causes: {:?}", hole.error_um);
    }
}

/// The estimates of a hole of the full plant, its readings altered by a known cause.
fn of_the_plant(simulated: &Simulated, alter: &dyn Fn(usize, Reading) -> Reading) -> Estimates {
    let readings: Vec<_> = simulated.readings.iter().enumerate().map(|(k, reading)| alter(k, *reading)).collect();
    let machine = machine(1e-3);
    let (samples, _) = received(&machine, &frames(&readings, 1e-3, 40));
    let found = monitored(settings(&machine), samples);
    assert_eq!(found.holes.len(), 1);
    found.holes[0].estimates.unwrap()
}

#[test]
fn on_the_full_plant_each_estimate_moves_by_its_cause_alone() {
    let simulated = simulated(&machine(1e-3), ONE_HOLE);
    let scale = Scale::of(&machine(1e-3));
    let r_counts = 5.0 * scale.counts_per_mm;
    let deepest = (0..).zip(&simulated.readings).min_by_key(|(_, reading)| reading.z_counts).unwrap().0;
    let plain = of_the_plant(&simulated, &|_, reading| reading);
    // The plant's own screw has its nominal pitch.
    assert!((plain.pitch_ratio - 1.0).abs() <= 4e-5, "{plain:?}");
    let z = |reading: Reading, counts: f64| Reading { z_counts: counts.round() as i64, ..reading };
    let longer = |_, reading: Reading| z(reading, r_counts + 1.0005 * (reading.z_counts as f64 - r_counts));
    let later = |k: usize, reading: Reading| z(reading, simulated.readings[k.saturating_sub(1)].z_counts as f64);
    let behind_the_turn = |k: usize, reading: Reading| {
        z(reading, reading.z_counts as f64 - if k > deepest { 0.008 * scale.counts_per_mm } else { 0.0 })
    };
    let eccentric = |_, reading: Reading| {
        let phase = std::f64::consts::TAU * reading.spindle_counts as f64 / scale.counts_per_rev;
        let counts = reading.spindle_counts as f64 + scale.counts_per_rev / 360.0 * phase.sin();
        Reading { spindle_counts: counts.round() as i64, ..reading }
    };
    type Alter<'a> = &'a dyn Fn(usize, Reading) -> Reading;
    let cases: [(Alter, [f64; 3]); 4] = [
        (&longer, [0.0005, 0.0, 0.0]),
        (&later, [0.0, 0.001, 0.0]),
        (&behind_the_turn, [0.0, 0.0, 8.0]),
        (&eccentric, [0.0, 0.0, 0.0]),
    ];
    for (case, (alter, [pitch_ratio, z_lag_s, backlash_um])) in cases.into_iter().enumerate() {
        let found = of_the_plant(&simulated, alter);
        let close = |found: f64, due: f64, within: f64| {
            assert!((found - due).abs() <= within, "case {case}: {found}, due {due}");
        };
        // 1.3 µm over the whole depth.
        close(found.pitch_ratio - plain.pitch_ratio, pitch_ratio, 5e-5);
        close(found.z_lag_s - plain.z_lag_s, z_lag_s, 2e-5);
        close(found.backlash_um - plain.backlash_um, backlash_um, 1.0);
        close(found.eccentricity_deg, if case == 3 { 1.0 } else { 0.0 }, 0.15);
    }
}
