use super::*;
use rigidtap::report::json::SUBCOMMANDS;

#[test]
fn simulate_prints_every_hole_and_the_worst_in_three_units() {
    let output = rigidtap(&["simulate", "gcode/s3000.ngc", "--holes"]);
    assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
    let printed = stdout(&output);
    assert_eq!(printed.lines().filter(|line| line.contains(" in   ")).count(), 21);
    assert_eq!(printed.lines().filter(|line| line.contains(" out  ")).count(), 21);
    for unit in ["measured, µm ", "spindle degrees ", "encoder pulses ", "Tolerance 52.5 µm", "21 holes in"] {
        assert!(printed.contains(unit), "{unit:?} in\n{printed}");
    }
}

#[test]
fn a_lost_thread_ends_with_code_3() {
    assert_eq!(code(&rigidtap(&["simulate", "gcode/s7000.ngc", "--law", "s-curve", "--compensation", "none"])), 3);
    // The monitor judges what the simulator wrote as the simulator did.
    let folder = tempfile::tempdir().unwrap();
    let trace = folder.path().join("t.csv");
    let words = ["simulate", "gcode/s7000.ngc", "--law", "s-curve", "--compensation", "none", "--trace", text(&trace)];
    assert_eq!(code(&rigidtap(&words)), 3);
    assert_eq!(code(&rigidtap(&["monitor", text(&trace)])), 3);
    // To compare is not to judge.
    assert_eq!(code(&rigidtap(&["compare", "gcode/s7000.ngc", "--laws", "s-curve", "--compensations", "none"])), 0);
}

#[test]
fn simulate_json_has_the_contracts_fields() {
    let found = json(&with_stdin(&["simulate", "-", "--format", "json"], ONE_HOLE));
    let program = &found["programs"][0];
    for field in ["file", "law", "sync", "compensation", "total_s", "verdict", "holes"] {
        assert!(!program[field].is_null(), "{field}");
    }
    let hole = &program["holes"][0];
    for field in ["hole", "x_mm", "y_mm", "verdict", "error_um", "true_error_um", "bottom_overshoot_um", "saturated"] {
        assert!(!hole[field].is_null(), "{field}");
    }
    for band in [&hole["error_um"], &hole["true_error_um"], &hole["strokes"][1]["error_um"]] {
        let value = |field: &str| band[field].as_f64().unwrap();
        assert!((value("max") - value("min") - value("peak_to_peak")).abs() < 1e-9);
        assert!(value("rms") > 0.0);
    }
    for (stroke, name) in hole["strokes"].as_array().unwrap().iter().zip(["in", "out"]) {
        assert_eq!(stroke["stroke"], name);
        for field in ["duration_s", "bound_s", "stroke_over_bound", "peak_rpm", "spindle_following_error_rev"] {
            assert!(stroke[field].as_f64().unwrap() > 0.0, "{field}");
        }
    }
}

#[test]
fn every_peck_has_its_strokes_in_one_hole_with_one_zero() {
    let program = b"G90 G0 X0. Y0. Z10.\nM29 S2000\nG84 X5. Y0. Z-16. R2. Q5. F2000.\nG80\nM30\n";
    let found = json(&with_stdin(&["simulate", "-", "--dialect", "fanuc", "--format", "json"], program));
    let hole = &found["programs"][0]["holes"][0];
    // Each turn of the axes costs backlash and friction, so an error, yet no thread.
    assert_ne!(hole["verdict"], "fail");
    let strokes = hole["strokes"].as_array().unwrap();
    assert_eq!(strokes.len(), 8);
    let value = |band: &serde_json::Value, field: &str| band[field].as_f64().unwrap();
    for (index, stroke) in strokes.iter().enumerate() {
        assert_eq!(stroke["stroke"], ["in", "out"][index % 2]);
        let (band, whole) = (&stroke["error_um"], &hole["error_um"]);
        assert!(value(band, "min") >= value(whole, "min") && value(band, "max") <= value(whole, "max"));
        assert!(value(band, "rms") > 0.0);
    }
}

