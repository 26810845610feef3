//! The C interface: the header under C and C++ compilers, a host in C against the library a kernel links, and the heap.
#![allow(unsafe_code, reason = "a host in C hands over bare pointers, too")]

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

/// The static library as the header tells to build it.
fn library() -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("capi");
    run(Command::new(env!("CARGO"))
        .current_dir(root())
        .args(["rustc", "--quiet", "--release", "--lib", "--no-default-features", "--features", "capi"])
        .args(["--crate-type", "staticlib", "--config", "profile.release.panic=\"abort\"", "--target-dir"])
        .arg(&target));
    target.join("release/librigidtap.a")
}

/// What a program in C prints that is built as C and as C++; each compiler is asked for.
fn under_each_compiler(source: &str, check: impl Fn(&str, &str)) {
    let library = library();
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
            .arg(&library)
            .args(["-lm", "-o"])
            .arg(&host));
        check(compiler, &run(&mut Command::new(&host)));
    }
}

#[test]
fn a_host_in_c_and_in_cpp_taps_stops_and_retracts() {
    under_each_compiler("tests/capi/host.c", |compiler, said| assert_eq!(said, "tapped\n", "{compiler}"));
}

/// The guide's example: two holes, each in the time of its plan, on axes that follow exactly.
#[test]
fn the_guides_host_in_c_taps_two_holes() {
    under_each_compiler("src/guide/examples/host.c", |compiler, said| {
        let holes: Vec<_> = said.lines().map(|line| line.split([' ', ':']).collect::<Vec<_>>()).collect();
        assert_eq!(holes.len(), 2, "{compiler}: {said}");
        for (number, words) in holes.iter().enumerate() {
            let [_, hole, _, seconds, _, _, error_um, ..] = words[..] else { panic!("{compiler}: {said}") };
            assert_eq!(hole, (number + 1).to_string(), "{compiler}: {said}");
            let (seconds, error_um): (f64, f64) = (seconds.parse().unwrap(), error_um.parse().unwrap());
            assert!((0.5..2.0).contains(&seconds) && error_um < 5.0, "{compiler}: {said}");
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
