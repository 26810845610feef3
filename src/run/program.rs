//! A whole program against a port.

use std::borrow::Borrow;
use std::ops::ControlFlow;

use crate::control::machine::{Law, Machine};
use crate::control::port::Port;
use crate::gcode::Command;
use crate::gcode::program::{Action, Overrides, PlanError, Planner};

use super::executor::{Executor, RunSettings};
use super::fault::Fault;
use super::learned::Learned;
use super::listener::Listener;
use super::monitor::{HoleOutcome, Verdict};
use super::power_cut::PowerCut;
use super::power_loss::{PowerLoss, PowerLossEnd};

/// A program that ran, hole by hole.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramOutcome {
    /// Time from the first to the last period.
    pub total_s: f64,
    /// Holes in their order.
    pub holes: Vec<HoleOutcome>,
    /// What ended the run before its end.
    pub fault: Option<Fault>,
    /// The power cut that ended it.
    pub power_loss: Option<PowerLoss>,
}

impl ProgramOutcome {
    /// The worst verdict of the holes; fail where a fault ended the run, or a power cut left the tap in a hole.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let worst = self.holes.iter().map(HoleOutcome::verdict).max().unwrap_or_default();
        let is_left = self.power_loss.as_ref().is_some_and(PowerLoss::is_left);
        if self.fault.is_some() || is_left { Verdict::Fail } else { worst }
    }
}

/// How a program is planned and run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ProgramSettings {
    /// Time law of the synchronous strokes.
    pub law: Law,
    /// Overrides of G0 and G1.
    pub overrides: Overrides,
    /// Synchronisation and start.
    pub run: RunSettings,
}

/// Runs a program from its first command to its last; each is taken when the one before is done.
///
/// # Errors
/// [`PlanError`] for a command that this machine cannot carry out; [`crate::gcode::program::Checker`] finds these before
/// anything moves.
pub fn run_program<P: Port>(
    commands: impl IntoIterator<Item: Borrow<Command>>,
    machine: &Machine,
    settings: &ProgramSettings,
    port: &mut P,
    listener: &mut dyn Listener,
) -> Result<ProgramOutcome, PlanError> {
    run_program_learning(commands, machine, settings, port, listener, &mut Learned::default())
}

/// The same on a machine that begins with what earlier holes taught, to which this program's are added. A power cut loses what
/// they taught, as it does on a machine that keeps it at the program's end.
///
/// # Errors
/// As [`run_program`].
pub fn run_program_learning<P: Port>(
    commands: impl IntoIterator<Item: Borrow<Command>>,
    machine: &Machine,
    settings: &ProgramSettings,
    port: &mut P,
    listener: &mut dyn Listener,
    learned: &mut Learned,
) -> Result<ProgramOutcome, PlanError> {
    let mut planner = Planner::new(machine, settings.law, settings.overrides, settings.run.start_mm);
    let mut run = Run::new(machine, settings.run, port, listener);
    run.executor.teach(learned);
    let mut actions = Vec::new();
    for command in commands {
        actions.clear();
        planner.plan(command.borrow(), &mut |action: Action| actions.push(action))?;
        if run.carry_out(&actions).is_break() {
            break;
        }
    }
    Ok(run.finish_learning(learned))
}

/// Runs actions that were planned before: what many runs of one program share is planned once.
pub fn run_actions<P: Port>(
    actions: &[Action],
    machine: &Machine,
    settings: RunSettings,
    port: &mut P,
    listener: &mut dyn Listener,
) -> ProgramOutcome {
    let mut run = Run::new(machine, settings, port, listener);
    // A fault is in the outcome.
    let _ = run.carry_out(actions);
    run.finish()
}

/// A run under way.
struct Run<'a, 'o, P: Port> {
    executor: Executor<'a, P>,
    listener: &'o mut dyn Listener,
    outcome: ProgramOutcome,
}

impl<'a, 'o, P: Port> Run<'a, 'o, P> {
    fn new(machine: &'a Machine, settings: RunSettings, port: &'a mut P, listener: &'o mut dyn Listener) -> Self {
        let outcome = ProgramOutcome { total_s: 0.0, holes: Vec::new(), fault: None, power_loss: None };
        Self { executor: Executor::new(machine, port, settings), listener, outcome }
    }

    fn carry_out(&mut self, actions: &[Action]) -> ControlFlow<()> {
        for action in actions {
            match self.executor.run(action, self.listener) {
                Ok(Some(hole)) => {
                    self.listener.hole(&hole);
                    let warning = hole.alarm;
                    self.outcome.holes.push(hole);
                    if let Some(alarm) = warning {
                        self.outcome.fault = Some(self.executor.fault(alarm));
                        return ControlFlow::Break(());
                    }
                }
                Ok(None) => self.note_power(),
                Err(fault) => {
                    self.outcome.holes.extend(self.executor.take_unfinished());
                    self.outcome.fault = Some(fault);
                    return ControlFlow::Break(());
                }
            }
            if self.outcome.power_loss.is_some() {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }

    /// Whether the power was lost in the last action, in a hole or out of one, and what came of it.
    fn note_power(&mut self) {
        let Some(PowerCut { lost, .. }) = self.executor.power_lost() else { return };
        let Some(cut) = self.executor.take_cut() else {
            let time_s = self.executor.now_s();
            self.outcome.power_loss =
                Some(PowerLoss { time_s, lost, hole: None, standing: None, end: PowerLossEnd::NoHole });
            return;
        };
        let (power_loss, hole) = self.executor.lose_power(lost, *cut, self.listener);
        self.listener.hole(&hole);
        self.outcome.holes.push(hole);
        self.outcome.power_loss = Some(power_loss);
    }

    fn finish_learning(mut self, learned: &mut Learned) -> ProgramOutcome {
        self.end();
        if self.outcome.power_loss.is_none() {
            *learned = self.executor.learned();
        }
        self.outcome
    }

    fn finish(mut self) -> ProgramOutcome {
        self.end();
        self.outcome
    }

    fn end(&mut self) {
        self.outcome.total_s = match self.outcome.fault {
            Some(fault) => fault.time_s,
            None if self.outcome.power_loss.is_some() => self.executor.now_s(),
            None => {
                self.executor.finish(self.listener);
                self.executor.now_s()
            }
        };
    }
}