#[test]
fn compare_json_has_one_entry_for_each_combination() {
    let found = json(&with_stdin(
        &[
            "compare",
            "-",
            "--laws",
            "s-curve,torque-curve",
            "--syncs",
            "commanded,following",
            "--compensations",
            "none,paper",
            "--shares",
            "0.6,0.8",
            "--format",
            "json",
        ],
        ONE_HOLE,
    ));
    let laws = found["programs"][0]["laws"].as_array().unwrap();
    // The S-curve has nothing that a share would change.
    assert_eq!(laws.len(), 4 + 8);
    for entry in laws {
        assert_eq!(entry["share"].is_null(), entry["law"] == "s-curve");
        for field in ["law", "sync", "compensation", "stroke_s", "stroke_over_bound", "peak_rpm", "verdict"] {
            assert!(!entry[field].is_null(), "{field}");
        }
        assert!(entry.get("without").is_some() && entry["error_um"]["peak_to_peak"].is_number());
    }
    // Fewer revolutions per second and second take longer.
    let stroke_s = |share: f64| {
        let of_share = |entry: &&serde_json::Value| entry["law"] == "torque-curve" && entry["share"] == share;
        laws.iter().find(of_share).unwrap()["stroke_s"].as_f64().unwrap()
    };
    assert!(stroke_s(0.6) > stroke_s(0.8));
}

#[test]
fn without_each_switches_the_effects_off_one_by_one() {
    let arguments =
        ["compare", "-", "--laws", "torque-curve", "--compensation", "none", "--without", "each", "--format", "json"];
    let found = json(&with_stdin(&arguments, ONE_HOLE));
    let laws = found["programs"][0]["laws"].as_array().unwrap();
    let standard = rigidtap::sim::Effect::ALL.into_iter().filter(|effect| effect.is_standard()).count();
    assert_eq!(laws.len(), 1 + standard);
    let error_um = |without: serde_json::Value| {
        let entry = laws.iter().find(|entry| entry["without"] == without).unwrap();
        entry["error_um"]["peak_to_peak"].as_f64().unwrap()
    };
    assert!(error_um("z-friction".into()) < error_um(serde_json::Value::Null) / 2.0);
}

#[test]
fn check_json_has_the_papers_holes() {
    let found = json(&rigidtap(&["check", "gcode/s3000.ngc", "--format", "json"]));
    let commands = found["files"][0]["commands"].as_array().unwrap();
    let holes: Vec<_> = commands.iter().filter(|command| command["kind"] == "tap").collect();
    assert_eq!(holes.len(), 21);
    for (index, hole) in holes.iter().enumerate() {
        assert_eq!(hole["x_mm"].as_f64().unwrap(), 7.0 * index as f64);
        for (field, value) in [("r_plane_mm", 15.0), ("bottom_mm", -10.0), ("return_mm", 15.0), ("pitch_mm", 1.0)] {
            assert_eq!(hole[field].as_f64().unwrap(), value, "{field}");
        }
        for (field, value) in [("speed_rpm", 3000.0), ("out_speed_rpm", 3000.0), ("dwell_s", 0.0), ("y_mm", 0.0)] {
            assert_eq!(hole[field].as_f64().unwrap(), value, "{field}");
        }
        assert_eq!(hole["hand"], "right");
        assert!(hole["peck_mm"].is_null() && hole["retract"].is_null());
    }
}

