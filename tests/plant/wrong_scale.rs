//! A machine file whose encoder has other counts than the machine: noticed in air, before the tap reaches the work piece.

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::math::poly::State;
use rigidtap::control::port::Port;
use rigidtap::control::sync::{Settings, Stage};
use rigidtap::control::tapping::Tapping;
use rigidtap::sim::{Plant, PlantOptions};

const PERIOD_S: f64 = 0.001;

/// Code of the alarm, and the deepest that the tip came until everything stood.
fn tap_with_coarse_scale(speed_rpm: f64) -> (Option<u32>, f64) {
    let machine = Machine::reference();
    let believed = machine.with(|spec| spec.z_axis.encoder_counts_per_mm = 1000.0).unwrap();
    let cycle = TapCycle::right_hand(0.0, -25.0, 1.0, speed_rpm);
    let plan = CyclePlan::new(cycle, &believed, Law::TorqueCurve).unwrap();
    let mut plant = Plant::new(&machine, &PlantOptions::default());
    plant.begin_hole(&cycle);
    let mut tapping = Tapping::new(&believed);
    tapping.start(plan, Settings::default(), 0.0, 0.0, 0.0).unwrap();
    let (mut alarm, mut deepest_mm) = (None, f64::INFINITY);
    for k in 0..4000 {
        let now_s = f64::from(k) * PERIOD_S;
        let feedback = plant.read(now_s);
        let step = tapping.step(now_s, &feedback).unwrap();
        alarm = alarm.or(step.alarm.map(|alarm| alarm.code()));
        deepest_mm = deepest_mm.min(plant.truth().unwrap().z_mm);
        if step.stage == Stage::Done {
            break;
        }
        plant.write(now_s, &step.setpoint(State::default(), State::default()));
    }
    (alarm, deepest_mm)
}

/// A slip that no check of the file alone can see: 1 µm a count for a scale of 0.1 µm.
#[test]
fn a_scale_of_another_step_raises_an_alarm_above_the_work_piece() {
    let surface_mm = -Machine::reference().spec().tap.surface_below_r_mm;
    for speed_rpm in [1000.0, 3000.0, 7000.0] {
        let (alarm, deepest_mm) = tap_with_coarse_scale(speed_rpm);
        assert!(alarm.is_some() && deepest_mm > surface_mm, "S{speed_rpm}: alarm {alarm:?}, tip at {deepest_mm} mm");
    }
}
