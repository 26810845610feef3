//! What is swept: everything that the command line asks for, read and checked.

use std::num::NonZeroU32;
use std::sync::atomic::{AtomicBool, Ordering};

use super::words;
use crate::cli::args::{Common, SweepArgs};
use crate::cli::input;
use crate::cli::outcome::{Stop, report};
use crate::cli::plant::{check_other, take_other};
use crate::cli::simulate::{report_unused, simulation};
use crate::config::MachineFile;
use crate::gcode::{Command, CommandKind};
use crate::study::{PartLabels, Simulation, SweepSettings};

/// Holes that show what learning gives, unless the command line says how many.
const LEARNING_HOLES: NonZeroU32 = NonZeroU32::new(10).expect("is not 0");

/// What is swept.
pub(super) struct Setup {
    /// Name of the program.
    pub(super) program: String,
    pub(super) commands: Vec<Command>,
    pub(super) file: MachineFile,
    pub(super) base: Simulation,
    pub(super) settings: SweepSettings,
}

impl Setup {
    pub(super) fn read(common: &Common, args: &SweepArgs) -> Result<Self, Stop> {
        let SweepArgs { file: path, plant, tap, .. } = args;
        let file = input::machine_file(common, &[tap.law])?;
        let machine = input::changed(file.machine.clone(), plant.tap.as_deref(), plant.material, tap.share)?;
        let reading = input::dialect(common, &file)?;
        report_unused(common, plant, tap);
        let mut base = simulation(machine, file.actual, plant, tap);
        take_other(&mut base, plant)?;
        let overrides = base.settings.overrides;
        let paths = std::slice::from_ref(path);
        let mut programs = input::programs(common, paths, &reading, &base.machine, &[tap.law], overrides)?;
        let Some(program) = programs.first_mut() else { return Err(Stop::Reported) };
        let commands = program.collect()?;
        report_other_holes(common, &program.name, &commands);
        let settings = SweepSettings {
            runs: args.runs,
            seed: plant.seed,
            holes: args.holes.unwrap_or(if plant.adapting.learn { LEARNING_HOLES } else { NonZeroU32::MIN }),
            spread: (!args.nominal).then_some(file.spread),
            hard: args.hard.then_some(file.hard),
            jobs: args.jobs,
        };
        Ok(Self { program: program.name.clone(), commands, file, base, settings })
    }

    /// Whether a sweep goes on: nobody interrupted it, and a plant that is not ours has not failed.
    pub(super) fn goes_on(&self, stop: &AtomicBool) -> bool {
        let failed = self.base.other_plant.as_ref().is_some_and(|source| source.error().is_some());
        !stop.load(Ordering::Relaxed) && !failed
    }

    /// What a plant that is not ours did wrong.
    pub(super) fn check_other(&self, args: &SweepArgs) -> Result<(), Stop> {
        check_other(&self.base, &args.plant)
    }

    /// What parts of this sweep are called, and which program runs them.
    pub(super) fn labels(&self, common: &Common, args: &SweepArgs) -> PartLabels {
        PartLabels {
            build: build(),
            program: self.program.clone(),
            machine: common.machine.as_deref().map_or_else(|| "built-in".to_owned(), input::name),
            options: words::options(common, args),
        }
    }
}

/// Tells this build of the program from others: the checksum of its file.
fn build() -> String {
    words::checksum(&std::env::current_exe().and_then(std::fs::read).unwrap_or_default())
}

/// Every hole of a program may be meant, and one alone is swept.
fn report_other_holes(common: &Common, name: &str, commands: &[Command]) {
    let mut holes = commands.iter().filter_map(|command| match command.kind {
        CommandKind::Tap(hole) => Some((command.line, hole)),
        _ => None,
    });
    let Some((line, first)) = holes.next() else { return };
    if !common.quiet && holes.any(|(_, hole)| !hole.is_alike(&first)) {
        report(&format!("note: {name}: its holes differ; only the first one is swept, that of line {line}"));
    }
}
