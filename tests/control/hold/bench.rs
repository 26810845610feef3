//! One machine on the test bench.

use rigidtap::control::cycle::{CyclePlan, Hand, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::model::cutting::Material;
use rigidtap::control::sync::{Identified, Settings};
use rigidtap::gcode::program::Action;
use rigidtap::gcode::{Command, CommandKind, Span, SpindleCommand};
use rigidtap::run::{Executor, HoleOutcome, Learned, ProgramSettings, RunSettings};
use rigidtap::sim::{Actual, Effects, Plant, PlantOptions};
use rigidtap::study::Simulation;

/// What is tapped, on what, and how.
#[derive(Clone)]
pub(crate) struct Bench {
    pub(crate) machine: Machine,
    pub(crate) hole: TapCycle,
    pub(crate) law: Law,
    pub(crate) actual: Actual,
    pub(crate) effects: Effects,
    pub(crate) seed: u64,
    pub(crate) run: RunSettings,
}

impl Bench {
    /// 25 mm of M6 under `torque-curve-smooth` at 75 % of the motor, from 10 mm above R.
    pub(crate) fn of(material: Material, speed_rpm: f64) -> Self {
        let machine = Machine::reference().with(|spec| {
            spec.law.motor_share = 0.75;
            spec.tap.kc_n_per_mm2 = material.kc_n_per_mm2();
            spec.tap.tool_factor = material.tool_factor();
        });
        Self {
            machine: machine.unwrap(),
            hole: TapCycle::right_hand(0.0, -25.0, 1.0, speed_rpm),
            law: Law::TorqueCurveSmooth,
            actual: Actual::default(),
            effects: Effects::FULL,
            seed: 1,
            run: RunSettings { start_mm: [0.0, 0.0, 10.0], ..RunSettings::default() },
        }
    }

    pub(crate) fn seeded(&self, seed: u64) -> Self {
        Self { seed, ..self.clone() }
    }

    pub(crate) fn dry(mut self) -> Self {
        self.run.dry_cycle = true;
        self
    }

    pub(crate) fn with_sync(mut self, change: impl FnOnce(&mut Settings)) -> Self {
        change(&mut self.run.sync);
        self
    }

    /// Taps the hole so many times in one place; what came of each, and what is known of the machine afterwards.
    pub(crate) fn tap(&self, holes: usize) -> (Vec<HoleOutcome>, Identified) {
        let plan = CyclePlan::new(self.hole, &self.machine, self.law).unwrap();
        let action = Action::Tap(Box::new(plan));
        let Self { actual, effects, seed, .. } = *self;
        let options =
            PlantOptions { actual, effects, seed, z_start_mm: self.run.start_mm[2], ..PlantOptions::default() };
        let mut plant = Plant::new(&self.machine, &options);
        let mut executor = Executor::new(&self.machine, &mut plant, self.run);
        let outcomes = (0..holes).map(|_| executor.run(&action, &mut ()).unwrap().unwrap()).collect();
        (outcomes, executor.identified())
    }

    /// A program of such holes, each approached from above with the spindle turning first, on a machine that begins with what
    /// earlier holes taught.
    pub(crate) fn program(&self, holes: usize, learned: &mut Learned) -> Vec<HoleOutcome> {
        let Self { machine, hole, law, actual, effects, seed, run } = self.clone();
        let hole = TapCycle { return_mm: 10.0, ..hole };
        let command = |kind| Command { kind, line: 1, column: 1, span: Span { start: 0, end: 0 } };
        let turning = SpindleCommand::On { hand: Hand::Right, speed_rpm: hole.speed_rpm };
        let taps = std::iter::repeat_n(command(CommandKind::Tap(hole)), holes);
        let commands = std::iter::once(command(CommandKind::Spindle(turning))).chain(taps);
        let settings = ProgramSettings { law, run, ..ProgramSettings::default() };
        let simulation = Simulation { actual, effects, seed, settings, ..Simulation::of(machine) };
        let outcome = simulation.run_learning(commands, &mut (), learned).unwrap();
        *learned = Learned::of(learned.bytes().to_vec(), &self.machine).unwrap();
        outcome.holes
    }

    pub(crate) fn first_um(&self) -> f64 {
        self.tap(1).0[0].worst_um()
    }
}

/// The value below which a share of all lies.
pub(crate) fn percentile(values: &mut [f64], share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let rank = (share * values.len() as f64).ceil() as usize;
    values[rank.clamp(1, values.len()) - 1]
}
