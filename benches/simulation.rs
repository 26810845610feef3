//! A simulated hole. Items are simulated periods of 1 ms: 0.1 Mitem/s is 100 times real time.

use divan::Bencher;
use divan::counter::ItemsCount;
use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::gcode::program::Action;
use rigidtap::run::{Executor, RunSettings};
use rigidtap::sim::{Actual, Effects, FrictionModel, Plant, PlantOptions};

fn main() {
    divan::main();
}

/// Taps one hole of 25 mm at S7000; the periods it took.
fn tap(machine: &Machine, action: &Action, options: &PlantOptions) -> u64 {
    let mut plant = Plant::new(machine, options);
    let mut executor = Executor::new(machine, &mut plant, RunSettings::default());
    executor.run(action, &mut ()).expect("settles");
    (executor.now_s() / machine.spec().control.period_s).round() as u64
}

#[divan::bench]
fn hole_full(bencher: Bencher<'_, '_>) {
    hole(bencher, &PlantOptions::default());
}

#[divan::bench]
fn hole_ideal(bencher: Bencher<'_, '_>) {
    hole(bencher, &PlantOptions { effects: Effects::IDEAL, ..PlantOptions::default() });
}

/// Everything of the hard spread at once, with the costliest friction law of it.
#[divan::bench]
fn hole_hard(bencher: Bencher<'_, '_>) {
    let actual = Actual {
        backlash_damping: 0.5,
        setpoint_latency_s: 20e-6,
        host_jitter_s: 5e-6,
        z_weight_n: 400.0,
        z_viscous_n_per_mm_s: 0.5,
        z_friction_asymmetry: 0.1,
        z_friction_model: FrictionModel::Gms,
        screw_error_um: 1.5,
        z_second_resonance_hz: Some(220.0),
        tap_axial_n: 50.0,
        spindle_eccentricity_arcsec: 10.0,
        torque_constant_fall: 0.05,
        stale_samples_per_hole: 0.2,
        missed_periods_per_hole: 0.05,
        drive_gain: 0.95,
        drive_delay_periods: 1.0,
        thermal_um_per_s: 0.2,
        effort_resolution: 0.001,
        ..Actual::default()
    };
    hole(bencher, &PlantOptions { actual, ..PlantOptions::default() });
}

fn hole(bencher: Bencher<'_, '_>, options: &PlantOptions) {
    let machine = Machine::reference();
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0);
    let action = Action::Tap(Box::new(CyclePlan::new(hole, &machine, Law::TorqueCurve).expect("feasible")));
    let periods = tap(&machine, &action, options);
    bencher.counter(ItemsCount::new(periods)).bench_local(|| tap(&machine, &action, options));
}
