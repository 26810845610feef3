use super::*;

/// Runs a program from standard input; it has to be rejected.
fn rejected(program: &[u8]) -> String {
    let output = with_stdin(&["check", "-", "--color", "never"], program);
    assert_eq!(code(&output), 1, "{}", stdout(&output));
    stderr(&output)
}

#[test]
fn a_place_for_every_kind_of_bad_program() {
    for (program, place) in [
        (&b""[..], "<stdin>:1:1"),
        (b"\x00\x01\x02\xFF\xFE", "<stdin>:1:1"),
        (b"M03 S1000\nG81 R3 Z-2\nM30", "<stdin>:2:"),
        (b"M03 S1000\nG0 X1e400\nM30", "<stdin>:2:4"),
        (b"M03 S1000\nG0 XNaN\nM30", "<stdin>:2:4"),
        (b"G0 Q5\nM30", "<stdin>:1:4"),
        (b"M03 S1000\nG81 R3 Z-2 F99000\nM30", "<stdin>:2:1"),
        (b"M03 S9000\nM30", "<stdin>:1:1"),
        (b"M03 S100\nG81 R3 Z-2 F5000\nM30", "<stdin>:2:1"),
    ] {
        let told = rejected(program);
        assert!(told.contains(place), "{place} in\n{told}");
    }
}

#[test]
fn all_errors_of_a_file_at_once() {
    let told = rejected(b"G0 Q5\nG77\nM99 S-1\nM30");
    for place in ["<stdin>:1:4", "<stdin>:2:1", "<stdin>:3:1", "<stdin>:3:5"] {
        assert!(told.contains(place), "{place} in\n{told}");
    }
}

#[test]
fn a_line_of_100_mb_is_one_error() {
    let told = rejected(&vec![b'X'; 100_000_000]);
    assert!(told.contains("<stdin>:1:1") && told.len() < 1000, "{told}");
}

#[test]
fn a_machine_file_with_a_typo_names_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let machine = file(&folder, "m.toml", b"[spindle]\nmax_rmp = 9000\n");
    let output = rigidtap(&["simulate", "gcode/s3000.ngc", "--machine", text(&machine)]);
    assert_eq!(code(&output), 1);
    let told = stderr(&output);
    assert!(told.contains("m.toml:2:1") && told.contains("did you mean max_rpm?"), "{told}");
}

#[test]
fn a_missing_file_is_named() {
    for arguments in [&["check", "none.ngc"][..], &["simulate", "gcode/s3000.ngc", "--machine", "none.toml"]] {
        let output = rigidtap(arguments);
        assert_eq!(code(&output), 1);
        assert!(stderr(&output).starts_with("error: none."), "{}", stderr(&output));
    }
}

#[test]
fn an_output_that_existed_stays_when_the_input_is_rejected() {
    let folder = tempfile::tempdir().unwrap();
    for (option, name) in [("--trace", "t.csv"), ("--plot", "p.svg")] {
        let kept = file(&folder, name, b"precious");
        let output = with_stdin(&["simulate", "-", option, text(&kept)], b"G77\n");
        assert_eq!(code(&output), 1);
        assert_eq!(std::fs::read(&kept).unwrap(), b"precious");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "no litter");
}

#[test]
fn an_output_never_takes_the_place_of_an_input_or_of_another_output() {
    let folder = tempfile::tempdir().unwrap();
    let program = file(&folder, "hole.svg", ONE_HOLE);
    let machine = file(&folder, "m.toml", b"");
    let out = folder.path().join("out.svg");
    let [program, machine, out] = [&program, &machine, &out].map(|path| text(path));
    for arguments in [
        &["simulate", program, "--plot", program][..],
        &["simulate", program, "--trace", program],
        &["simulate", program, "--machine", machine, "--trace", machine],
        &["simulate", program, "--trace", out, "--plot", out],
        &["compare", program, "--plot", program],
        &["plan", program, "--plot", program],
        &["plan", program, "--plot", "-"],
    ] {
        let output = rigidtap(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", stderr(&output));
    }
    assert_eq!(std::fs::read(program).unwrap(), ONE_HOLE);
    assert_eq!(std::fs::read(machine).unwrap(), b"");
    assert!(!Path::new(out).exists());
}

#[test]
fn a_failed_run_keeps_every_output_that_existed() {
    let folder = tempfile::tempdir().unwrap();
    let kept = file(&folder, "t.csv", b"precious");
    let output = with_stdin(&["simulate", "-", "--trace", text(&kept), "--plot", "none/p.svg"], ONE_HOLE);
    assert_eq!(code(&output), 1);
    assert_eq!(std::fs::read(&kept).unwrap(), b"precious");
}

#[test]
fn a_program_that_takes_for_ever_is_refused() {
    let told = rejected(b"G0 X1000000000\nM30");
    assert!(told.contains("<stdin>:1:1") && told.contains("hours"), "{told}");
}

#[test]
fn an_output_without_a_folder_is_named() {
    let output = with_stdin(&["simulate", "-", "--trace", "none/t.csv"], ONE_HOLE);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("none/t.csv"), "{}", stderr(&output));
}

