//! `--plant MODEL.fmu`: the example in C, whole and with deliberate defects. Needs a C compiler and zip.

use std::path::Path;
use std::process::Command;

use super::*;

/// Builds the example's two FMUs after changes of its files' text: each is a file, a text in it, and what stands there instead.
fn build(changes: &[(&str, &str, &str)]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/guide/examples/fmu");
    for name in ["build", "plant.c", "fmu_plant.h", "modelDescription2.xml", "modelDescription3.xml"] {
        std::fs::copy(example.join(name), folder.path().join(name)).unwrap();
    }
    for (name, from, to) in changes {
        let path = folder.path().join(name);
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{from} in {name}");
        std::fs::write(path, text.replace(from, to)).unwrap();
    }
    let built = Command::new(folder.path().join("build")).arg(folder.path()).output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    folder
}

/// What a command that ends in an error says; nothing is printed or left behind beside it.
fn refused(folder: &tempfile::TempDir, version: u32) -> String {
    let fmu = folder.path().join(format!("plant{version}.fmu"));
    let trace = folder.path().join("trace.csv");
    let output = with_stdin(&["simulate", "-", "--plant", text(&fmu), "--trace", text(&trace)], ONE_HOLE);
    assert_eq!((code(&output), stdout(&output).as_str(), trace.exists()), (1, "", false), "{}", stderr(&output));
    stderr(&output)
}

/// Both versions, to the byte; on one and many threads, run after run in the same process.
#[test]
fn the_example_taps_under_every_command() {
    let folder = build(&[]);
    let of = |words: &[&str], version: u32| {
        let fmu = folder.path().join(format!("plant{version}.fmu"));
        let words = [words, &["--plant", text(&fmu), "--format", "json"]].concat();
        let output = with_stdin(&words, ONE_HOLE);
        assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
        json(&output)
    };
    let simulated = of(&["simulate", "-"], 2);
    assert_eq!(simulated, of(&["simulate", "-"], 3));
    let hole = &simulated["programs"][0]["holes"][0];
    assert_eq!(hole["verdict"], "ok");
    let error_um = hole["error_um"]["peak_to_peak"].as_f64().unwrap();
    assert!(error_um > 0.1 && hole["true_error_um"]["peak_to_peak"].as_f64().is_some_and(|um| um > 0.1));

    let compared = of(&["compare", "-", "--laws", "torque-curve"], 3);
    assert_eq!(compared["programs"][0]["laws"].as_array().map(Vec::len), Some(1));
    let swept = |jobs: &str| of(&["sweep", "-", "--runs", "5", "--jobs", jobs], 2);
    let one = swept("1");
    assert_eq!(one, swept("3"));
    // The example makes nothing of what is drawn: every machine is the one above.
    assert_eq!((&one["worst_um"]["p50"], &one["worst_um"]["max"]), (&one["worst_um"]["max"], &one["worst_um"]["max"]));
}

#[test]
fn variables_that_are_not_a_plants_are_told_all_at_once() {
    let folder = build(&[
        ("modelDescription2.xml", "name=\"z_counts\"", "name=\"z_count\""),
        (
            "modelDescription2.xml",
            "name=\"set_z_mm\" valueReference=\"3\" causality=\"input\"",
            "name=\"set_z_mm\" valueReference=\"3\" causality=\"local\"",
        ),
        ("modelDescription2.xml", "<Real unit=\"rev/s\" start=\"0\"/>", "<Real unit=\"mm/s\" start=\"0\"/>"),
        ("modelDescription2.xml", "name=\"set_z_mm_per_s2\"", "name=\"set_z_mm_per_sec2\""),
        ("modelDescription3.xml", "<Int64 name=\"spindle_counts\"", "<Float32 name=\"spindle_counts\""),
    ]);
    let message = refused(&folder, 2);
    for words in [
        "output z_counts is missing: expected encoder that closes Z's position loop",
        "set_z_mm is of causality local, expected input",
        "set_spindle_rev_per_s has unit mm/s, expected rev/s",
        "input set_z_mm_per_sec2 is none of a plant, and nobody would set it; is set_z_mm_per_s2 meant?",
    ] {
        assert!(message.contains(words), "{words} in {message}");
    }
    let message = refused(&folder, 3);
    assert!(message.contains("spindle_counts is of type Float32, expected one whole number"), "{message}");
}

#[test]
fn an_fmu_that_fails_ends_the_run_with_its_reason() {
    let step = ("plant.c", "double t = k * TICK_S,");
    for (change, expected) in [
        (
            ("plant.c", "f->true_z_mm = m->z.position;", "f->true_z_mm = m->z.position < 5.0 ? NAN : m->z.position;"),
            "true_z_mm is NaN, expected a finite number",
        ),
        (
            (
                "plant.c",
                "f->z_counts = (int64_t)floor(m->z.position * COUNTS_PER_MM);",
                "if (m->z.position < 5.0) abort();",
            ),
            "it crashed (signal: 6",
        ),
        (
            (step.0, step.1, "if (m->z.position < 5.0) return 1;\n        double t = k * TICK_S,"),
            "fmi2DoStep answers error",
        ),
    ] {
        let folder = build(&[change]);
        let message = refused(&folder, 2);
        assert!(message.contains("plant2.fmu: at 0."), "{message}");
        assert!(message.contains(expected), "{expected} in {message}");
        let fmu = folder.path().join("plant2.fmu");
        let csv = folder.path().join("all.csv");
        let words = ["sweep", "-", "--runs", "3", "--csv", text(&csv), "--plant", text(&fmu)];
        let output = with_stdin(&words, ONE_HOLE);
        assert!(code(&output) == 1 && !csv.exists() && stderr(&output).contains(expected), "{}", stderr(&output));
    }
}

#[test]
fn an_fmu_that_hangs_is_ended() {
    let folder = build(&[(
        "plant.c",
        "double t = k * TICK_S,",
        "while (m->z.position < 5.0) {}\n        double t = k * TICK_S,",
    )]);
    let message = refused(&folder, 3);
    assert!(message.contains("no answer within 10 s: it was ended"), "{message}");
}

#[test]
fn what_is_no_fmu_is_refused() {
    let folder = build(&[("modelDescription2.xml", "fmiVersion=\"2.0\"", "fmiVersion=\"1.0\"")]);
    assert!(refused(&folder, 2).contains("FMI 1.0 is not known: expected 2.0 or 3.0"));
    for (bytes, expected) in [(&b""[..], "it is no FMU"), (ONE_HOLE, "it is no FMU")] {
        std::fs::write(folder.path().join("plant2.fmu"), bytes).unwrap();
        assert!(refused(&folder, 2).contains(expected));
    }
    let missing = with_stdin(&["simulate", "-", "--plant", "none.fmu"], ONE_HOLE);
    assert!(code(&missing) == 1 && stderr(&missing).contains("none.fmu: it is no FMU"));
    let fmu = folder.path().join("plant3.fmu");
    let ideal = with_stdin(&["simulate", "-", "--ideal", "--plant", text(&fmu)], ONE_HOLE);
    assert!(code(&ideal) == 2 && stderr(&ideal).contains("--ideal is of our own plant"));
    // A step that does not fit the period.
    let folder = build(&[(
        "modelDescription3.xml",
        "canHandleVariableCommunicationStepSize=\"true\"",
        "fixedInternalStepSize=\"0.0003\"",
    )]);
    assert!(
        refused(&folder, 3).contains("its step is fixed at 0.0003 s, expected a whole part of the period of 0.001 s")
    );
}
