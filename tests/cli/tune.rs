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
fn a_run_up_gives_the_bands_of_the_machine_it_shows() {
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
fn wrong_words_are_wrong_usage() {
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
