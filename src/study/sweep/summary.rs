//! What a sweep comes to: counts, percentiles, the worst machines, what makes the tail.

use std::io;

use super::percentiles::Percentiles;
use super::ranked::at_ranks;
use super::records::Records;
use super::swept_machine::{SweptMachine, badness};
use super::tail::{TailShift, shifts};
use crate::run::Verdict;

/// Machines that are kept whole.
const WORST: usize = 10;
/// Numbers of a machine that have percentiles.
const FIGURES: usize = 8;

/// How many machines are what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// All machines.
    pub machines: u32,
    /// Those whose first hole fails, or whose run an alarm ended.
    pub failing: u32,
    /// Those of the others whose first hole is between half of the tolerance and all of it.
    pub warning: u32,
    /// Those with |e| over 1 mm, or with a growing oscillation.
    pub unstable: u32,
    /// Those whose spindle drive stood at its torque limit.
    pub saturated: u32,
    /// Those that an alarm stopped.
    pub alarms: u32,
}

impl Counts {
    fn add(&mut self, machine: &SweptMachine) {
        self.machines += 1;
        self.failing += u32::from(machine.fails());
        self.warning += u32::from(!machine.fails() && machine.first.verdict == Verdict::Warning);
        self.unstable += u32::from(machine.unstable);
        self.saturated += u32::from(machine.saturated);
        self.alarms += u32::from(machine.alarm.is_some());
    }

    /// Each by its name.
    pub(super) fn named(&self) -> [(&'static str, u32); 6] {
        [
            ("machines", self.machines),
            ("failing", self.failing),
            ("warning", self.warning),
            ("unstable", self.unstable),
            ("saturated", self.saturated),
            ("alarms", self.alarms),
        ]
    }

    /// Share of the machines that fail.
    #[must_use]
    pub fn fail_ratio(&self) -> f64 {
        f64::from(self.failing) / f64::from(self.machines)
    }

    /// Share of those that are a warning.
    #[must_use]
    pub fn warning_ratio(&self) -> f64 {
        f64::from(self.warning) / f64::from(self.machines)
    }
}

/// What a sweep comes to. Percentiles are exact, of however many machines.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepSummary {
    /// How many machines are what.
    pub counts: Counts,
    /// First hole: measured e(k), peak to peak.
    pub error_um: Percentiles,
    /// First hole: true e(k), peak to peak.
    pub true_error_um: Percentiles,
    /// First hole: the larger of the two, by machine.
    pub worst_um: Percentiles,
    /// First hole: greatest true depth below the programmed bottom.
    pub bottom_overshoot_um: Percentiles,
    /// First hole: time of a stroke over the frictionless minimum.
    pub stroke_over_bound: Percentiles,
    /// Last hole: the larger of measured and true e(k).
    pub last_worst_um: Percentiles,
    /// Last hole: depth below the bottom.
    pub last_bottom_overshoot_um: Percentiles,
    /// The worst later hole over the first, by machine; no number where there is one hole alone.
    pub worst_growth_ratio: Percentiles,
    /// The ten machines with the worst first holes, the worst first, of equals the one with the lower number.
    pub worst: Vec<SweptMachine>,
    /// What the machines of the worst hundredth have of each effect against all, by how far it lies off the middle.
    pub tail: Vec<TailShift>,
}

/// The numbers that have percentiles, by name.
const NAMES: [&str; FIGURES] = [
    "error_um",
    "true_error_um",
    "worst_um",
    "bottom_overshoot_um",
    "stroke_over_bound",
    "last_worst_um",
    "last_bottom_overshoot_um",
    "worst_growth_ratio",
];

fn figures(machine: &SweptMachine) -> [f64; FIGURES] {
    let SweptMachine { first, last, worst_growth_ratio, .. } = machine;
    [
        first.error_um,
        first.true_error_um,
        first.worst_um,
        first.bottom_overshoot_um,
        first.stroke_over_bound,
        last.worst_um,
        last.bottom_overshoot_um,
        worst_growth_ratio.unwrap_or(f64::NAN),
    ]
}

/// Least and greatest value of each number.
pub(super) struct Extremes([[f64; 2]; FIGURES]);

impl Extremes {
    /// Each by its name.
    pub(super) fn named(&self) -> [(&'static str, [f64; 2]); FIGURES] {
        std::array::from_fn(|index| (NAMES[index], self.0[index]))
    }
}

/// Of all machines, in one pass; a value that is no number counts as the greatest.
pub(super) fn extremes(records: &mut Records) -> io::Result<Extremes> {
    let mut found = Extremes([[f64::INFINITY, f64::NEG_INFINITY]; FIGURES]);
    records.each_outcome(&mut |machine| {
        for ([least, most], value) in found.0.iter_mut().zip(figures(machine)) {
            *least = least.min(value);
            *most = if value.is_nan() || *most < value { value } else { *most };
        }
    })?;
    Ok(found)
}

/// Counts and the worst machines, in one pass and a look at those.
pub(super) fn counts_and_worst(records: &mut Records) -> io::Result<(Counts, Vec<SweptMachine>)> {
    let mut counts = Counts::default();
    let mut worst: Vec<(f64, u32)> = Vec::new();
    records.each_outcome(&mut |machine| {
        counts.add(machine);
        // Machines come in the order of their numbers, so that of equals the first stays ahead.
        let size = badness(machine);
        let at = worst.partition_point(|(other, _)| other.total_cmp(&size).is_ge());
        if at < WORST {
            worst.insert(at, (size, machine.run));
            worst.truncate(WORST);
        }
    })?;
    let mut whole = Vec::new();
    records.each_of(&mut |machine| worst.iter().any(|(_, run)| *run == machine.run), &mut |machine| {
        whole.push(*machine)
    })?;
    whole.sort_by_key(|machine: &SweptMachine| worst.iter().position(|(_, run)| *run == machine.run));
    Ok((counts, whole))
}

/// All of it, in a few passes.
pub(super) fn summary(records: &mut Records) -> io::Result<SweepSummary> {
    let (counts, worst) = counts_and_worst(records)?;
    let machines = records.machines();
    let ranks = Percentiles::ranks(machines);
    let wanted: Vec<_> = (0..FIGURES).flat_map(|column| ranks.map(|rank| (column, rank))).collect();
    let found = at_ranks(&wanted, machines, &mut |see| records.each_outcome(&mut |machine| see(&figures(machine))))?;
    let of = |column: usize| {
        let at = |index: usize| found.get(column * ranks.len() + index).copied().unwrap_or(f64::NAN);
        Percentiles { p50: at(0), p99: at(1), p999: at(2), max: at(3) }
    };
    Ok(SweepSummary {
        counts,
        error_um: of(0),
        true_error_um: of(1),
        worst_um: of(2),
        bottom_overshoot_um: of(3),
        stroke_over_bound: of(4),
        last_worst_um: of(5),
        last_bottom_overshoot_um: of(6),
        worst_growth_ratio: of(7),
        worst,
        tail: shifts(records)?,
    })
}
