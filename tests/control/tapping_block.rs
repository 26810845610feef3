//! A whole block, stopped at a random moment, on a machine that follows at once.

use proptest::prelude::*;
use rigidtap::control::cycle::{Hand, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::Feedback;
use rigidtap::control::sync::{Compensation, Mode, Settings, Stage};
use rigidtap::control::tapping::{Block, BlockRequest, BlockStage, BlockStep};

/// For a host whose drives take no force feedforward.
const PLAIN: Settings = Settings {
    mode: Mode::Commanded,
    compensation: Compensation::Uncompensated,
    identify: false,
    learn: false,
    supervise: true,
};

const PERIOD_S: f64 = 0.001;

fn request() -> BlockRequest {
    let hole = TapCycle { x_mm: 20.0, y_mm: -5.0, return_mm: 10.0, ..TapCycle::right_hand(2.0, -12.0, 1.0, 4000.0) };
    BlockRequest { hole, start_mm: [0.0, 3.0, 25.0], holes: 3, step_mm: [7.0, 1.0] }
}

fn block(spindle_rpm: f64) -> Block {
    let machine = Machine::reference();
    Block::plan(request(), &machine, Law::TorqueCurveSmooth, PLAIN, 0.25, spindle_rpm).expect("feasible")
}

fn reading(step: &BlockStep) -> Feedback {
    Feedback {
        spindle_counts: (step.setpoint.spindle.position * 16_384.0).round() as i64,
        z_counts: (step.setpoint.z.position * 10_000.0).round() as i64,
        ..Feedback::default()
    }
}

/// Runs to the end with a command at a period and another one a second later; each step is checked against the last.
fn run(block: &mut Block, stop_at: u32, resumes: bool) -> Result<BlockStep, TestCaseError> {
    let mut feedback = Feedback { spindle_counts: 4096, z_counts: 250_000, ..Feedback::default() };
    let mut last: Option<BlockStep> = None;
    for k in 0..20_000 {
        let now_s = f64::from(k) * PERIOD_S;
        if k == stop_at {
            block.stop(now_s);
        } else if k == stop_at.saturating_add(1000) {
            // The hole may be over by then, or none: then there is nothing to let go.
            let _ = if resumes { block.resume(now_s) } else { block.retract(now_s) };
        }
        let step = block.step(now_s, &feedback);
        prop_assert!(step.alarm.is_none(), "at rest where it has to be: {:?}", step.alarm);
        feedback = reading(&step);
        let BlockStep { setpoint, .. } = step;
        if let Some(BlockStep { setpoint: before, .. }) = last {
            for (axis, before) in [(setpoint.x, before.x), (setpoint.y, before.y), (setpoint.z, before.z)] {
                let moved = (axis.position - before.position).abs();
                prop_assert!(moved <= 500.0 * PERIOD_S * (1.0 + 1e-9), "{k}: an axis jumps by {moved} mm");
                prop_assert!((axis.velocity - before.velocity).abs() <= 10_000.0 * PERIOD_S * 1.001, "{k}");
            }
            prop_assert!((setpoint.spindle.position - before.spindle.position).abs() <= 8000.0 / 60.0 * PERIOD_S);
            let beside = (setpoint.x.position, setpoint.y.position) != (before.x.position, before.y.position);
            prop_assert!(
                !beside || setpoint.z.position > 2.0,
                "{k}: X and Y move with the tap at {}",
                setpoint.z.position
            );
        }
        prop_assert!(setpoint.z.position >= -12.0 - 1e-9);
        if step.stage == BlockStage::Done {
            return Ok(step);
        }
        last = Some(step);
    }
    Err(TestCaseError::fail("the block does not end"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_block_ends_where_it_should_however_it_is_stopped(
        stop_at in 0u32..4500, resumes: bool, spindle_rpm in prop_oneof![Just(0.0), Just(3000.0), Just(-800.0)],
    ) {
        let whole = run(&mut block(spindle_rpm), u32::MAX, false)?;
        prop_assert_eq!((whole.hole, whole.setpoint.x.position, whole.setpoint.y.position), (2, 34.0, -3.0));
        prop_assert_eq!((whole.setpoint.z.position, whole.setpoint.spindle.velocity), (10.0, 0.0));
        let end = run(&mut block(spindle_rpm), stop_at, resumes)?;
        if resumes {
            prop_assert_eq!(end.setpoint.x.position, whole.setpoint.x.position);
        }
        prop_assert_eq!(end.setpoint.z.position, 10.0);
    }
}

#[test]
fn every_hole_of_a_block_begins_at_its_start_angle() {
    for hand in [Hand::Right, Hand::Left] {
        let hole = TapCycle { start_angle_rev: Some(-0.375), hand, ..request().hole };
        let request = BlockRequest { hole, ..request() };
        let machine = Machine::reference();
        let mut block = Block::plan(request, &machine, Law::TorqueCurve, PLAIN, 0.1, 1234.0).expect("feasible");
        let mut feedback = Feedback { spindle_counts: 1638, z_counts: 250_000, ..Feedback::default() };
        let (mut begun, mut records) = (Vec::new(), Vec::new());
        for k in 0..20_000 {
            let step = block.step(f64::from(k) * PERIOD_S, &feedback);
            assert_eq!(step.alarm, None);
            if matches!(step.stage, BlockStage::Hole(Stage::Synchronous(..))) && begun.len() <= step.hole as usize {
                // The hole's first synchronous period: the spindle still rests.
                begun.push(step.setpoint.spindle.position.rem_euclid(1.0));
                records.push(block.power_loss_record().expect("valid from here on"));
            }
            assert!(matches!(step.stage, BlockStage::Hole(_)) || block.power_loss_record().is_none());
            feedback = reading(&step);
            if step.stage == BlockStage::Done {
                break;
            }
        }
        assert!(begun.len() == 3 && begun.iter().all(|angle| (angle - 0.625).abs() < 1e-9), "{begun:?}");
        assert!(
            records.iter().all(|record| record.hand == hand && record.zero.spindle_counts.rem_euclid(16_384) == 10_240)
        );
    }
}
