//! `advise`: the answer holds where it is tried out.

use super::*;

const TWO_KINDS: &[u8] =
    b"G90 G0 X0 Y0 Z10\nM03 S3000\nG84 X0 Y0 R2 Z-8 F3000\nX10\nG80\nM03 S2000\nG84 X0 Y20 R2 Z-10 F2500\nG80\nM30\n";

fn advised(arguments: &[&str]) -> serde_json::Value {
    let words = ["advise", "-", "--dialect", "linuxcnc", "--format", "json", "-q", "--runs", "24"];
    json(&with_stdin(&[&words, arguments].concat(), TWO_KINDS))
}

/// The speeds written into the program, law and share on the command line: the same machines hold, and others do.
#[test]
fn the_advice_holds_on_other_machines() {
    let found = advised(&["--laws", "torque-curve", "--shares", "0.7,0.8"]);
    let (law, share) = (found["law"].as_str().unwrap(), found["share"].as_f64().unwrap().to_string());
    let holes = found["holes"].as_array().unwrap();
    assert_eq!(holes.iter().map(|hole| hole["count"].as_u64().unwrap()).collect::<Vec<_>>(), [2, 1]);
    for hole in holes {
        let (speed, pitch) = (hole["speed_rpm"].as_f64().unwrap(), hole["pitch_mm"].as_f64().unwrap());
        assert_eq!(hole["feed_mm_per_min"].as_f64().unwrap(), speed * pitch);
        assert_eq!((hole["advised"]["runs"].as_u64(), &hole["advised"]["good"]), (Some(24), &24.into()));
        let depth = hole["depth_mm"].as_f64().unwrap();
        let program =
            format!("G90 G0 X0 Y0 Z10\nM03 S{speed}\nG84 X0 Y0 R2 Z{} F{}\nG80\nM30\n", 2.0 - depth, speed * pitch);
        let words = ["sweep", "-", "--dialect", "linuxcnc", "--runs", "60", "--seed", "9", "--format", "json", "-q"];
        let swept = json(&with_stdin(&[&words[..], &["--law", law, "--share", &share]].concat(), program.as_bytes()));
        assert_eq!((&swept["fail_ratio"], &swept["warning_ratio"]), (&0.0.into(), &0.0.into()), "{swept}");
    }
    assert!(found["saved_s"].as_f64().unwrap() > 0.1, "S3000 and S2000 are slower than the machine can: {found}");
}

#[test]
fn the_answer_comes_first_and_the_parameters_have_their_source() {
    let words =
        ["advise", "-", "--dialect", "linuxcnc", "-q", "--runs", "8", "--laws", "torque-curve", "--shares", "0.6"];
    let more = ["--control", "siemens", "--compensation", "full", "--parts-per-year", "1000"];
    let shown = stdout(&with_stdin(&[&words[..], &more].concat(), TWO_KINDS));
    assert!(shown.starts_with("Set law torque-curve at 60 % of the motor: S"), "{shown}");
    for words in ["MD35210 = ", "p. 754", "was found does not tell", "[law.torque_curve]", "in 1000 parts a year"] {
        assert!(shown.replace("\n  ", " ").contains(words), "{words} in\n{shown}");
    }
}

#[test]
fn a_control_without_a_found_number_says_so() {
    let found = advised(&["--laws", "torque-curve", "--shares", "0.6", "--control", "fanuc", "--compensation", "full"]);
    let parameters = found["control"]["parameters"].as_array().unwrap();
    assert!(parameters.iter().all(|found| found["number"].is_null() && !found["source"].as_str().unwrap().is_empty()));
    assert!(found["control"]["notes"][0].as_str().unwrap().contains("No manual that was found"));
}

/// Same words, same machines, same answer, on any number of threads.
#[test]
fn the_advice_does_not_depend_on_threads() {
    let of = |jobs: &str| advised(&["--laws", "torque-curve-smooth", "--shares", "0.8", "--jobs", jobs]);
    assert_eq!(of("1"), of("3"));
}

#[test]
fn where_nothing_holds_it_says_what_came_nearest() {
    let folder = tempfile::tempdir().unwrap();
    let worn = file(&folder, "worn.toml", b"[tolerance]\nerror_um = 2\n");
    let output =
        with_stdin(&["advise", "-", "--dialect", "linuxcnc", "--machine", text(&worn), "--runs", "8"], TWO_KINDS);
    assert_eq!(code(&output), 1);
    assert!(
        stderr(&output).contains("no setting holds at 100 %") && stderr(&output).contains("hint:"),
        "{}",
        stderr(&output)
    );
    assert_eq!(code(&with_stdin(&["advise", "-"], b"G0 X1\nM30\n")), 1);
}

/// A program for a faster spindle than this one: its own S is no reason to refuse.
#[test]
fn a_program_too_fast_for_the_spindle_is_advised_on() {
    let folder = tempfile::tempdir().unwrap();
    let slow = file(&folder, "slow.toml", b"[spindle]\nmax_rpm = 2500\n");
    let found = advised(&["--machine", text(&slow), "--laws", "torque-curve", "--shares", "0.7"]);
    assert!(found["present_part_s"].is_null() && found["part_s"].as_f64().unwrap() > 1.0, "{found}");
    assert!(found["holes"][0]["speed_rpm"].as_f64().unwrap() <= 2500.0);
}
