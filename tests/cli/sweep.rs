//! `rigidtap sweep`.

use std::path::Path;

use super::*;

/// Runs a sweep with all three output files in a folder; what it printed.
fn sweep_into(folder: &Path, arguments: &[&str], program: &[u8]) -> Output {
    let paths = ["all.csv", "plot.svg", "worst.toml"].map(|name| folder.join(name));
    let outputs = ["--csv", text(&paths[0]), "--plot", text(&paths[1]), "--save-worst", text(&paths[2])];
    with_stdin(&[&["sweep", "-"], &outputs[..], arguments].concat(), program)
}

/// The CSV's rows by column name.
fn rows(folder: &Path) -> Vec<std::collections::HashMap<String, String>> {
    let mut reader = csv::Reader::from_path(folder.join("all.csv")).unwrap();
    assert_eq!(reader.headers().unwrap().iter().collect::<Vec<_>>(), rigidtap::report::sweep_csv::COLUMNS);
    reader.deserialize().map(Result::unwrap).collect()
}

fn number(row: &std::collections::HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap()
}

#[test]
fn one_thread_and_many_write_the_same_bytes() {
    let run = |jobs: &str| {
        let folder = tempfile::tempdir().unwrap();
        let arguments = ["--runs", "9", "--holes", "2", "--jobs", jobs, "--format", "json"];
        let output = sweep_into(folder.path(), &arguments, ONE_HOLE);
        assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
        let files = ["all.csv", "plot.svg", "worst.toml"].map(|name| std::fs::read(folder.path().join(name)).unwrap());
        (output.stdout, files)
    };
    let (one, four) = (run("1"), run("4"));
    assert!(one == four);
}

/// The nearest-rank percentiles of JSON, again from the CSV; and every drawn value in its range.
#[test]
fn json_and_csv_agree() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = ["--runs", "12", "--holes", "3", "--seed", "5", "--format", "json"];
    let found = json(&sweep_into(folder.path(), &arguments, ONE_HOLE));
    assert_eq!((&found["runs"], &found["seed"], &found["unstable"]), (&12.into(), &5.into(), &0.into()));
    let rows = rows(folder.path());
    assert_eq!(rows.len(), 12);
    for (field, column) in [
        ("error_um", "error_um"),
        ("true_error_um", "true_error_um"),
        ("worst_um", "worst_um"),
        ("bottom_overshoot_um", "bottom_overshoot_um"),
        ("stroke_over_bound", "stroke_over_bound"),
        ("last_worst_um", "last_worst_um"),
        ("worst_growth_ratio", "worst_growth_ratio"),
    ] {
        let mut values: Vec<f64> = rows.iter().map(|row| number(row, column)).collect();
        values.sort_by(f64::total_cmp);
        for (percentile, value) in [("p50", values[5]), ("p99", values[11]), ("p999", values[11]), ("max", values[11])]
        {
            assert_eq!(found[field][percentile].as_f64().unwrap(), value, "{field} {percentile}");
        }
    }
    let saturated = rows.iter().filter(|row| row["saturated"] == "1").count();
    assert_eq!(found["saturated"], saturated);
    for row in &rows {
        assert_eq!(number(row, "worst_um"), number(row, "error_um").max(number(row, "true_error_um")));
        for (column, low, high) in [
            ("inertia", 0.8, 1.2),
            ("torque_limit", 0.85, 1.0),
            ("torque_constant", 0.85, 1.0),
            ("friction", 0.5, 2.0),
            ("spindle_resonance", 0.8, 1.2),
            ("z_resonance", 0.8, 1.2),
            ("cutting_torque", 0.0, 2.0),
            ("encoder_error", 0.0, 2.0),
            ("backlash_um", 0.0, 5.0),
            ("encoder_latency_s", 10e-6, 100e-6),
        ] {
            assert!((low..=high).contains(&number(row, column)), "{column}");
        }
    }
}

