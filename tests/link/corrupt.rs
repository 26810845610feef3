//! Corrupt readings: no recording with one passes, wherever it stands and whatever it says; and what real machines
//! write is never taken for one.

use rigidtap::control::machine::Law;
use rigidtap::link::plausibility::Limits;
use rigidtap::link::recording::{Context, Corrupt, Corruption, Recording, RecordingFile};
use rigidtap::run::analysis::Judgement;

use super::*;

/// What drivers, torn cables and flipped bits leave in a file.
const EXTREMES: [&str; 14] = [
    "-2147483648",
    "2147483647",
    "4294967295",
    "-9223372036854775808",
    "9223372036854775807",
    "18446744073709551615",
    "1e18",
    "-1e18",
    "1e300",
    "-1.7976931348623157e308",
    "1e400",
    "inf",
    "-inf",
    "999999999",
];

/// A recording as rows of words, and how it is to be read.
struct Table {
    name: &'static str,
    head: &'static str,
    separator: &'static str,
    map: Option<&'static str>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn text(&self) -> String {
        let mut text = self.head.to_owned();
        for row in &self.rows {
            text += &row.join(self.separator);
            text.push('\n');
        }
        text
    }

    /// Line of a row in the file.
    fn line(&self, row: usize) -> usize {
        row + 1 + usize::from(!self.head.is_empty())
    }
}

/// One good hole in every format that is read.
fn tables(simulated: &Simulated, scale: &Scale) -> Vec<Table> {
    let table = |name, head, separator, map, row: &dyn Fn(usize, &Reading) -> Vec<String>| {
        let rows = simulated.readings.iter().enumerate().map(|(k, reading)| row(k, reading)).collect();
        Table { name, head, separator, map, rows }
    };
    let counts = |reading: &Reading| [reading.spindle_counts.to_string(), reading.z_counts.to_string()];
    let rev = |reading: &Reading| format!("{:.6}", reading.spindle_counts as f64 / scale.counts_per_rev);
    let mm = |reading: &Reading| format!("{:.6}", reading.z_counts as f64 / scale.counts_per_mm);
    vec![
        table("trace", "time_s,spindle_encoder_counts,z_encoder_counts\n", ",", None, &|k, reading| {
            let [spindle, z] = counts(reading);
            vec![format!("{:.6}", k as f64 * 1e-3), spindle, z]
        }),
        table("halsampler", "", " ", None, &|_, reading| vec![rev(reading), mm(reading)]),
        table("halsampler -t", "", " ", None, &|k, reading| vec![k.to_string(), rev(reading), mm(reading)]),
        table(
            "mapped",
            "t;angle;enc\n",
            ";",
            Some("time=t[ms],spindle=angle[deg],z=enc[counts16/10000]"),
            &|k, reading| {
                let angle = 360.0 * reading.spindle_counts as f64 / scale.counts_per_rev;
                vec![k.to_string(), format!("{angle:.6}"), reading.z_counts.rem_euclid(65_536).to_string()]
            },
        ),
    ]
}

fn read(machine: &Machine, text: &str, map: Option<&str>) -> (Recording, Monitored) {
    let context = Context { scale: Scale::of(machine), period_s: 1e-3, limits: Limits::of(machine) };
    let map = map.map(|map| map.parse().unwrap());
    let mut file = RecordingFile::new(std::io::Cursor::new(text), map.as_ref(), &context).unwrap();
    let settings = AnalysisSettings { scale: file.scale(), ..settings(machine) };
    let (mut analysis, mut found) = (Analysis::new(settings), Monitored::default());
    let recording = file.read(&mut |sample| analysis.push(sample, &mut found)).unwrap();
    analysis.finish(&mut found);
    found.holes.iter_mut().for_each(|hole| hole.corrupt = recording.corrupt > 0);
    (recording, found)
}

