//! Warnings of planning: what the machine can carry out, and should not.

use core::f64::consts::PI;

use crate::control::cycle::{CyclePlan, StrokeKind, TapCycle};
use crate::control::machine::{Law, Machine};
use crate::control::model::cutting::Material;
use crate::gcode::command::{Command, CommandKind};
use crate::gcode::program::plan_hole;

/// A hole that can be tapped, and should be tapped otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Warning {
    /// The stroke is too short for the commanded speed.
    SpeedNotReached {
        /// Of the stroke out, not in.
        out: bool,
        /// Commanded speed.
        command_rpm: f64,
        /// Greatest speed that is reached.
        peak_rpm: f64,
    },
    /// The tap's circumference is faster than the material bears.
    CuttingTooFast {
        /// The greatest speed that is reached.
        speed_m_per_min: f64,
        /// What the material bears.
        limit_m_per_min: f64,
    },
    /// At this pitch the law's acceleration is more than Z's: the hole is planned slower.
    LawSlowed {
        /// The law.
        law: Law,
        /// Factor on its accelerations, jerks and share.
        factor: f64,
        /// Z's greatest acceleration.
        limit_mm_per_s2: f64,
    },
}

impl Warning {
    /// Whether the hole is not tapped as the machine file says: that is told wherever a program runs.
    #[must_use]
    pub const fn changes_the_plan(&self) -> bool {
        matches!(self, Self::LawSlowed { .. })
    }
}

/// Speeds that differ by less are the same.
const SAME_RPM: f64 = 0.5;
const MM_PER_M: f64 = 1000.0;

/// Finds warnings about the holes of a program, once for each group of holes that are tapped alike. Holes that the
/// machine cannot tap are errors and not warnings: see [`Checker`](super::program::Checker).
///
/// ```
/// use rigidtap::control::machine::{Law, Machine};
/// use rigidtap::gcode::{Warning, Warnings, Dialect, Options, interpret};
/// let program = interpret(b"M03S7000 G0X0Y0Z10\nG81Z-10R15F7000\nM30\n", &Dialect::PAPER, Options::default());
/// let (machine, mut found) = (Machine::reference(), Vec::new());
/// let mut warnings = Warnings::new(&machine, Law::TorqueCurve);
/// for command in &program.commands {
///     warnings.command(command, &mut |warning| found.push(warning));
/// }
/// assert!(matches!(found[0], Warning::SpeedNotReached { out: false, peak_rpm, .. } if peak_rpm < 6500.0));
/// ```
#[derive(Clone, Debug)]
pub struct Warnings<'m> {
    machine: &'m Machine,
    law: Law,
    before: Option<TapCycle>,
}

impl<'m> Warnings<'m> {
    /// For a machine and a time law.
    #[must_use]
    pub const fn new(machine: &'m Machine, law: Law) -> Self {
        Self { machine, law, before: None }
    }

    /// The next command.
    pub fn command(&mut self, command: &Command, report: &mut dyn FnMut(Warning)) {
        let CommandKind::Tap(hole) = command.kind else { return };
        if self.before.replace(hole).is_some_and(|before| before.is_alike(&hole)) {
            return;
        }
        if let Ok((plan, slowed)) = plan_hole(hole, self.machine, self.law) {
            if let Some(factor) = slowed {
                let limit_mm_per_s2 = self.machine.spec().z.max_mm_per_s2;
                report(Warning::LawSlowed { law: self.law, factor, limit_mm_per_s2 });
            }
            of_hole(&plan, self.machine, report);
        }
    }
}

fn of_hole(plan: &CyclePlan, machine: &Machine, report: &mut dyn FnMut(Warning)) {
    let hole = plan.cycle();
    let peak_rpm =
        |kind| plan.strokes().filter(|stroke| stroke.kind == kind).map(|stroke| stroke.peak_rpm()).fold(0.0, f64::max);
    let (in_rpm, out_rpm) = (peak_rpm(StrokeKind::In), peak_rpm(StrokeKind::Out));
    if in_rpm < hole.speed_rpm - SAME_RPM {
        report(Warning::SpeedNotReached { out: false, command_rpm: hole.speed_rpm, peak_rpm: in_rpm });
    } else if out_rpm < hole.out_speed_rpm - SAME_RPM {
        report(Warning::SpeedNotReached { out: true, command_rpm: hole.out_speed_rpm, peak_rpm: out_rpm });
    }
    let limit = Material::of_kc(machine.spec().tap.kc_n_per_mm2).and_then(Material::max_m_per_min);
    if let Some((limit_m_per_min, (major_mm, _))) = limit.zip(machine.tap_size(hole.pitch_mm)) {
        let speed_m_per_min = PI * major_mm * in_rpm / MM_PER_M;
        if speed_m_per_min > limit_m_per_min {
            report(Warning::CuttingTooFast { speed_m_per_min, limit_m_per_min });
        }
    }
}
