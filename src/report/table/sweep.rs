//! A sweep for people.

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use super::words::{counted, settings as settings_words};
use crate::control::machine::Law;
use crate::control::sync::Settings;
use crate::sim::{Actual, ActualValue};
use crate::study::{Counts, Percentiles, Shard, Sweep, SweepSettings, SweptMachine, TailShift};

/// Percentiles over all machines, how many were unstable or saturated, and the worst one.
#[must_use]
pub fn swept_program(
    layout: Layout,
    file: &str,
    law: Law,
    sync: Settings,
    settings: &SweepSettings,
    sweep: &Sweep,
) -> String {
    let mut table = Columns::new(&[
        text("of each machine", 0),
        number("p50", 0),
        number("p99", 0),
        number("p99.9", 0),
        number("max", 0),
    ]);
    let found = &sweep.summary;
    let mut row = |name: String, percentiles: Percentiles, digits: usize| {
        let Percentiles { p50, p99, p999, max } = percentiles;
        let cells = [p50, p99, p999, max].map(|value| format!("{value:.digits$}"));
        table.row(std::iter::once(name).chain(cells).collect());
    };
    row("hole 1: e(k), p-p µm".into(), found.error_um, 2);
    row("hole 1: true e(k), p-p µm".into(), found.true_error_um, 2);
    row("hole 1: worse of both, µm".into(), found.worst_um, 2);
    row("hole 1: overshoot of bottom, µm".into(), found.bottom_overshoot_um, 2);
    row("hole 1: stroke time over bound".into(), found.stroke_over_bound, 3);
    let holes = settings.holes.get();
    if holes > 1 {
        row(format!("hole {holes}: worse of both, µm"), found.last_worst_um, 2);
        row(format!("hole {holes}: overshoot of bottom, µm"), found.last_bottom_overshoot_um, 2);
        row("worst later hole over hole 1".into(), found.worst_growth_ratio, 3);
    }
    let counts = &found.counts;
    let all = counts.machines as usize;
    let machines = if settings.spread.is_some() { "machine" } else { "nominal machine" };
    let mut page = Page::new(layout);
    page.say(format!(
        "{file}: {}, seed {}; {}, {}",
        counted(all, machines),
        settings.seed,
        law.name(),
        settings_words(sync),
    ));
    page.say(count_words(counts));
    page.blank().table(&table);
    if let Some(machine) = sweep.worst() {
        page.blank().say(worst(machine));
    }
    let shifts = &found.tail;
    if all >= TAIL_MACHINES && !shifts.is_empty() {
        page.blank().say("What makes the tail (rank 0.5: the effect has no part in it; of a word its share):");
        page.table(&tail(shifts));
    }
    page.finish()
}

/// How many machines are what.
fn count_words(counts: &Counts) -> String {
    let all = counts.machines as usize;
    let of = [
        ("fail", counts.failing),
        ("warning", counts.warning),
        ("unstable", counts.unstable),
        ("saturated", counts.saturated),
        ("stopped by an alarm", counts.alarms),
    ];
    let words = of.map(|(name, count)| format!("{name} {count} ({})", percent_of(count as usize, all)));
    words.join(", ")
}

/// One part of a sweep.
#[must_use]
pub fn swept_part(file: &str, settings: &SweepSettings, shard: Shard, counts: &Counts, name: &str) -> String {
    let runs = shard.runs(settings.runs);
    format!(
        "{file}: part {shard}, machines {} to {} of {}, seed {}\n{}\nwritten to {name}\n",
        runs.start(),
        runs.end(),
        settings.runs,
        settings.seed,
        count_words(counts),
    )
}

/// A share with as many decimals as one machine makes a difference in.
fn percent_of(count: usize, all: usize) -> String {
    let decimals = if all > 1000 { 2 } else { usize::from(all > 100) };
    format!("{:.decimals$} %", 100.0 * count as f64 / all as f64)
}

/// Effects of the tail that are worth a line.
const TAIL_ROWS: usize = 12;
/// With fewer machines the worst hundredth is one alone, which says nothing.
const TAIL_MACHINES: usize = 300;

/// What the worst hundredth has of each effect, the effect that it differs most in first.
fn tail(shifts: &[TailShift]) -> Columns {
    let mut table =
        Columns::new(&[text("median of", 0), number("all", 0), number("worst 1 %", 0), number("rank in all", 0)]);
    for shift in shifts.iter().take(TAIL_ROWS) {
        table.row(vec![
            shift.key.clone(),
            significant(shift.all),
            significant(shift.tail),
            format!("{:.2}", shift.rank),
        ]);
    }
    table
}

/// Three significant digits.
pub(super) fn significant(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = (2 - value.abs().log10().floor() as i32).max(0) as usize;
    if digits > 6 { format!("{value:.2e}") } else { format!("{value:.digits$}") }
}

/// The worst machine, which `--save-worst` keeps.
fn worst(machine: &SweptMachine) -> String {
    let SweptMachine { run, seed, actual, first, .. } = machine;
    let value_or_factor = |value: Option<f64>, factor: f64, unit: &str| {
        value.map_or_else(|| format!("×{factor:.3}"), |value| format!("{value:.1} {unit}"))
    };
    format!(
        "worst: run {run}, {worst_um:.2} µm, seed {seed}: inertia ×{inertia:.3}, torque limit ×{torque_limit:.3}, torque constant \
         ×{torque_constant:.3}, friction ×{friction:.3}, resonances ×{spindle:.3} and ×{z:.3}, cutting torque ×{cutting:.3}, \
         encoder error ×{encoder:.3}, backlash {backlash}, latency {latency}{further}",
        worst_um = first.worst_um,
        inertia = actual.inertia,
        torque_limit = actual.torque_limit,
        torque_constant = actual.torque_constant,
        friction = actual.friction,
        spindle = actual.spindle_resonance,
        z = actual.z_resonance,
        cutting = actual.cutting_torque,
        encoder = actual.encoder_error,
        backlash = value_or_factor(actual.backlash_um, actual.backlash, "µm"),
        latency =
            value_or_factor(actual.encoder_latency_s.map(|latency_s| 1e6 * latency_s), actual.encoder_latency, "µs"),
        further = further(actual),
    )
}

/// What the machine has of the hard spread, by its keys.
fn further(actual: &Actual) -> String {
    const STANDARD: usize = 12;
    let (mine, none) = (actual.values(), Actual::default().values());
    let listed = mine.iter().zip(&none).skip(STANDARD).filter(|(mine, none)| mine != none);
    listed
        .map(|((key, value), _)| match value {
            ActualValue::Number(number) => format!(", {key} {}", significant(number.unwrap_or(0.0))),
            ActualValue::Word(word) => format!(", {key} {word}"),
            ActualValue::Switch(on) => format!(", {key} {on}"),
        })
        .collect()
}