#[test]
fn no_recording_with_an_extreme_value_passes() {
    let machine = machine(1e-3);
    let simulated = simulated(&machine, ONE_HOLE);
    let all = simulated.readings.len();
    let first = simulated.errors.iter().position(Option::is_some).unwrap();
    let last = simulated.errors.iter().rposition(Option::is_some).unwrap();
    let special =
        [0, 1, 2, first - 1, first, first + 1, (first + last) / 2, last - 1, last, last + 1, all - 2, all - 1];
    let rows: std::collections::BTreeSet<usize> = special.into_iter().chain((0..all).step_by(all / 10)).collect();
    for mut table in tables(&simulated, &Scale::of(&machine)) {
        let (recording, found) = read(&machine, &table.text(), table.map);
        assert_eq!((recording.corrupt, found.holes.len()), (0, 1), "{}: {:?}", table.name, recording.first_corrupt);
        assert_eq!(found.holes[0].judgement().name(), "ok", "{}", table.name);
        for &row in &rows {
            for column in 0..table.rows[row].len() {
                for value in EXTREMES {
                    let good = core::mem::replace(&mut table.rows[row][column], value.to_owned());
                    let (recording, found) = read(&machine, &table.text(), table.map);
                    let case = format!("{}, row {row}, column {column}, {value}", table.name);
                    assert!(recording.corrupt > 0, "{case}");
                    let passes = |hole: &MeasuredHole| matches!(hole.judgement().name(), "ok" | "warning");
                    assert!(!found.holes.iter().any(passes), "{case}: {:?}", found.holes[0].judgement());
                    // It is told where it stands; at either end only together with its neighbour.
                    let near = |told: &Corrupt| told.line.abs_diff(table.line(row)) <= 2;
                    assert!(recording.first_corrupt.iter().any(near), "{case}: {:?}", recording.first_corrupt);
                    table.rows[row][column] = good;
                }
            }
        }
    }
}

#[test]
fn a_jump_is_told_with_line_column_and_value() {
    let machine = machine(1e-3);
    let simulated = simulated(&machine, ONE_HOLE);
    let mut table = tables(&simulated, &Scale::of(&machine)).remove(0);
    let middle = simulated.errors.iter().position(Option::is_some).unwrap() + 200;
    table.rows[middle][2] = "-2147483648".into();
    let (recording, found) = read(&machine, &table.text(), None);
    assert_eq!((recording.corrupt, recording.gaps, recording.missing), (1, 1, 1));
    let told = &recording.first_corrupt[0];
    assert_eq!((told.line, told.column), (table.line(middle), 3));
    assert_eq!((told.name.as_str(), told.value.as_str()), ("z_encoder_counts", "-2147483648"));
    assert!(matches!(told.why, Corruption::Position(_)));
    let text = told.to_string();
    assert!(text.starts_with("z_encoder_counts is -2147483648, 21474") && text.contains("z.mass_kg"), "{text}");
    // The readings around it still show the hole.
    assert_eq!(found.holes[0].judgement(), Judgement::Corrupt);
    assert!(found.holes[0].error_um.peak_to_peak() < 100.0);
}

#[test]
fn counts_lost_for_good_are_one_jump_and_a_new_beginning() {
    let machine = machine(1e-3);
    let simulated = simulated(&machine, ONE_HOLE);
    let mut table = tables(&simulated, &Scale::of(&machine)).remove(0);
    let middle = simulated.errors.iter().position(Option::is_some).unwrap() + 200;
    for row in &mut table.rows[middle..] {
        row[1] = (row[1].parse::<i64>().unwrap() + 65_536).to_string();
    }
    let (recording, found) = read(&machine, &table.text(), None);
    assert_eq!(recording.corrupt, 1);
    assert!(found.holes.iter().all(|hole| hole.judgement().name() != "ok"));
}

/// Every law at every speed, late and stale readings, and the fastest reversals are what machines do.
#[test]
fn what_machines_do_is_no_corruption() {
    let machine = machine(1e-3);
    for law in Law::ALL {
        for speed in [1000, 3000, 7000] {
            let program = format!("G90 M03 S{speed}\nG0 X0 Y0 Z10\nG81 R5 Z-10 F{speed}\nG80 M30\n");
            let mut simulated = simulated_in(&machine, program.as_bytes(), &Dialect::PAPER, law);
            // Each eleventh reading is the one before it again.
            for k in (11..simulated.readings.len()).step_by(11) {
                simulated.readings[k] = simulated.readings[k - 1];
            }
            for table in tables(&simulated, &Scale::of(&machine)) {
                let (recording, _) = read(&machine, &table.text(), table.map);
                assert_eq!(recording.first_corrupt, [], "{}, {}, S{speed}", table.name, law.name());
            }
            // Times that jitter by a third of a period, and a gap of a quarter of a second.
            let mut table = tables(&simulated, &Scale::of(&machine)).remove(0);
            for (k, row) in table.rows.iter_mut().enumerate() {
                row[0] = format!("{:.6}", (k as f64 + if k % 3 == 0 { 0.33 } else { 0.0 }) * 1e-3);
            }
            table.rows.drain(400..650);
            let (recording, _) = read(&machine, &table.text(), None);
            assert_eq!(recording.first_corrupt, [], "jitter, {}, S{speed}", law.name());
            assert_eq!(recording.gaps, 1);
        }
    }
}
