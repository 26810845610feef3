//! What a user of the command line sees: exit codes, messages with their place, and files that are whole or untouched.

mod advise;
mod answers;
mod bad_input;
mod dialects;
#[cfg(all(feature = "fmi", unix))]
mod fmi;
mod good_runs;
mod help;
mod hostile;
mod learned;
mod power_loss;
mod report;
mod schema;
mod streaming;
mod sweep;
#[cfg(unix)]
mod terminal;
mod tune;

use std::path::{Path, PathBuf};
use std::process::Output;

/// A motor of half the torque under the reference machine's bands: the spindle never comes to rest in time.
const WEAK: &[u8] = b"\
[spindle]
torque_curve = [[0, 10], [3000, 10], [8000, 3.75]]
[law.torque_curve]
bands = [
  { to_rpm = 3000, accel_s = 0.0785, decel_s = 0.0785 },
  { to_rpm = 4200, accel_s = 0.0440, decel_s = 0.0440 },
  { to_rpm = 5600, accel_s = 0.0684, decel_s = 0.0684 },
  { to_rpm = 8000, accel_s = 0.1675, decel_s = 0.1675 },
]
";

/// The binary in the project's folder, so that paths in messages are as a user would type them.
fn rigidtap(arguments: &[&str]) -> Output {
    with_stdin(arguments, b"")
}

fn with_stdin(arguments: &[&str], stdin: &[u8]) -> Output {
    assert_cmd::Command::cargo_bin("rigidtap")
        .unwrap()
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .write_stdin(stdin)
        .output()
        .unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("ends by itself")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

fn json(output: &Output) -> serde_json::Value {
    assert_eq!(stderr(output), "", "nothing beside the JSON");
    serde_json::from_str(&stdout(output)).unwrap()
}

/// A file of this name and content in a folder of its own.
fn file(folder: &tempfile::TempDir, name: &str, content: &[u8]) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, content).unwrap();
    path
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// One hole of 5 mm, tapped quickly.
const ONE_HOLE: &[u8] = b"%\nG90 M03 S1000\nG0 X0 Y0 Z10\nG81 R3 Z-2 F1000\nG80\nM30\n%\n";
