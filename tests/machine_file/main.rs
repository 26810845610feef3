//! What a user sees of machine files: every message once, the samples, and the file that `machine` prints.
//!
//! Each `tests/machine_files/NAME.toml` is read, and what it gives must be `NAME.txt`. After a change of wording, run
//! with `BLESS=1` to write the expected texts anew, and read the difference.

mod slips;

use std::path::{Path, PathBuf};

use rigidtap::config::{ConfigDiagnostic, MachineFile};
use rigidtap::gcode::Severity;

/// Files of a folder with an extension, in order of their names.
fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = entries.filter(|path| path.extension().is_some_and(|found| found == extension)).collect();
    files.sort();
    assert!(!files.is_empty());
    files
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap().to_string_lossy().into_owned()
}

fn lines(diagnostics: &[ConfigDiagnostic], name: &str) -> String {
    diagnostics.iter().map(|diagnostic| format!("{}\n", diagnostic.in_file(name))).collect()
}

/// Holds a text against a golden file.
fn assert_golden(path: &Path, text: &str) {
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(path, text).unwrap();
    }
    let expected = std::fs::read_to_string(path).unwrap_or_default();
    assert!(expected == text, "{} differs, found:\n{text}\nexpected:\n{expected}", path.display());
}

#[test]
fn every_message_is_as_expected() {
    for path in files("tests/machine_files", "toml") {
        let found = match MachineFile::read(&std::fs::read(&path).unwrap()) {
            Ok(file) => lines(&file.warnings, &file_name(&path)),
            Err(faults) => lines(&faults, &file_name(&path)),
        };
        assert_golden(&path.with_extension("txt"), &found);
    }
}

#[test]
fn warnings_do_not_reject() {
    let file = MachineFile::read(include_bytes!("../machine_files/warnings.toml")).unwrap();
    assert!(file.warnings.iter().all(|warning| warning.severity() == Severity::Warning));
    assert_eq!(file.machine.spec().spindle.max_rpm, 7900.0);
}

#[test]
fn every_sample_machine_reads_without_warning_and_writes_back() {
    for path in files("gcode/machines", "toml") {
        let name = file_name(&path);
        let file = MachineFile::read(&std::fs::read(&path).unwrap())
            .unwrap_or_else(|faults| panic!("{}", lines(&faults, &name)));
        assert_eq!(lines(&file.warnings, &name), "");
        assert_eq!(MachineFile::read(file.to_toml().as_bytes()).unwrap(), file, "{name}");
    }
}

#[test]
fn the_reference_machine_is_among_the_samples() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("gcode/machines/reference.toml");
    assert_golden(&path, &MachineFile::reference().to_toml());
}

#[test]
fn a_changed_machine_says_what_it_was_changed_from() {
    let file = MachineFile::read(include_bytes!("../../gcode/machines/old-belt.toml")).unwrap();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/machine_files/old-belt.written.txt");
    assert_golden(&path, &file.to_toml());
}

#[test]
fn every_form_of_a_range_reads_back() {
    let file = MachineFile::read(include_bytes!("../machine_files/hard_good.toml")).unwrap();
    assert_eq!(file.warnings, []);
    let written = file.to_toml();
    assert_eq!(MachineFile::read(written.as_bytes()).unwrap(), file);
    for line in [
        "spindle_takes = \"speed\"",
        "z_second_resonance_hz = 220",
        "# backlash = [0, 2.5]",
        "backlash_um = [0, 5]",
        "friction = { any = [0.5, 0.7], ratio = 0.2 }",
        "z_friction_model = { one_of = [\"lugre\", \"stick\"] }",
        "screw_lead_mm = { one_of = [5, 10, 20] }",
    ] {
        assert!(written.lines().any(|found| found.starts_with(line)), "{line} in\n{written}");
    }
}

#[test]
fn an_empty_file_is_the_reference_machine() {
    for empty in [&b""[..], b"\n", b"# nothing\n", b"\xEF\xBB\xBF[spindle]\r\n"] {
        assert_eq!(MachineFile::read(empty).unwrap(), MachineFile::reference());
    }
}

#[test]
fn what_is_no_text_is_refused_with_its_place() {
    let refused = |bytes: &[u8]| lines(&MachineFile::read(bytes).unwrap_err(), "m");
    assert_eq!(
        refused(b"[spindle]\nmax_rpm = 8000 \xFF\xFE"),
        "m:2:16: error: byte 0xFF is not UTF-8: expected a text file\n  hint: start from the output of `rigidtap machine`\n"
    );
    assert_eq!(
        refused(&vec![b' '; 100_000_000]),
        "m:1:1: error: the file has 100000000 bytes: expected a machine file, at most 1048576 bytes\n  \
         hint: start from the output of `rigidtap machine`\n"
    );
    assert!(refused(b"\x7FELF\x02\x01\x01\0\0\0").starts_with("m:1:1: error: not TOML: "));
    assert!(refused("[".repeat(100_000).as_bytes()).starts_with("m:1:"));
    assert!(refused(format!("x = {}", "[".repeat(100_000)).as_bytes()).starts_with("m:1:"));
}

#[test]
fn a_file_of_another_kind_does_not_flood() {
    let text: String = (0..10_000).map(|index| format!("k{index} = 1\n")).collect();
    let faults = MachineFile::read(text.as_bytes()).unwrap_err();
    assert_eq!(faults.len(), 51);
    assert_eq!(faults[50].message(), "9950 further faults are not shown");
}
