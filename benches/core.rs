//! The real-time core: planning a stroke, one period's step, evaluation at a time, the checker.

use divan::{Bencher, black_box};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::Feedback;
use rigidtap::control::profile::verify::{Limits, Task, verify};
use rigidtap::control::profile::{
    ImprovedSCurveLaw, LinearLaw, Profile, SCurveLaw, SpeedBand, StrokeRequest, TorqueCurveLaw, TrapezoidJerkLaw,
};
use rigidtap::control::sync::{Adaptation, Compensation, Settings, Stage, Synchronizer};
use rsruckig::prelude::{InputParameter, Ruckig, ThrowErrorHandler, Trajectory};

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

/// Random strokes from rest to rest, the same for every planner.
fn problems() -> Vec<(SCurveLaw, StrokeRequest)> {
    let mut random = Pcg64Mcg::seed_from_u64(1);
    let mut any = |low: f64, high: f64| (low.ln() + random.random_range(0.0..1.0) * (high / low).ln()).exp();
    (0..1024)
        .map(|_| {
            let law = SCurveLaw { acceleration: any(10.0, 1e3), jerk: any(100.0, 1e5) };
            (law, StrokeRequest { distance: any(0.1, 100.0), command: any(1.0, 200.0) })
        })
        .collect()
}

fn each_problem<R>(bencher: Bencher<'_, '_>, mut plan: impl FnMut(SCurveLaw, StrokeRequest) -> R) {
    let problems = problems();
    let mut next = 0;
    bencher.bench_local(|| {
        next = (next + 1) % problems.len();
        let (law, stroke) = black_box(problems[next]);
        // Not returned: divan would keep each sample's thousand profiles, and time the memory.
        black_box(&plan(law, stroke));
    });
}

/// The S-curve and rsruckig on the same problems, each sample all of them, and the laws beside them with the same limits as far as they have them.
mod plan_random_stroke {
    use super::*;

    #[divan::bench(sample_size = 1024)]
    fn s_curve(bencher: Bencher<'_, '_>) {
        each_problem(bencher, |law, stroke| law.plan(stroke));
    }

    /// Into storage that stays, as rsruckig plans.
    #[divan::bench(sample_size = 1024)]
    fn s_curve_into(bencher: Bencher<'_, '_>) {
        let mut profile = Profile::default();
        each_problem(bencher, |law, stroke| law.plan_into(stroke, black_box(&mut profile)));
    }

    #[divan::bench(sample_size = 1024)]
    fn rsruckig(bencher: Bencher<'_, '_>) {
        let mut planner = Ruckig::<1, ThrowErrorHandler>::new(None, 0.001);
        let mut trajectory = Trajectory::new(None);
        let mut input = InputParameter::<1>::new(None);
        each_problem(bencher, |law, stroke| {
            input.target_position[0] = stroke.distance;
            input.max_velocity[0] = stroke.command;
            input.max_acceleration[0] = law.acceleration;
            input.max_jerk[0] = law.jerk;
            planner.calculate(&input, &mut trajectory).is_ok()
        });
    }

    /// Four bands, each with three quarters of the acceleration below it.
    #[divan::bench(sample_size = 1024)]
    fn torque_curve(bencher: Bencher<'_, '_>) {
        each_problem(bencher, |law, stroke| {
            let band = |share: f64, rate: f64| SpeedBand {
                to_rev_per_s: share * stroke.command,
                accel_rev_per_s2: rate * law.acceleration,
                decel_rev_per_s2: rate * law.acceleration,
            };
            TorqueCurveLaw::from_rest(&[band(0.4, 1.0), band(0.6, 0.75), band(0.8, 0.56), band(1.0, 0.42)])?
                .plan(stroke)
        });
    }

    #[divan::bench(sample_size = 1024)]
    fn linear(bencher: Bencher<'_, '_>) {
        each_problem(bencher, |law, stroke| LinearLaw { acceleration: law.acceleration }.plan(stroke));
    }

    fn trapezoid(law: SCurveLaw, quantised_s: Option<f64>) -> TrapezoidJerkLaw {
        // Jerk is full after a third of the time that the acceleration takes.
        let SCurveLaw { acceleration, jerk } = law;
        TrapezoidJerkLaw { acceleration, jerk, snap: 2.0 * jerk * jerk / acceleration, quantised_s }
    }

    #[divan::bench(sample_size = 1024)]
    fn trapezoid_jerk(bencher: Bencher<'_, '_>) {
        each_problem(bencher, |law, stroke| trapezoid(law, None).plan(stroke));
    }

    #[divan::bench(sample_size = 1024)]
    fn trapezoid_jerk_quantised(bencher: Bencher<'_, '_>) {
        each_problem(bencher, |law, stroke| trapezoid(law, Some(0.001)).plan(stroke));
    }

    #[divan::bench(sample_size = 1024)]
    fn improved_s_curve(bencher: Bencher<'_, '_>) {
        each_problem(bencher, |law, stroke| ImprovedSCurveLaw { acceleration: law.acceleration }.plan(stroke));
    }
}

/// A whole hole, feasibility checks included.
#[divan::bench(args = Law::ALL)]
fn plan_hole(bencher: Bencher<'_, '_>, law: Law) {
    let machine = Machine::reference();
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0);
    bencher.bench_local(|| CyclePlan::new(black_box(hole), &machine, law));
}

/// At times spread over the stroke, so that no branch is learnt by heart.
#[divan::bench(args = Law::ALL, sample_size = 1024)]
fn profile_at(bencher: Bencher<'_, '_>, law: Law) {
    let profile = stroke(law);
    let times: [f64; 1024] =
        std::array::from_fn(|index| (index as f64 * 0.618_033_988_75).fract() * profile.duration_s());
    let mut next = 0;
    bencher.bench_local(|| {
        next = (next + 1) % times.len();
        // Not returned: divan would store each state, and time that too.
        black_box(&profile.at(black_box(times[next])));
    });
}

/// One interpolation period in the middle of a hole, with an encoder reading that moves.
#[divan::bench(args = Compensation::ALL)]
fn synchronizer_step(bencher: Bencher<'_, '_>, compensation: Compensation) {
    let machine = Machine::reference();
    let plan = CyclePlan::new(TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0), &machine, Law::TorqueCurve);
    let settings = Settings { compensation, ..Settings::default() };
    let mut rested = Synchronizer::new(plan.expect("feasible"), settings, 0.0);
    let mut adaptation = Adaptation::new(&machine);
    let mut start_s = 0.0;
    while rested.step(start_s, &Feedback::default(), &mut adaptation).stage == Stage::Settling {
        start_s += 0.001;
    }
    let (mut synchronizer, mut period) = (rested.clone(), 0_i64);
    bencher.bench_local(|| {
        period = if period < 700 { period + 1 } else { 0 };
        let feedback = Feedback { spindle_counts: period * 500, z_counts: period * -305, ..Feedback::default() };
        synchronizer.step(black_box(start_s + period as f64 * 0.001), black_box(&feedback), &mut adaptation)
    });
}

#[divan::bench(args = Law::ALL)]
fn verify_stroke(bencher: Bencher<'_, '_>, law: Law) {
    let profile = stroke(law);
    let task = Task { distance: STROKE.distance, ..Task::default() };
    let limits = Limits {
        velocity: STROKE.command,
        acceleration: &|_| f64::INFINITY,
        jerk: f64::INFINITY,
        continuous_acceleration: false,
    };
    bencher.bench_local(|| verify(black_box(&profile), &task, &limits));
}