#[test]
fn plan_json_of_a_stroke_adds_up() {
    let found = json(&rigidtap(&["plan", "--stroke-rev", "25", "--speed-rpm", "7000", "--format", "json"]));
    let segments = found["segments"].as_array().unwrap();
    let value = |segment: &serde_json::Value, field: &str| segment[field].as_f64().unwrap();
    let total_s: f64 = segments.iter().map(|segment| value(segment, "duration_s")).sum();
    assert!((total_s - found["duration_s"].as_f64().unwrap()).abs() < 1e-12);
    let last = segments.last().unwrap();
    let t_s = value(last, "duration_s");
    let end_rev = value(last, "position_rev")
        + value(last, "velocity_rev_per_s") * t_s
        + value(last, "acceleration_rev_per_s2") * t_s * t_s / 2.0;
    assert!((end_rev - 25.0).abs() < 1e-9);
    assert_eq!((value(last, "jerk_rev_per_s3"), value(last, "snap_rev_per_s4")), (0.0, 0.0));
    assert!(found["peak_rpm"].as_f64().unwrap() < found["command_rpm"].as_f64().unwrap());
}

#[test]
fn the_trace_agrees_with_the_report() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.csv");
    let found = json(&with_stdin(&["simulate", "-", "--trace", text(&path), "--format", "json"], ONE_HOLE));
    let mut reader = csv::Reader::from_path(&path).unwrap();
    let columns: Vec<_> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    assert_eq!(columns, rigidtap::run::trace::COLUMNS);
    let column = |name: &str| columns.iter().position(|found| found == name).unwrap();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    for (k, row) in rows.iter().enumerate() {
        assert_eq!(row[column("k")].parse::<usize>().unwrap(), k, "no period is missing");
    }
    // e(k) from the counts alone, by the definition.
    let synchronous: Vec<_> = rows.iter().filter(|row| !row[column("error_um")].is_empty()).collect();
    let count = |row: &csv::StringRecord, name: &str| row[column(name)].parse::<f64>().unwrap();
    let first = synchronous[0];
    let (mut low, mut high) = (0f64, 0f64);
    for row in &synchronous {
        let z_mm = -(count(row, "z_encoder_counts") - count(first, "z_encoder_counts")) / 10_000.0;
        let turned = (count(row, "spindle_encoder_counts") - count(first, "spindle_encoder_counts")) / 16_384.0;
        let error_um = 1000.0 * (z_mm - turned);
        assert!((error_um - count(row, "error_um")).abs() < 1e-3);
        (low, high) = (low.min(error_um), high.max(error_um));
    }
    let reported = found["programs"][0]["holes"][0]["error_um"]["peak_to_peak"].as_f64().unwrap();
    assert!((high - low - reported).abs() < 1e-6);
    assert!(
        ["in", "out", "rapid", "orient"].iter().all(|stage| rows.iter().any(|row| &row[column("stroke")] == *stage))
    );
}

#[test]
fn the_same_seed_writes_the_same_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let trace = |name: &str, seed: &str| {
        let path = folder.path().join(name);
        let output = with_stdin(&["simulate", "-", "--seed", seed, "--trace", text(&path)], ONE_HOLE);
        assert_eq!(code(&output), 0);
        std::fs::read(path).unwrap()
    };
    let first = trace("a.csv", "7");
    assert!(first == trace("b.csv", "7") && first != trace("c.csv", "8"));
}

#[test]
fn overrides_change_positioning_and_no_stroke() {
    let run = |percent: &str| {
        let output = with_stdin(&["simulate", "-", "--rapid-override", percent, "--format", "json"], ONE_HOLE);
        let found = json(&output);
        let program = &found["programs"][0];
        (program["total_s"].as_f64().unwrap(), program["holes"][0]["strokes"][0]["duration_s"].as_f64().unwrap())
    };
    let ((full_s, full_stroke_s), (slow_s, slow_stroke_s)) = (run("100"), run("10"));
    assert!(slow_s > full_s + 0.5);
    assert_eq!(full_stroke_s, slow_stroke_s);
}

