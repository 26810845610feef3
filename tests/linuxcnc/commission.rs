//! A machine from zero, as the guide's page has it: each step by a command that a user gives.

use std::path::Path;
use std::process::Command;

use rigidtap::config::MachineFile;
use rigidtap::sim::Actual;

use super::record::{rows, tapped, worst};
use super::session::{Session, is_done};
use super::table::{BOTTOM_MM, R_MM};

/// What the data sheet does not say, and nobody knows.
fn unknown() -> Actual {
    Actual {
        friction: 1.5,
        backlash_um: Some(4.0),
        inertia: 1.15,
        torque_constant: 0.93,
        z_resonance: 0.9,
        cutting_torque: 1.4,
        ..Actual::default()
    }
}

const HOLES: usize = 20;

/// `rigidtap WORDS` in the session's folder; what it prints.
fn rigidtap(folder: &Path, words: &str) -> String {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rigidtap"));
    let output = command.current_dir(folder).args(words.split_whitespace()).output().expect("it runs");
    let [said, complaint] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    assert!(output.status.success(), "{words}: {complaint}\n{said}");
    said
}

/// Greatest true e(k) of the holes from the third on, µm, and what `monitor` says of their recording.
pub(crate) fn commissioned(session: &Session) -> (f64, String) {
    let folder = session.folder();
    // 1. The data sheets.
    let sheets = "machine --new --power-kw 6.2832 --rated-rpm 3000 --max-rpm 8000 --inertia-kg-m2 0.004 --rapid-m-per-min 30 \
                  --accel-m-per-s2 10 --scale-um 0.1 --encoder-lines 4096 --quiet";
    session.write("mine.toml", &rigidtap(folder, sheets));
    // The machine itself, in place of metal.
    let sheet =
        MachineFile::read(rigidtap(folder, "machine --machine mine.toml").as_bytes()).expect("it was just written");
    session.write("machine.toml", &MachineFile { actual: unknown(), ..sheet.clone() }.to_toml());
    // 2. The dry cycle, recorded.
    rigidtap(folder, "machine --machine mine.toml --hal machine.hal");
    session.write("dry.ngc", &rigidtap(folder, "tune --machine mine.toml --dry-cycle --dialect linuxcnc"));
    let said = session.log("dry.ngc");
    assert!(is_done(&said), "{said}");
    let (spindle, z) = (&sheet.machine.spec().spindle, &sheet.machine.spec().z_axis);
    let counts = format!("{} {} {}", spindle.encoder_counts_per_rev, z.encoder_counts_per_mm, z.motor_counts_per_mm);
    session.run(&format!("./log_to_csv log.txt {counts} > dry.csv"));
    // 3. The machine as it was measured.
    rigidtap(folder, "tune --machine mine.toml --identify dry.csv --save measured.toml");
    rigidtap(folder, "machine --machine measured.toml --hal machine.hal");
    // 4. Twenty holes, recorded.
    // The spindle stands between holes: by that, encoders alone tell one hole from the next.
    let holes = (0..HOLES).fold("G21 G90 G94 G17 G99\nS7000 M5\nG0 Z10\n".to_owned(), |text, _| {
        text + &format!("G84.2 R{R_MM} Z{BOTTOM_MM} F7000\nG0 Z10\nG4 P0.45\n")
    });
    session.write("holes.ngc", &(holes + "M2\n"));
    let said = session.log("holes.ngc");
    assert!(is_done(&said), "{said}");
    session.run(&format!("./log_to_csv log.txt {counts} > holes.csv"));
    // 5. What the encoders say.
    let monitored = rigidtap(folder, "monitor holes.csv --machine measured.toml --pitch 1");
    let record = std::fs::read_to_string(folder.join("truth.txt")).expect("recorded");
    let tapped = tapped(&rows(&record), R_MM, BOTTOM_MM, 1.0, 1.0);
    assert_eq!(tapped.len(), HOLES, "{said}");
    (worst(&tapped[2..], |hole| hole.error_um), monitored)
}
