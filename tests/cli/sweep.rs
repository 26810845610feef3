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

/// A sweep's own words, the same for its parts, their whole and the single run.
const WORDS: [&str; 6] = ["--hard", "--runs", "11", "--holes", "2", "--learn"];

/// Runs one part of a sweep.
fn part(folder: &Path, shard: &str, words: &[&str]) -> (std::path::PathBuf, Output) {
    let path = folder.join(format!("{}.part", shard.replace('/', "of")));
    let output = with_stdin(&[&["sweep", "-", "--shard", shard, "--out", text(&path)], words].concat(), ONE_HOLE);
    (path, output)
}

/// JSON, CSV, picture and the worst machine's file, to the byte.
#[test]
fn parts_merge_to_what_the_single_run_gives() {
    let folder = tempfile::tempdir().unwrap();
    let parts = ["2/3", "3/3", "1/3"].map(|shard| {
        let (path, output) = part(folder.path(), shard, &[&WORDS[..], &["--format", "json"]].concat());
        let found = json(&output);
        assert_eq!(format!("{}/{}", found["shard"], found["of"]), shard);
        path
    });
    let run = |further: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        let words = [&WORDS[..], &["--format", "json"], further].concat();
        let output = sweep_into(folder.path(), &words, ONE_HOLE);
        assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
        let files = ["all.csv", "plot.svg", "worst.toml"].map(|name| std::fs::read(folder.path().join(name)).unwrap());
        (output.stdout, files)
    };
    let merged = run(&[&["--merge"], &parts.each_ref().map(|path| text(path))[..]].concat());
    assert!(merged == run(&[]));
    // A part's first line is JSON: counts, extremes, and the worst machines whole.
    let bytes = std::fs::read(&parts[0]).unwrap();
    let line = bytes.split(|byte| *byte == b'\n').next().unwrap();
    let head: serde_json::Value = serde_json::from_slice(line).unwrap();
    assert_eq!((&head["first_run"], &head["machines"], &head["counts"]["machines"]), (&4.into(), &4.into(), &4.into()));
    let worst_um: Vec<f64> =
        head["worst"].as_array().unwrap().iter().map(|machine| machine["worst_um"].as_f64().unwrap()).collect();
    assert!(worst_um.len() == 4 && worst_um.is_sorted_by(|left, right| left >= right));
    assert_eq!(head["extremes"]["worst_um"][1].as_f64(), Some(worst_um[0]));
    assert!(head["worst"][0]["actual"]["z_friction_model"].is_string());
}

#[test]
fn parts_that_do_not_make_the_sweep_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let words = ["--runs", "6"];
    let of = |shard: &str, words: &[&str]| {
        let (path, output) = part(folder.path(), shard, words);
        assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
        path
    };
    let (first, second, third) = (of("1/3", &words), of("2/3", &words), of("3/3", &words));
    let refused = |parts: &[&Path], words: &[&str], program: &[u8]| {
        let csv = folder.path().join("all.csv");
        let paths: Vec<_> = parts.iter().map(|path| text(path)).collect();
        let arguments = [&["sweep", "-", "--csv", text(&csv)], words, &["--merge"], &paths].concat();
        let output = with_stdin(&arguments, program);
        assert_eq!((code(&output), stdout(&output).as_str(), csv.exists()), (1, "", false));
        stderr(&output)
    };
    let message = refused(&[&first, &third], &words, ONE_HOLE);
    assert!(message.contains("part 2/3 is missing, machines 3 to 4: run it again with --shard 2/3"), "{message}");
    let copy = folder.path().join("copy.part");
    std::fs::copy(&second, &copy).unwrap();
    let message = refused(&[&first, &second, &copy, &third], &words, ONE_HOLE);
    assert!(message.contains("copy.part both have machines 3 to 4"), "{message}");

    let all: [&Path; 3] = [&first, &second, &third];
    let other = |words: &[&str], expected: &str| {
        let message = refused(&all, words, ONE_HOLE);
        assert!(message.contains(expected) && message.matches("error").count() == 3, "{expected} in {message}");
    };
    other(&["--runs", "7"], "its number of machines (--runs) is 6, expected 7");
    other(&["--runs", "6", "--seed", "2"], "its seed (--seed) is 1, expected 2");
    other(&["--runs", "6", "--holes", "2"], "its number of holes (--holes) is 1, expected 2");
    other(&["--runs", "6", "--law", "s-curve"], "expected `--law s-curve");
    other(&["--runs", "6", "--share", "0.5"], "--share 0.5`");
    other(&["--runs", "6", "--supervision", "off"], "--supervision off`");
    let machine = file(&folder, "m.toml", b"[spread]\nfriction = [1, 3]\n");
    other(&["--runs", "6", "--machine", text(&machine)], "its machine is built-in (");
    let deeper = String::from_utf8(ONE_HOLE.to_vec()).unwrap().replace("Z-2", "Z-3");
    assert!(refused(&all, &words, deeper.as_bytes()).contains("its program is <stdin> ("));

    let bytes = std::fs::read(&second).unwrap();
    let broken = folder.path().join("broken.part");
    let with = |bytes: &[u8], expected: &str| {
        std::fs::write(&broken, bytes).unwrap();
        let message = refused(&[&first, &broken, &third], &words, ONE_HOLE);
        assert!(message.contains(expected), "{expected} in {message}");
    };
    with(&bytes[..bytes.len() - 1], "cut short or damaged");
    let mut changed = bytes.clone();
    changed[bytes.len() - 30] ^= 1;
    with(&changed, "cut short or damaged");
    with(ONE_HOLE, "it is no part of a sweep");
    with(b"", "it is no part of a sweep");
    let replaced = |from: &str, to: &str| {
        let at = bytes.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
        [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat()
    };
    with(&replaced("\"format_version\":1", "\"format_version\":9"), "its form is of version 9, expected 1");
    with(&replaced("\"rigidtap\":\"0", "\"rigidtap\":\"9"), "its version of rigidtap is 9.1.0");
    with(&replaced("\"build\":\"", "\"build\":\"0"), "its build of rigidtap is 0");
}

