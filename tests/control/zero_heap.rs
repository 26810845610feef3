//! The core allocates nothing, neither planning nor stepping. The allocator aborts the test where it does.

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::motor::Friction;
use rigidtap::control::port::Feedback;
use rigidtap::control::profile::{SCurveLaw, StrokeRequest, TorqueCurveSmoothLaw, TorqueLimitLaw, Turns};
use rigidtap::control::sync::{Adaptation, Compensation, Mode, Settings, Stage, Synchronizer};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

#[test]
fn a_whole_hole_without_the_heap() {
    for law in Law::ALL {
        for mode in Mode::ALL {
            for compensation in Compensation::ALL {
                for supervise in [true, false] {
                    let settings = Settings { mode, compensation, identify: true, learn: true, supervise };
                    let periods = assert_no_alloc(|| tap(law, settings));
                    assert!(periods > 100, "{law:?} {mode:?} {compensation:?}: {periods} periods");
                }
            }
        }
    }
}

/// Plans and taps one hole on a machine that follows at once; the periods it took.
fn tap(law: Law, settings: Settings) -> u32 {
    let machine = Machine::reference();
    let (per_rev, per_mm) =
        (machine.spec().spindle.encoder_counts_per_rev, machine.spec().z_axis.encoder_counts_per_mm);
    let plan = CyclePlan::new(TapCycle::right_hand(0.0, -25.0, 1.0, 5000.0), &machine, law).expect("feasible");
    let (mut synchronizer, mut adaptation) = (Synchronizer::new(plan, settings, 0.0), Adaptation::new(&machine));
    let mut feedback = Feedback::default();
    for period in 0.. {
        let step = synchronizer.step(f64::from(period) * 0.001, &feedback, &mut adaptation);
        // Z that follows a machine without latency leaves the thread, which supervision notices.
        if matches!(step.stage, Stage::Done | Stage::Held) {
            return period;
        }
        feedback.spindle_counts = (step.spindle.position * per_rev).round() as i64;
        feedback.z_counts = (step.z.position * per_mm).round() as i64;
    }
    unreachable!("the loop ends with the hole")
}

#[test]
fn planning_without_the_heap() {
    let machine = assert_no_alloc(|| Machine::reference().with_motor_share(0.7)).expect("in range");
    assert_no_alloc(|| {
        let request = StrokeRequest { distance: 25.0, command: 7000.0 / 60.0 };
        let between = SCurveLaw { acceleration: 600.0, jerk: 20_000.0 }.plan_between(request, 3.0, 5.0);
        let bound = machine.motor().fastest_stroke(25.0, 100.0, 0.8);
        let law = TorqueCurveSmoothLaw::new(machine.motor(), 0.7, 1e5);
        let turn = law.turn_acceleration(request).and_then(|end| law.plan(request, Turns { start: 0.0, end }));
        let limit = TorqueLimitLaw::new(machine.motor(), Friction::default(), 0.7).plan(request);
        assert!(turn.is_ok() && limit.is_ok());
        assert!(between.is_ok() && machine.torque_curve().change_speed(0.0, 50.0).is_ok() && bound.duration_s > 0.0);
    });
}
