//! A host that taps one hole: the loop that a CNC kernel runs, here on a machine that follows at once.
//!
//! `cargo run --example host_loop`
#![allow(clippy::print_stdout, reason = "an example prints what it found")]

use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::Feedback;
use rigidtap::control::sync::{Compensation, Settings, Stage};
use rigidtap::control::tapping::Tapping;

/// Interpolation period of the host.
const PERIOD_S: f64 = 0.001;
/// Counts of the reference machine's encoders.
const COUNTS_PER_REV: f64 = 16_384.0;
const COUNTS_PER_MM: f64 = 10_000.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let machine = Machine::reference();
    // M6: R plane 2 mm above the surface, 10 mm deep, pitch 1 mm, 3000 rpm.
    let hole = TapCycle::right_hand(2.0, -10.0, 1.0, 3000.0);

    // Outside the period: the plan either holds the machine's limits, or is refused.
    let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).map_err(|error| format!("{error:?}"))?;
    // These drives take no torque and no force beside their setpoints.
    let settings = Settings { compensation: Compensation::Uncompensated, ..Settings::default() };
    // M03 left the spindle turning at 1500 rpm; it is brought to rest first.
    let mut tapping = Tapping::new(&machine);
    tapping.start(plan, settings, 0.0, 0.0, 1500.0).map_err(|error| format!("{error:?}"))?;

    // Inside it: feedback in, setpoints out.
    let mut feedback = Feedback { z_counts: (2.0 * COUNTS_PER_MM) as i64, ..Feedback::default() };
    let (mut deepest_mm, mut greatest_error_um) = (f64::INFINITY, 0.0_f64);
    for period in 0_u32.. {
        let now_s = f64::from(period) * PERIOD_S;
        let step = tapping.step(now_s, &feedback).ok_or("no hole is under way")?;
        if let Some(alarm) = step.alarm {
            return Err(alarm.into());
        }
        if step.stage == Stage::Done {
            println!("{now_s:.3} s, {deepest_mm:.3} mm deep, |e(k)| up to {greatest_error_um:.2} µm");
            break;
        }
        deepest_mm = deepest_mm.min(step.z.position);
        greatest_error_um = greatest_error_um.max(step.error_mm.abs() * 1e3);
        // In place of the drives: encoders that read what was commanded.
        feedback.spindle_counts = (step.spindle.position * COUNTS_PER_REV).round() as i64;
        feedback.z_counts = (step.z.position * COUNTS_PER_MM).round() as i64;
    }
    Ok(())
}
