//! The simulated machine: each effect visible where its key says, and whole holes that behave as the papers found.

mod axes;
mod broken_tap;
mod drives;
mod fault_bounds;
mod fault_runs;
mod fault_table;
mod faults;
mod golden;
mod hard_axes;
mod hard_host;
mod holes;
mod power_loss;
mod single_effects;
mod start_angle;
mod stop;
mod wrong_scale;

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{Feedback, Port, Setpoint, Truth};
use rigidtap::control::sync::Compensation;
use rigidtap::gcode::program::Action;
use rigidtap::run::{Executor, HoleOutcome, Listener, Row, RunSettings};
use rigidtap::sim::{Actual, Effects, FrictionModel, Plant, PlantOptions};

/// Interpolation at the drive's own rate: resonances lie far below half of 8 kHz.
const FINE_S: f64 = 0.000_125;

/// Taps one M6 hole of 25 mm, commanded, without compensation.
fn tap(law: Law, speed_rpm: f64, options: &PlantOptions) -> (HoleOutcome, Vec<Row>) {
    tap_on(&Machine::reference(), law, speed_rpm, options)
}

fn tap_on(machine: &Machine, law: Law, speed_rpm: f64, options: &PlantOptions) -> (HoleOutcome, Vec<Row>) {
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, speed_rpm);
    let action = Action::Tap(Box::new(CyclePlan::new(hole, machine, law).expect("feasible")));
    let mut rows = Rows::default();
    let mut plant = Plant::new(machine, options);
    // The plant is looked at as the plan alone moves it, however far off.
    let mut settings = RunSettings::default();
    settings.sync.compensation = Compensation::Uncompensated;
    settings.sync.supervise = false;
    let outcome = Executor::new(machine, &mut plant, settings).run(&action, &mut rows);
    (outcome.expect("settles").expect("a hole was tapped"), rows.0)
}

/// Keeps every row.
#[derive(Default)]
struct Rows(Vec<Row>);

impl Listener for Rows {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        self.0.push(*row);
    }
}

/// A machine that has something of every effect of the hard spread.
fn hard() -> Actual {
    Actual {
        backlash_damping: 0.0,
        setpoint_latency_s: 40e-6,
        host_jitter_s: 5e-6,
        z_weight_n: 600.0,
        z_viscous_n_per_mm_s: 1.0,
        z_friction_asymmetry: 0.1,
        z_friction_model: FrictionModel::Gms,
        screw_error_um: 2.0,
        z_second_resonance_hz: Some(220.0),
        tap_axial_n: 100.0,
        spindle_eccentricity_arcsec: 15.0,
        torque_constant_fall: 0.1,
        stale_samples_per_hole: 1.0,
        missed_periods_per_hole: 1.0,
        drive_gain: 0.9,
        drive_delay_periods: 1.5,
        thermal_um_per_s: 0.5,
        effort_resolution: 0.01,
        reports_effort: false,
        ..Actual::default()
    }
}

fn with(effects: Effects) -> PlantOptions {
    PlantOptions { effects, ..PlantOptions::default() }
}

/// Drives the bare plant with setpoints over time, sampled finely; what was read and what is true before each.
fn drive(options: &PlantOptions, duration_s: f64, setpoint: impl Fn(f64) -> Setpoint) -> Vec<(Feedback, Truth)> {
    drive_on(&Machine::reference(), options, duration_s, setpoint)
}

fn drive_on(
    machine: &Machine,
    options: &PlantOptions,
    duration_s: f64,
    setpoint: impl Fn(f64) -> Setpoint,
) -> Vec<(Feedback, Truth)> {
    let machine = machine.with(|spec| spec.control.period_s = FINE_S).expect("the drive's period");
    let mut plant = Plant::new(&machine, options);
    (0..(duration_s / FINE_S) as u32)
        .map(|period| {
            let now_s = f64::from(period) * FINE_S;
            let feedback = plant.read(now_s);
            let truth = plant.truth().expect("a simulation knows");
            plant.write(now_s, &setpoint(now_s));
            (feedback, truth)
        })
        .collect()
}

/// Rest, then constant acceleration from `start_s` on.
fn accelerating(acceleration: f64, start_s: f64) -> impl Fn(f64) -> State {
    move |now_s| {
        let since_s = now_s - start_s;
        if since_s < 0.0 { State::default() } else { State { acceleration, ..State::default() }.after(since_s, 0.0) }
    }
}

/// Rest, constant acceleration for a quarter of a second, then constant speed.
fn cruising(speed: f64) -> impl Fn(f64) -> State {
    const RAMP_S: f64 = 0.25;
    move |now_s| {
        let ramp = State { acceleration: speed / RAMP_S, ..State::default() };
        if now_s < RAMP_S {
            return ramp.after(now_s, 0.0);
        }
        State { acceleration: 0.0, ..ramp.after(RAMP_S, 0.0) }.after(now_s - RAMP_S, 0.0)
    }
}

/// The frequency between `low_hz` and `high_hz` at which a signal is strongest, and its amplitude there.
fn strongest(signal: &[f64], low_hz: f64, high_hz: f64) -> (f64, f64) {
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let amplitude = |hz: f64| {
        let (mut cosine, mut sine) = (0.0, 0.0);
        for (index, value) in signal.iter().enumerate() {
            // Hann: what the window cuts off must not pass for a resonance.
            let share = index as f64 / signal.len() as f64;
            let window = 1.0 - (std::f64::consts::TAU * share).cos();
            let phase = std::f64::consts::TAU * hz * FINE_S * index as f64;
            cosine += window * (value - mean) * phase.cos();
            sine += window * (value - mean) * phase.sin();
        }
        2.0 * cosine.hypot(sine) / signal.len() as f64
    };
    let steps = (high_hz - low_hz) as u32;
    (0..=steps)
        .map(|step| low_hz + f64::from(step))
        .map(|hz| (hz, amplitude(hz)))
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .expect("a frequency range")
}
