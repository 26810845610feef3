//! One program against one simulated machine.

use std::borrow::Borrow;
use std::sync::Arc;

use super::other_plant::{PlantSource, RunPlant};
use crate::control::cycle::StrokeKind;
use crate::control::machine::Machine;
use crate::gcode::Command;
use crate::gcode::program::PlanError;
use crate::run::{Learned, Listener, ProgramOutcome, ProgramSettings, Row, RowStage, run_program_learning};
use crate::sim::{Actual, Effects, Injection, MOST_FAULTS, Plant, PlantOptions};

/// A simulated machine with the way it is run; every run starts with a fresh plant.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// What the control knows of the machine.
    pub machine: Machine,
    /// How the plant differs from that.
    pub actual: Actual,
    /// Which imperfections the plant has.
    pub effects: Effects,
    /// Seed of everything random.
    pub seed: u64,
    /// What goes wrong, and when.
    pub faults: [Option<Injection>; MOST_FAULTS],
    /// Someone else's plant in place of ours, which knows effects and faults of its own.
    pub other_plant: Option<Arc<dyn PlantSource>>,
    /// Law, synchronisation, overrides, start.
    pub settings: ProgramSettings,
}

impl Simulation {
    /// The machine as its file says, with every imperfection, under default settings.
    #[must_use]
    pub fn of(machine: Machine) -> Self {
        Self {
            machine,
            actual: Actual::default(),
            effects: Effects::FULL,
            seed: 1,
            faults: [None; MOST_FAULTS],
            other_plant: None,
            settings: ProgramSettings::default(),
        }
    }

    /// Runs a program; each command is taken when the one before is done.
    ///
    /// # Errors
    /// [`PlanError`] for a command that the machine cannot carry out.
    ///
    /// ```
    /// use rigidtap::control::machine::Machine;
    /// use rigidtap::gcode::{Options, Dialect, interpret};
    /// use rigidtap::study::Simulation;
    /// let source = b"G90 M03 S3000 G81 X0 Y0 R15 Z-10 F3000 M30";
    /// let program = interpret(source, &Dialect::PAPER, Options::default());
    /// let outcome = Simulation::of(Machine::reference()).run(&program.commands, &mut ()).unwrap();
    /// assert_eq!(outcome.holes.len(), 1);
    /// ```
    pub fn run(
        &self,
        commands: impl IntoIterator<Item: Borrow<Command>>,
        listener: &mut dyn Listener,
    ) -> Result<ProgramOutcome, PlanError> {
        self.run_learning(commands, listener, &mut Learned::default())
    }

    /// The same, with what earlier holes taught, to which this program's are added.
    ///
    /// # Errors
    /// As [`Simulation::run`].
    pub fn run_learning(
        &self,
        commands: impl IntoIterator<Item: Borrow<Command>>,
        listener: &mut dyn Listener,
        learned: &mut Learned,
    ) -> Result<ProgramOutcome, PlanError> {
        let mut plant = self.plant(self.actual, self.seed);
        run_program_learning(commands, &self.machine, &self.settings, &mut plant, listener, learned)
    }

    /// A fresh plant, at rest where the settings start.
    pub(super) fn plant(&self, actual: Actual, seed: u64) -> RunPlant {
        let z_start_mm = self.settings.run.start_mm[2];
        if let Some(source) = &self.other_plant {
            return RunPlant::Other(source.start(&actual, seed, z_start_mm, self.machine.spec().control.period_s));
        }
        let options = PlantOptions { actual, effects: self.effects, seed, z_start_mm, faults: self.faults };
        RunPlant::Ours(Box::new(Plant::new(&self.machine, &options)))
    }
}

/// e(k) at one synchronous period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorPoint {
    /// Period from the program's start.
    pub k: u64,
    /// Hole, from 1.
    pub hole: u32,
    /// Stroke of the hole.
    pub kind: StrokeKind,
    /// e(k).
    pub error_um: f64,
}

/// A listener that keeps e(k) of every synchronous period.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorSeries {
    /// The points in time.
    pub points: Vec<ErrorPoint>,
}

impl Listener for ErrorSeries {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        if let (RowStage::Stroke(kind), Some(error_um)) = (row.stage, row.error_um) {
            self.points.push(ErrorPoint { k: row.k, hole: row.hole, kind, error_um });
        }
    }
}
