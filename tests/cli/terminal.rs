//! Tables in a real pseudo-terminal, at the widths that people have.

use std::fs::File;
use std::io::Read as _;
use std::process::Command;

use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};

use super::*;

/// What the program writes on a terminal of so many columns.
fn on_terminal(columns: u16, arguments: &[&str]) -> String {
    let ours = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
    grantpt(&ours).unwrap();
    unlockpt(&ours).unwrap();
    let path = ptsname(&ours, Vec::new()).unwrap();
    let theirs = File::options().read(true).write(true).open(path.to_str().unwrap()).unwrap();
    tcsetwinsize(&theirs, Winsize { ws_row: 40, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 }).unwrap();
    let mut child = Command::new(env!("CARGO_BIN_EXE_rigidtap"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(arguments)
        .stdout(theirs)
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    // Ends with an error once the program has closed its end.
    let mut shown = Vec::new();
    let _ = File::from(ours).read_to_end(&mut shown);
    assert!(child.wait().unwrap().code().is_some_and(|code| code == 0 || code == 3), "{arguments:?}");
    String::from_utf8(shown).unwrap().replace("\r\n", "\n")
}

fn widest(text: &str) -> usize {
    text.lines().map(|line| line.chars().count()).max().unwrap_or(0)
}

/// In place of a recording's path.
const TRACE: &str = "TRACE";

const TABLES: [&[&str]; 12] = [
    &["check", "gcode/m8_grid.ngc", "gcode/inch_quarter_20.ngc", "gcode/dwell.ngc"],
    &["plan", "gcode/left_hand.ngc"],
    &["plan", "--stroke-rev", "25", "--speed-rpm", "7000"],
    &["simulate", "gcode/dwell.ngc"],
    &["simulate", "gcode/dwell.ngc", "--holes", "--compensation", "none"],
    &["simulate", "gcode/s7000.ngc", "--law", "s-curve", "--compensation", "none"],
    &["compare", "gcode/dwell.ngc", "gcode/left_hand.ngc", "--syncs", "commanded,following", "--shares", "0.7,0.8"],
    &["compare", "gcode/dwell.ngc", "--without", "backlash,cutting"],
    &["sweep", "gcode/dwell.ngc", "--runs", "2"],
    &["tune"],
    &["tune", "--identify", TRACE],
    &["monitor", TRACE],
];

#[test]
fn no_line_is_wider_than_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let trace = folder.path().join("t.csv");
    assert_eq!(code(&rigidtap(&["simulate", "gcode/dwell.ngc", "--trace", text(&trace)])), 0);
    for columns in [80, 100, 120] {
        for arguments in TABLES {
            let arguments: Vec<_> =
                arguments.iter().map(|word| if *word == TRACE { text(&trace) } else { word }).collect();
            let shown = on_terminal(columns, &arguments);
            // TOML to paste is no table.
            let report = shown.split_once("\n[").map_or(shown.as_str(), |(before, _)| before);
            assert!(widest(report) <= usize::from(columns), "{columns}: {arguments:?}\n{shown}");
            assert!(report.lines().count() >= 3, "{arguments:?}\n{shown}");
        }
    }
}

#[test]
fn a_wider_terminal_has_more_columns_and_wide_has_all() {
    let shown = |columns: u16, more: &[&str]| on_terminal(columns, &[&["simulate", "gcode/dwell.ngc"], more].concat());
    let headings = |text: &str| text.lines().find(|line| line.starts_with("hole  ")).unwrap().to_owned();
    let (narrow, wider, all) = (shown(80, &[]), shown(120, &[]), shown(80, &["--wide"]));
    assert!(!headings(&narrow).contains("p-p pulses") && headings(&wider).contains("rms µm"), "{narrow}\n{wider}");
    for heading in ["p-p pulses", "following rev", "saturated"] {
        assert!(headings(&all).contains(heading), "{all}");
    }
    // What is left out is named, and in all of them nothing is.
    assert!(narrow.contains("--wide adds: ") && !all.contains("--wide adds"), "{narrow}\n{all}");
}

#[test]
fn without_a_terminal_it_is_80_columns() {
    let piped = stdout(&rigidtap(&["simulate", "gcode/dwell.ngc"]));
    assert_eq!(piped, on_terminal(80, &["simulate", "gcode/dwell.ngc"]));
}
