//! The controlled stop on the simulated machine with every effect.

use rigidtap::control::cycle::{CyclePlan, Interrupted, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::{Port, Setpoint};
use rigidtap::control::sync::{ErrorBand, Settings, Stage};
use rigidtap::control::tapping::Tapping;
use rigidtap::control::units::um_from_mm;
use rigidtap::sim::{Plant, PlantOptions};

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
