use super::*;

fn numbers(list: &serde_json::Value, field: &str) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|entry| entry[field].as_f64().unwrap()).collect()
}

#[test]
fn json_has_the_contracts_fields() {
    let found = json(&rigidtap(&["tune", "--format", "json"]));
    for field in ["to_rpm", "accel_s", "decel_s"] {
        assert_eq!(numbers(&found["bands"], field).len(), 4, "{field}");
    }
    assert_eq!(numbers(&found["prices"], "bands"), (1..=12).map(f64::from).collect::<Vec<_>>());
    let price = numbers(&found["prices"], "stroke_over_bound")[3];
    assert!((price - 1.018).abs() < 0.002, "{price}");
}

#[test]
fn the_toml_can_be_pasted() {
    let output = rigidtap(&["tune", "--bands", "6", "--stroke-rev", "8,12.5"]);
    assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
    let printed = stdout(&output);
    assert!(printed.contains("strokes of 8, 12.5 rev at 8000 rpm"), "{printed}");
    let toml = &printed[printed.find("[law.torque_curve]").unwrap()..];
    let folder = tempfile::tempdir().unwrap();
    let machine = file(&folder, "m.toml", toml.as_bytes());
    let planned = rigidtap(&["plan", "--stroke-rev", "10", "--speed-rpm", "8000", "--machine", text(&machine)]);
    assert_eq!((code(&planned), stderr(&planned).as_str()), (0, ""), "no warning either: within the motor");
}

#[test]
fn a_run_up_gives_the_bands_of_the_machine_it_measures() {
    let known = json(&rigidtap(&["tune", "--format", "json"]));
    let measured = json(&rigidtap(&["tune", "--run-up", "gcode/machines/run_up.csv", "--format", "json"]));
    for field in ["to_rpm", "rate_rpm_per_s"] {
        let (known, measured) = (numbers(&known["bands"], field), numbers(&measured["bands"], field));
        for (known, measured) in known.iter().zip(&measured) {
            assert!((measured / known - 1.0).abs() < 0.04, "{field}: {measured} from the log, {known}");
        }
    }
    let printed = stdout(&rigidtap(&["tune", "--run-up", "gcode/machines/run_up.csv"]));
    assert!(printed.starts_with("measured"), "{printed}");
}

#[test]
fn a_bad_run_up_is_rejected_at_its_place() {
    for (log, place) in [
        (&b"time_s,rpm\n0,0\n0.1,fast\n"[..], "<stdin>:3:5: error: found `fast`, expected a number"),
        (b"time_s,rpm\n0,0\n0,1\n", "<stdin>:3:1: error: time 0 s does not come after 0 s"),
        (b"0,0\n1,100\n", "<stdin>:2:1: error: the run-up ends at 100 rpm, expected at least 7200 rpm"),
        (b"", "<stdin>:1:1: error: no rows"),
    ] {
        let output = with_stdin(&["tune", "--run-up", "-"], log);
        assert_eq!(code(&output), 1);
        assert!(stderr(&output).starts_with(place), "{place} in\n{}", stderr(&output));
    }
    assert_eq!(code(&rigidtap(&["tune", "--run-up", "none.csv"])), 1);
}

#[test]
fn gains_are_the_sync_table_of_the_machine() {
    let folder = tempfile::tempdir().unwrap();
    let machine = file(
        &folder,
        "m.toml",
        b"[z]\nresonance_hz = 50\n[drive]\nz_velocity_gain_per_s = 300\n[sync]\nbacklash_crossing_s = 0.001\n",
    );
    let printed = stdout(&rigidtap(&["tune", "--gains", "--machine", text(&machine)]));
    let gains: toml::Table = printed.parse().unwrap();
    let found = json(&rigidtap(&["tune", "--gains", "--machine", text(&machine), "--format", "json"]));
    assert_eq!(found["backlash_crossing_s"], 0.008, "by the rule for 50 Hz, whatever the file says");
    for (key, value) in gains["sync"].as_table().unwrap() {
        let value = value.as_float().or_else(|| Some(value.as_integer()? as f64));
        assert_eq!(found[key].as_f64(), value, "{key}");
    }
    let head = ["rigidtap", "schema", "machine"].len();
    assert_eq!(found.as_object().unwrap().len(), head + gains["sync"].as_table().unwrap().len());
    // Pasted, they are the file's.
    let pasted = file(
        &folder,
        "pasted.toml",
        format!("[z]\nresonance_hz = 50\n[drive]\nz_velocity_gain_per_s = 300\n{printed}").as_bytes(),
    );
    let shown = stdout(&rigidtap(&["machine", "--machine", text(&pasted)]));
    assert!(shown.contains("backlash_crossing_s = 0.008"), "{shown}");
}

/// A machine with more friction and backlash than its file says.
const WORN: &[u8] = b"[actual]\nfriction = 1.6\nbacklash_um = 4.5\ninertia = 0.9\n";

