//! The programs written for each kind of misreading: `kinds.txt` lists them, and the guide's table counts them.

use std::collections::BTreeSet;
use std::path::Path;

use rigidtap::gcode::Dialect;

/// In the order of the guide's columns.
const DIALECTS: [&str; 7] = ["paper", "fanuc", "haas", "linuxcnc", "siemens", "brother", "mitsubishi"];

#[test]
fn the_guide_counts_the_programs_of_each_kind() {
    assert_eq!(BTreeSet::from(DIALECTS), Dialect::ALL.iter().map(|dialect| dialect.name).collect());
    let guide = include_str!("../../src/guide/dialects.md");
    let mut kinds: Vec<(&str, [usize; 7])> = Vec::new();
    let mut seen = BTreeSet::new();
    for line in include_str!("kinds.txt").lines() {
        let Some(program) = line.strip_prefix("  ") else {
            kinds.push((line, [0; 7]));
            continue;
        };
        assert!(seen.insert(program), "{program} stands twice");
        let (dialect, name) = program.split_once('/').expect("dialect/name");
        let folder = if dialect == "paper" { String::new() } else { format!("{dialect}/") };
        let golden = |kind| format!("{}/tests/gcode/{kind}/{folder}{name}", env!("CARGO_MANIFEST_DIR"));
        let is_there =
            |path: String| Path::new(&format!("{path}.ngc")).is_file() && Path::new(&format!("{path}.txt")).is_file();
        assert!(is_there(golden("good")) != is_there(golden("bad")), "{program} is good or bad, and there");
        let column = DIALECTS.iter().position(|known| *known == dialect).expect("a dialect");
        kinds.last_mut().expect("a kind before it").1[column] += 1;
    }
    let row = |name: &str, counts: [usize; 7]| {
        counts.iter().fold(format!("| {name} |"), |row, count| format!("{row} {count} |"))
    };
    let mut all = [0; 7];
    for (kind, counts) in kinds {
        let row = row(kind, counts);
        assert!(guide.contains(&row), "the guide lacks: {row}");
        all.iter_mut().zip(counts).for_each(|(all, count)| *all += count);
    }
    let row = row("all", all);
    assert!(guide.contains(&row), "the guide lacks: {row}");
    assert!(all.iter().sum::<usize>() >= 60 && all.iter().all(|count| *count > 0), "{all:?}");
}
