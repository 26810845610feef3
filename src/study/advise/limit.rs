//! What keeps a kind of hole from being tapped faster.

use super::bench::Bench;
use super::kinds::at_speed;
use super::trial::Setting;
use crate::control::cycle::{CyclePlan, StrokeKind, TapCycle};
use crate::control::machine::Machine;
use crate::control::units::{mm_per_min_from_mm_per_s, rpm_from_rev_per_s};
use crate::sim::Effect;

/// What keeps a kind of hole from being tapped faster.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Limit {
    /// The hole is so short that the motor has to brake before it reaches the speed: more S changes nothing.
    Motor {
        /// The speed that it reaches.
        peak_rpm: f64,
    },
    /// The spindle's greatest speed.
    SpindleSpeed {
        /// It.
        max_rpm: f64,
    },
    /// Pitch × speed is all that Z has.
    ZSpeed {
        /// Z's greatest speed.
        max_mm_per_s: f64,
    },
    /// Faster, the error passes its margin.
    Error {
        /// The first speed that was tried and does not hold.
        fails_at_rpm: f64,
        /// The depth below the bottom does, not the thread.
        by_depth: bool,
        /// What of the machine makes most of it; none where no single effect does.
        effect: Option<Effect>,
    },
}

/// Speeds that a person would write: the step of the advice.
pub(super) fn step_rpm(speed_rpm: f64) -> f64 {
    if speed_rpm < 1000.0 { 10.0 } else { 50.0 }
}

/// A speed rounded down to its step.
pub(super) fn rounded_down(speed_rpm: f64) -> f64 {
    let step = step_rpm(speed_rpm);
    ((speed_rpm / step + 1e-9).floor() * step).max(step)
}

/// The greatest speed that spindle and Z have for a pitch, in the advice's steps.
pub(super) fn machine_rpm(machine: &Machine, hole: &TapCycle) -> f64 {
    let spec = machine.spec();
    let by_z = rpm_from_rev_per_s(spec.z.max_mm_per_s / hole.pitch_mm);
    let out_ratio = (hole.out_speed_rpm / hole.speed_rpm).max(1.0);
    rounded_down(spec.spindle.max_rpm.min(by_z) / out_ratio)
}

/// The plan's peak speed on the way in; none where there is no plan.
pub(super) fn peak_rpm(setting: &Setting, hole: &TapCycle) -> Option<f64> {
    let plan = CyclePlan::new(*hole, &setting.machine, setting.law).ok()?;
    let inward = plan.strokes().filter(|stroke| stroke.kind == StrokeKind::In);
    Some(inward.map(|stroke| stroke.peak_rpm()).fold(0.0, f64::max))
}

/// Time of the planned strokes of one hole; none where there is no plan.
pub(super) fn planned_s(setting: &Setting, hole: &TapCycle) -> Option<f64> {
    let plan = CyclePlan::new(*hole, &setting.machine, setting.law).ok()?;
    Some(plan.strokes().filter(|stroke| stroke.kind.moves()).map(|stroke| stroke.duration_s).sum())
}

/// The greatest speed that still makes a hole shorter in time, in the advice's steps; none where there is no plan.
pub(super) fn useful_rpm(setting: &Setting, hole: &TapCycle) -> Option<f64> {
    let most = machine_rpm(&setting.machine, hole);
    let peak = peak_rpm(setting, &at_speed(hole, most))?;
    let step = step_rpm(peak);
    Some(most.min((peak / step - 1e-9).ceil() * step))
}

/// Least share of what a machine uses that an effect has to make, to be named.
const LEAST_PART: f64 = 0.15;

impl Bench<'_> {
    /// What keeps a hole at the speed that it has; `fails_at` is a greater speed that did not hold, with its worst machine.
    pub(super) fn limit(&self, setting: &Setting, hole: &TapCycle, fails_at: Option<(f64, u32, bool)>) -> Limit {
        let spec = setting.machine.spec();
        if let Some((fails_at_rpm, run, by_depth)) = fails_at {
            let effect = self.cause(setting, &at_speed(hole, fails_at_rpm), run);
            return Limit::Error { fails_at_rpm, by_depth, effect };
        }
        let most = machine_rpm(&setting.machine, hole);
        let peak = peak_rpm(setting, &at_speed(hole, most)).unwrap_or(most);
        if peak < 0.999 * most {
            Limit::Motor { peak_rpm: peak }
        } else if hole.pitch_mm * spec.spindle.max_rpm > mm_per_min_from_mm_per_s(spec.z.max_mm_per_s) {
            Limit::ZSpeed { max_mm_per_s: spec.z.max_mm_per_s }
        } else {
            Limit::SpindleSpeed { max_rpm: spec.spindle.max_rpm }
        }
    }

    /// The effect without which a machine uses least of its limits.
    fn cause(&self, setting: &Setting, hole: &TapCycle, run: u32) -> Option<Effect> {
        let whole = self.used_without(setting, hole, run, None);
        let present = Effect::ALL.into_iter().filter(|effect| self.base.actual.has(*effect));
        let without = present.map(|effect| (effect, self.used_without(setting, hole, run, Some(effect))));
        let best = without.min_by(|left, right| left.1.total_cmp(&right.1));
        best.filter(|(_, used)| *used < (1.0 - LEAST_PART) * whole).map(|(effect, _)| effect)
    }
}