/// Every number of the first hole, from the saved file and its seed alone, to the last bit.
#[test]
fn the_saved_worst_machine_gives_the_same_hole_again() {
    let folder = tempfile::tempdir().unwrap();
    let law = ["--law", "torque-curve-smooth", "--sync", "commanded", "--compensation", "paper"];
    let arguments = [&["--runs", "7", "--share", "0.75", "--material", "ck45"], &law[..]].concat();
    assert_eq!(code(&sweep_into(folder.path(), &arguments, ONE_HOLE)), 0);
    let rows = rows(folder.path());
    let worst = rows.iter().max_by(|a, b| number(a, "worst_um").total_cmp(&number(b, "worst_um"))).unwrap();
    let saved = folder.path().join("worst.toml");
    let again = format!("--machine THIS_FILE --seed {} {}", worst["seed"], law.join(" "));
    assert!(std::fs::read_to_string(&saved).unwrap().contains(&again));
    let arguments = ["simulate", "-", "--machine", text(&saved), "--seed", &worst["seed"], "--format", "json"];
    let found = json(&with_stdin(&[&arguments[..], &law].concat(), ONE_HOLE));
    let hole = &found["programs"][0]["holes"][0];
    for (value, column) in [
        (&hole["error_um"]["peak_to_peak"], "error_um"),
        (&hole["true_error_um"]["peak_to_peak"], "true_error_um"),
        (&hole["bottom_overshoot_um"], "bottom_overshoot_um"),
    ] {
        assert_eq!(value.as_f64().unwrap().to_bits(), number(worst, column).to_bits(), "{column}");
    }
}

#[test]
fn the_machine_files_spread_is_what_is_drawn_from() {
    let folder = tempfile::tempdir().unwrap();
    let machine = file(&folder, "m.toml", b"[spread]\nfriction = [1.25, 1.25]\nbacklash_um = [7, 8]\n");
    let output = sweep_into(folder.path(), &["--runs", "3", "--machine", text(&machine)], ONE_HOLE);
    assert_eq!(code(&output), 0);
    let rows = rows(folder.path());
    assert!(rows.iter().all(|row| row["friction"] == "1.25" && (7.0..=8.0).contains(&number(row, "backlash_um"))));
    assert!(rows[0]["inertia"] != rows[1]["inertia"]);
}

/// The hard spread comes on top: what the standard one draws stays as it was, and so does each machine's seed.
#[test]
fn hard_machines_are_the_same_ones_with_more_on_top() {
    let of = |words: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        let arguments = [&["--runs", "6", "--format", "json"], words].concat();
        let found = json(&sweep_into(folder.path(), &arguments, ONE_HOLE));
        (found, rows(folder.path()))
    };
    let ((plain_json, plain), (hard_json, hard)) = (of(&[]), of(&["--hard"]));
    assert_eq!((&plain_json["hard"], &hard_json["hard"]), (&false.into(), &true.into()));
    for (plain, hard) in plain.iter().zip(&hard) {
        for column in ["seed", "inertia", "friction", "backlash_um", "encoder_latency_s"] {
            assert_eq!(plain[column], hard[column], "{column}");
        }
        assert_eq!((plain["z_weight_n"].as_str(), plain["z_friction_model"].as_str()), ("0", "stribeck"));
        assert!(number(hard, "z_weight_n") != 0.0 && number(hard, "z_weight_n").abs() <= 1500.0);
        assert!(["10", "16"].contains(&hard["screw_lead_mm"].as_str()));
        assert!(["ok", "warning", "fail"].contains(&hard["verdict"].as_str()));
    }
    let failed = hard.iter().filter(|row| row["verdict"] == "fail").count() as f64 / 6.0;
    let warned = hard.iter().filter(|row| row["verdict"] == "warning").count() as f64 / 6.0;
    assert_eq!(hard_json["fail_ratio"].as_f64().unwrap(), failed);
    assert_eq!(hard_json["warning_ratio"].as_f64().unwrap(), warned);
    let tail = hard_json["tail"].as_array().unwrap();
    assert!(tail.iter().any(|shift| shift["key"] == "z_weight_n") && tail.len() > 20);
    let output = with_stdin(&["sweep", "-", "--hard", "--nominal", "--runs", "1"], ONE_HOLE);
    assert_eq!(code(&output), 2);
}

#[test]
fn nominal_machines_differ_by_their_seed_alone() {
    let folder = tempfile::tempdir().unwrap();
    let machine = file(&folder, "m.toml", b"[actual]\nfriction = 1.5\n");
    let output = sweep_into(folder.path(), &["--nominal", "--runs", "4", "--machine", text(&machine)], ONE_HOLE);
    assert_eq!(code(&output), 0);
    let rows = rows(folder.path());
    for row in &rows {
        assert_eq!((row["friction"].as_str(), row["inertia"].as_str(), row["backlash_um"].as_str()), ("1.5", "1", "2"));
    }
    assert!(rows[0]["seed"] != rows[1]["seed"] && rows[0]["error_um"] != rows[1]["error_um"]);
}

