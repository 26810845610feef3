//! Programs in, expected text out: every `tests/gcode/good/*.ngc` has its commands as canonical text beside it, every
//! `tests/gcode/bad/*.ngc` its diagnostics, exactly. `UPDATE_GOLDEN=1 cargo test --test gcode` writes them anew.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use rigidtap::control::cycle::Retract;
use rigidtap::gcode::{DecimalPoint, Dialect, G81, Interpretation, Options, canonical, codes, explain, interpret};

/// The programs of a folder, in order.
fn programs(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut programs: Vec<_> = fs::read_dir(folder)
        .expect("folder")
        .map(|entry| entry.expect("entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "ngc"))
        .collect();
    programs.sort();
    programs
}

/// The programs of a folder and of its folders, one for each dialect.
fn programs_of_dialects(folder: &str) -> Vec<PathBuf> {
    let mut all = programs(folder);
    for dialect in Dialect::ALL.iter().filter(|dialect| **dialect != Dialect::PAPER) {
        all.extend(programs(&format!("{folder}/{}", dialect.name)));
    }
    all
}

/// The folder says the dialect, `paper` where there is none; further settings stand in the file's name:
/// `…_drill.ngc`, `…_power_on_inch.ngc`, `…_fanuc_point.ngc`, `…_calculator.ngc`, `…_full_retract.ngc`, `…_start_angle.ngc`, `…_block_delete.ngc`.
fn interpret_file(path: &Path) -> Interpretation {
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let folder = path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy();
    let mut dialect = Dialect::by_name(&folder).unwrap_or_default();
    if name.ends_with("_calculator") {
        dialect.decimal_point = DecimalPoint::Calculator;
    }
    if name.ends_with("_full_retract") {
        dialect.cycle.peck = Some(Retract::Full);
    }
    if name.ends_with("_start_angle") {
        dialect.start_angle_deg = Some(45.0);
    }
    if name.ends_with("_drill") {
        dialect.g81 = G81::Drill;
    }
    dialect.power_on_inch = name.ends_with("_power_on_inch");
    if name.ends_with("_fanuc_point") {
        dialect.decimal_point = DecimalPoint::Fanuc;
    }
    let options = Options { block_delete: name.ends_with("_block_delete"), ..Options::default() };
    interpret(&fs::read(path).expect("program"), &dialect, options)
}

fn diagnostics_text(program: &Interpretation) -> String {
    program.diagnostics.as_slice().iter().fold(String::new(), |mut text, d| {
        let (severity, message) = (d.severity().name(), d.message());
        writeln!(text, "{}:{} {severity}[{}] {message} / {}", d.line, d.column, d.code(), d.hint()).expect("text");
        text
    })
}

fn commands_text(program: &Interpretation) -> String {
    program.commands.iter().map(|command| canonical(command) + "\n").collect()
}

/// Compares with the text beside the program, or writes it.
fn check(path: &Path, text: &str, failures: &mut String) {
    let golden = path.with_extension("txt");
    if std::env::var_os("UPDATE_GOLDEN").is_some() {
        fs::write(&golden, text).expect("golden written");
        return;
    }
    let expected = fs::read_to_string(&golden).unwrap_or_default();
    if expected != text {
        writeln!(failures, "{}\nexpected:\n{expected}\nfound:\n{text}", path.display()).expect("text");
    }
}

#[test]
fn good_programs_give_their_commands() {
    let programs = programs_of_dialects("tests/gcode/good");
    assert!(programs.len() >= 60);
    let mut failures = String::new();
    for path in programs {
        let program = interpret_file(&path);
        assert!(!program.diagnostics.has_errors(), "{}\n{}", path.display(), diagnostics_text(&program));
        check(&path, &(commands_text(&program) + &diagnostics_text(&program)), &mut failures);
    }
    assert!(failures.is_empty(), "{failures}");
}

#[test]
fn bad_programs_give_their_diagnostics() {
    let programs = programs_of_dialects("tests/gcode/bad");
    assert!(programs.len() >= 80);
    let mut failures = String::new();
    for path in programs {
        let program = interpret_file(&path);
        assert!(program.diagnostics.has_errors(), "{} has no error", path.display());
        check(&path, &diagnostics_text(&program), &mut failures);
    }
    assert!(failures.is_empty(), "{failures}");
}

#[test]
fn the_sample_programs_are_free_of_findings() {
    for path in programs("gcode") {
        let program = interpret_file(&path);
        assert!(program.diagnostics.as_slice().is_empty(), "{}\n{}", path.display(), diagnostics_text(&program));
    }
}

/// Codes of diagnostics that a source names.
fn codes_in(source: &str) -> BTreeSet<String> {
    let is_code =
        |word: &&str| word.len() == 4 && word.starts_with('G') && word[1..].chars().all(|c| c.is_ascii_digit());
    source.split('"').filter(is_code).map(str::to_owned).collect()
}

#[test]
fn every_diagnostic_has_its_story() {
    let mut known = codes_in(include_str!("../../src/gcode/messages/code.rs"));
    known.extend(codes_in(include_str!("../../src/gcode/planning_error.rs")));
    assert_eq!(codes().map(str::to_owned).collect::<BTreeSet<_>>(), known);
    assert!(codes().all(|code| explain(code).is_some_and(|story| story.len() > 40)));
}

/// The front end's list of diagnostics and the programs that show them stay one.
#[test]
fn every_diagnostic_has_its_program() {
    let known = codes_in(include_str!("../../src/gcode/messages/code.rs"));
    let programs = [programs_of_dialects("tests/gcode/good"), programs_of_dialects("tests/gcode/bad")].concat();
    let shown: BTreeSet<_> = programs
        .iter()
        .flat_map(|path| {
            interpret_file(path).diagnostics.as_slice().iter().map(|d| d.code().to_owned()).collect::<Vec<_>>()
        })
        .collect();
    assert!(known.len() > 70);
    // A jump read line by line, which a unit test shows; and what planning finds, which no interpreter does.
    assert_eq!(known.difference(&shown).collect::<Vec<_>>(), ["G115", "G701", "G702", "G703"]);
}

/// The guide's table of kinds names programs: each of them is there.
#[test]
fn the_programs_that_the_guide_names_are_there() {
    let guide = include_str!("../../src/guide/dialects.md");
    let named: Vec<_> = guide.split('`').filter(|text| text.starts_with("tests/") && text.ends_with(".ngc")).collect();
    assert!(named.len() > 30, "only {} named", named.len());
    for program in named {
        assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join(program).is_file(), "{program}");
    }
    for dialect in Dialect::ALL {
        assert!(guide.contains(&format!("| `{}` |", dialect.name)), "{}", dialect.name);
    }
}
