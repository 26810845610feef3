//! Programs as shops have them: the dialect by the program itself, subprograms in their own files, taps by their names.

use super::*;
use rigidtap::control::thread::StandardThread;

const HEAD: &str = "G21 G90 G94 G54\nG0 X0. Y0. Z20.\n";

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in files {
        std::fs::write(folder.path().join(name), content).unwrap();
    }
    folder
}

/// Where the holes are that `check --canon` prints.
fn holes(output: &Output) -> Vec<String> {
    let at = |line: &str| Some(line.split_once("tap ")?.1.split_once(" r=")?.0.to_owned());
    stdout(output).lines().filter_map(at).collect()
}

#[test]
fn auto_reads_each_program_as_what_it_looks_like_and_says_why() {
    let cases = [
        ("fanuc.nc", format!("{HEAD}M29 S500\nG84 X1. Z-9. R2. F500.\nG80\nM30\n"), "read as fanuc: M29 in line 3"),
        (
            "haas.nc",
            format!("{HEAD}S500\nG84 X1. Z-9. R2. F500.\nM97 P9\nG80\nM30\nN9 M99\n"),
            "read as haas: M97 in line 5",
        ),
        (
            "siemens.mpf",
            "G71 G90\nG0 X0 Z9\nCYCLE84(9,0,2,-9,,,5,6,,,500)\nM30\n".into(),
            "read as siemens: CYCLE in line 3",
        ),
        ("speedio.nc", format!("{HEAD}G77 X1. Z-9. R2. I1. S500\nG80\nM30\n"), "read as brother: G77 in line 3"),
        ("m80.nc", format!("{HEAD}G84 X1. Z-9. R2. F1. S500 ,R1\nG80\nM30\n"), "read as mitsubishi: ,R1 in line 3"),
        ("lcnc.ngc", "G21 G90\ng0 x0 z9 s500 m3\nG33.1 Z-9 K1\nM2\n".into(), "read as linuxcnc: G33.1 in line 3"),
    ];
    let written: Vec<_> = cases.iter().map(|(name, program, _)| (*name, program.as_str())).collect();
    let folder = folder(&written);
    let paths = cases.each_ref().map(|(name, ..)| folder.path().join(name));
    let mut words = vec!["check", "--dialect", "auto"];
    words.extend(paths.iter().map(|path| text(path)));
    let output = rigidtap(&words);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    for (path, (.., why)) in paths.iter().zip(&cases) {
        assert!(stderr(&output).contains(&format!("{}: {why}", path.display())), "{why}:\n{}", stderr(&output));
    }
    // Quiet, it says nothing of it; and what is read alike is read the same.
    words.push("-q");
    assert!(!stderr(&rigidtap(&words)).contains("read as"));
    let named = rigidtap(&["check", "--canon", "--dialect", "fanuc", text(&paths[0])]);
    assert_eq!(stdout(&rigidtap(&["check", "--canon", "--dialect", "auto", text(&paths[0])])), stdout(&named));
}

/// What changes nothing is named as the program writes it.
#[test]
fn words_behind_a_comma_are_told_with_their_comma() {
    let program = format!("{HEAD}G84 X1. Z-9. R2. F1. S500 ,R1 ,I0.1 ,J0.2\nG80\nM30\n");
    let output = with_stdin(&["check", "-", "--dialect", "mitsubishi"], program.as_bytes());
    assert!(stderr(&output).contains("depends on ,I, ,J;"), "{}", stderr(&output));
}

#[test]
fn subprograms_are_looked_for_beside_the_program_and_then_in_each_folder() {
    let main = format!("{HEAD}M29 S500\nG99 G84 X1. Y0. Z-9. R2. F500.\nM98 P0007 L2\nM98 P8\nG80\nM30\n");
    let own = folder(&[("main.nc", &main), ("O0007.nc", "O0007\nG91 X5.\nG90\nM99\n")]);
    let further = folder(&[("o00008.NC", "O8\nX50.\nM99\n"), ("7", "O7\nX999.\nM99\n")]);
    let main = own.path().join("main.nc");
    let words = ["check", "--canon", "--dialect", "fanuc", text(&main)];
    let output = rigidtap(&[&words[..], &["--subprograms", text(further.path())]].concat());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(holes(&output), ["x=1 y=0", "x=6 y=0", "x=11 y=0", "x=50 y=0"]);
    // Without the folder it is an error, with the hint.
    let output = rigidtap(&words);
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("G506") && stderr(&output).contains("--subprograms"), "{}", stderr(&output));
    // What is wrong in another file is told there.
    std::fs::write(further.path().join("o00008.NC"), "O8\nX50. Q\nM99\n").unwrap();
    let output = rigidtap(&[&words[..], &["--subprograms", text(further.path())]].concat());
    assert_eq!(code(&output), 1);
    assert!(stderr(&output).contains("o00008.NC:2:6"), "{}", stderr(&output));
}

#[test]
fn a_sinumeriks_subprograms_are_files_of_their_names() {
    let main =
        "G71 G90 G54 G17\nG0 X0 Y0 Z20\nMCALL CYCLE84(20,0,2,-15,,0,5,,1.25,0,500,500)\nL10 P2\nROW\nMCALL\nM30\n";
    let own = folder(&[("MAIN.MPF", main), ("l10.spf", "G91 X5\nG90\nM17\n")]);
    let further = folder(&[("Row.SPF", "PROC ROW\nX50\nRET\n"), ("L10.SPF", "X999\nM17\n")]);
    let main = own.path().join("MAIN.MPF");
    let words = ["check", "--canon", "--dialect", "auto", text(&main), "--subprograms", text(further.path())];
    let output = rigidtap(&words);
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert_eq!(holes(&output), ["x=5 y=0", "x=10 y=0", "x=50 y=0"]);
}

#[test]
fn a_tap_by_its_name_sets_pitch_and_tolerance() {
    let program = |feed: f64| format!("G21 G90\nG0 X0. Y0. Z9.\nM29 S1000\nG84 X0. Z-9. R2. F{feed:.1}\nG80\nM30\n");
    for name in ["M6", "m10X1.25", "1/4-28", "#10-32 UNF", "G1/8", "BSW 1/4"] {
        let thread = StandardThread::by_name(name).unwrap();
        let words = ["simulate", "-", "--dialect", "fanuc", "--tap", name, "--format", "json"];
        let found = json(&with_stdin(&words, program(1000.0 * thread.pitch_mm).as_bytes()));
        let hole = &found["programs"][0]["holes"][0];
        assert!((hole["pitch_mm"].as_f64().unwrap() / thread.pitch_mm - 1.0).abs() < 1e-3, "{name}");
        let tolerance_um = hole["tolerance_um"].as_f64().unwrap();
        assert!((tolerance_um / thread.sync_tolerance_um() - 1.0).abs() < 1e-3, "{name}: {tolerance_um}");
        // A hole of another pitch is another tap's.
        let output = with_stdin(&words[..6], program(900.0 * thread.pitch_mm).as_bytes());
        assert_eq!(code(&output), 1, "{name}");
        assert!(stderr(&output).contains("G611"), "{name}: {}", stderr(&output));
    }
    for (name, why) in [("1/8-27 NPT", "tapers"), ("Rc1/4", "tapers"), ("M6x2", "no size"), ("", "no size")] {
        let output = rigidtap(&["simulate", "gcode/s3000.ngc", "--tap", name]);
        assert_eq!(code(&output), 2, "{name}");
        assert!(stderr(&output).contains(why) && stderr(&output).contains("--tap"), "{name}: {}", stderr(&output));
    }
}
