//! One interpolation period as everything after the loop sees it.

use crate::control::cycle::StrokeKind;
use crate::control::port::{Feedback, Setpoint, Truth};

/// What the machine is doing in a period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowStage {
    /// A synchronous stroke.
    Stroke(StrokeKind),
    /// Positioning: G0, G1, or the moves around a hole.
    Rapid,
    /// The spindle comes to rest at R, and both axes settle.
    Orient,
}

impl RowStage {
    /// Name in the trace's column `stroke`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stroke(kind) => kind.name(),
            Self::Rapid => "rapid",
            Self::Orient => "orient",
        }
    }
}

/// One interpolation period: what was read at its start, and what was commanded for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Period, from 0 at the program's start.
    pub k: u64,
    /// Its time.
    pub time_s: f64,
    /// Hole, from 1; 0 between holes.
    pub hole: u32,
    /// What the machine is doing.
    pub stage: RowStage,
    /// Segment of the plan in force, from 0.
    pub phase: usize,
    /// Setpoint of this period.
    pub setpoint: Setpoint,
    /// Reading at its start.
    pub feedback: Feedback,
    /// A sample was missing, and the model stood in for it.
    pub bridged: bool,
    /// Where spindle and Z truly were, where a simulation knows.
    pub truth: Option<Truth>,
    /// Command in force less actual angle of the spindle, rev.
    pub spindle_following_error_rev: f64,
    /// Command in force less actual position of Z.
    pub z_following_error_um: f64,
    /// Correction in force on Z, positive into the hole.
    pub correction_um: f64,
    /// Share by which the governor lets the plan run slower than the clock.
    pub slowed: f64,
    /// e(k) in µm; none outside the synchronous periods.
    pub error_um: Option<f64>,
    /// The same of the tool's true angle and the true tool tip.
    pub true_error_um: Option<f64>,
}
