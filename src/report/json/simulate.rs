//! `simulate`.

use schemars::JsonSchema;
use serde::Serialize;

use super::alarm::AlarmAnswer;
use super::parts::{Band, MethodAnswer, finite};
use crate::control::machine::{Law, Machine};
use crate::control::sync::Settings;
use crate::control::units::um_from_mm;
use crate::report::alarm::power_loss_sentence;
use crate::report::unit::deg_and_pulses_per_um;
use crate::run::{HoleOutcome, PowerLoss, PowerLossEnd, ProgramOutcome, StrokeOutcome};

/// Programs in the order of the command line.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct SimulateAnswer {
    /// Each on a fresh machine.
    pub programs: Vec<SimulatedProgram>,
}

/// One program that ran.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct SimulatedProgram {
    file: String,
    #[serde(flatten)]
    method: MethodAnswer,
    /// The synchronizer identified the machine on its way.
    identify: bool,
    /// It learned from hole to hole.
    learn: bool,
    /// Time from the first to the last period.
    total_s: f64,
    /// The worst of the holes; `fail` where an alarm ended the run.
    #[schemars(extend("enum" = ["ok", "warning", "fail"]))]
    verdict: &'static str,
    /// The alarm that ended the run; null where none did.
    alarm: Option<AlarmAnswer>,
    /// The power cut that ended the run; null where none did.
    power_loss: Option<PowerLossAnswer>,
    /// Holes in their order.
    holes: Vec<HoleAnswer>,
}

#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct HoleAnswer {
    /// Number in the program, from 1.
    hole: u32,
    x_mm: f64,
    y_mm: f64,
    /// The worst of error, true error and depth against their tolerances.
    #[schemars(extend("enum" = ["ok", "warning", "fail"]))]
    verdict: &'static str,
    /// The alarm that ended this hole; null where none did.
    alarm: Option<AlarmAnswer>,
    pitch_mm: f64,
    /// What the thread bears, peak to peak.
    tolerance_um: f64,
    /// Measured synchronisation error e(k) over all synchronous periods.
    error_um: Band,
    /// The same as an angle of the spindle.
    error_deg: Band,
    /// The same in counts of the spindle's encoder.
    error_pulses: Band,
    /// e(k) of the true angle at the tool and the true tool tip.
    true_error_um: Band,
    /// Greatest true depth less the programmed bottom; positive is too deep.
    bottom_overshoot_um: Option<f64>,
    /// Time at R, before the first stroke and after the last, until both axes stand.
    wait_s: f64,
    /// The spindle's drive stood at its torque limit.
    saturated: bool,
    /// Samples that were missing or repeated, and for which the model stood in.
    bridged_samples: u32,
    /// Strokes in their order.
    strokes: Vec<StrokeAnswer>,
}

#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct StrokeAnswer {
    #[schemars(extend("enum" = ["in", "dwell", "out"]))]
    stroke: &'static str,
    /// Time taken.
    duration_s: f64,
    /// The least time that 100 % of the motor could do, without friction.
    bound_s: f64,
    /// Time taken over that minimum.
    stroke_over_bound: Option<f64>,
    /// Planned peak speed.
    peak_rpm: f64,
    /// e(k), with the hole's zero.
    error_um: Band,
    /// Greatest following error of the spindle, a magnitude.
    spindle_following_error_rev: Option<f64>,
    /// By segment of the plan.
    phases: Vec<PhaseAnswer>,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct PhaseAnswer {
    /// Segment of the plan, from 0.
    phase: usize,
    /// e(k) in it, with the hole's zero.
    error_um: Band,
}

impl SimulatedProgram {
    /// Of a program that ran.
    #[must_use]
    pub fn new(file: &str, law: Law, sync: Settings, machine: &Machine, outcome: &ProgramOutcome) -> Self {
        let alarm = outcome.fault.as_ref().map(AlarmAnswer::from);
        Self {
            file: file.to_owned(),
            method: MethodAnswer::new(law, &sync),
            identify: sync.identify,
            learn: sync.learn,
            total_s: outcome.total_s,
            verdict: outcome.verdict().name(),
            power_loss: outcome.power_loss.as_ref().map(PowerLossAnswer::from),
            holes: outcome.holes.iter().map(|hole| HoleAnswer::new(hole, machine, alarm.as_ref())).collect(),
            alarm,
        }
    }
}

/// A power cut, and what came of it after the restart.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
struct PowerLossAnswer {
    /// From the program's start.
    time_s: f64,
    #[schemars(extend("enum" = ["mains", "dead"]))]
    lost: &'static str,
    /// Number in the program, from 1; null between holes.
    hole: Option<u32>,
    /// How deep below R the tap stood, by the record; null where no hole had begun.
    depth_mm: Option<f64>,
    /// How far Z led the hole's helix there; null likewise.
    offset_um: Option<f64>,
    #[schemars(extend("enum" = ["no-hole", "retracted", "refused", "alarm", "coasting"]))]
    end: &'static str,
    /// What came of it, in words.
    message: String,
}

impl From<&PowerLoss> for PowerLossAnswer {
    fn from(loss: &PowerLoss) -> Self {
        Self {
            time_s: loss.time_s,
            lost: loss.lost.name(),
            hole: loss.hole,
            depth_mm: loss.standing.map(|standing| standing.depth_mm),
            offset_um: loss.standing.map(|standing| um_from_mm(standing.offset_mm)),
            end: match loss.end {
                PowerLossEnd::NoHole => "no-hole",
                PowerLossEnd::Retracted => "retracted",
                PowerLossEnd::Refused(_) => "refused",
                PowerLossEnd::Alarm(_) => "alarm",
                PowerLossEnd::Coasting => "coasting",
            },
            message: power_loss_sentence(loss),
        }
    }
}

impl HoleAnswer {
    fn new(hole: &HoleOutcome, machine: &Machine, alarm: Option<&AlarmAnswer>) -> Self {
        let (deg_per_um, pulses_per_um) = deg_and_pulses_per_um(hole.pitch_mm, machine);
        Self {
            hole: hole.hole,
            x_mm: hole.x_mm,
            y_mm: hole.y_mm,
            verdict: hole.verdict().name(),
            alarm: alarm.filter(|alarm| alarm.hole == hole.hole).cloned(),
            pitch_mm: hole.pitch_mm,
            tolerance_um: hole.tolerance_um,
            error_um: (&hole.error_um).into(),
            error_deg: (&hole.error_um.scaled(deg_per_um)).into(),
            error_pulses: (&hole.error_um.scaled(pulses_per_um)).into(),
            true_error_um: (&hole.true_error_um).into(),
            bottom_overshoot_um: finite(hole.bottom_overshoot_um),
            wait_s: hole.wait_s,
            saturated: hole.saturated,
            bridged_samples: hole.bridged_samples,
            strokes: hole.strokes.iter().map(StrokeAnswer::from).collect(),
        }
    }
}

impl From<&StrokeOutcome> for StrokeAnswer {
    fn from(stroke: &StrokeOutcome) -> Self {
        let phases = stroke.phases.iter();
        Self {
            stroke: stroke.kind.name(),
            duration_s: stroke.duration_s,
            bound_s: stroke.bound_s,
            stroke_over_bound: finite(stroke.stroke_over_bound()),
            peak_rpm: stroke.peak_rpm,
            error_um: (&stroke.error_um).into(),
            spindle_following_error_rev: finite(stroke.spindle_following_error_rev),
            phases: phases
                .map(|found| PhaseAnswer { phase: found.phase, error_um: (&found.error_um).into() })
                .collect(),
        }
    }
}