#[test]
fn a_part_is_one_of_some_and_goes_into_its_own_file() {
    let folder = tempfile::tempdir().unwrap();
    for wrong in ["0/3", "4/3", "1", "1/0", "x/2"] {
        let (path, output) = part(folder.path(), wrong, &[]);
        assert!(code(&output) == 2 && stderr(&output).contains("expected K/N") && !path.exists());
    }
    let (path, output) = part(folder.path(), "1/7", &["--runs", "6"]);
    assert!(code(&output) == 2 && stderr(&output).contains("more parts than machines") && !path.exists());
    assert_eq!(code(&with_stdin(&["sweep", "-", "--shard", "1/2"], ONE_HOLE)), 2);
    let csv = folder.path().join("all.csv");
    assert_eq!(code(&part(folder.path(), "1/2", &["--csv", text(&csv)]).1), 2);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// The search on any number of threads; its machine by `simulate`, to the bit; and the effects' errors by machines with one
/// value set back.
#[test]
fn the_worst_machine_is_found_saved_and_explained() {
    let folder = tempfile::tempdir().unwrap();
    let saved = folder.path().join("worst.toml");
    let words = ["--law", "torque-curve-smooth", "--sync", "commanded", "--compensation", "full"];
    let run = |jobs: &str| {
        let arguments = ["sweep", "-", "--worst", "--hard", "--runs", "90", "--jobs", jobs, "--format", "json"];
        let found = json(&with_stdin(&[&arguments[..], &["--save-worst", text(&saved)], &words].concat(), ONE_HOLE));
        (found, std::fs::read_to_string(&saved).unwrap())
    };
    let (found, toml) = run("1");
    assert_eq!((found.clone(), toml.clone()), run("3"));
    assert_eq!((&found["runs"], &found["anywhere_runs"]), (&90.into(), &60.into()));
    let worst = &found["worst"];
    let worst_um = worst["worst_um"].as_f64().unwrap();
    assert!(worst_um >= found["anywhere_um"].as_f64().unwrap());
    let seed = worst["seed"].to_string();
    assert!(toml.contains(&format!("--machine THIS_FILE --seed {seed} {}", words.join(" "))));
    let simulated_um = |machine: &Path| {
        let arguments = ["simulate", "-", "--machine", text(machine), "--seed", &seed, "--format", "json"];
        let found = json(&with_stdin(&[&arguments[..], &words].concat(), ONE_HOLE));
        let hole = &found["programs"][0]["holes"][0];
        let of = |field: &str| hole[field]["peak_to_peak"].as_f64().unwrap();
        of("error_um").max(of("true_error_um"))
    };
    assert_eq!(simulated_um(&saved), worst_um);
    let effects = found["effects"].as_array().unwrap();
    assert!(effects.len() > 20);
    let sizes: Vec<f64> = effects.iter().map(|effect| effect["worst_um"].as_f64().unwrap_or(f64::INFINITY)).collect();
    assert!(sizes.is_sorted());
    let weight = effects.iter().find(|effect| effect["key"] == "z_weight_n").unwrap();
    assert_eq!((&weight["value"], &weight["nominal"]), (&worst["actual"]["z_weight_n"], &0.0.into()));
    let mut lines: Vec<_> = toml.lines().map(str::to_owned).collect();
    let line = lines.iter_mut().find(|line| line.starts_with("z_weight_n") && !line.contains('[')).unwrap();
    *line = "z_weight_n = 0".into();
    let lighter = file(&folder, "lighter.toml", lines.join("\n").as_bytes());
    assert_eq!(weight["worst_um"].as_f64(), Some(simulated_um(&lighter)));
}

#[test]
fn a_search_needs_a_spread_and_a_hole_that_begins() {
    for wrong in [["--worst", "--nominal"], ["--worst", "--csv=x.csv"], ["--worst", "--shard=1/2"]] {
        assert_eq!(code(&with_stdin(&[&["sweep", "-", "--out", "x"], &wrong[..]].concat(), ONE_HOLE)), 2);
    }
    let printed = stdout(&with_stdin(&["sweep", "-", "--worst", "--runs", "3"], ONE_HOLE));
    for words in ["the worst of 3 machines, seed 1", "µm in its first hole, ok", "µm with it nominal", "inertia"] {
        assert!(printed.contains(words), "{words} in\n{printed}");
    }
}
