//! The C interface: the header under C and C++ compilers, a host in C against the library a kernel links, and the heap.
#![allow(unsafe_code, reason = "a host in C hands over bare pointers, too")]

mod cia402;
mod full;
mod machines;
mod numbers;

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use assert_no_alloc::{AllocDisabler, assert_no_alloc};
use rigidtap::capi::{
    RigidtapFeedback, RigidtapHole, RigidtapMachine, RigidtapMachineData, RigidtapSetpoint, RigidtapStatus,
    RigidtapTap, rigidtap_machine_init, rigidtap_machine_reference, rigidtap_tap_plan, rigidtap_tap_retract,
    rigidtap_tap_start, rigidtap_tap_step, rigidtap_tap_stop,
};

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn run(command: &mut Command) -> String {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = [&output.stdout[..], &output.stderr[..]].concat();
    let said = String::from_utf8_lossy(&said).into_owned();
    assert!(output.status.success(), "{command:?}\n{said}");
    said
}

/// A static library as its header tells to build it: of the control, or with the simulated machine beside it.
fn library(features: &str) -> PathBuf {
    let tmp = Path::new(env!("CARGO_TARGET_TMPDIR"));
    // The one with the simulated machine is what the component of LinuxCNC is built with, too.
    let target = if features == "capi" { tmp.join("capi") } else { tmp.with_file_name("sim") };
    run(Command::new(env!("CARGO"))
        .current_dir(root())
        .args(["rustc", "--quiet", "--release", "--lib", "--no-default-features", "--features", features])
        .args(["--crate-type", "staticlib", "--config", "profile.release.panic=\"abort\"", "--target-dir"])
        .arg(&target));
    target.join("release/librigidtap.a")
}

/// What a program in C prints that is built as C and as C++; each compiler is asked for.
fn under_each_compiler(source: &str, features: &str, check: impl Fn(&str, &str)) {
    let library = library(features);
    for (compiler, standard) in [("gcc", "-std=c99"), ("g++", "-std=c++11")] {
        if Command::new(compiler).arg("--version").output().is_err() {
            let _ = std::io::Write::write_all(
                &mut std::io::stderr(),
                format!("capi: not run under {compiler}, which is not installed\n").as_bytes(),
            );
            continue;
        }
        let name = source.replace(['/', '.'], "-");
        let host = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("capi-{name}-{compiler}"));
        let language = if compiler == "g++" { "c++" } else { "c" };
        run(Command::new(compiler)
            .args([standard, "-Wall", "-Wextra", "-Werror", "-pedantic", "-x", language])
            .arg(root().join(source))
            .args(["-x", "none", "-Wl,--gc-sections", "-I"])
            .arg(root().join("src/capi"))
            .arg("-I")
            .arg(root().join("src/capi/sim"))
            .arg(&library)
            .args(["-lm", "-lpthread", "-ldl", "-o"])
            .arg(&host));
        check(compiler, &run(&mut Command::new(&host)));
    }
}

#[test]
fn a_host_in_c_and_in_cpp_taps_stops_and_retracts() {
    under_each_compiler("tests/capi/host.c", "capi", |compiler, said| assert_eq!(said, "tapped\n", "{compiler}"));
}

/// The guide's example: four holes on the simulated machine, at four speeds.
#[test]
fn the_guides_host_in_c_holds_the_thread_on_the_simulated_machine() {
    under_each_compiler("src/guide/examples/host.c", "capi,std", |compiler, said| {
        let holes: Vec<Vec<&str>> = said.lines().map(|line| line.split_whitespace().collect()).collect();
        assert_eq!(holes.len(), 4, "{compiler}: {said}");
        for (words, speed) in holes.iter().zip(["S1000:", "S3000:", "S5000:", "S7000:"]) {
            let [rpm, seconds, _, _, error_um, _, _, alarm] = words[..] else { panic!("{compiler}: {said}") };
            assert_eq!((rpm, alarm), (speed, "0"), "{compiler}: {said}");
            let (seconds, error_um): (f64, f64) = (seconds.parse().unwrap(), error_um.parse().unwrap());
            assert!((0.7..4.0).contains(&seconds) && error_um < 5.0, "{compiler}: {said}");
        }
    });
}

/// Zeroed memory is what a host starts from.
fn zeroed<T>() -> Box<T> {
    // SAFETY: every type of the interface is plain numbers, for which zero is a value.
    unsafe { Box::new(std::mem::zeroed()) }
}

#[test]
fn no_call_touches_the_heap() {
    let (mut machine, mut tap): (Box<RigidtapMachine>, Box<RigidtapTap>) = (zeroed(), zeroed());
    let (mut data, mut hole): (Box<RigidtapMachineData>, Box<RigidtapHole>) = (zeroed(), zeroed());
    let mut setpoint = RigidtapSetpoint::default();
    let none = std::ptr::null_mut();
    (hole.bottom_mm, hole.pitch_mm, hole.speed_rpm, hole.peck_mm) = (-20.0, 1.25, 4000.0, 6.0);
    let periods = assert_no_alloc(|| {
        // SAFETY: every pointer is of a live value of its own.
        unsafe {
            assert_eq!(rigidtap_machine_reference(&raw mut *data), RigidtapStatus::Ok);
            assert_eq!(rigidtap_machine_init(&raw mut *machine, &raw const *data, none), RigidtapStatus::Ok);
            assert_eq!(
                rigidtap_tap_plan(&raw mut *tap, &raw const *machine, &raw const *hole, none),
                RigidtapStatus::Ok
            );
            assert_eq!(rigidtap_tap_start(&raw mut *tap, 0.0, 0, 2000.0, none), RigidtapStatus::Ok);
            let mut feedback = RigidtapFeedback::default();
            let mut period = 0;
            while setpoint.stage != 6 && period < 10_000 {
                let now_s = f64::from(period) * 0.001;
                if period == 600 {
                    assert_eq!(rigidtap_tap_stop(&raw mut *tap, now_s), RigidtapStatus::Ok);
                }
                if period == 900 {
                    assert_eq!(rigidtap_tap_retract(&raw mut *tap, now_s), RigidtapStatus::Ok);
                }
                let status = rigidtap_tap_step(&raw mut *tap, now_s, &raw const feedback, &raw mut setpoint, none);
                assert_eq!(status, RigidtapStatus::Ok);
                feedback.spindle_counts = (setpoint.spindle.position * 16_384.0).round() as i64;
                feedback.z_counts = (setpoint.z.position * 10_000.0).round() as i64;
                period += 1;
            }
            period
        }
    });
    assert!((901..3000).contains(&periods), "{periods} periods");
}
