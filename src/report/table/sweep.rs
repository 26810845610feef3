//! A sweep for people.

use super::columns::{Columns, number, text};
use super::layout::{Layout, Page};
use super::words::{counted, settings as settings_words};
use crate::control::machine::Law;
use crate::control::sync::Settings;
use crate::study::{Percentiles, Sweep, SweepSettings, SweptMachine};

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
        "{}, {}, {}",
        share("unstable", &|machine| machine.unstable),
        share("saturated", &|machine| machine.saturated),
        share("stopped by an alarm", &|machine| machine.alarm.is_some()),
    ));
    page.blank().table(&table);
    if let Some(machine) = sweep.worst() {
        page.blank().say(worst(machine));
    }
    page.finish()
}

/// A share with as many decimals as one machine makes a difference in.
fn percent_of(count: usize, all: usize) -> String {
    let decimals = if all > 1000 { 2 } else { usize::from(all > 100) };
    format!("{:.decimals$} %", 100.0 * count as f64 / all as f64)
}

/// The worst machine, which `--save-worst` keeps.
fn worst(machine: &SweptMachine) -> String {
    let SweptMachine { run, seed, actual, first, .. } = machine;
    let optional = |value: Option<f64>, unit: &str| {
        value.map_or_else(|| "as its file".into(), |value| format!("{value:.1} {unit}"))
    };
    format!(
        "worst: run {run}, {worst_um:.2} µm, seed {seed}: inertia ×{inertia:.3}, torque limit ×{torque_limit:.3}, torque constant \
         ×{torque_constant:.3}, friction ×{friction:.3}, resonances ×{spindle:.3} and ×{z:.3}, cutting torque ×{cutting:.3}, \
         encoder error ×{encoder:.3}, backlash {backlash}, latency {latency}",
        worst_um = first.worst_um,
        inertia = actual.inertia,
        torque_limit = actual.torque_limit,
        torque_constant = actual.torque_constant,
        friction = actual.friction,
        spindle = actual.spindle_resonance,
        z = actual.z_resonance,
        cutting = actual.cutting_torque,
        encoder = actual.encoder_error,
        backlash = optional(actual.backlash_um, "µm"),
        latency = optional(actual.encoder_latency_s.map(|latency_s| 1e6 * latency_s), "µs"),
    )
}
