//! `sweep`.

use schemars::JsonSchema;
use serde::Serialize;

use super::parts::finite;
use crate::control::machine::Law;
use crate::control::sync::Settings;
use crate::sim::Actual;
use crate::study::{Percentiles, Sweep, SweepSettings, SweptMachine};

/// Many machines that differ from the nominal one. A number that an alarm kept from being is null.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct SweepAnswer {
    file: String,
    /// Time law of the strokes, by the command line's name.
    law: &'static str,
    /// What Z follows, by the command line's name.
    sync: &'static str,
    /// Compensation of Z, by the command line's name.
    compensation: &'static str,
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
    /// Machines with |e| over 1 mm, or with a growing oscillation.
    unstable: usize,
    /// Machines whose spindle drive stood at its torque limit.
    saturated: usize,
    /// Machines that an alarm stopped.
    alarms: usize,
    /// First hole: measured e(k), peak to peak.
    error_um: PercentilesAnswer,
    /// First hole: true e(k), peak to peak.
    true_error_um: PercentilesAnswer,
    /// First hole: the larger of the two, by machine.
    worst_um: PercentilesAnswer,
    /// First hole: greatest true depth below the programmed bottom.
    bottom_overshoot_um: PercentilesAnswer,
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

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct WorstMachine {
    /// Number in the sweep, from 1.
    run: u32,
    /// Seed of what is random in it.
    seed: u64,
    worst_um: Option<f64>,
    actual: ActualAnswer,
}

/// `[actual]`: factors, and values where they are not the file's.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct ActualAnswer {
    inertia: f64,
    torque_limit: f64,
    torque_constant: f64,
    friction: f64,
    spindle_resonance: f64,
    z_resonance: f64,
    cutting_torque: f64,
    encoder_error: f64,
    backlash_um: Option<f64>,
    encoder_latency_s: Option<f64>,
}

impl SweepAnswer {
    /// Of a sweep that was run.
    #[must_use]
    pub fn new(file: &str, law: Law, sync: Settings, settings: &SweepSettings, sweep: &Sweep) -> Self {
        let of = |number: fn(&SweptMachine) -> f64| PercentilesAnswer::from(sweep.percentiles(number));
        let later = (settings.holes.get() > 1).then(|| {
            let worst_um = of(|machine| machine.last.worst_um);
            let overshoot_um = of(|machine| machine.last.bottom_overshoot_um);
            let where_so = |so: bool, value: PercentilesAnswer| so.then_some(value);
            LaterHoles {
                last_worst_um: where_so(!sync.learn, worst_um),
                last_bottom_overshoot_um: where_so(!sync.learn, overshoot_um),
                learned_worst_um: where_so(sync.learn, worst_um),
                learned_bottom_overshoot_um: where_so(sync.learn, overshoot_um),
                worst_growth_ratio: of(|machine| machine.worst_growth_ratio.unwrap_or(f64::NAN)),
            }
        });
        Self {
            file: file.to_owned(),
            law: law.name(),
            sync: sync.mode.name(),
            compensation: sync.compensation.name(),
            identify: sync.identify,
            learn: sync.learn,
            runs: settings.runs.get(),
            holes: settings.holes.get(),
            nominal: settings.spread.is_none(),
            unstable: sweep.count(|machine| machine.unstable),
            saturated: sweep.count(|machine| machine.saturated),
            alarms: sweep.count(|machine| machine.alarm.is_some()),
            error_um: of(|machine| machine.first.error_um),
            true_error_um: of(|machine| machine.first.true_error_um),
            worst_um: of(|machine| machine.first.worst_um),
            bottom_overshoot_um: of(|machine| machine.first.bottom_overshoot_um),
            worst: sweep.worst().map(|machine| WorstMachine {
                run: machine.run,
                seed: machine.seed,
                worst_um: finite(machine.first.worst_um),
                actual: (&machine.actual).into(),
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

impl From<&Actual> for ActualAnswer {
    fn from(actual: &Actual) -> Self {
        Self {
            inertia: actual.inertia,
            torque_limit: actual.torque_limit,
            torque_constant: actual.torque_constant,
            friction: actual.friction,
            spindle_resonance: actual.spindle_resonance,
            z_resonance: actual.z_resonance,
            cutting_torque: actual.cutting_torque,
            encoder_error: actual.encoder_error,
            backlash_um: actual.backlash_um,
            encoder_latency_s: actual.encoder_latency_s,
        }
    }
}
