//! The list of keys against the data it stands for, and reading against writing.

use std::collections::BTreeSet;

use proptest::prelude::*;

use super::keys::{self, Draft, Slot};
use super::{GcodeOptions, MachineFile};
use crate::control::machine::{BandSpec, Machine, Ramp};
use crate::control::motor::TorquePoint;
use crate::sim::{Actual, Drawn, Spread};

/// Paths of all fields of a draft, as its pretty debug form lists them, spelled as keys.
fn fields() -> BTreeSet<String> {
    let Draft { spec, actual, spread, hard, gcode, data_sheet } = Draft::reference();
    let text = format!(
        "{spec:#?}\nActual {{\n spindle: {data_sheet:#?}\n actual: {actual:#?}\n spread: {spread:#?}\n spread.hard: {hard:#?}\n gcode: {gcode:#?}"
    );
    let (mut path, mut out, mut list_depth) = (Vec::new(), BTreeSet::new(), 0);
    for line in text.lines().map(str::trim) {
        let (name, rest) = line.split_once(": ").unwrap_or(("", line));
        if rest.ends_with('[') || (list_depth > 0 && rest.ends_with('{')) {
            if list_depth == 0 {
                out.insert([path.join("."), name.to_owned()].join("."));
            }
            list_depth += 1;
        } else if list_depth > 0 {
            list_depth -= usize::from(rest.starts_with([']', '}']));
        } else if rest.ends_with('{') {
            path.extend((!name.is_empty()).then(|| name.replace("z_axis", "z")));
        } else if rest.starts_with('}') {
            path.pop();
        } else {
            out.insert([path.join("."), name.to_owned()].join("."));
        }
    }
    out
}

#[test]
fn every_field_has_its_key_and_every_key_its_field() {
    let keys: BTreeSet<_> = keys::all().map(|key| key.path.to_owned()).collect();
    assert_eq!(keys, fields());
    assert!(keys::all().all(|key| keys::find_table(key.table()).is_some()));
}

#[test]
fn every_key_is_written_and_what_is_written_is_read() {
    let text = MachineFile::reference().to_toml();
    // With the commented-out lines in force every key stands in the file.
    let all: String = text
        .lines()
        .map(|line| if is_key_line(line) || is_in_list(line) { &line[2..] } else { line }.to_owned() + "\n")
        .collect();
    let reading = super::read::read(all.as_bytes(), &all);
    assert_eq!(reading.faults, []);
    for key in keys::all() {
        assert!(reading.places.contains_key(key.path), "{} is not written", key.path);
    }
    assert!(text.lines().all(|line| line.chars().count() <= 120));
}

/// A line of a list that is commented out as a whole.
fn is_in_list(line: &str) -> bool {
    line.starts_with("#   { to_rpm") || line == "# ]"
}

fn is_key_line(line: &str) -> bool {
    line.strip_prefix("# ").is_some_and(|rest| rest.split(" = ").next().is_some_and(|key| !key.contains(' ')))
        && line.contains(" = ")
}

#[test]
fn every_word_is_read_and_written() {
    for key in keys::all() {
        let Slot::Word { known, get, set } = key.slot else { continue };
        for word in known {
            let mut draft = Draft::reference();
            set(&mut draft, word);
            assert_eq!(get(&draft), *word, "{}", key.path);
        }
    }
}

fn file(draft: Draft) -> Option<MachineFile> {
    let Draft { spec, actual, spread, hard, gcode, data_sheet } = draft;
    Some(MachineFile {
        machine: Machine::check(spec).ok()?,
        actual,
        spread,
        hard,
        gcode,
        data_sheet,
        warnings: Vec::new(),
    })
}

fn scaled(drawn: Drawn, factor: f64) -> Drawn {
    match drawn {
        Drawn::Within(ends) => Drawn::Within(ends.map(|end| end * factor)),
        Drawn::Some { any, ratio } => Drawn::Some { any: any.map(|end| end * factor), ratio: ratio * factor / 1.5 },
        Drawn::OneOf(values) => Drawn::OneOf(values.map(|value| value.map(|value| value * factor))),
    }
}

