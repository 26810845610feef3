//! Many machines that differ from the nominal one, each drawn at random, all under the nominal machine's control.

mod machine_run;
mod percentiles;
mod settings;
mod stability;
mod swept_machine;
mod tail;

use std::num::NonZeroU32;

pub use percentiles::Percentiles;
pub use settings::SweepSettings;
pub use swept_machine::{HoleErrors, SweptMachine};
pub use tail::TailShift;

pub(super) use machine_run::{RunRecorder, run_machine};

use super::parallel::{cores, in_order};
use super::simulation::Simulation;
use crate::control::cycle::TapCycle;
use crate::gcode::program::{Action, PlanError, Planner};
use crate::gcode::{Command, CommandKind};
use crate::run::Verdict;

/// A sweep that was run.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The hole that each machine tapped.
    pub hole: TapCycle,
    /// All machines in the order of their numbers.
    pub machines: Vec<SweptMachine>,
}

impl Sweep {
    /// Percentiles of one number of every machine.
    #[must_use]
    pub fn percentiles(&self, of: impl Fn(&SweptMachine) -> f64) -> Percentiles {
        Percentiles::of(self.machines.iter().map(of))
    }

    /// The machine with the worst first hole; of equals the first.
    #[must_use]
    pub fn worst(&self) -> Option<&SweptMachine> {
        // By size alone: a value that is no number counts as the greatest.
        let size = |machine: &SweptMachine| machine.first.worst_um.abs();
        self.machines.iter().rev().max_by(|left, right| size(left).total_cmp(&size(right)))
    }

    /// Share of the machines whose first hole fails, or whose run an alarm ended.
    #[must_use]
    pub fn fail_ratio(&self) -> f64 {
        self.ratio(SweptMachine::fails)
    }

    /// Share of the machines whose first hole is between half of the tolerance and all of it.
    #[must_use]
    pub fn warning_ratio(&self) -> f64 {
        self.ratio(|machine| !machine.fails() && machine.first.verdict == Verdict::Warning)
    }

    fn ratio(&self, so: impl Fn(&SweptMachine) -> bool) -> f64 {
        self.count(so) as f64 / self.machines.len() as f64
    }

    /// What the machines of the worst hundredth have of each effect against all, by how far it lies off the middle.
    #[must_use]
    pub fn tail(&self) -> Vec<TailShift> {
        tail::shifts(&self.machines)
    }

    /// How many machines are so.
    #[must_use]
    pub fn count(&self, so: impl Fn(&SweptMachine) -> bool) -> usize {
        self.machines.iter().filter(|machine| so(machine)).count()
    }
}

/// Why a sweep cannot run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SweepError {
    /// The program taps no hole.
    NoHole,
    /// The machine cannot carry out a command.
    Plan(PlanError),
}

/// Runs many machines, each from the program's start through its first hole, which it taps `settings.holes` times.
/// `go_on` is asked after each machine; where it says no, the sweep is given up and there is none.
///
/// # Errors
/// [`SweepError`].
///
/// ```
/// use std::num::NonZeroU32;
/// use rigidtap::control::machine::Machine;
/// use rigidtap::gcode::{Dialect, Options, interpret};
/// use rigidtap::sim::Spread;
/// use rigidtap::study::{Simulation, SweepSettings, sweep};
/// let program = interpret(b"G90 M03 S1000 G81 X0 Y0 R3 Z-2 F1000 M30", &Dialect::PAPER, Options::default());
/// let runs = NonZeroU32::new(3).unwrap();
/// let settings = SweepSettings { runs, seed: 1, holes: NonZeroU32::MIN, spread: Some(Spread::default()), hard: None, jobs: None };
/// let base = Simulation::of(Machine::reference());
/// let found = sweep(&program.commands, &base, &settings, &|| true).unwrap().unwrap();
/// let worst_um = found.percentiles(|machine| machine.first.worst_um);
/// assert_eq!(worst_um.max, found.worst().unwrap().first.worst_um);
/// assert_eq!(found.count(|machine| machine.unstable), 0);
/// ```
pub fn sweep(
    commands: &[Command],
    base: &Simulation,
    settings: &SweepSettings,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Sweep>, SweepError> {
    let (hole, commands) = first_hole(commands, settings.holes).ok_or(SweepError::NoHole)?;
    let actions = plan(&commands, base).map_err(SweepError::Plan)?;
    let machines = in_order(
        settings.jobs.unwrap_or_else(cores),
        settings.runs.get() as usize,
        &|| RunRecorder::new(&base.machine, hole.pitch_mm),
        &|recorder, index| run_machine(base, settings, &actions, index as u32 + 1, recorder),
        go_on,
    );
    Ok(machines.map(|machines| Sweep { hole, machines }))
}

/// A program up to its first hole, with that hole as often as asked.
fn first_hole(commands: &[Command], holes: NonZeroU32) -> Option<(TapCycle, Vec<Command>)> {
    let (at, command, hole) = commands.iter().enumerate().find_map(|(at, command)| match command.kind {
        CommandKind::Tap(hole) => Some((at, *command, hole)),
        _ => None,
    })?;
    let before = commands.iter().take(at).copied();
    Some((hole, before.chain(std::iter::repeat_n(command, holes.get() as usize)).collect()))
}

/// Every action up to the last hole; what comes after it tells nothing.
fn plan(commands: &[Command], base: &Simulation) -> Result<Vec<Action>, PlanError> {
    let settings = &base.settings;
    let mut planner = Planner::new(&base.machine, settings.law, settings.overrides, settings.run.start_mm);
    let mut actions = Vec::new();
    for command in commands {
        planner.plan(command, &mut |action| actions.push(action))?;
    }
    let end = actions.iter().rposition(|action| matches!(action, Action::Tap(_))).map_or(0, |last| last + 1);
    actions.truncate(end);
    Ok(actions)
}
