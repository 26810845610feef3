//! `sweep --worst`.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Serialize;

use super::parts::{ActualAnswer, MethodAnswer};
use crate::control::machine::Law;
use crate::control::sync::Settings;
use crate::study::{SweepSettings, WorstMachine};

/// The worst machine that was found in the box that a sweep draws from.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct SweepWorstAnswer {
    file: String,
    #[serde(flatten)]
    method: MethodAnswer,
    /// The synchronizer identified the machine on its way.
    identify: bool,
    /// It learned from hole to hole.
    learn: bool,
    /// Number of machines that were run.
    runs: u32,
    /// How often each machine tapped the hole.
    holes: u32,
    /// `[spread.hard]` was searched, too.
    hard: bool,
    /// Machines of those that looked anywhere, as a sweep does.
    anywhere_runs: u32,
    /// The largest error among those.
    anywhere_um: f64,
    /// Machines whose run ended before their hole began.
    without_error: u32,
    worst: FoundMachine,
    /// Its effects, the one first without which the error is least.
    effects: Vec<EffectAnswer>,
}

/// The machine with the largest error.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct FoundMachine {
    /// Run that found it, from 1.
    run: u32,
    /// Seed of what is random in it.
    seed: u64,
    /// First hole: the larger of measured and true e(k), peak to peak.
    worst_um: f64,
    /// First hole: `ok`, `warning` or `fail`.
    verdict: &'static str,
    /// Code of the alarm that ended its run.
    alarm: Option<u32>,
    /// `[actual]` by its keys.
    actual: BTreeMap<&'static str, ActualAnswer>,
}

/// One effect of it.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct EffectAnswer {
    /// Key of `[actual]`.
    key: &'static str,
    /// As the worst machine has it.
    value: ActualAnswer,
    /// As the nominal machine has it.
    nominal: ActualAnswer,
    /// The error with this one as on the nominal machine; null where the hole then does not begin.
    worst_um: Option<f64>,
}

impl SweepWorstAnswer {
    /// Of a search that was made.
    #[must_use]
    pub fn new(file: &str, law: Law, sync: Settings, settings: &SweepSettings, found: &WorstMachine) -> Self {
        let machine = &found.machine;
        Self {
            file: file.to_owned(),
            method: MethodAnswer::new(law, &sync),
            identify: sync.identify,
            learn: sync.learn,
            runs: found.runs,
            holes: settings.holes.get(),
            hard: settings.hard.is_some(),
            anywhere_runs: found.anywhere_runs,
            anywhere_um: found.anywhere_um,
            without_error: found.without_error,
            worst: FoundMachine {
                run: machine.run,
                seed: machine.seed,
                worst_um: machine.first.worst_um,
                verdict: machine.first.verdict.name(),
                alarm: machine.alarm,
                actual: machine.actual.values().into_iter().map(|(key, value)| (key, value.into())).collect(),
            },
            effects: found
                .effects
                .iter()
                .map(|effect| EffectAnswer {
                    key: effect.key,
                    value: effect.value.into(),
                    nominal: effect.nominal.into(),
                    worst_um: effect.worst_um,
                })
                .collect(),
        }
    }
}