/// Any valid file: every number moved by its own factor, any curve, any bands in either form.
fn any_file() -> impl Strategy<Value = MachineFile> {
    let factors = proptest::collection::vec(0.5..1.5_f64, keys::all().count());
    let curve = (1.0..500.0_f64, proptest::collection::vec((1.0..5000.0_f64, 0.1..500.0_f64), 1..15));
    let band = (1.0..3000.0_f64, 1e-6..1000.0_f64, 1e-6..1000.0_f64, any::<bool>());
    let bands = proptest::collection::vec(band, 1..16);
    let words = proptest::collection::vec(any::<prop::sample::Index>(), keys::all().count());
    (factors, curve, bands, words, 1..40_u8, any::<bool>()).prop_filter_map(
        "valid",
        |(factors, (standstill_nm, points), bands, words, divisor, optional)| {
            let mut draft = Draft::reference();
            for ((key, factor), word) in keys::all().zip(factors).zip(words) {
                match key.slot {
                    Slot::Number(at) => *at(&mut draft) *= factor,
                    Slot::Optional { at, example } if optional => *at(&mut draft) = Some(example * factor),
                    Slot::Ruled { at, .. } if optional => *at(&mut draft) = Some(0.1 * factor),
                    Slot::Range(at) => *at(&mut draft) = scaled(*at(&mut draft), factor),
                    Slot::OptionalRange { at, example } if optional => {
                        *at(&mut draft) = Some(scaled(example.into(), factor));
                    }
                    Slot::Switch(at) => *at(&mut draft) = *word.get(&[false, true]),
                    Slot::Word { known, set, .. } => set(&mut draft, word.get::<&str>(known)),
                    _ => {}
                }
            }
            // A factor says nothing beside the value itself.
            if optional {
                let (none, all) = (Actual::default(), Spread::default());
                (draft.actual.backlash, draft.actual.encoder_latency) = (none.backlash, none.encoder_latency);
                (draft.spread.backlash, draft.spread.encoder_latency) = (all.backlash, all.encoder_latency);
            }
            draft.actual.backlash_damping = draft.actual.backlash_damping.min(1.0);
            draft.hard.backlash_damping = [0.25, 0.75].into();
            draft.hard.reports_effort = draft.hard.reports_effort.min(1.0);
            // What stands in relation to another value, and ratios that may not pass 1.
            draft.spec.tap.hole_mm = draft.spec.tap.major_mm.map(|major_mm| major_mm * 0.8);
            draft.spec.drive.period_s = draft.spec.control.period_s / f64::from(divisor);
            draft.spec.law.motor_share = draft.spec.law.motor_share.min(1.0);
            draft.spec.z_axis.static_ratio = draft.spec.z_axis.static_ratio.max(1.0);
            let curve = &mut draft.spec.spindle.torque_curve;
            *curve = [TorquePoint { speed_rpm: 0.0, torque_nm: standstill_nm }].into_iter().collect();
            let mut speed_rpm = 0.0;
            for (index, (step_rpm, torque_nm)) in points.into_iter().enumerate() {
                speed_rpm += step_rpm;
                curve.push(TorquePoint { speed_rpm, torque_nm: if index == 0 { standstill_nm } else { torque_nm } });
            }
            draft.spec.spindle.max_rpm = speed_rpm;
            let mut to_rpm = 0.0;
            draft.spec.law.torque_curve.bands = bands
                .into_iter()
                .map(|(step_rpm, accel, decel, timed)| {
                    to_rpm += step_rpm;
                    let ramp = if timed {
                        Ramp::Time { accel_s: accel, decel_s: decel }
                    } else {
                        Ramp::Rate { accel_rpm_per_s: accel * 1e4 + 1.0, decel_rpm_per_s: decel * 1e4 + 1.0 }
                    };
                    BandSpec { to_rpm, ramp }
                })
                .collect();
            file(draft)
        },
    )
}

proptest! {
    #[test]
    fn any_valid_machine_reads_back_to_the_bit(file in any_file()) {
        let text = file.to_toml();
        let read = MachineFile::read(text.as_bytes()).map_err(|faults| TestCaseError::fail(format!("{faults:?}\n{text}")))?;
        // Debug prints the shortest digits that tell every f64 from its neighbours, and the sign of zero.
        prop_assert_eq!(format!("{:?}", read.machine.spec()), format!("{:?}", file.machine.spec()));
        prop_assert_eq!((read.actual, read.spread, &read.gcode), (file.actual, file.spread, &file.gcode));
        prop_assert_eq!(read.hard, file.hard);
        prop_assert_eq!(read.to_toml(), text);
    }

    #[test]
    fn no_bytes_make_it_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let _ = MachineFile::read(&bytes);
    }

    /// Text near a machine file reaches further into the reader than noise does.
    #[test]
    fn no_broken_file_makes_it_panic(at in any::<prop::sample::Index>(), len in 0..40_usize, paste in "[\\[\\]{}=.,0-9a-z\"'#\n -]{0,12}") {
        let mut text: Vec<char> = MachineFile::reference().to_toml().chars().collect();
        let start = at.index(text.len());
        let end = (start + len).min(text.len());
        text.splice(start..end, paste.chars());
        let text: String = text.into_iter().collect();
        if let Err(faults) = MachineFile::read(text.as_bytes()) {
            prop_assert!(!faults.is_empty());
            for fault in faults {
                prop_assert!(text.get(fault.span.clone()).is_some(), "{fault:?} lies outside the text");
                prop_assert!(!fault.message().is_empty());
            }
        }
    }
}

#[test]
fn values_left_out_are_the_reference_machines() {
    let empty = MachineFile::read(b"").unwrap();
    assert_eq!(empty, MachineFile::reference());
    assert_eq!((empty.actual, empty.gcode), (Actual::default(), GcodeOptions::default()));
}