#[test]
fn wrong_words_end_with_code_2() {
    for arguments in [
        &[][..],
        &["drill"],
        &["simulate"],
        &["simulate", "gcode/s3000.ngc", "--law", "exponential"],
        &["simulate", "gcode/s3000.ngc", "--share", "-1"],
        &["simulate", "gcode/s3000.ngc", "--share", "2"],
        &["simulate", "gcode/s3000.ngc", "--tap", "M99"],
        &["simulate", "gcode/s3000.ngc", "--without", "gravity"],
        &["compare", "gcode/s3000.ngc", "--without", "gravity"],
        &["check", "gcode/s3000.ngc", "--dialect", "heidenhain"],
        &["check", "-", "-"],
        &["plan"],
        &["plan", "--stroke-rev", "25"],
        &["plan", "--stroke-rev", "25", "--speed-rpm", "99999"],
        &["monitor"],
        &["monitor", "e.csv", "--serial", "/dev/null"],
        &["monitor", "--serial", "/dev/null"],
        &["monitor", "e.csv", "--pitch", "0"],
        &["monitor", "e.csv", "--map", "spindle=a[parsec],z=b[mm]"],
        &["plan", "gcode/dwell.ngc", "--plot", "plan.png"],
        &["simulate", "gcode/dwell.ngc", "--plot", "e"],
        &["plan", "--stroke-rev", "nan", "--speed-rpm", "100"],
    ] {
        let output = rigidtap(arguments);
        assert_eq!(code(&output), 2, "{arguments:?}: {}", stderr(&output));
        assert!(!stderr(&output).is_empty() && stdout(&output).is_empty(), "{arguments:?}");
    }
}

#[test]
fn quiet_keeps_errors_and_drops_warnings() {
    // No program end is a warning.
    let warned = |arguments: &[&str], program: &[u8]| stderr(&with_stdin(arguments, program));
    assert!(warned(&["check", "-"], b"G0 X1\n").contains("<stdin>:1"));
    assert_eq!(warned(&["check", "-", "-q"], b"G0 X1\n"), "");
    assert!(warned(&["check", "-", "-q"], b"G77\n").contains("<stdin>:1:1"));
}

#[test]
fn colour_only_where_asked() {
    let told = |color: &str| stderr(&with_stdin(&["check", "-", "--color", color], b"G77\n"));
    assert!(told("always").contains('\u{1b}') && !told("never").contains('\u{1b}') && !told("auto").contains('\u{1b}'));
}

#[test]
fn a_recording_that_is_none_names_its_place() {
    for (content, map, place) in [
        (&b""[..], None, "<stdin>:1:1"),
        (b"time,volts\n1,2\n", None, "<stdin>:1:1"),
        (b"0.1 0.2\n0.1 x\n", None, "<stdin>:2:5"),
        (b"a,b\n1,2\n1,two\n", Some("spindle=a[rev],z=b[mm]"), "<stdin>:3:3"),
        (b"0.1 0.2\n0.1 0.2\n", None, "--pitch"),
    ] {
        let arguments = [&["monitor", "-"][..], &map.map_or(vec![], |map| vec!["--map", map])].concat();
        let output = with_stdin(&arguments, content);
        assert_eq!(code(&output), 1, "{}", stdout(&output));
        assert!(stderr(&output).contains(place), "{place} in {}", stderr(&output));
    }
    let output = rigidtap(&["monitor", "--serial", "/dev/none", "--pitch", "1"]);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("/dev/none"), "{}", stderr(&output));
}
