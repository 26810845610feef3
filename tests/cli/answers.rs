//! Every answer in JSON: its head, and the schema that `rigidtap schema` prints for it.

use rigidtap::report::json::SUBCOMMANDS;
use serde_json::Value;

use super::schema::faults;
use super::*;

fn schema(subcommand: &str) -> Value {
    json(&rigidtap(&["schema", subcommand]))
}

/// Runs a command in JSON and holds it against its subcommand's schema.
fn valid(arguments: &[&str], stdin: &[u8]) -> Value {
    let answer = json(&with_stdin(&[arguments, &["--format", "json", "-q"]].concat(), stdin));
    let faults = faults(&answer, &schema(arguments[0]));
    assert!(faults.is_empty(), "{arguments:?}: {faults:#?}\n{answer:#}");
    let head: Vec<_> = answer.as_object().unwrap().iter().take(3).map(|(key, _)| key.as_str()).collect();
    assert_eq!(head, ["rigidtap", "schema", "machine"], "{arguments:?}");
    assert_eq!((&answer["rigidtap"], &answer["schema"]), (&env!("CARGO_PKG_VERSION").into(), &2.into()));
    answer
}

#[test]
fn every_answer_is_as_its_schema_says() {
    let folder = tempfile::tempdir().unwrap();
    let trace = folder.path().join("trace.csv");
    let weak = file(&folder, "weak.toml", WEAK);
    let pecks = b"G90 G0 X0. Y0. Z10.\nM29 S2000\nG84 X5. Y0. Z-7. R2. Q5. F2000.\nG80\nG4 P100\nG1 X1. F600.\nM30\n";

    for subcommand in SUBCOMMANDS {
        assert!(schema(subcommand)["$schema"].is_string(), "{subcommand}");
    }
    let checked = valid(&["check", "-", "--dialect", "fanuc"], pecks);
    let commands = checked["files"][0]["commands"].as_array().unwrap();
    assert!(commands.iter().any(|command| command["retract"] == "chip-break"), "{checked:#}");
    let commands = rigidtap(&["check", "-", "--format", "json"]);
    assert_eq!(code(&commands), 1, "an empty program is rejected in JSON, too");
    valid(&["plan", "--stroke-rev", "25", "--speed-rpm", "7000"], b"");
    let planned = valid(&["plan", "-", "--dialect", "fanuc"], pecks);
    assert!(planned["total_s"].as_f64().unwrap() > planned["entries"][3]["start_s"].as_f64().unwrap());
    let simulated = valid(&["simulate", "-", "--trace", text(&trace), "--seed", "7"], ONE_HOLE);
    assert_eq!((&simulated["machine"], &simulated["seed"]), (&"built-in".into(), &7.into()));
    valid(&["compare", "-", "--laws", "linear", "--without", "cutting"], ONE_HOLE);
    valid(&["sweep", "-", "--runs", "2", "--holes", "2"], ONE_HOLE);
    valid(&["sweep", "-", "--runs", "2", "--learn"], ONE_HOLE);
    valid(&["advise", "-", "--runs", "3", "--laws", "linear", "--control", "linuxcnc"], ONE_HOLE);
    valid(&["tune", "--bands", "2"], b"");
    valid(&["tune", "--gains"], b"");
    valid(&["tune", "--dry-cycle"], b"");
    assert!(valid(&["tune", "--identify", text(&trace)], b"").get("seed").is_none(), "a recording has no seed");
    valid(&["monitor", text(&trace)], b"");
    let machine = valid(&["machine", "--machine", text(&weak)], b"");
    assert_eq!(machine["machine"], text(&weak));
}

/// What an alarm keeps from being is null, and the alarm says so itself.
#[test]
fn an_alarm_is_an_object_of_its_hole_and_its_program() {
    let folder = tempfile::tempdir().unwrap();
    let weak = file(&folder, "weak.toml", WEAK);
    let arguments = ["gcode/s7000.ngc", "--machine", text(&weak)];
    let simulated = valid(&[&["simulate"], &arguments[..]].concat(), b"");
    let alarm = &simulated["programs"][0]["alarm"];
    assert_eq!((&alarm["code"], &alarm["hole"]), (&"A112".into(), &1.into()));
    assert!(alarm["message"].as_str().unwrap().contains("torque limit") && alarm["k"].is_u64());
    let swept = valid(&[&["sweep", "--runs", "1", "--nominal"], &arguments[..]].concat(), b"");
    assert_eq!((&swept["alarms"], &swept["worst_um"]["max"]), (&1.into(), &Value::Null));
    valid(&[&["compare", "--laws", "torque-curve"], &arguments[..]].concat(), b"");
}

/// A schema that lets everything pass would hold nothing.
#[test]
fn a_schema_refuses_what_is_not_its_answer() {
    let mut answer = valid(&["simulate", "-"], ONE_HOLE);
    let schema = schema("simulate");
    let found = |answer: &Value| {
        let mut found = faults(answer, &schema);
        found.sort();
        found
    };
    assert_eq!(found(&answer), [""; 0]);
    answer["programs"][0]["verdict"] = "fine".into();
    assert_eq!(found(&answer), ["/programs/0/verdict: not one of [\"ok\",\"warning\",\"fail\"]"]);
    answer["programs"][0]["verdict"] = "ok".into();
    answer["programs"][0]["holes"][0].as_object_mut().unwrap().remove("error_um");
    answer["programs"][0]["holes"][0]["strokes"][0]["bound_s"] = "long".into();
    assert_eq!(
        found(&answer),
        ["/programs/0/holes/0/strokes/0/bound_s: not a \"number\"", "/programs/0/holes/0: error_um is missing"]
    );
}

#[test]
fn every_alarm_is_explained_and_no_other_number() {
    for number in 101..=112 {
        let told = rigidtap(&["check", "--explain", &format!("A{number}")]);
        let text = String::from_utf8(told.stdout.clone()).unwrap();
        assert_eq!(code(&told), 0, "A{number}");
        assert!(text.starts_with(&format!("A{number}: ")), "{text}");
        for part in ["Why it comes: ", "What to do: "] {
            assert!(text.contains(part), "A{number} does not say: {part}");
        }
    }
    for none in ["A100", "A113", "A0"] {
        assert_eq!(code(&rigidtap(&["check", "--explain", none])), 2, "{none}");
    }
}
