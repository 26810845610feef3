//! `advise`.

use schemars::JsonSchema;
use serde::Serialize;

use super::parts::{MethodAnswer, finite};
use crate::control::sync::Settings;
use crate::report::advice::{Asked, ControlSheet, answer_sentences, limit_sentence, yield_bound};
use crate::study::{Advice, Alternative, KindAdvice, Limit, Trial};

/// What to set, what it gains, what limits it.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct AdviseAnswer {
    /// Programs that make the part, in the order of the command line.
    files: Vec<String>,
    /// The answer in three sentences.
    answer: [String; 3],
    #[serde(flatten)]
    method: MethodAnswer,
    /// Utilisation of the motor; null where the law has none.
    share: Option<f64>,
    /// Machines that it was shown on.
    runs: u32,
    /// Greatest share of tolerance and clearance that was allowed.
    margin: f64,
    /// By 95 % confidence at least this share of such machines stays under the margin.
    good_ratio_bound: f64,
    /// Time of a part as advised, without what holes wait for the axes to stand.
    part_s: f64,
    /// Law that the programs run under now.
    present_law: &'static str,
    /// Time of a part under it; null where it has no plan.
    present_part_s: Option<f64>,
    /// What a part saves.
    saved_s: Option<f64>,
    /// Parts in a year.
    parts_per_year: Option<f64>,
    /// What a year saves.
    saved_h_per_year: Option<f64>,
    /// What 20 % more torque would take off a part.
    more_torque_s: Option<f64>,
    /// Each kind of hole.
    holes: Vec<KindAnswer>,
    /// Settings that were looked at, the fastest promise first.
    alternatives: Vec<AlternativeAnswer>,
    /// What to type into the control; null unless one was named.
    control: Option<ControlAnswer>,
    /// The machine file's lines to set it.
    toml: String,
}

/// One kind of hole.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct KindAnswer {
    /// Line of the first of them.
    line: u32,
    /// How many there are.
    count: usize,
    pitch_mm: f64,
    depth_mm: f64,
    /// As programmed.
    programmed_rpm: f64,
    /// As advised.
    speed_rpm: f64,
    /// F that goes with it.
    feed_mm_per_min: f64,
    /// What limits it.
    #[schemars(extend("enum" = ["motor", "spindle-speed", "z-speed", "error", "depth"]))]
    limit: &'static str,
    /// The same in words.
    limit_message: String,
    /// The effect that makes most of the error; null where no single one does, or where the error does not limit it.
    limit_effect: Option<&'static str>,
    /// At the advised speed.
    advised: TrialAnswer,
    /// As it runs now; null where the present law has no plan for it.
    present: Option<TrialAnswer>,
    /// Other speeds, slower first.
    others: Vec<TrialAnswer>,
}

/// One speed on some machines.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct TrialAnswer {
    speed_rpm: f64,
    runs: u32,
    /// Machines under the margin.
    good: u32,
    /// Stopped by an alarm.
    alarms: u32,
    /// Mean time of one hole's strokes.
    hole_s: Option<f64>,
    /// Greatest e(k), the worse of measured and true, peak to peak.
    worst_um: Option<f64>,
    /// Greatest depth below the bottom.
    bottom_overshoot_um: Option<f64>,
    /// Greatest error or depth over what is allowed; null after an alarm.
    used: Option<f64>,
}

/// A setting that was looked at.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct AlternativeAnswer {
    law: &'static str,
    share: Option<f64>,
    /// Time of all holes' strokes where it holds; null where it does not.
    holes_s: Option<f64>,
}

/// A control's parameters.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct ControlAnswer {
    name: &'static str,
    parameters: Vec<ParameterAnswer>,
    /// What is not said here, and what to look up.
    notes: Vec<&'static str>,
}

/// One parameter of a control.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct ParameterAnswer {
    /// Number or name; null where no manual that was found tells it.
    number: Option<&'static str>,
    meaning: &'static str,
    value: String,
    unit: &'static str,
    rounding: &'static str,
    source: &'static str,
}

impl AdviseAnswer {
    /// Of an advice.
    #[must_use]
    pub fn new(
        files: Vec<String>,
        advice: &Advice,
        asked: &Asked,
        sync: &Settings,
        control: Option<&ControlSheet>,
        toml: String,
    ) -> Self {
        let saved_s = advice.present_s.map(|present_s| present_s - advice.part_s);
        let per_year =
            |saved_s: f64| asked.parts_per_year.map(|parts| parts * saved_s / crate::control::units::S_PER_HOUR);
        Self {
            files,
            answer: answer_sentences(advice, asked),
            method: MethodAnswer::new(advice.law, sync),
            share: advice.share,
            runs: asked.runs,
            margin: asked.margin,
            good_ratio_bound: yield_bound(asked.runs),
            part_s: advice.part_s,
            present_law: asked.present.name(),
            present_part_s: advice.present_s.and_then(finite),
            saved_s: saved_s.and_then(finite),
            parts_per_year: asked.parts_per_year,
            saved_h_per_year: saved_s.and_then(per_year).and_then(finite),
            more_torque_s: advice.more_torque_s,
            holes: advice.kinds.iter().map(KindAnswer::from).collect(),
            alternatives: advice.alternatives.iter().map(AlternativeAnswer::from).collect(),
            control: control.map(ControlAnswer::from),
            toml,
        }
    }
}

impl From<&KindAdvice> for KindAnswer {
    fn from(advice: &KindAdvice) -> Self {
        let (limit, limit_effect) = match advice.limit {
            Limit::Motor { .. } => ("motor", None),
            Limit::SpindleSpeed { .. } => ("spindle-speed", None),
            Limit::ZSpeed { .. } => ("z-speed", None),
            Limit::Error { by_depth, effect, .. } => (if by_depth { "depth" } else { "error" }, effect),
        };
        let hole = &advice.kind.hole;
        Self {
            line: advice.kind.line,
            count: advice.kind.count,
            pitch_mm: hole.pitch_mm,
            depth_mm: hole.depth_mm(),
            programmed_rpm: hole.speed_rpm,
            speed_rpm: advice.trial.speed_rpm,
            feed_mm_per_min: advice.trial.speed_rpm * hole.pitch_mm,
            limit,
            limit_message: limit_sentence(advice),
            limit_effect: limit_effect.map(|effect| effect.name()),
            advised: (&advice.trial).into(),
            present: advice.present.as_ref().map(TrialAnswer::from),
            others: advice.others.iter().map(TrialAnswer::from).collect(),
        }
    }
}

impl From<&Trial> for TrialAnswer {
    fn from(trial: &Trial) -> Self {
        Self {
            speed_rpm: trial.speed_rpm,
            runs: trial.runs,
            good: trial.good,
            alarms: trial.alarms,
            hole_s: finite(trial.hole_s),
            worst_um: finite(trial.worst_um),
            bottom_overshoot_um: finite(trial.deepest_um),
            used: finite(trial.used),
        }
    }
}

impl From<&Alternative> for AlternativeAnswer {
    fn from(found: &Alternative) -> Self {
        Self { law: found.law.name(), share: found.share, holes_s: found.holes_s }
    }
}

impl From<&ControlSheet> for ControlAnswer {
    fn from(sheet: &ControlSheet) -> Self {
        let parameters = sheet.parameters.iter().cloned().map(|found| ParameterAnswer {
            number: found.number,
            meaning: found.name,
            value: found.value,
            unit: found.unit,
            rounding: found.rounding,
            source: found.source,
        });
        Self { name: sheet.control.name(), parameters: parameters.collect(), notes: sheet.notes.clone() }
    }
}
