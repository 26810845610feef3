use rand::{RngExt, SeedableRng};

use super::*;
use crate::control::machine::Machine;
use crate::control::motor::{Motor, TorqueCurve, TorquePoint};
use crate::control::units::{rev_per_s_from_rpm, rpm_from_rev_per_s};
use crate::laws::{STROKES_REV, TuneTask};

fn motor(points: &[(f64, f64)]) -> Motor {
    let points: Vec<_> = points.iter().map(|&(speed_rpm, torque_nm)| TorquePoint { speed_rpm, torque_nm }).collect();
    Motor { curve: TorqueCurve::new(&points).unwrap(), inertia_kg_m2: 0.004 }
}

/// A run-up to 8000 rpm as text, one row each ms, with this much noise either way; rows that `change` spares or alters.
fn log(motor: &Motor, noise_rpm: f64, change: impl Fn(u32, f64) -> Option<f64>) -> String {
    let mut random = rand_pcg::Pcg64::seed_from_u64(3);
    let mut speed = 0.0;
    let mut text = String::from("t, speed\n");
    for row in 0..700 {
        let noise = if noise_rpm > 0.0 { random.random_range(-noise_rpm..noise_rpm) } else { 0.0 };
        if let Some(rpm) = change(row, rpm_from_rev_per_s(speed) + noise) {
            text += &format!("{}, {rpm:.2}\n", f64::from(row) / 1000.0);
        }
        for _ in 0..100 {
            if row >= 10 {
                speed += 1e-5 * motor.acceleration_rev_per_s2(speed, 1.0);
            }
        }
        speed = speed.min(8000.0 / 60.0);
    }
    text
}

/// Greatest deviation of the estimated torque from the true one between 3 % and 97 % of the speed.
fn deviation(truth: &Motor, text: &str) -> f64 {
    let found = RunUp::read(text.as_bytes()).unwrap().motor(8000.0, 0.004).unwrap();
    let speeds = (3..=97).map(|percent| 80.0 * f64::from(percent));
    speeds.map(|rpm| (found.curve.torque_nm(rpm) / truth.curve.torque_nm(rpm) - 1.0).abs()).fold(0.0, f64::max)
}

#[test]
fn finds_the_curve_under_the_noise() {
    for (points, tolerance) in [
        (&[(0.0, 20.0), (3000.0, 20.0), (8000.0, 7.5)][..], 0.02),
        (&[(0.0, 20.0), (2400.0, 20.0), (5600.0, 8.0), (8000.0, 5.0)], 0.03),
        (&[(0.0, 8.0), (8000.0, 8.0)], 0.01),
    ] {
        let truth = motor(points);
        for noise_rpm in [0.0, 5.0, 15.0] {
            let off = deviation(&truth, &log(&truth, noise_rpm, |_, rpm| Some(rpm)));
            assert!(off < tolerance + noise_rpm / 500.0, "{off} at {noise_rpm} rpm of noise on {points:?}");
        }
    }
}

#[test]
fn bears_what_real_logs_have() {
    let truth = Machine::reference().motor().clone();
    let check = |what: &str, text: String| {
        let off = deviation(&truth, &text);
        assert!(off < 0.05, "{off} with {what}");
    };
    check("dropped rows", log(&truth, 5.0, |row, rpm| (row % 3 == 0 || !(40..90).contains(&row)).then_some(rpm)));
    check("few rows", log(&truth, 2.0, |row, rpm| (row % 6 == 0).then_some(rpm)));
    check("spikes", log(&truth, 5.0, |row, rpm| Some(if row % 17 == 0 { 0.0 } else { rpm })));
    check("comments", log(&truth, 5.0, |_, rpm| Some(rpm)).replace("0.1, ", "# logger restarted\n\n0.1,\n0.1, "));
    check("left hand", log(&truth, 5.0, |_, rpm| Some(-rpm)));
    check("decimal commas", log(&truth, 5.0, |_, rpm| Some(rpm)).replace(", ", ";").replace('.', ","));
    // The spindle waits 60 ms at 5000 rpm, as for a change of its winding.
    let plain = log(&truth, 5.0, |_, rpm| Some(rpm));
    let mut stalled = String::new();
    let mut late_s = 0.0;
    for line in plain.lines() {
        let Some((t, rpm)) =
            line.split_once(", ").and_then(|(t, v)| Some((t.parse::<f64>().ok()?, v.parse::<f64>().ok()?)))
        else {
            continue;
        };
        if late_s == 0.0 && rpm > 5000.0 {
            (0..60).for_each(|wait| stalled += &format!("{:.4} {rpm}\n", t + f64::from(wait) / 1000.0));
            late_s = 0.06;
        }
        stalled += &format!("{:.4} {rpm}\n", t + late_s);
    }
    check("a stall, no header", stalled);
}

#[test]
fn gives_the_bands_of_the_true_curve() {
    let truth = Machine::reference().motor().clone();
    let found = RunUp::read(log(&truth, 5.0, |_, rpm| Some(rpm)).as_bytes()).unwrap().motor(8000.0, 0.004).unwrap();
    let tuned = |motor: Motor| TuneTask::new(motor, 8000.0, 0.8, &STROKES_REV).unwrap().best(4).unwrap();
    let (expected, found) = (tuned(truth.clone()), tuned(found));
    for (found, expected) in found.bands.iter().zip(&expected.bands) {
        assert!((found.to_rpm / expected.to_rpm - 1.0).abs() < 0.04, "{found:?} {expected:?}");
        // Against the true motor at the very top, not only against the other bands.
        let most = truth.acceleration_rev_per_s2(rev_per_s_from_rpm(found.to_rpm), 0.8);
        assert!((rev_per_s_from_rpm(found.rate_rpm_per_s) / most - 1.0).abs() < 0.03, "{found:?} {expected:?}");
    }
}

#[test]
fn every_fault_has_its_place() {
    let place = |text: &str| {
        let error = RunUp::read(text.as_bytes()).and_then(|run_up| run_up.motor(8000.0, 0.004)).unwrap_err();
        (error.line, error.column, error.fault)
    };
    assert_eq!(place("# nothing\n"), (1, 1, RunUpFault::Empty));
    assert!(matches!(place("time_s,torque\n0,1\n"), (1, 1, RunUpFault::NoColumn { .. })));
    assert_eq!(place("0,0\n0.1\n"), (2, 1, RunUpFault::Short { found: 1, expected: 2 }));
    assert!(matches!(place("t,x,rpm\n0,0,0\n1,0,fast\n"), (3, 5, RunUpFault::NotANumber { .. })));
    assert!(matches!(place("0 0\n1 nan\n"), (2, 3, RunUpFault::NotANumber { .. })));
    assert_eq!(place("0,0\n1,5\n1,9\n"), (3, 1, RunUpFault::TimeOrder { time_s: 1.0, previous_s: 1.0 }));
    let ramp = |from: f64, to: f64, rows: u32| -> String {
        let rpm = |row: u32| from + (to - from) * f64::from(row) / f64::from(rows);
        (0..=rows).map(|row| format!("{row},{}\n", rpm(row))).collect()
    };
    assert!(matches!(place(&ramp(0.0, 4000.0, 50)), (51, 1, RunUpFault::EndsSlow { .. })));
    assert!(matches!(place(&ramp(4000.0, 8000.0, 50)).2, RunUpFault::StartsFast { .. }));
    assert!(matches!(place(&ramp(0.0, 8000.0, 9)).2, RunUpFault::FewRows { .. }));
}
