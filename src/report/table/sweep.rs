//! A sweep for people.

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use super::words::{counted, settings as settings_words};
use crate::control::machine::Law;
use crate::control::sync::Settings;
use crate::run::Verdict;
use crate::sim::{Actual, ActualValue};
use crate::study::{Percentiles, Sweep, SweepSettings, SweptMachine, TailShift};

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
    let mut row = |name: String, of: &dyn Fn(&SweptMachine) -> f64, digits: usize| {
        let Percentiles { p50, p99, p999, max } = sweep.percentiles(of);
        let cells = [p50, p99, p999, max].map(|value| format!("{value:.digits$}"));
        table.row(std::iter::once(name).chain(cells).collect());
    };
    row("hole 1: e(k), p-p µm".into(), &|machine| machine.first.error_um, 2);
    row("hole 1: true e(k), p-p µm".into(), &|machine| machine.first.true_error_um, 2);
    row("hole 1: worse of both, µm".into(), &|machine| machine.first.worst_um, 2);
    row("hole 1: overshoot of bottom, µm".into(), &|machine| machine.first.bottom_overshoot_um, 2);
    row("hole 1: stroke time over bound".into(), &|machine| machine.first.stroke_over_bound, 3);
    let holes = settings.holes.get();
    if holes > 1 {
        row(format!("hole {holes}: worse of both, µm"), &|machine| machine.last.worst_um, 2);
        row(format!("hole {holes}: overshoot of bottom, µm"), &|machine| machine.last.bottom_overshoot_um, 2);
        row("worst later hole over hole 1".into(), &|machine| machine.worst_growth_ratio.unwrap_or(f64::NAN), 3);
    }
    let share = |name: &str, so: &dyn Fn(&SweptMachine) -> bool| {
        let count = sweep.count(so);
        format!("{name} {count} ({})", percent_of(count, sweep.machines.len()))
    };
    let machines = if settings.spread.is_some() { "machine" } else { "nominal machine" };
    let mut page = Page::new(layout);
    page.say(format!(
        "{file}: {}, seed {}; {}, {}",
        counted(sweep.machines.len(), machines),
        settings.seed,
        law.name(),
        settings_words(sync),
    ));
    page.say(format!(
        "{}, {}, {}, {}, {}",
        share("fail", &SweptMachine::fails),
        share("warning", &|machine| !machine.fails() && machine.first.verdict == Verdict::Warning),
        share("unstable", &|machine| machine.unstable),
        share("saturated", &|machine| machine.saturated),
        share("stopped by an alarm", &|machine| machine.alarm.is_some()),
    ));
    page.blank().table(&table);
    if let Some(machine) = sweep.worst() {
        page.blank().say(worst(machine));
    }
    let shifts = sweep.tail();
    if sweep.machines.len() >= TAIL_MACHINES && !shifts.is_empty() {
        page.blank().say("What makes the tail (rank 0.5: the effect has no part in it; of a word its share):");
        page.table(&tail(&shifts));
    }
    page.finish()
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
fn significant(value: f64) -> String {
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