#[test]
fn a_machine_file_starts_as_a_copy_of_what_is_printed() {
    let folder = tempfile::tempdir().unwrap();
    let printed = rigidtap(&["machine"]);
    let path = file(&folder, "mine.toml", &printed.stdout);
    assert_eq!(stdout(&rigidtap(&["machine", "--machine", text(&path)])), stdout(&printed));
    let arguments = ["simulate", "gcode/dwell.ngc", "--format", "json"];
    let own = rigidtap(&[&arguments[..], &["--machine", text(&path)]].concat());
    assert_eq!(json(&own)["programs"], json(&rigidtap(&arguments))["programs"]);
}

#[test]
fn pictures_are_svg() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.svg");
    for arguments in [
        &["simulate", "gcode/dwell.ngc"][..],
        &["compare", "gcode/dwell.ngc"],
        &["plan", "gcode/dwell.ngc"],
        &["plan", "--stroke-rev", "25", "--speed-rpm", "7000"],
    ] {
        let output = rigidtap(&[arguments, &["--plot", text(&path)]].concat());
        assert_eq!((code(&output), stderr(&output).as_str()), (0, ""), "{arguments:?}");
        assert!(std::fs::read_to_string(&path).unwrap().starts_with("<svg"));
        std::fs::remove_file(&path).unwrap();
    }
}

/// Times of a plan are sums, and what ends where the next begins may be off by the last bit.
#[test]
fn every_sample_is_drawn_under_every_law() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.svg");
    for program in ["dwell", "left_hand", "s3000", "s5000", "s7000"] {
        for law in rigidtap::control::machine::Law::ALL {
            let program = format!("gcode/{program}.ngc");
            let output = rigidtap(&["plan", &program, "--law", law.name(), "--plot", text(&path)]);
            assert!(output.status.success(), "{program} {law:?}: {output:?}");
        }
    }
}

#[test]
fn every_subcommand_has_help_with_an_example() {
    for subcommand in SUBCOMMANDS.iter().copied().chain(["schema", "completions", "man"]) {
        let output = rigidtap(&[subcommand, "--help"]);
        assert_eq!(code(&output), 0);
        assert!(stdout(&output).contains("Example"), "{subcommand}");
    }
}

#[test]
fn the_machine_as_json_has_the_files_keys() {
    let found = json(&rigidtap(&["machine", "--format", "json"]));
    assert_eq!(found["spindle"]["max_rpm"], 8000.0);
}

#[test]
fn block_delete_skips_what_begins_with_a_slash() {
    let program = [ONE_HOLE, b""].concat();
    let program = String::from_utf8(program).unwrap().replace("G80", "/G81 X9 R3 Z-2\nG80");
    let holes = |arguments: &[&str]| {
        let found = json(&with_stdin(&[&["check", "-", "--format", "json"], arguments].concat(), program.as_bytes()));
        let commands = found["files"][0]["commands"].as_array().unwrap().clone();
        commands.iter().filter(|command| command["kind"] == "tap").count()
    };
    assert_eq!((holes(&[]), holes(&["--block-delete"])), (2, 1));
}

