//! `sweep`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use super::parts::{ActualAnswer, MethodAnswer, finite};
use crate::control::machine::Law;
use crate::control::sync::Settings;
use crate::study::{Percentiles, Sweep, SweepSettings, SweepSummary, TailShift};

/// Many machines that differ from the nominal one. A number that an alarm kept from being is null.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct SweepAnswer {
    file: String,
    #[serde(flatten)]
    method: MethodAnswer,
    /// The synchronizer identified the machine on its way.
    identify: bool,
    /// It learned from hole to hole.
    learn: bool,
    /// Number of machines.
    runs: u32,
    /// How often each machine tapped the hole.
    holes: u32,
    /// The machines differ in what is random alone.
    nominal: bool,
    /// They were drawn from `[spread.hard]`, too.
    hard: bool,
    /// Machines with |e| over 1 mm, or with a growing oscillation.
    unstable: u32,
    /// Machines whose spindle drive stood at its torque limit.
    saturated: u32,
    /// Machines that an alarm stopped.
    alarms: u32,
    /// First hole: measured e(k), peak to peak.
    error_um: PercentilesAnswer,
    /// First hole: true e(k), peak to peak.
    true_error_um: PercentilesAnswer,
    /// First hole: the larger of the two, by machine.
    worst_um: PercentilesAnswer,
    /// First hole: greatest true depth below the programmed bottom.
    bottom_overshoot_um: PercentilesAnswer,
    /// First hole: time of a stroke over the frictionless minimum.
    stroke_over_bound: PercentilesAnswer,
    /// Share of the machines whose first hole fails.
    fail_ratio: f64,
    /// Share of those that are a warning.
    warning_ratio: f64,
    /// What the worst hundredth has of each effect.
    tail: Vec<TailAnswer>,
    /// The machine with the worst first hole.
    worst: Option<WorstMachine>,
    /// The last of several holes.
    #[serde(flatten)]
    later: Option<LaterHoles>,
}

/// The last of several holes; named `learned_…` where the synchronizer learned.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct LaterHoles {
    #[serde(skip_serializing_if = "Option::is_none")]
    last_worst_um: Option<PercentilesAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    last_bottom_overshoot_um: Option<PercentilesAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    learned_worst_um: Option<PercentilesAnswer>,
    #[serde(skip_serializing_if = "Option::is_none")]
    learned_bottom_overshoot_um: Option<PercentilesAnswer>,
    /// The worst later hole over the first, by machine.
    worst_growth_ratio: PercentilesAnswer,
}

/// Percentiles by nearest rank.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct PercentilesAnswer {
    p50: Option<f64>,
    p99: Option<f64>,
    /// The 99.9th.
    p999: Option<f64>,
    max: Option<f64>,
}

#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct WorstMachine {
    /// Number in the sweep, from 1.
    run: u32,
    /// Seed of what is random in it.
    seed: u64,
    worst_um: Option<f64>,
    /// `[actual]` by its keys: factors, and values where they are not the file's.
    actual: BTreeMap<&'static str, ActualAnswer>,
}

/// An effect in the worst hundredth of the machines.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct TailAnswer {
    /// Key of `[actual]`.
    key: String,
    /// Median over all machines.
    all: f64,
    /// Median over the worst hundredth.
    tail: f64,
    /// Rank of that median among all, 0 to 1; 0.5 where the effect has no part in the tail.
    rank: f64,
}

impl SweepAnswer {
    /// Of a sweep that was run.
    #[must_use]
    pub fn new(file: &str, law: Law, sync: Settings, settings: &SweepSettings, sweep: &Sweep) -> Self {
        let SweepSummary { counts, tail, .. } = &sweep.summary;
        let found = &sweep.summary;
        let later = (settings.holes.get() > 1).then(|| {
            let worst_um = found.last_worst_um.into();
            let overshoot_um = found.last_bottom_overshoot_um.into();
            let where_so = |so: bool, value: PercentilesAnswer| so.then_some(value);
            LaterHoles {
                last_worst_um: where_so(!sync.learn, worst_um),
                last_bottom_overshoot_um: where_so(!sync.learn, overshoot_um),
                learned_worst_um: where_so(sync.learn, worst_um),
                learned_bottom_overshoot_um: where_so(sync.learn, overshoot_um),
                worst_growth_ratio: found.worst_growth_ratio.into(),
            }
        });
        Self {
            file: file.to_owned(),
            method: MethodAnswer::new(law, &sync),
            identify: sync.identify,
            learn: sync.learn,
            runs: settings.runs.get(),
            holes: settings.holes.get(),
            nominal: settings.spread.is_none(),
            hard: settings.hard.is_some(),
            unstable: counts.unstable,
            saturated: counts.saturated,
            alarms: counts.alarms,
            error_um: found.error_um.into(),
            true_error_um: found.true_error_um.into(),
            worst_um: found.worst_um.into(),
            bottom_overshoot_um: found.bottom_overshoot_um.into(),
            stroke_over_bound: found.stroke_over_bound.into(),
            fail_ratio: counts.fail_ratio(),
            warning_ratio: counts.warning_ratio(),
            tail: tail.iter().cloned().map(TailAnswer::from).collect(),
            worst: sweep.worst().map(|machine| WorstMachine {
                run: machine.run,
                seed: machine.seed,
                worst_um: finite(machine.first.worst_um),
                actual: machine.actual.values().into_iter().map(|(key, value)| (key, value.into())).collect(),
            }),
            later,
        }
    }
}

impl From<Percentiles> for PercentilesAnswer {
    fn from(Percentiles { p50, p99, p999, max }: Percentiles) -> Self {
        let [p50, p99, p999, max] = [p50, p99, p999, max].map(finite);
        Self { p50, p99, p999, max }
    }
}

impl From<TailShift> for TailAnswer {
    fn from(TailShift { key, all, tail, rank }: TailShift) -> Self {
        Self { key, all, tail, rank }
    }
}