/// A quarter of the motor's torque: the machine counts, whether it loses the thread or never begins it.
#[test]
fn machines_far_too_weak_count() {
    let folder = tempfile::tempdir().unwrap();
    let machine = file(&folder, "m.toml", b"[spread]\ntorque_limit = [0.5, 0.5]\ntorque_constant = [0.5, 0.5]\n");
    let run = |dialect: &str, program: &[u8]| {
        let arguments = [
            "--runs",
            "2",
            "--compensation",
            "none",
            "--supervision",
            "off",
            "--dialect",
            dialect,
            "-q",
            "--machine",
            text(&machine),
            "--format",
            "json",
        ];
        let output = sweep_into(folder.path(), &arguments, program);
        assert_eq!(code(&output), 0);
        json(&output)
    };
    let found = run("fanuc", b"G90 G0 X0. Y0. Z10.\nM29 S7000\nG84 X5. Z-20. R5. F7000.\nG80\nM30\n");
    assert_eq!((&found["alarms"], &found["unstable"], &found["saturated"]), (&0.into(), &2.into(), &2.into()));
    assert!(found["worst_um"]["p50"].as_f64().unwrap() > 1000.0);
    // The spindle that ran at S does not come to rest before the hole.
    let program = std::fs::read(Path::new(env!("CARGO_MANIFEST_DIR")).join("gcode/s7000.ngc")).unwrap();
    let found = run("paper", &program);
    assert_eq!((&found["alarms"], &found["worst_um"]["p50"]), (&2.into(), &serde_json::Value::Null));
    assert!(rows(folder.path()).iter().all(|row| row["worst_um"] == "inf" && row["alarm"] == "112"));
}

#[test]
fn the_table_says_what_the_json_says() {
    let printed = stdout(&with_stdin(&["sweep", "-", "--runs", "3"], ONE_HOLE));
    for words in
        ["3 machines, seed 1", "p99.9", "worse of both", "overshoot of bottom", "unstable 0 (0 %)", "worst: run "]
    {
        assert!(printed.contains(words), "{words} in\n{printed}");
    }
    assert!(stdout(&rigidtap(&["sweep", "--help"])).contains("Example"));
}

#[test]
fn what_cannot_be_swept_is_refused_and_nothing_written() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("all.csv");
    let refused = |arguments: &[&str], program: &[u8]| {
        let output = with_stdin(&[&["sweep", "-", "--csv", text(&csv)], arguments].concat(), program);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{arguments:?} left a file");
        (code(&output), stderr(&output))
    };
    let (status, message) = refused(&[], b"G90 G0 X0 Y0 Z10\nM30\n");
    assert!(status == 1 && message.contains("no hole to sweep"), "{message}");
    for wrong in [["--runs", "0"], ["--holes", "x"], ["--jobs", "0"]] {
        let (status, message) = refused(&wrong, ONE_HOLE);
        assert!(status == 2 && message.contains("expected a whole number from 1"), "{message}");
    }
    let missing = folder.path().join("none/worst.toml");
    assert_eq!(refused(&["--runs", "1", "--save-worst", text(&missing)], ONE_HOLE).0, 1);
    assert_eq!(refused(&["--runs", "1", "--plot", text(&csv)], ONE_HOLE).0, 2);
}

#[test]
fn holes_that_differ_are_reported() {
    let program = b"G90 M03 S1000\nG0 X0 Y0 Z10\nG81 R3 Z-2 F1000\nX9 Z-3\nG80\nM30\n";
    let output = with_stdin(&["sweep", "-", "--runs", "1"], program);
    assert!(code(&output) == 0 && stderr(&output).contains("only the first one is swept, that of line 3"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_no_file() {
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("all.csv");
    std::fs::write(&csv, "old").unwrap();
    let child = std::process::Command::new(env!("CARGO_BIN_EXE_rigidtap"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["sweep", "gcode/s7000.ngc", "--runs", "1000000", "--csv", text(&csv)])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    // Once its temporary file stands beside the old one it is sweeping.
    while std::fs::read_dir(folder.path()).unwrap().count() < 2 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = child.wait_with_output().unwrap();
    assert_eq!((code(&output), stdout(&output).as_str()), (130, ""));
    assert!(stderr(&output).contains("nothing was written"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert_eq!(std::fs::read_to_string(&csv).unwrap(), "old");
}
