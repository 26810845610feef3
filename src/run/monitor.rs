//! The monitor: judges e(k), and never computes it.

use crate::control::cycle::{CyclePlan, StrokeKind};
use crate::control::machine::Machine;
use crate::control::motor::Motor;
use crate::control::profile::Profile;
use crate::control::sync::{Alarm, ErrorBand};
use crate::control::units::{rev_per_s_from_rpm, rpm_from_rev_per_s, um_from_mm};

use super::row::{Row, RowStage};

/// How a hole is judged: the worse of measured and true peak-to-peak error against the thread's tolerance, and the tip's depth
/// below the bottom against its clearance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Verdict {
    /// Up to half of the limit.
    #[default]
    Ok,
    /// Up to the limit.
    Warning,
    /// Beyond it.
    Fail,
}

/// Share of the tolerance above which a hole is no longer simply good.
const WARNING_SHARE: f64 = 0.5;

impl Verdict {
    /// The verdict on a peak-to-peak error.
    ///
    /// ```
    /// use rigidtap::run::Verdict;
    /// assert_eq!([20.0, 40.0, 60.0].map(|error_um| Verdict::of(error_um, 53.0)), [Verdict::Ok, Verdict::Warning, Verdict::Fail]);
    /// ```
    #[must_use]
    pub fn of(error_um: f64, tolerance_um: f64) -> Self {
        if error_um <= WARNING_SHARE * tolerance_um {
            Self::Ok
        } else if error_um <= tolerance_um {
            Self::Warning
        } else {
            Self::Fail
        }
    }

    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ok => "ok",
            Self::Warning => "warning",
            Self::Fail => "fail",
        }
    }
}

/// One segment of a stroke's plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseOutcome {
    /// Segment of the plan, from 0.
    pub phase: usize,
    /// e(k) in it, µm, with the hole's zero.
    pub error_um: ErrorBand,
}

/// One stroke of a hole.
#[derive(Clone, Debug, PartialEq)]
pub struct StrokeOutcome {
    /// In or out.
    pub kind: StrokeKind,
    /// Time taken: the planned one, and more where the governor slowed the path.
    pub duration_s: f64,
    /// The frictionless bound at 100 % of the motor.
    pub bound_s: f64,
    /// Planned peak speed.
    pub peak_rpm: f64,
    /// Greatest torque that the plan asks for its inertia, over what the motor has at that speed.
    pub peak_torque_share: f64,
    /// Greatest planned jerk, rpm/s²; none where the acceleration steps.
    pub peak_jerk_rpm_per_s2: Option<f64>,
    /// e(k), µm, with the hole's zero.
    pub error_um: ErrorBand,
    /// Greatest following error of the spindle, a magnitude.
    pub spindle_following_error_rev: f64,
    /// Detail by segment of the plan.
    pub phases: Vec<PhaseOutcome>,
}

impl StrokeOutcome {
    /// Planned time over the bound.
    #[must_use]
    pub fn stroke_over_bound(&self) -> f64 {
        self.duration_s / self.bound_s
    }
}

/// One hole, judged.
#[derive(Clone, Debug, PartialEq)]
pub struct HoleOutcome {
    /// Number in the program, from 1.
    pub hole: u32,
    /// Position.
    pub x_mm: f64,
    /// Position.
    pub y_mm: f64,
    /// Pitch.
    pub pitch_mm: f64,
    /// What the thread bears, peak to peak.
    pub tolerance_um: f64,
    /// Measured e(k) over all synchronous periods, µm.
    pub error_um: ErrorBand,
    /// The same of true angle and true tool tip; empty where nobody knows them.
    pub true_error_um: ErrorBand,
    /// Greatest true depth below the programmed bottom; positive is too deep.
    pub bottom_overshoot_um: f64,
    /// How much too deep the tip may go.
    pub bottom_clearance_um: f64,
    /// Time at R, before the first stroke and after the last, until both axes stand.
    pub wait_s: f64,
    /// The spindle's drive stood at its torque limit.
    pub saturated: bool,
    /// Samples that were missing, and for which the model stood in.
    pub bridged_samples: u32,
    /// The alarm that ended the hole, or that it is warned of.
    pub alarm: Option<Alarm>,
    /// Strokes in their order.
    pub strokes: Vec<StrokeOutcome>,
}

impl HoleOutcome {
    /// The greater of measured and true peak-to-peak error.
    #[must_use]
    pub fn worst_um(&self) -> f64 {
        let (measured, true_one) = (self.error_um.peak_to_peak(), self.true_error_um.peak_to_peak());
        // Not `max`, which would drop a value that is no number.
        if measured >= true_one || measured.is_nan() { measured } else { true_one }
    }

    /// The verdict: the worst of thread, depth and alarm.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let by_alarm = match self.alarm {
            None => Verdict::Ok,
            Some(Alarm::TapBroken { .. }) => Verdict::Warning,
            Some(_) => Verdict::Fail,
        };
        Verdict::of(self.worst_um(), self.tolerance_um).max(self.depth_verdict()).max(by_alarm)
    }

    /// The verdict on the depth alone.
    #[must_use]
    pub fn depth_verdict(&self) -> Verdict {
        Verdict::of(self.bottom_overshoot_um, self.bottom_clearance_um)
    }

    /// What decides the verdict: the error over the tolerance, or the depth over its clearance, whichever is more.
    #[must_use]
    pub fn used_ratio(&self) -> f64 {
        if self.is_decided_by_depth() { self.depth_ratio() } else { self.worst_um() / self.tolerance_um }
    }

    /// Whether the depth decides the verdict, and not the thread.
    #[must_use]
    pub fn is_decided_by_depth(&self) -> bool {
        self.depth_ratio() > self.worst_um() / self.tolerance_um
    }

    fn depth_ratio(&self) -> f64 {
        self.bottom_overshoot_um / self.bottom_clearance_um
    }

    /// Greatest following error of the spindle over all strokes, a magnitude.
    #[must_use]
    pub fn spindle_following_error_rev(&self) -> f64 {
        self.strokes.iter().map(|stroke| stroke.spindle_following_error_rev).fold(0.0, f64::max)
    }
}

