//! Held against LinuxCNC's `rs274`, program by program: the path, and each hole's position, planes, return level, pitch,
//! hand and dwell; or that both refuse it. Differences stand in `differences.txt` with their reasons; there is no other.
//!
//! Where `rs274` (Debian: linuxcnc-uspace) is missing the test says so and passes, unless `RIGIDTAP_RS274=1` asks for it.

mod canon;

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use self::canon::{Hole, Run};
use rigidtap::control::cycle::Hand;
use rigidtap::gcode::{CommandKind, Dialect, Options, SpindleCommand, interpret};

/// `rs274` prints four decimals: in mm half of the last one, in inches 25.4 times that.
const PRINTED_MM: f64 = 0.5e-4 * 25.4 + 1e-9;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/gcode/rs274")
}

fn programs() -> Vec<PathBuf> {
    let mut found: Vec<_> =
        fs::read_dir(folder().join("programs")).expect("folder").map(|entry| entry.expect("entry").path()).collect();
    found.sort();
    found
}

/// Programs that differ, with the reason.
fn differences() -> BTreeMap<String, String> {
    let table = fs::read_to_string(folder().join("differences.txt")).expect("table");
    let row =
        |line: &str| line.split_once(':').map(|(name, reason)| (name.trim().to_owned(), reason.trim().to_owned()));
    table.lines().filter(|line| !line.starts_with('#')).filter_map(row).collect()
}

/// The program as this interpreter has it, from the machine's zero, where `rs274` starts.
fn own(path: &Path) -> Result<Run, String> {
    let options = Options { start_mm: [0.0; 3], ..Options::default() };
    let program = interpret(&fs::read(path).expect("program"), &Dialect::LINUXCNC, options);
    if let Some(error) = program.diagnostics.as_slice().iter().find(|found| found.is_error()) {
        return Err(format!("refused here: {}:{} {}", error.line, error.column, error.message()));
    }
    let mut run = Run::default();
    for command in &program.commands {
        match command.kind {
            CommandKind::Rapid { to_mm } | CommandKind::Feed { to_mm, .. } => run.go(to_mm),
            CommandKind::Dwell { dwell_s } => run.dwells_s.push(dwell_s),
            CommandKind::Tap(hole) => {
                let [x_mm, y_mm, z_mm] = run.at_mm();
                let height_mm = z_mm.max(hole.r_plane_mm);
                run.go([x_mm, y_mm, height_mm]);
                run.go([hole.x_mm, hole.y_mm, height_mm]);
                for level_mm in [hole.r_plane_mm, hole.bottom_mm, hole.return_mm] {
                    run.go([hole.x_mm, hole.y_mm, level_mm]);
                }
                run.holes.push(Hole {
                    x_mm: hole.x_mm,
                    y_mm: hole.y_mm,
                    r_plane_mm: hole.r_plane_mm,
                    bottom_mm: hole.bottom_mm,
                    return_mm: hole.return_mm,
                    pitch_mm: hole.pitch_mm,
                    right: hole.hand == Hand::Right,
                    dwell_s: hole.dwell_s,
                });
            }
            CommandKind::Spindle(SpindleCommand::On { .. } | SpindleCommand::Off) | CommandKind::End => {}
        }
    }
    Ok(run)
}

/// The same by `rs274`; the error that it ends with.
fn theirs(path: &Path) -> Result<Run, String> {
    // It writes a file of parameters where it stands.
    let folder = tempfile::tempdir().expect("folder");
    fs::write(folder.path().join("tools"), "T1 P1 Z0\nT2 P2 Z0\n").expect("tool table");
    let files = ["-t", "tools", "-v", "parameters", "-g"];
    let output = Command::new("rs274").args(files).arg(path).current_dir(folder.path()).output().expect("runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    match output.status.success() {
        true => Ok(canon::read(&text)),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    }
}

#[test]
fn linuxcnc_agrees() {
    if Command::new("rs274").arg("-g").arg("/dev/null").output().is_err() {
        assert!(
            std::env::var_os("RIGIDTAP_RS274").is_none_or(|asked| asked != "1"),
            "rs274 is missing: apt-get install linuxcnc-uspace"
        );
        // Not by println, which the test runner keeps to itself.
        writeln!(std::io::stderr(), "NOT RUN: rs274 is missing (Debian: linuxcnc-uspace)").expect("stderr");
        return;
    }
    let differences = differences();
    let (mut failures, mut agreeing, mut refused) = (String::new(), 0, 0);
    for path in programs() {
        let name = path.file_stem().expect("name").to_string_lossy().into_owned();
        let found = match (own(&path), theirs(&path)) {
            (Err(_), Err(_)) => {
                refused += 1;
                Ok(())
            }
            (Ok(own), Ok(theirs)) => own.compare(&theirs, PRINTED_MM),
            (Err(refused), Ok(_)) => Err(refused),
            (Ok(_), Err(refused)) => Err(format!("refused by rs274: {refused}")),
        };
        match (found, differences.get(&name)) {
            (Ok(()), None) => agreeing += 1,
            (Ok(()), Some(reason)) => failures += &format!("{name} agrees, and the table says: {reason}\n"),
            (Err(_), Some(_)) => {}
            (Err(difference), None) => failures += &format!("{name}: {difference}\n"),
        }
    }
    assert!(failures.is_empty(), "{failures}");
    assert!(agreeing >= 100, "only {agreeing}");
    assert!(refused >= 25, "only {refused} refused by both");
}
