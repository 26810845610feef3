//! One kind of hole under one setting, on many drawn machines.

use std::num::NonZeroU32;
use std::ops::Range;

use super::bench::Bench;
use crate::control::cycle::TapCycle;
use crate::control::machine::{Law, Machine};
use crate::gcode::program::Action;
use crate::gcode::program::Planner;
use crate::gcode::{Command, CommandKind, Span};
use crate::sim::Effect;
use crate::study::parallel::in_order;
use crate::study::simulation::Simulation;
use crate::study::sweep::{RunRecorder, SweepSettings, SweptMachine, run_machine};

/// So many machines are run before it is asked whether a setting has failed already.
const BATCH: usize = 8;

/// A setting: law and utilisation of the motor with the machine retuned to them.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Setting {
    pub(super) law: Law,
    pub(super) share: Option<f64>,
    pub(super) machine: Machine,
}

/// What one kind of hole came to on some machines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Commanded speed on the way in.
    pub speed_rpm: f64,
    /// Machines that were run.
    pub runs: u32,
    /// Of these, how many stayed under the margin.
    pub good: u32,
    /// Mean time of the strokes of one hole.
    pub hole_s: f64,
    /// Greatest error, the worse of measured and true, µm peak to peak.
    pub worst_um: f64,
    /// Greatest depth below the bottom, µm.
    pub deepest_um: f64,
    /// The worst machine's error or depth over what is allowed, whichever is more; infinite after an alarm.
    pub used: f64,
    /// Whether the depth decides that.
    pub by_depth: bool,
    /// Machines that an alarm stopped.
    pub alarms: u32,
    /// Number of the worst machine.
    pub worst_run: u32,
}

impl Trial {
    /// Whether every machine stayed under the margin.
    #[must_use]
    pub const fn holds(&self) -> bool {
        self.good == self.runs
    }
}

impl Bench<'_> {
    /// Taps one hole on each of some machines, which are told by their numbers; with `early`, until one is over the margin.
    /// None where the setting has no plan for the hole, or where it was given up.
    pub(super) fn trial(&self, setting: &Setting, hole: &TapCycle, machines: Range<u32>, early: bool) -> Option<Trial> {
        let actions = self.actions(setting, hole)?;
        let limits = self.limits(hole);
        let mut trial = Trial {
            speed_rpm: hole.speed_rpm,
            runs: 0,
            good: 0,
            hole_s: 0.0,
            worst_um: 0.0,
            deepest_um: f64::NEG_INFINITY,
            used: f64::NEG_INFINITY,
            by_depth: false,
            alarms: 0,
            worst_run: 0,
        };
        let numbers: Vec<u32> = machines.collect();
        for batch in numbers.chunks(if early { BATCH } else { numbers.len().max(1) }) {
            let found = in_order(
                self.threads,
                batch.len(),
                &|| RunRecorder::new(&setting.machine, hole.pitch_mm),
                &|recorder, index| self.run(setting, &actions, batch[index], None, recorder),
                self.go_on,
            )?;
            for machine in &found {
                trial.add(machine, limits, self.margin);
            }
            if early && !trial.holds() {
                break;
            }
        }
        trial.hole_s /= f64::from(trial.runs.max(1));
        Some(trial)
    }

    /// What one machine uses of its limits, lacking an effect.
    pub(super) fn used_without(&self, setting: &Setting, hole: &TapCycle, run: u32, effect: Option<Effect>) -> f64 {
        let Some(actions) = self.actions(setting, hole) else { return f64::INFINITY };
        let mut recorder = RunRecorder::new(&setting.machine, hole.pitch_mm);
        let machine = self.run(setting, &actions, run, effect, &mut recorder);
        used(&machine, self.limits(hole)).0
    }

    fn run(
        &self,
        setting: &Setting,
        actions: &[Action],
        run: u32,
        without: Option<Effect>,
        recorder: &mut RunRecorder,
    ) -> SweptMachine {
        let mut base = Simulation { machine: setting.machine.clone(), ..self.base.clone() };
        base.settings.law = setting.law;
        if let Some(effect) = without {
            base.effects = base.effects.without(effect);
        }
        let settings = SweepSettings {
            runs: NonZeroU32::MIN,
            seed: self.seed,
            holes: NonZeroU32::MIN,
            spread: self.spread,
            hard: None,
            jobs: None,
        };
        run_machine(&base, &settings, actions, run, recorder)
    }

    /// The hole with its approach; none where this setting has no plan for it.
    fn actions(&self, setting: &Setting, hole: &TapCycle) -> Option<Vec<Action>> {
        let settings = &self.base.settings;
        let mut planner = Planner::new(&setting.machine, setting.law, settings.overrides, settings.run.start_mm);
        let command = Command { kind: CommandKind::Tap(*hole), line: 1, column: 1, span: Span::default() };
        let mut actions = Vec::new();
        planner.plan(&command, &mut |action| actions.push(action)).ok()?;
        let end = actions.iter().rposition(|action| matches!(action, Action::Tap(_)))?;
        actions.truncate(end + 1);
        Some(actions)
    }

    /// What thread and depth allow, µm.
    fn limits(&self, hole: &TapCycle) -> [f64; 2] {
        let machine = &self.base.machine;
        let tolerance_um = machine.sync_tolerance_um(hole.pitch_mm).unwrap_or(0.0);
        [tolerance_um, crate::control::units::um_from_mm(machine.bottom_clearance_mm(hole.pitch_mm))]
    }
}

/// What a machine uses of its limits, and whether by the depth.
fn used(machine: &SweptMachine, [tolerance_um, clearance_um]: [f64; 2]) -> (f64, bool) {
    if machine.alarm.is_some() {
        return (f64::INFINITY, false);
    }
    let (thread, depth) = (machine.first.worst_um / tolerance_um, machine.first.bottom_overshoot_um / clearance_um);
    // What is no number is over any limit.
    if thread >= depth || thread.is_nan() {
        (if thread.is_nan() { f64::INFINITY } else { thread }, false)
    } else {
        (depth, true)
    }
}

impl Trial {
    fn add(&mut self, machine: &SweptMachine, limits: [f64; 2], margin: f64) {
        let (used, by_depth) = used(machine, limits);
        self.runs += 1;
        self.good += u32::from(used <= margin);
        self.alarms += u32::from(machine.alarm.is_some());
        self.hole_s += machine.first.strokes_s;
        self.worst_um = self.worst_um.max(machine.first.worst_um);
        self.deepest_um = self.deepest_um.max(machine.first.bottom_overshoot_um);
        if used > self.used {
            (self.used, self.by_depth, self.worst_run) = (used, by_depth, machine.run);
        }
    }
}
