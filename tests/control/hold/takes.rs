//! Drives that take less of a setpoint than all of it: their own loops are made to give what they are not told.

use rigidtap::config::MachineFile;
use rigidtap::control::machine::{Law, Takes};
use rigidtap::control::model::cutting::Material;

use super::bench::Bench;

const SEEDS: u64 = 4;

fn bench(speed_rpm: f64, spindle_takes: Takes, z_takes: Takes) -> Bench {
    let mut bench = Bench::of(Material::AlSi, speed_rpm);
    let machine = bench.machine.with(|spec| (spec.drive.spindle_takes, spec.drive.z_takes) = (spindle_takes, z_takes));
    bench.machine = machine.unwrap();
    bench
}

#[test]
fn threads_are_held_whatever_the_drives_take() {
    use Takes::{Position, Torque, Velocity};
    for (spindle_takes, z_takes) in [
        (Position, Position),
        (Velocity, Velocity),
        (Torque, Position),
        (Position, Torque),
        (Velocity, Position),
        (Torque, Velocity),
    ] {
        for speed_rpm in [7000.0, 3000.0] {
            for seed in 1..=SEEDS {
                let worst_um = bench(speed_rpm, spindle_takes, z_takes).seeded(seed).first_um();
                assert!(worst_um <= 6.0, "{spindle_takes:?} {z_takes:?} S{speed_rpm} seed {seed}: {worst_um} µm");
            }
        }
    }
}

/// Learning goes through the same inverse: what it corrects, the drive does.
#[test]
fn learning_goes_on_through_the_inverse() {
    let bench = bench(7000.0, Takes::Position, Takes::Position).with_sync(|sync| sync.learn = true);
    for seed in 1..=SEEDS {
        let (holes, _) = bench.seeded(seed).tap(10);
        let worst_um = holes[9].worst_um();
        assert!(worst_um <= 2.5, "seed {seed}: {worst_um} µm");
    }
}

/// A frequency converter's drive has a slow speed loop and no position loop. Its lag is no jam, and hole after hole is tapped; what it
/// costs is several times what a servo spindle leaves.
#[test]
fn a_spindle_on_a_frequency_converter_taps_hole_after_hole() {
    let file = MachineFile::read(include_bytes!("../../../gcode/machines/retrofit-vfd.toml")).unwrap();
    let mut bench = Bench::of(Material::AlSi, 1000.0);
    (bench.machine, bench.law) = (file.machine, Law::TorqueCurve);
    // Its fault would end the test.
    for hole in bench.tap(3).0 {
        let measured_um = hole.error_um.peak_to_peak();
        assert!(
            measured_um <= 35.0 && hole.bottom_overshoot_um <= 20.0,
            "{measured_um} µm, {}",
            hole.bottom_overshoot_um
        );
    }
}
