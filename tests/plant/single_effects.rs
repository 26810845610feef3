//! What each effect of the hard spread costs by itself under the control as it is.
//!
//! `cargo test --release --test plant -- --ignored --nocapture single_effects` prints the table; RIGIDTAP_SEEDS changes
//! the number of seeds.

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::gcode::program::Action;
use rigidtap::run::{Executor, RunSettings};
use rigidtap::sim::{Actual, FrictionModel, Plant, PlantOptions};
use rigidtap::study::Percentiles;

const HOLES: usize = 10;

/// Worst of measured and true e(k) in the first and the last hole, and of an alarm infinity.
fn holes(machine: &Machine, actual: Actual, seed: u64) -> [f64; 2] {
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0);
    let action = Action::Tap(Box::new(CyclePlan::new(hole, machine, Law::TorqueCurveSmooth).expect("feasible")));
    let mut settings = RunSettings::default();
    settings.sync.learn = true;
    let options = PlantOptions { actual, seed, z_start_mm: settings.start_mm[2], ..PlantOptions::default() };
    let mut plant = Plant::new(machine, &options);
    let mut executor = Executor::new(machine, &mut plant, settings);
    let mut worst = [f64::INFINITY; 2];
    for number in 0..HOLES {
        match executor.run(&action, &mut ()) {
            Ok(Some(outcome)) => {
                worst[1] = outcome.worst_um();
                if number == 0 {
                    worst[0] = worst[1];
                }
            }
            _ => return [worst[0], f64::INFINITY],
        }
    }
    worst
}

fn cases() -> Vec<(&'static str, Actual)> {
    let none = Actual::default();
    vec![
        ("as modelled", none),
        ("LuGre friction", Actual { z_friction_model: FrictionModel::LuGre, ..none }),
        ("GMS friction", Actual { z_friction_model: FrictionModel::Gms, ..none }),
        ("stick, no pre-sliding", Actual { z_friction_model: FrictionModel::Stick, ..none }),
        ("no damping in the backlash", Actual { backlash_damping: 0.0, ..none }),
        ("viscous friction 2 N·s/mm", Actual { z_viscous_n_per_mm_s: 2.0, ..none }),
        ("weight 1000 N", Actual { z_weight_n: 1000.0, ..none }),
        ("weight −1000 N", Actual { z_weight_n: -1000.0, ..none }),
        ("friction asymmetry 20 %", Actual { z_friction_asymmetry: 0.2, ..none }),
        ("screw error 3 µm over 10 mm", Actual { screw_error_um: 3.0, ..none }),
        ("screw error 3 µm over 16 mm", Actual { screw_error_um: 3.0, screw_lead_mm: 16.0, ..none }),
        ("screw error 8 µm over 10 mm", Actual { screw_error_um: 8.0, ..none }),
        ("screw growing 0.5 µm/s", Actual { thermal_um_per_s: 0.5, ..none }),
        ("second axial mode 220 Hz", Actual { z_second_resonance_hz: Some(220.0), ..none }),
        ("axial tap force 100 N", Actual { tap_axial_n: 100.0, ..none }),
        ("axial tap force 400 N", Actual { tap_axial_n: 400.0, ..none }),
        ("axial tap force −100 N", Actual { tap_axial_n: -100.0, ..none }),
        ("eccentricity 15″", Actual { spindle_eccentricity_arcsec: 15.0, ..none }),
        ("torque constant −15 % at top", Actual { torque_constant_fall: 0.15, ..none }),
        ("setpoints 50 µs late", Actual { setpoint_latency_s: 50e-6, ..none }),
        ("setpoints 100 µs late", Actual { setpoint_latency_s: 100e-6, ..none }),
        ("setpoints 100 µs early", Actual { setpoint_latency_s: -100e-6, ..none }),
        ("setpoints one period late", Actual { setpoint_latency_periods: 1.0, ..none }),
        ("host jitter ±5 µs", Actual { host_jitter_s: 5e-6, ..none }),
        ("host jitter ±20 µs", Actual { host_jitter_s: 20e-6, ..none }),
        ("one stale sample a hole", Actual { stale_samples_per_hole: 1.0, ..none }),
        ("one missed period a hole", Actual { missed_periods_per_hole: 1.0, ..none }),
        ("drive gains ×0.85", Actual { drive_gain: 0.85, ..none }),
        ("drive gains ×1.15", Actual { drive_gain: 1.15, ..none }),
        ("drives 2 of their periods later", Actual { drive_delay_periods: 2.0, ..none }),
        ("efforts in steps of 1 %", Actual { effort_resolution: 0.01, ..none }),
        ("no effort reported", Actual { reports_effort: false, ..none }),
    ]
}

#[test]
#[ignore = "some minutes: prints a table"]
#[allow(clippy::print_stdout, reason = "a table to look at")]
fn single_effects() {
    let seeds = std::env::var("RIGIDTAP_SEEDS").ok().and_then(|text| text.parse().ok()).unwrap_or(100_u64);
    let machine = Machine::reference().with(|spec| spec.law.motor_share = 0.75).expect("valid");
    println!(
        "nominal machine, S7000, 25 rev, pitch 1, AlSi, torque-curve-smooth at share 0.75, full, learning; {seeds} seeds; µm"
    );
    println!("| effect | hole 1, p50 / p99 | hole {HOLES}, p50 / p99 |\n|---|--:|--:|");
    for (name, actual) in cases() {
        let found: Vec<_> = (1..=seeds).map(|seed| holes(&machine, actual, seed)).collect();
        let cell = |index: usize| {
            let Percentiles { p50, p99, .. } = Percentiles::of(found.iter().map(|holes| holes[index]));
            format!("{p50:.1} / {p99:.1}")
        };
        println!("| {name} | {} | {} |", cell(0), cell(1));
    }
}
