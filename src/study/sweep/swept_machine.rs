//! What one machine of a sweep comes to.

use crate::run::{HoleOutcome, Verdict};
use crate::sim::Actual;

/// What one hole comes to, µm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoleErrors {
    /// Measured e(k), peak to peak.
    pub error_um: f64,
    /// True e(k), peak to peak.
    pub true_error_um: f64,
    /// The larger of the two.
    pub worst_um: f64,
    /// Greatest true depth below the programmed bottom.
    pub bottom_overshoot_um: f64,
    /// The longest stroke's time over the frictionless bound.
    pub stroke_over_bound: f64,
    /// Time of all its strokes.
    pub strokes_s: f64,
    /// The verdict.
    pub verdict: Verdict,
}

impl HoleErrors {
    /// A hole that was never begun, since an alarm ended the run before it: worse than any other.
    pub const NONE: Self = Self {
        error_um: f64::INFINITY,
        true_error_um: f64::INFINITY,
        worst_um: f64::INFINITY,
        bottom_overshoot_um: f64::INFINITY,
        stroke_over_bound: f64::INFINITY,
        strokes_s: f64::INFINITY,
        verdict: Verdict::Fail,
    };

    pub(super) fn of(outcome: &HoleOutcome) -> Self {
        if outcome.error_um.count() == 0 {
            return Self::NONE;
        }
        Self {
            error_um: outcome.error_um.peak_to_peak(),
            true_error_um: outcome.true_error_um.peak_to_peak(),
            worst_um: outcome.worst_um(),
            bottom_overshoot_um: outcome.bottom_overshoot_um,
            stroke_over_bound: outcome.strokes.iter().map(|stroke| stroke.stroke_over_bound()).fold(0.0, f64::max),
            strokes_s: outcome.strokes.iter().map(|stroke| stroke.duration_s).sum(),
            verdict: outcome.verdict(),
        }
    }
}

/// One machine that was run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweptMachine {
    /// Number in the sweep, from 1.
    pub run: u32,
    /// Seed of what is random in it.
    pub seed: u64,
    /// How it differs from the nominal machine.
    pub actual: Actual,
    /// Its first hole.
    pub first: HoleErrors,
    /// Its last hole; the first where there is one alone.
    pub last: HoleErrors,
    /// The worst later hole's `worst_um` over the first's; none where there is one hole alone.
    pub worst_growth_ratio: Option<f64>,
    /// The spindle's drive stood at its torque limit in some hole.
    pub saturated: bool,
    /// |e| was over 1 mm in some hole, or e(k) swung more than 10 times as far in the last 10 ms of a stroke out as in
    /// its first 10 ms.
    pub unstable: bool,
    /// Code of the alarm that ended its run, such as 108 of A108.
    pub alarm: Option<u32>,
}

impl SweptMachine {
    /// Its first hole is no thread, or its run did not come to its end.
    #[must_use]
    pub fn fails(&self) -> bool {
        self.first.verdict == Verdict::Fail || self.alarm.is_some()
    }
}

/// How bad a machine is, by size alone: a value that is no number counts as the greatest.
pub(super) fn badness(machine: &SweptMachine) -> f64 {
    machine.first.worst_um.abs()
}
