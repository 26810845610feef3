//! The real-time core: planning a stroke, one period's step, evaluation at a time, the checker.

use divan::{Bencher, black_box};
use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::Feedback;
use rigidtap::control::profile::verify::{Limits, Task, verify};
use rigidtap::control::profile::{Profile, StrokeRequest};
use rigidtap::control::sync::{Compensation, Settings, Stage, Synchronizer};

fn main() {
    divan::main();
}

const STROKE: StrokeRequest = StrokeRequest { distance: 25.0, command: 7000.0 / 60.0 };

fn stroke(law: Law) -> Profile {
    Machine::reference().stroke(law, STROKE).expect("feasible")
}

/// One stroke of 25 rev at S7000.
#[divan::bench(args = Law::ALL)]
fn plan_stroke(bencher: Bencher<'_, '_>, law: Law) {
    let machine = Machine::reference();
    bencher.bench_local(|| machine.stroke(law, black_box(STROKE)));
}

/// A whole hole, feasibility checks included.
#[divan::bench(args = Law::ALL)]
fn plan_hole(bencher: Bencher<'_, '_>, law: Law) {
    let machine = Machine::reference();
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0);
    bencher.bench_local(|| CyclePlan::new(black_box(hole), &machine, law));
}

/// At times spread over the stroke, so that no branch is learnt by heart.
#[divan::bench(args = Law::ALL)]
fn profile_at(bencher: Bencher<'_, '_>, law: Law) {
    let profile = stroke(law);
    let mut share = 0.0_f64;
    bencher.bench_local(|| {
        share = (share + 0.618_033_988_75).fract();
        profile.at(black_box(share * profile.duration_s()))
    });
}

/// One interpolation period in the middle of a hole, with an encoder reading that moves.
#[divan::bench(args = Compensation::ALL)]
fn synchronizer_step(bencher: Bencher<'_, '_>, compensation: Compensation) {
    let machine = Machine::reference();
    let plan = CyclePlan::new(TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0), &machine, Law::TorqueCurve);
    let settings = Settings { compensation, ..Settings::default() };
    let mut rested = Synchronizer::new(plan.expect("feasible"), &machine, settings, 0.0);
    let mut start_s = 0.0;
    while rested.step(start_s, &Feedback::default()).expect("at rest").stage == Stage::Settling {
        start_s += 0.001;
    }
    let (mut synchronizer, mut period) = (rested.clone(), 0_i64);
    bencher.bench_local(|| {
        period = if period < 700 { period + 1 } else { 0 };
        let feedback = Feedback { spindle_counts: period * 500, z_counts: period * -305, ..Feedback::default() };
        synchronizer.step(black_box(start_s + period as f64 * 0.001), black_box(&feedback))
    });
}

#[divan::bench(args = Law::ALL)]
fn verify_stroke(bencher: Bencher<'_, '_>, law: Law) {
    let profile = stroke(law);
    let task = Task { distance: STROKE.distance, start_velocity: 0.0, end_velocity: 0.0 };
    let limits = Limits {
        velocity: STROKE.command,
        acceleration: &|_| f64::INFINITY,
        jerk: f64::INFINITY,
        continuous_acceleration: false,
    };
    bencher.bench_local(|| verify(black_box(&profile), &task, &limits));
}
