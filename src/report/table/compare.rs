//! `compare` for people: programs side by side, worst over the holes of each.

use std::path::Path;

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use super::words::yes;
use crate::report::alarm::sentence;
use crate::study::{Comparison, Summary, Variant};

/// The same programs under many settings. What all rows have in common stands above them, and is a column only where
/// there is room.
#[must_use]
pub fn compared(layout: Layout, programs: &[(String, Vec<Comparison>)]) -> String {
    let variants: Vec<Variant> = programs.iter().flat_map(|(_, list)| list).map(|found| found.variant).collect();
    // Rank of a column of settings: always there where rows differ in it, else the first to go.
    let rank = |differ: bool| if differ { 0 } else { 9 };
    let differ = |same: &dyn Fn(&Variant, &Variant) -> bool| variants.iter().any(|one| !same(one, &variants[0]));
    let [by_law, by_sync, by_compensation] = [
        differ(&|left, right| left.law == right.law),
        differ(&|left, right| left.sync.mode == right.sync.mode),
        differ(&|left, right| left.sync.compensation == right.sync.compensation),
    ];
    let by_share = differ(&|left, right| left.share == right.share);
    let by_effect = variants.iter().any(|variant| variant.without.is_some());
    let mut columns = vec![
        text("program", rank(programs.len() > 1)),
        text("law", rank(by_law)),
        text("sync", rank(by_sync)),
        text("compensation", rank(by_compensation)),
    ];
    if by_effect {
        columns.push(text("without", 0));
    }
    if variants.iter().any(|variant| variant.share.is_some()) {
        columns.push(number("share", rank(by_share)));
    }
    columns.extend([
        text("verdict", 0),
        number("stroke s", 0),
        number("time/min", 3),
        number("peak rpm", 4),
        number("torque %", 2),
        number("jerk Mrpm/s²", 7),
        number("min µm", 6),
        number("max µm", 6),
        number("p-p µm", 0),
        number("true µm", 1),
        number("following rev", 8),
        text("saturated", 5),
    ]);
    let mut table = Columns::new(&columns);
    let names = short_names(programs);
    for ((_, comparisons), name) in programs.iter().zip(&names) {
        for comparison in comparisons {
            table.row(row(name, comparison, by_effect, variants.iter().any(|variant| variant.share.is_some())));
        }
    }
    let mut page = Page::new(layout);
    page.say(common(programs, &variants, [by_law, by_sync, by_compensation, by_share])).blank().table(&table);
    page.say(
        "Worst over each program's holes: p-p is the measured e(k), true the same at tool and table, peak to peak.",
    );
    if variants.iter().any(|variant| !variant.sync.supervise) {
        page.say("Without supervision: compensation none and paper, and sync following, as the papers have them.");
    }
    for (file, comparisons) in programs {
        for found in comparisons {
            if let Some(fault) = &found.outcome.fault {
                let law = found.variant.law.name();
                page.say(format!("{file}, {law}: stopped by an alarm: {}", sentence(fault)));
            }
        }
    }
    page.finish()
}

/// What all rows have in common.
fn common(programs: &[(String, Vec<Comparison>)], variants: &[Variant], differ: [bool; 4]) -> String {
    let mut words = match programs {
        [(file, _)] => vec![file.clone()],
        _ => vec![format!("{} programs", programs.len())],
    };
    if let Some(one) = variants.first() {
        let [by_law, by_sync, by_compensation, by_share] = differ;
        words.extend((!by_law).then(|| one.law.name().to_owned()));
        words.extend((!by_sync).then(|| one.sync.mode.name().to_owned()));
        words.extend((!by_compensation).then(|| format!("compensation {}", one.sync.compensation.name())));
        words.extend(one.share.filter(|_| !by_share).map(|share| format!("{:.0} % of the motor", share * 100.0)));
    }
    words.join(", ")
}

/// Names without their folders, where they still tell the programs apart.
fn short_names(programs: &[(String, Vec<Comparison>)]) -> Vec<String> {
    let last =
        |name: &str| Path::new(name).file_name().map_or_else(|| name.to_owned(), |last| last.to_string_lossy().into());
    let short: Vec<String> = programs.iter().map(|(name, _)| last(name)).collect();
    let twice = |name: &String| short.iter().filter(|other| *other == name).count() > 1;
    if short.iter().any(twice) { programs.iter().map(|(name, _)| name.clone()).collect() } else { short }
}

fn row(name: &str, comparison: &Comparison, with_effect: bool, with_share: bool) -> Vec<String> {
    let (variant, summary) = (comparison.variant, Summary::of(&comparison.outcome));
    let mut row = vec![
        name.to_owned(),
        variant.law.name().into(),
        variant.sync.mode.name().into(),
        variant.sync.compensation.name().into(),
    ];
    if with_effect {
        row.push(variant.without.map_or("", |effect| effect.name()).into());
    }
    if with_share {
        row.push(variant.share.map_or_else(String::new, |share| format!("{share:.2}")));
    }
    row.extend([
        summary.verdict.name().into(),
        format!("{:.4}", summary.stroke_s),
        format!("{:.3}", summary.stroke_over_bound),
        format!("{:.0}", summary.peak_rpm),
        format!("{:.0}", summary.peak_torque_share * 100.0),
        summary.peak_jerk_rpm_per_s2.map_or_else(|| "steps".into(), |jerk| format!("{:.2}", jerk / 1e6)),
        format!("{:.1}", summary.error_um.min()),
        format!("{:.1}", summary.error_um.max()),
        format!("{:.1}", summary.error_um.peak_to_peak()),
        format!("{:.1}", summary.true_error_um.peak_to_peak()),
        format!("{:.3}", summary.spindle_following_error_rev),
        yes(summary.saturated).into(),
    ]);
    row
}
