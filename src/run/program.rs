//! A whole program against a port.

use crate::control::machine::{Law, Machine};
use crate::control::port::Port;
use crate::gcode::Command;
use crate::gcode::program::{Action, Overrides, PlanError, Planner};

use super::executor::{Executor, Fault, RunSettings};
use super::monitor::{HoleOutcome, Verdict};
use super::observer::Observer;

/// A program that ran, hole by hole.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramOutcome {
    /// Time from the first to the last period.
    pub total_s: f64,
    /// Holes in their order.
    pub holes: Vec<HoleOutcome>,
    /// What ended the run before its end.
    pub fault: Option<Fault>,
}

impl ProgramOutcome {
    /// The worst verdict of the holes; fail where a fault ended the run.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        let worst = self.holes.iter().map(HoleOutcome::verdict).max().unwrap_or_default();
        if self.fault.is_some() { Verdict::Fail } else { worst }
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

/// Runs a program from its first command to its last.
///
/// # Errors
/// [`PlanError`] for a command that this machine cannot carry out; [`crate::gcode::program::check`] finds these before
/// anything moves.
pub fn run_program<P: Port>(
    commands: &[Command],
    machine: &Machine,
    settings: &ProgramSettings,
    port: &mut P,
    observer: &mut dyn Observer,
) -> Result<ProgramOutcome, PlanError> {
    let mut planner = Planner::new(machine, settings.law, settings.overrides, settings.run.start_mm);
    let mut executor = Executor::new(machine, port, settings.run);
    let mut outcome = ProgramOutcome { total_s: 0.0, holes: Vec::new(), fault: None };
    for command in commands {
        let mut actions = Vec::new();
        planner.plan(command, &mut |action: Action| actions.push(action))?;
        for action in &actions {
            match executor.run(action, observer) {
                Ok(Some(hole)) => {
                    observer.hole(&hole);
                    outcome.holes.push(hole);
                }
                Ok(None) => {}
                Err(fault) => {
                    outcome.fault = Some(fault);
                    outcome.total_s = fault.time_s;
                    return Ok(outcome);
                }
            }
        }
    }
    executor.finish(observer);
    outcome.total_s = executor.now_s();
    Ok(outcome)
}