#[test]
fn an_alarm_is_reported_with_its_cause() {
    let folder = tempfile::tempdir().unwrap();
    let machine = file(&folder, "weak.toml", WEAK);
    let arguments = ["gcode/s7000.ngc", "-q", "--machine", text(&machine)];
    let simulated = rigidtap(&[&["simulate"], &arguments[..]].concat());
    assert_eq!(code(&simulated), 3);
    for printed in
        [stdout(&simulated), stdout(&rigidtap(&[&["compare", "--laws", "torque-curve"], &arguments[..]].concat()))]
    {
        for words in ["stopped by an alarm", "hole 1", "not at rest at R", "torque limit", "--share"] {
            let printed = printed.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(printed.contains(words), "{words} in\n{printed}");
        }
    }
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_ends_quietly() {
    let mut child = std::process::Command::new(assert_cmd::cargo::cargo_bin("rigidtap"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["check", "--canon", "gcode/s3000.ngc"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
}

#[test]
fn monitor_judges_a_simulated_trace_as_the_simulator_did() {
    let folder = tempfile::tempdir().unwrap();
    let trace = folder.path().join("t.csv");
    let simulated = json(&with_stdin(&["simulate", "-", "--trace", text(&trace), "--format", "json"], ONE_HOLE));
    let (again, plot) = (folder.path().join("again.csv"), folder.path().join("e.svg"));
    let outputs = ["--trace", text(&again), "--plot", text(&plot), "--format", "json"];
    let found = json(&rigidtap(&[&["monitor", text(&trace)], &outputs[..]].concat()));
    assert_eq!((&found["pitch_mm"], &found["link"]["kind"]), (&1.0.into(), &"trace".into()));
    let (due, hole) = (&simulated["programs"][0]["holes"][0], &found["holes"][0]);
    assert_eq!(due["verdict"], hole["verdict"]);
    for field in ["min", "max", "peak_to_peak"] {
        let difference = due["error_um"][field].as_f64().unwrap() - hole["error_um"][field].as_f64().unwrap();
        assert!(difference.abs() <= 0.2, "{field}: {due} {hole}");
    }
    for field in ["lead_in", "reversal", "strokes", "estimates", "gaps", "peak_um"] {
        assert!(!hole[field].is_null(), "{field}");
    }
    assert!(std::fs::read_to_string(&plot).unwrap().starts_with("<svg"));
    // What the monitor writes it reads again, to the same end.
    let second = json(&rigidtap(&["monitor", text(&again), "--format", "json"]));
    assert_eq!(second["holes"], found["holes"]);
    let table = stdout(&rigidtap(&["monitor", text(&trace)]));
    assert!(table.contains("reversal:") && table.contains("estimates, none of them in e(k)"), "{table}");
}

#[cfg(unix)]
#[test]
fn a_simulated_board_is_monitored_live() {
    use std::io::BufRead;
    let folder = tempfile::tempdir().unwrap();
    let program = file(&folder, "p.ngc", ONE_HOLE);
    let mut board = std::process::Command::new(env!("CARGO_BIN_EXE_rigidtap"))
        .args(["monitor", "--simulate-board", text(&program)])
        .stdout(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    let mut port = String::new();
    std::io::BufReader::new(board.stdout.take().unwrap()).read_line(&mut port).unwrap();
    let output = rigidtap(&["monitor", "--serial", port.trim(), "--pitch", "1", "--holes", "1"]);
    board.kill().unwrap();
    board.wait().unwrap();
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    assert!(stdout(&output).starts_with("hole 1: "), "{}", stdout(&output));
}

#[test]
fn holes_that_are_ok_are_summed_up_unless_asked_for() {
    let program = b"G90 M03 S3000\nG0 X0 Y0 Z5\nG91 G81 X5 R-3 Z-2 F3000 K60\nG80\nM30\n";
    let rows = |arguments: &[&str]| {
        let text = stdout(&with_stdin(arguments, program));
        assert!(text.contains("60 holes in "), "{text}");
        text.lines().filter(|line| line.contains(" both ")).count()
    };
    assert_eq!(rows(&["simulate", "-"]), 1);
    assert_eq!(rows(&["simulate", "-", "--holes"]), 60);
}

#[test]
fn what_changes_nothing_is_one_line_unless_asked_for() {
    let program = b"T1 M06\nG43 H01\nM08\nM30\n";
    let brief = with_stdin(&["check", "-", "--dialect", "haas"], program);
    assert_eq!(stderr(&brief), "<stdin>: nothing that is simulated depends on M06, T, H, M08; -v shows where\n");
    let long = stderr(&with_stdin(&["check", "-", "--dialect", "haas", "-v"], program));
    assert!(long.contains("<stdin>:1:4") && long.contains("<stdin>:3:1"), "{long}");
}

/// A count that jumps in what the host reads is felt at once, and a name that is none is refused with all that are.
#[test]
fn a_fault_is_injected_by_name_and_time() {
    let run = |words: &[&str]| with_stdin(&[&["simulate", "-", "--format", "json"], words].concat(), ONE_HOLE);
    let healthy = json(&run(&[]));
    let hole = &healthy["programs"][0]["holes"][0];
    let total_s = healthy["programs"][0]["total_s"].as_f64().unwrap();
    assert!(hole["error_um"]["peak_to_peak"].as_f64().unwrap() < 10.0);
    let jump = format!("z-jump@{}", total_s - 0.2);
    assert!(run(&["--fault", &jump]).stdout != run(&[]).stdout);
    let refused = run(&["--fault", "z-jmp@1"]);
    assert!(code(&refused) == 2 && stderr(&refused).contains("z-jump"), "{}", stderr(&refused));
    // A clock that gives no number, or runs backwards, comes to the control and ends the hole with an alarm.
    for fault in ["clock-nan", "clock-falls"] {
        let output = run(&["--fault", &format!("{fault}@{}", total_s - 0.2)]);
        let found: serde_json::Value = serde_json::from_str(&stdout(&output)).unwrap();
        assert_eq!(code(&output), 3, "{}", stderr(&output));
        assert!(found["programs"][0]["alarm"].is_object(), "{fault}: {found:#}");
    }
    let help = stdout(&rigidtap(&["simulate", "--help"]));
    assert!(help.contains("NAME@SECONDS") && help.contains("spindle-encoder-frozen") && help.contains("tap-jam"));
}

/// A data sheet's values make a file that is used as it is, and what is missing is named.
#[test]
fn a_new_machine_comes_from_a_data_sheet() {
    let words = [
        "machine",
        "--new",
        "--power-kw",
        "7.5",
        "--rated-rpm",
        "3000",
        "--max-rpm",
        "12000",
        "--rapid-m-per-min",
        "36",
    ];
    let missing = rigidtap(&words);
    assert_eq!(code(&missing), 2);
    assert!(stderr(&missing).contains("--run-up-s, --accel-m-per-s2"), "{}", stderr(&missing));
    let printed =
        rigidtap(&[&words[..], &["--run-up-s", "0.6", "--accel-m-per-s2", "8", "--dialect", "fanuc"]].concat());
    assert_eq!((code(&printed), stderr(&printed).as_str()), (0, ""));
    let folder = tempfile::tempdir().unwrap();
    let path = file(&folder, "new.toml", &printed.stdout);
    assert_eq!(code(&rigidtap(&["simulate", "gcode/s3000.ngc", "--dialect", "paper", "--machine", text(&path)])), 0);
    let absurd = rigidtap(&[&words[..], &["--run-up-s", "600", "--accel-m-per-s2", "8"]].concat());
    assert!(stderr(&absurd).contains("machines take 0.03 to 12 s"), "{}", stderr(&absurd));
}

#[test]
fn a_picture_of_one_hole_and_stroke() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("hole.svg");
    let program = "gcode/m8_grid.ngc";
    let output = rigidtap(&["simulate", program, "--plot", text(&path), "--hole", "2", "--stroke", "out", "-q"]);
    assert_eq!(code(&output), 0);
    let svg = std::fs::read_to_string(&path).unwrap();
    assert!(svg.contains("Spindle speed, rpm") && svg.contains("Spindle torque, N·m"));
    assert!(svg.contains("hole 2, stroke out: peak to peak") && svg.contains("prefers-color-scheme: dark"), "{svg}");
    // What is not there is refused with what is.
    let refused = rigidtap(&["simulate", program, "--plot", text(&path), "--hole", "99"]);
    assert_eq!(code(&refused), 2);
    assert!(String::from_utf8_lossy(&refused.stderr).contains("expected 1 to "), "{refused:?}");
    assert_eq!(code(&rigidtap(&["simulate", program, "--hole", "1"])), 2);
}
