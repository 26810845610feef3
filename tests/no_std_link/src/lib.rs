//! A kernel without std, without a heap and without unwinding that taps a hole.

#![no_std]

use rigidtap::control::coupling::Line;
use rigidtap::control::cycle::{CyclePlan, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::port::{CountUnwrapper, Feedback};
use rigidtap::control::profile::verify::{Limits, Task, verify};
use rigidtap::control::profile::{Profile, StrokeRequest};
use rigidtap::control::sync::{Adaptation, Compensation, ErrorBand, Mode, Settings, Stage, Synchronizer};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}

/// Plans a hole and steps through it, with encoders that `read` supplies; the periods it took, or a negative number.
///
/// What is chosen by the caller cannot be folded away by the compiler: every law and mode stays in the library.
#[unsafe(no_mangle)]
pub extern "C" fn rigidtap_tap_hole(
    depth_mm: f64,
    pitch_mm: f64,
    speed_rpm: f64,
    law: u32,
    following: bool,
    compensation: u32,
    read: extern "C" fn(spindle_rev: f64, z_mm: f64, spindle_counts: &mut i64, z_counts: &mut i64),
) -> i64 {
    let Ok(machine) = Machine::reference().with(|spec| spec.law.torque_curve.start_rpm = 0.0) else { return -1 };
    let law = match law {
        0 => Law::TorqueCurve,
        1 => Law::SCurve,
        2 => Law::TrapezoidJerk,
        3 => Law::ImprovedSCurve,
        _ => Law::Linear,
    };
    let hole = TapCycle::right_hand(0.0, -depth_mm, pitch_mm, speed_rpm);
    let Ok(plan) = CyclePlan::new(hole, &machine, law) else { return -2 };
    let settings = Settings {
        mode: if following { Mode::Following } else { Mode::Commanded },
        compensation: match compensation {
            0 => Compensation::Uncompensated,
            1 => Compensation::Integral,
            _ => Compensation::ModelBased,
        },
        identify: true,
        learn: true,
        supervise: true,
    };
    let mut synchronizer = Synchronizer::new(plan, settings, 0.0);
    let mut adaptation = Adaptation::new(&machine);
    let mut feedback = Feedback::default();
    let mut period = 0;
    loop {
        let step = synchronizer.step(period as f64 * machine.spec().control.period_s, &feedback, &mut adaptation);
        if step.alarm.is_some() {
            return -3;
        }
        if step.stage == Stage::Done {
            return period;
        }
        read(step.spindle.position, step.z.position, &mut feedback.spindle_counts, &mut feedback.z_counts);
        period += 1;
    }
}

/// The rest of the core: positioning, changes of speed, the bound, the checks. A number, so that nothing is dropped.
#[unsafe(no_mangle)]
pub extern "C" fn rigidtap_position(distance: f64, command: f64, end: f64, share: f64, bits: u32, raw: u64) -> f64 {
    let Ok(machine) = Machine::reference().with_motor_share(share) else { return f64::NAN };
    let mut findings = 0.0;
    machine.warnings(&mut |_| findings += 1.0);
    let stroke = StrokeRequest { distance, command };
    let plans = [
        machine.s_curve().plan_between(stroke, 0.0, end).unwrap_or_default(),
        machine.torque_curve().change_speed(command, end).unwrap_or_default(),
        Profile::default(),
    ];
    let line = Line::new([0.0, 0.0, 0.0], [distance, command, end]);
    let limits = Limits {
        velocity: line.path_limit([command; 3]),
        acceleration: &|state| machine.motor().acceleration_rev_per_s2(state.velocity, share),
        jerk: f64::INFINITY,
        continuous_acceleration: false,
    };
    let mut band = ErrorBand::default();
    for plan in &plans {
        let task = Task { distance, end_velocity: end, ..Task::default() };
        findings += f64::from(verify(plan, &task, &limits).is_err());
        let path = plan.at(share);
        line.follow(&path).iter().for_each(|axis| band.add(axis.position));
    }
    let count = CountUnwrapper::new(bits).map_or(0, |mut encoder| encoder.unwrap_count(raw));
    findings + band.rms() + count as f64 + machine.motor().fastest_stroke(distance, command, share).duration_s
}
