//! The controlled stop on the simulated machine with every effect.

use rigidtap::control::cycle::{CyclePlan, Interrupted, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::{Port, Setpoint};
use rigidtap::control::sync::{Compensation, ErrorBand, Settings, Stage};
use rigidtap::control::tapping::Tapping;
use rigidtap::control::units::um_from_mm;
use rigidtap::sim::{Axis, AxisFault, Fault, Injection, Plant, PlantOptions};

/// What the hole's e(k) spanned in µm, and whether it was held on the way.
fn stopped(speed_rpm: f64, stop_at: u32) -> (f64, bool) {
    let machine = Machine::reference();
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, speed_rpm);
    let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).expect("feasible");
    let mut plant = Plant::new(&machine, &PlantOptions::default());
    plant.begin_hole(&hole);
    let mut tapping = Tapping::new(&machine);
    tapping.start(plan, Settings::default(), 0.0, 0.0, 0.0).expect("a number");
    let (mut band, mut held, mut periods) = (ErrorBand::default(), false, 0);
    for k in 0..4000 {
        let now_s = f64::from(k) * 0.001;
        let feedback = plant.read(now_s);
        let step = tapping.step(now_s, &feedback).expect("under way");
        assert_eq!(step.alarm, None);
        if let Stage::Synchronous(_, interrupted) = step.stage {
            band.add(um_from_mm(step.error_mm));
            periods += 1;
            if periods == stop_at {
                tapping.stop(now_s);
            }
            held |= interrupted == Some(Interrupted::Holding);
            if periods == stop_at + 500 {
                tapping.retract(now_s).expect("stopped");
            }
        }
        if step.stage == Stage::Done {
            return (band.peak_to_peak(), held);
        }
        plant.write(now_s, &Setpoint { spindle: step.spindle, z: step.z, ..Setpoint::default() });
    }
    panic!("S{speed_rpm}, stopped in period {stop_at}: the tap did not come back");
}

#[test]
fn a_stop_at_any_moment_keeps_the_thread() {
    for speed_rpm in [1000.0, 3000.0, 5000.0, 7000.0] {
        for step in 0..12 {
            let (error_um, held) = stopped(speed_rpm, 10 + 70 * step);
            assert!(held && error_um <= 50.0, "S{speed_rpm}, step {step}: {error_um} µm, held: {held}");
        }
    }
}

/// A spindle that coasts takes the tap deeper than Z may go: the thread is given up there, and spindle and Z rest off the helix.
/// Acknowledged, the tap comes back all the same.
#[test]
fn a_tap_that_rests_off_its_helix_comes_back() {
    // The papers' integrator winds up where Z may not follow.
    for compensation in [Compensation::Uncompensated, Compensation::ModelBased] {
        let machine = Machine::reference();
        let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 3000.0);
        let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).expect("feasible");
        // Shortly before it brakes at the bottom.
        let trip =
            Injection { duration_s: Some(10.0), ..Injection::new(Fault::Axis(Axis::Spindle, AxisFault::Trip), 0.5) };
        let options = PlantOptions { faults: [Some(trip), None, None, None], ..PlantOptions::default() };
        let mut plant = Plant::new(&machine, &options);
        plant.begin_hole(&hole);
        let mut tapping = Tapping::new(&machine);
        let settings = Settings { compensation, ..Settings::default() };
        tapping.start(plan, settings, 0.0, 0.0, 0.0).expect("a number");
        let (mut left_um, mut done) = (None, false);
        for k in 0..20_000 {
            let now_s = f64::from(k) * 0.001;
            let feedback = plant.read(now_s);
            let step = tapping.step(now_s, &feedback).expect("under way");
            if step.stage == Stage::Done {
                done = true;
                break;
            }
            // The drive is ready again.
            if k > 10_900 && left_um.is_none() {
                assert_eq!((step.stage, step.alarm.map(|alarm| alarm.code())), (Stage::Held, Some(105)));
                left_um = Some(um_from_mm(step.error_mm));
                assert!(tapping.acknowledge());
            }
            if k == 11_200 {
                tapping.retract(now_s).expect("held");
            }
            assert!(left_um.is_none() || step.alarm.is_none() || k == 10_901, "{k}: {:?}", step.alarm);
            plant.write(now_s, &Setpoint { spindle: step.spindle, z: step.z, ..Setpoint::default() });
        }
        let left_um = left_um.expect("held");
        assert!(done && left_um < -1000.0, "{}: {left_um} µm", compensation.name());
    }
}
