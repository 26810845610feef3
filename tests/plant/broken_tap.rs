//! A tap that breaks is warned of at the end of its hole, and nothing else is.

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::Port;
use rigidtap::control::sync::{Alarm, Compensation, Settings};
use rigidtap::control::tapping::{Block, BlockRequest, BlockStage};
use rigidtap::gcode::program::Action;
use rigidtap::run::{ProgramOutcome, RunSettings, Verdict, run_actions};
use rigidtap::sim::{Actual, Effect, Effects, Fault, Injection, Plant, PlantOptions};

const HOLES: usize = 5;

fn hole(speed_rpm: f64) -> TapCycle {
    TapCycle::right_hand(0.0, -25.0, 1.0, speed_rpm)
}

/// The same hole again and again, with a tap that breaks at a time.
fn tap(speed_rpm: f64, compensation: Compensation, breaks_s: Option<f64>, options: PlantOptions) -> ProgramOutcome {
    let machine = Machine::reference();
    let plan = CyclePlan::new(hole(speed_rpm), &machine, Law::TorqueCurve).expect("feasible");
    let actions = vec![Action::Tap(Box::new(plan)); HOLES];
    let mut settings = RunSettings::default();
    settings.sync.compensation = compensation;
    let faults = [breaks_s.map(|at_s| Injection::new(Fault::TapBroken, at_s)), None, None, None];
    let mut plant = Plant::new(&machine, &PlantOptions { faults, ..options });
    run_actions(&actions, &machine, settings, &mut plant, &mut ())
}

#[test]
fn a_tap_that_broke_is_a_warning_and_the_program_stops() {
    for speed_rpm in [1000.0, 3000.0, 7000.0] {
        for compensation in Compensation::ALL {
            let healthy = tap(speed_rpm, compensation, None, PlantOptions::default());
            assert!(healthy.fault.is_none() && healthy.holes.len() == HOLES, "{speed_rpm} {:?}", healthy.fault);
            // Between the third hole and the fourth.
            let breaks_s = healthy.total_s * 3.0 / HOLES as f64;
            let broken = tap(speed_rpm, compensation, Some(breaks_s), PlantOptions::default());
            let last = broken.holes.last().expect("some");
            assert!(matches!(last.alarm, Some(Alarm::TapBroken { .. })), "{speed_rpm} {}", compensation.name());
            assert_eq!(
                (last.hole, last.verdict(), broken.fault.map(|fault| fault.hole)),
                (4, Verdict::Warning, Some(4))
            );
        }
    }
}

#[test]
fn other_machines_and_air_are_not_warned_of() {
    let air = PlantOptions { effects: Effects::FULL.without(Effect::Cutting), ..PlantOptions::default() };
    let weak = Actual { inertia: 1.2, torque_constant: 0.9, friction: 1.4, ..Actual::default() };
    let coarse = Actual { effort_resolution: 0.01, drive_delay_periods: 1.5, ..Actual::default() };
    for options in [air, PlantOptions { actual: weak, ..air }] {
        for speed_rpm in [1000.0, 7000.0] {
            let found = tap(speed_rpm, Compensation::ModelBased, None, options);
            assert_eq!((found.fault, found.holes.len()), (None, HOLES), "{speed_rpm}");
        }
    }
    for actual in [weak, coarse] {
        for seed in 1..10 {
            let options = PlantOptions { actual, seed, ..PlantOptions::default() };
            let found = tap(3000.0, Compensation::ModelBased, None, options);
            assert_eq!((found.fault, found.holes.len()), (None, HOLES), "{seed}");
        }
    }
}

/// It ends its move, stands above the hole, and goes on when it is told to.
#[test]
fn a_block_stops_after_the_hole_and_can_go_on() {
    let machine = Machine::reference();
    let request = BlockRequest { hole: hole(3000.0), start_mm: [0.0; 3], holes: 5, step_mm: [10.0, 0.0] };
    let mut block = Block::plan(request, &machine, Law::TorqueCurve, Settings::default(), 0.0, 0.0).expect("feasible");
    // A hole takes a little more than a second: it breaks in the third.
    let broken = Injection::new(Fault::TapBroken, 3.0);
    let options = PlantOptions { faults: [Some(broken), None, None, None], ..PlantOptions::default() };
    let mut plant = Plant::new(&machine, &options);
    plant.begin_hole(&request.hole);
    let (mut stood, mut resumed) = (0, 0);
    for k in 0..20_000 {
        let now_s = f64::from(k) * 0.001;
        let step = block.step(now_s, &plant.read(now_s));
        assert_eq!(step.alarm, None, "{k}");
        if step.stage == BlockStage::Done {
            // The third, and the fourth that the broken tap was sent on to; after the fifth there is nothing to stop.
            assert_eq!(resumed, 2);
            return;
        }
        if step.warning.is_some() && step.stage == BlockStage::Positioning && step.setpoint.z.velocity.abs() < 0.1 {
            stood += 1;
            if stood == 500 {
                assert!(matches!(step.warning, Some(Alarm::TapBroken { .. })));
                assert!((step.setpoint.z.position - request.hole.return_mm).abs() < 0.01);
                block.resume(now_s).expect("stopped");
                (stood, resumed) = (0, resumed + 1);
            }
        }
        plant.write(now_s, &step.setpoint);
    }
    panic!("it does not end: resumed {resumed} times, stood {stood}");
}