/// Gathers one hole's rows.
pub(super) struct Monitor {
    outcome: HoleOutcome,
    bottom_mm: f64,
    period_s: f64,
    /// The stroke in force, in the plan's order.
    stroke: usize,
}

impl Monitor {
    pub(super) fn new(hole: u32, plan: &CyclePlan, machine: &Machine) -> Self {
        let cycle = plan.cycle();
        let strokes = plan.strokes().filter(|stroke| stroke.kind.moves()).map(|stroke| {
            let speed_rpm = if stroke.kind == StrokeKind::In { cycle.speed_rpm } else { cycle.out_speed_rpm };
            let bound = machine.motor().fastest_stroke(stroke.profile.distance(), rev_per_s_from_rpm(speed_rpm), 1.0);
            StrokeOutcome {
                kind: stroke.kind,
                duration_s: stroke.duration_s,
                bound_s: bound.duration_s,
                peak_rpm: stroke.peak_rpm(),
                peak_torque_share: peak_torque_share(&stroke.profile, machine.motor()),
                peak_jerk_rpm_per_s2: stroke.profile.peak_jerk().map(rpm_from_rev_per_s),
                error_um: ErrorBand::default(),
                spindle_following_error_rev: 0.0,
                phases: (0..stroke.profile.segments().len())
                    .map(|phase| PhaseOutcome { phase, error_um: ErrorBand::default() })
                    .collect(),
            }
        });
        let outcome = HoleOutcome {
            hole,
            x_mm: cycle.x_mm,
            y_mm: cycle.y_mm,
            pitch_mm: cycle.pitch_mm,
            // A program without a tolerance for its pitch is refused before it runs; a host's own run has no verdict to lose.
            tolerance_um: machine.sync_tolerance_um(cycle.pitch_mm).unwrap_or(0.0),
            error_um: ErrorBand::default(),
            true_error_um: ErrorBand::default(),
            bottom_overshoot_um: f64::NEG_INFINITY,
            bottom_clearance_um: um_from_mm(machine.bottom_clearance_mm(cycle.pitch_mm)),
            wait_s: 0.0,
            saturated: false,
            bridged_samples: 0,
            alarm: None,
            strokes: strokes.collect(),
        };
        Self { outcome, bottom_mm: cycle.bottom_mm, period_s: machine.spec().control.period_s, stroke: 0 }
    }

    pub(super) fn observe(&mut self, row: &Row) {
        let outcome = &mut self.outcome;
        outcome.bridged_samples += u32::from(row.bridged);
        if row.stage == RowStage::Orient {
            outcome.wait_s += self.period_s;
        }
        let (RowStage::Stroke(kind), Some(error_um)) = (row.stage, row.error_um) else { return };
        outcome.error_um.add(error_um);
        if let Some(true_error_um) = row.true_error_um {
            outcome.true_error_um.add(true_error_um);
        }
        if let Some(truth) = row.truth {
            outcome.bottom_overshoot_um = outcome.bottom_overshoot_um.max(um_from_mm(self.bottom_mm - truth.z_mm));
        }
        outcome.saturated |= row.feedback.torque_saturated();
        // Strokes in and out alternate: with another kind the next one has begun.
        let begun = |index: usize| outcome.strokes.get(index).is_some_and(|stroke| stroke.kind == kind);
        if !begun(self.stroke) && begun(self.stroke + 1) {
            self.stroke += 1;
        }
        if let Some(stroke) = outcome.strokes.get_mut(self.stroke).filter(|stroke| stroke.kind == kind) {
            stroke.error_um.add(error_um);
            stroke.duration_s += row.slowed * self.period_s;
            let following = row.spindle_following_error_rev.abs();
            stroke.spindle_following_error_rev = stroke.spindle_following_error_rev.max(following);
            if let Some(phase) = stroke.phases.get_mut(row.phase) {
                phase.error_um.add(error_um);
            }
        }
    }

    pub(super) fn finish(self, alarm: Option<Alarm>) -> HoleOutcome {
        HoleOutcome { alarm, ..self.outcome }
    }
}

/// Instants of a segment at which its torque is looked at; between them it changes little.
const INSTANTS: u32 = 8;

fn peak_torque_share(profile: &Profile, motor: &Motor) -> f64 {
    let states = profile.segments().iter().flat_map(|segment| {
        (0..=INSTANTS).map(|instant| {
            segment.start.after(segment.duration_s * f64::from(instant) / f64::from(INSTANTS), segment.snap)
        })
    });
    states
        .map(|state| {
            motor.torque_for_nm(state.acceleration.abs()) / motor.curve.torque_nm(rpm_from_rev_per_s(state.velocity))
        })
        .fold(0.0, f64::max)
}
