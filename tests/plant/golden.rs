//! The nominal plant, bit for bit: what it reads and where it truly is under fixed setpoints, without any control.

use rigidtap::control::cycle::TapCycle;
use rigidtap::control::machine::Machine;
use rigidtap::control::math::poly::State;
use rigidtap::control::port::{Port, Setpoint};
use rigidtap::sim::{Effects, Plant, PlantOptions};
use std::fmt::Write;
use std::path::Path;

/// A hole of 25 mm at pitch 1 under a parabola each way, with one period of rest before and after.
fn setpoint(now_s: f64) -> Setpoint {
    const HALF_S: f64 = 0.22;
    const PEAK_REV_PER_S2: f64 = 25.0 / (HALF_S * HALF_S);
    let part = |since_s: f64| {
        // Up for half of a stroke, down for the other half.
        let fast = State { acceleration: PEAK_REV_PER_S2 * 0.5, ..State::default() };
        if since_s < HALF_S {
            return fast.after(since_s.max(0.0), 0.0);
        }
        let end = State { acceleration: -PEAK_REV_PER_S2 * 0.5, ..fast.after(HALF_S, 0.0) };
        end.after((since_s - HALF_S).min(HALF_S), 0.0)
    };
    let (inwards, outwards) = (part(now_s - 0.05), part(now_s - 0.05 - 2.0 * HALF_S));
    let spindle = State {
        position: inwards.position - outwards.position,
        velocity: inwards.velocity - outwards.velocity,
        acceleration: 0.0,
        jerk: 0.0,
    };
    let z = State { position: -spindle.position, velocity: -spindle.velocity, ..State::default() };
    Setpoint { spindle, z, spindle_torque_nm: 0.3, z_force_n: -100.0, ..Setpoint::default() }
}

fn run(name: &str, options: &PlantOptions, text: &mut String) {
    let machine = Machine::reference();
    let mut plant = Plant::new(&machine, options);
    plant.begin_hole(&TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0));
    writeln!(text, "# {name}").unwrap();
    for period in 0..1000_u32 {
        let now_s = f64::from(period) * 0.001;
        let read = plant.read(now_s);
        if period % 20 == 0 {
            let truth = plant.truth().expect("a simulation knows");
            writeln!(
                text,
                "{period} {} {} {} {:?} {:?} {:?} {:?} {:?} {:?} {:?} {}",
                read.spindle_counts,
                read.z_counts,
                read.z_motor_counts.expect("simulated"),
                read.spindle_torque_nm.expect("reported"),
                read.z_force_n.expect("reported"),
                truth.spindle_rev,
                truth.z_mm,
                truth.spindle_rpm,
                truth.spindle_torque_nm,
                truth.z_force_n,
                read.torque_saturated(),
            )
            .unwrap();
        }
        plant.write(now_s, &setpoint(now_s));
    }
}

/// `BLESS=1` writes the file anew. It changes only where the standard plant is meant to change.
#[test]
fn the_nominal_plant_keeps_its_bits() {
    let mut text = "# period, counts of spindle, Z and Z's motor, reported torque and force; true spindle rev, tip mm, rpm, N·m, N; \
                    saturated\n"
        .to_owned();
    run("every effect, seed 1", &PlantOptions::default(), &mut text);
    run("every effect, seed 2", &PlantOptions { seed: 2, ..PlantOptions::default() }, &mut text);
    run("no effect", &PlantOptions { effects: Effects::IDEAL, ..PlantOptions::default() }, &mut text);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/plant/nominal.txt");
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let kept = std::fs::read_to_string(&path).unwrap_or_default();
    for (line, (kept, found)) in (1..).zip(kept.lines().zip(text.lines())) {
        assert_eq!(kept, found, "line {line} of {}", path.display());
    }
    assert_eq!(kept.len(), text.len());
}
