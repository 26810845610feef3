//! The paper's three cases, and further pitches, as tables a person can review.
//!
//! `BLESS=1 cargo test --test regression` rewrites the tables after a change that is meant; read the difference.

use std::fmt::Write as _;
use std::path::Path;

use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::sync::{Compensation, Mode, Settings};
use rigidtap::gcode::{Dialect, Options, interpret};
use rigidtap::run::{Learned, Verdict};
use rigidtap::study::{Comparison, Simulation, Summary, Variant, compare};

fn program(speed_rpm: u32) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("gcode/s{speed_rpm}.ngc"));
    std::fs::read(path).unwrap()
}

/// Every combination of laws, modes and compensations.
fn variants(laws: &[Law], modes: &[Mode], compensations: &[Compensation]) -> Vec<Variant> {
    let mut variants = Vec::new();
    for &law in laws {
        for &mode in modes {
            for &compensation in compensations {
                // The papers' controls believe what they are told, and Z that follows unpredicted leaves the thread.
                let supervise = compensation == Compensation::ModelBased && mode == Mode::Commanded;
                variants.push(Variant {
                    law,
                    sync: Settings { mode, compensation, supervise, ..Settings::default() },
                    share: None,
                    without: None,
                });
            }
        }
    }
    variants
}

fn run(source: &[u8], variants: &[Variant]) -> Vec<Comparison> {
    let read = interpret(source, &Dialect::PAPER, Options::default());
    assert!(!read.diagnostics.has_errors(), "{:?}", read.diagnostics);
    let mut base = Simulation::of(Machine::reference());
    base.settings.run.start_mm = Options::default().start_mm;
    compare(&read.commands, &base, variants, &Learned::default(), &|| {}).unwrap()
}

fn line(name: &str, comparison: &Comparison) -> String {
    let (variant, summary) = (comparison.variant, Summary::of(&comparison.outcome));
    format!(
        "{name:<16} {:<19} {:<10} {:<6} {:>6} {:>9.4} {:>9.0} {:>9.1} {:>9.1} {:>11.3} {:>5} {}",
        variant.law.name(),
        variant.sync.mode.name(),
        variant.sync.compensation.name(),
        comparison.outcome.holes.len(),
        summary.stroke_s,
        summary.peak_rpm,
        summary.error_um.peak_to_peak(),
        summary.true_error_um.peak_to_peak(),
        summary.spindle_following_error_rev,
        if summary.saturated { "yes" } else { "no" },
        summary.verdict.name(),
    )
}

const HEADING: &str = "program          law                 sync       comp    holes  stroke s  peak rpm    p-p µm  true p-p  follow rev   sat. verdict";

/// Holds a table against its golden file, or rewrites it.
fn golden(name: &str, table: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/regression").join(name);
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, table).unwrap();
    }
    let expected = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(expected == table, "{} differs; now:\n{table}", path.display());
}

#[test]
fn the_papers_three_cases() {
    let variants = variants(&Law::ALL, &Mode::ALL, &Compensation::ALL);
    let mut table = format!("{HEADING}\n");
    for speed_rpm in [3000, 5000, 7000] {
        for comparison in run(&program(speed_rpm), &variants) {
            writeln!(table, "{}", line(&format!("s{speed_rpm}"), &comparison)).unwrap();
        }
    }
    golden("three_cases.txt", &table);
}

/// The paper's finding, independent of the tables' digits.
#[test]
fn the_papers_finding() {
    for compensation in [Compensation::Uncompensated, Compensation::Integral] {
        let variants = variants(&[Law::SCurve, Law::TorqueCurve], &[Mode::Commanded], &[compensation]);
        let [low, middle, high] = [3000, 5000, 7000].map(|speed_rpm| {
            let results = run(&program(speed_rpm), &variants);
            let [s_curve, banded] = results.as_slice() else { panic!("two laws") };
            [Summary::of(&s_curve.outcome), Summary::of(&banded.outcome)]
        });
        let ratio = |[s_curve, banded]: &[Summary; 2]| s_curve.error_um.peak_to_peak() / banded.error_um.peak_to_peak();
        assert!((0.5..2.0).contains(&ratio(&low)), "S3000: {}", ratio(&low));
        assert!(ratio(&middle) >= 2.0, "S5000: {}", ratio(&middle));
        assert!(ratio(&high) >= 20.0, "S7000: {}", ratio(&high));
        let [s_curve, banded] = high;
        assert_eq!((s_curve.verdict, s_curve.saturated), (Verdict::Fail, true));
        assert!(banded.verdict != Verdict::Fail && !banded.saturated);
        assert!(banded.error_um.peak_to_peak() <= 40.0);
        assert!(s_curve.spindle_following_error_rev >= 1.0);
    }
}

/// The paper combined speeds and pitches.
#[test]
fn further_pitches() {
    let mut table = format!("{HEADING}\n");
    for (pitch_mm, spindle) in [(0.5, "M03"), (0.8, "M03"), (1.25, "M03"), (1.75, "M03"), (1.0, "M04")] {
        for speed_rpm in [1000.0, 5000.0] {
            let feed = pitch_mm * speed_rpm;
            let source = format!(
                "%\nG90 {spindle} S{speed_rpm}\nG0 X0 Y0 Z10\nG99 G81 X0 Y0 R5 Z-20 F{feed}\nX10\nX20\nG80\nM30\n%\n"
            );
            let variants = variants(&[Law::TorqueCurve], &[Mode::Commanded], &[Compensation::Integral]);
            for comparison in run(source.as_bytes(), &variants) {
                let hand = if spindle == "M04" { " left" } else { "" };
                writeln!(table, "{}", line(&format!("P{pitch_mm} S{speed_rpm}{hand}"), &comparison)).unwrap();
            }
        }
    }
    golden("further_pitches.txt", &table);
}

#[test]
fn the_same_seed_gives_the_same_results_on_any_number_of_threads() {
    let all = variants(&Law::ALL, &[Mode::Commanded], &[Compensation::Uncompensated]);
    let source = program(5000);
    let together = run(&source, &all);
    for (variant, comparison) in all.iter().zip(&together) {
        assert_eq!(run(&source, std::slice::from_ref(variant)), std::slice::from_ref(comparison));
    }
}
