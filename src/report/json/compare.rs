//! `compare`.

use schemars::JsonSchema;
use serde::Serialize;

use super::alarm::AlarmAnswer;
use super::parts::{Band, MethodAnswer, finite};
use crate::study::{Comparison, Summary};

/// Programs in the order of the command line.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct CompareAnswer {
    /// Each under every combination.
    pub programs: Vec<ComparedProgram>,
}

/// One program under every combination of the lists.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct ComparedProgram {
    file: String,
    /// Combinations in the order of the lists.
    laws: Vec<CombinationAnswer>,
}

/// One combination, worst over the program's holes.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct CombinationAnswer {
    #[serde(flatten)]
    method: MethodAnswer,
    /// Torque utilisation that the law was tuned to; null for the machine file's.
    share: Option<f64>,
    /// Effect that the plant lacks; null for the full plant.
    without: Option<&'static str>,
    /// Longest stroke.
    stroke_s: f64,
    /// Greatest time of a stroke over its minimum.
    stroke_over_bound: Option<f64>,
    /// Greatest planned speed.
    peak_rpm: f64,
    /// Greatest torque that the plan asks, over what the motor has at that speed.
    peak_torque_share: Option<f64>,
    /// Greatest planned jerk; null where the acceleration steps.
    peak_jerk_rpm_per_s2: Option<f64>,
    /// Measured e(k) of the hole with the widest band.
    error_um: Band,
    /// True e(k) of the hole with the widest band.
    true_error_um: Band,
    /// Greatest following error of the spindle, a magnitude.
    spindle_following_error_rev: Option<f64>,
    /// In some hole the spindle's drive stood at its torque limit.
    saturated: bool,
    /// The worst of the holes.
    #[schemars(extend("enum" = ["ok", "warning", "fail"]))]
    verdict: &'static str,
    /// The alarm that ended the run; null where none did.
    alarm: Option<AlarmAnswer>,
}

impl ComparedProgram {
    /// Of a program's results.
    #[must_use]
    pub fn new(file: &str, comparisons: &[Comparison]) -> Self {
        Self { file: file.to_owned(), laws: comparisons.iter().map(CombinationAnswer::from).collect() }
    }
}

impl From<&Comparison> for CombinationAnswer {
    fn from(comparison: &Comparison) -> Self {
        let summary = Summary::of(&comparison.outcome);
        let variant = comparison.variant;
        Self {
            method: MethodAnswer::new(variant.law, &variant.sync),
            share: variant.share,
            without: variant.without.map(|effect| effect.name()),
            stroke_s: summary.stroke_s,
            stroke_over_bound: finite(summary.stroke_over_bound),
            peak_rpm: summary.peak_rpm,
            peak_torque_share: finite(summary.peak_torque_share),
            peak_jerk_rpm_per_s2: summary.peak_jerk_rpm_per_s2.and_then(finite),
            error_um: (&summary.error_um).into(),
            true_error_um: (&summary.true_error_um).into(),
            spindle_following_error_rev: finite(summary.spindle_following_error_rev),
            saturated: summary.saturated,
            verdict: summary.verdict.name(),
            alarm: comparison.outcome.fault.as_ref().map(AlarmAnswer::from),
        }
    }
}