#[test]
fn a_dry_cycle_finds_the_machine_live_and_from_its_trace() {
    let folder = tempfile::tempdir().unwrap();
    let machine = file(&folder, "m.toml", WORN);
    let program = file(&folder, "dry.ngc", &rigidtap(&["tune", "--dry-cycle"]).stdout);
    let trace = folder.path().join("dry.csv");
    let words = ["simulate", text(&program), "--material", "none", "--trace", text(&trace)];
    let run = rigidtap(&[&words[..], &["--machine", text(&machine), "--seed", "3"]].concat());
    assert_eq!(code(&run), 0, "{}", stderr(&run));
    let live = json(&rigidtap(&["tune", "--identify", "--seed", "3", "--machine", text(&machine), "--format", "json"]));
    let recorded = json(&rigidtap(&["tune", "--identify", text(&trace), "--format", "json"]));
    for (key, truth, within) in [
        ("friction_n", 480.0, 0.03),
        ("static_ratio", 1.3, 0.03),
        ("stribeck_mm_per_s", 2.0, 0.1),
        ("presliding_um", 5.0, 0.1),
        ("backlash_um", 4.5, 0.1),
        ("inertia_ratio", 0.9, 0.02),
    ] {
        let [live, recorded] = [&live, &recorded].map(|found| found[key].as_f64().unwrap());
        assert!((live / truth - 1.0).abs() < within, "{key}: {live}");
        assert!((recorded / live - 1.0).abs() < 1e-3, "{key}: {recorded} from the trace, {live} live");
    }
    assert!((live["lost_motion_um"].as_f64().unwrap() - 4.5 - 6.08).abs() < 0.3, "{live:#}");
    assert!(live["torque_limit_ratio"].is_null());

    // Pasted into a file, the control knows it.
    let printed = stdout(&rigidtap(&["tune", "--identify", text(&trace)]));
    assert!(printed.contains("not measured: torque limit"), "{printed}");
    let toml: toml::Table = printed[printed.find("[z]").unwrap()..].parse().unwrap();
    let keys: Vec<_> = toml["z"].as_table().unwrap().keys().map(String::as_str).collect();
    assert_eq!(keys.len(), 6, "{keys:?}");
    let pasted = file(&folder, "pasted.toml", &printed.as_bytes()[printed.find("[z]").unwrap()..]);
    assert_eq!(code(&rigidtap(&["check", "gcode/s3000.ngc", "--machine", text(&pasted)])), 0);
}

#[test]
fn a_trace_yields_what_its_motion_measures() {
    let mut trace = String::from("time_s,z_encoder_counts,z_force_n\n");
    for k in 0..4000 {
        let (stroke, at) = (k / 800, k % 800);
        let counts = 400 * if stroke % 2 == 0 { at } else { 800 - at };
        trace += &format!("{:.3},{counts},{}\n", f64::from(k) * 0.001, if stroke % 2 == 0 { 250 } else { -250 });
    }
    trace += "3.5,0,\n3.501,0,\n";
    let found = json(&with_stdin(&["tune", "--identify", "-", "--format", "json"], trace.as_bytes()));
    assert!((found["friction_n"].as_f64().unwrap() - 250.0).abs() < 3.0, "{found:#}");
    assert_eq!((&found["periods"], &found["readings_left_out"]), (&4000.into(), &2.into()));
    let printed = stdout(&with_stdin(&["tune", "--identify", "-"], trace.as_bytes()));
    let toml: toml::Table = printed[printed.find("[z]").unwrap()..].parse().unwrap();
    assert_eq!(toml["z"].as_table().unwrap().keys().collect::<Vec<_>>(), ["coulomb_n"]);
    for (key, name) in [
        ("static_ratio", "static ratio"),
        ("stribeck_mm_per_s", "Stribeck speed"),
        ("presliding_um", "pre-sliding travel"),
        ("lost_motion_um", "reversal value"),
        ("inertia_ratio", "inertia"),
    ] {
        assert!(found[key].is_null(), "{key}: {}", found[key]);
        assert!(printed.contains(&format!("not measured: {name}")), "{name} in {printed}");
    }
}

#[test]
fn a_bad_trace_is_rejected_at_its_place() {
    for (trace, told) in [
        (&b""[..], "error: <stdin>:1:1: no readings here"),
        (b"time_s,z_encoder_counts,z_force_n\n", "error: <stdin>:1:1: no readings here"),
        (b"time_s,z_encoder_counts\n0,0\n", "error: <stdin>:1:1: no column is headed `z_force_n`"),
        (b"time_s,z_encoder_counts,z_force_n\n0,0,1\n0.001,x,1\n", "error: <stdin>:3:7: found `x`: expected a number"),
        (b"time_s,z_encoder_counts,z_force_n\n0,0,1\n0.001,0\n", "error: <stdin>:3:8: the row ends here"),
        (b"time_s;z_encoder_counts;z_force_n\n0;0;1\n0,01;0;1\n", "error: <stdin>:3:1: rows are 0.010000 s apart"),
    ] {
        let output = with_stdin(&["tune", "--identify", "-"], trace);
        assert_eq!((code(&output), stdout(&output).as_str()), (1, ""));
        assert!(stderr(&output).starts_with(told), "{told} in\n{}", stderr(&output));
    }
    assert_eq!(code(&rigidtap(&["tune", "--identify", "none.csv"])), 1);
}

#[test]
fn wrong_words_are_wrong_usage() {
    for words in [
        &["--gains", "--identify"][..],
        &["--gains", "--bands", "3"],
        &["--identify", "--run-up", "x"],
        &["--seed", "2"],
        &["--dry-cycle", "--gains"],
        &["--identify", "trace.csv", "--seed", "2"],
    ] {
        assert_eq!(code(&rigidtap(&[&["tune"], words].concat())), 2, "{words:?}");
    }
    for words in [["--bands", "0"], ["--bands", "17"], ["--stroke-rev", "0"], ["--stroke-rev", "5,x"]] {
        assert_eq!(code(&rigidtap(&["tune", words[0], words[1]])), 2, "{words:?}");
    }
}

#[test]
fn compare_retunes_for_each_share() {
    let at = |share| {
        let output =
            with_stdin(&["compare", "-", "--laws", "torque-curve", "--shares", share, "--format", "json"], ONE_HOLE);
        json(&output)["programs"][0]["laws"][0]["stroke_s"].as_f64().unwrap()
    };
    assert!(at("0.5") > at("0.9"));
}
