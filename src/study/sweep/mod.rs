//! Many machines that differ from the nominal one, each drawn at random, all under the nominal machine's control.

mod machine_run;
mod part;
mod percentiles;
mod ranked;
mod record;
mod records;
mod search;
mod settings;
mod stability;
mod summary;
mod swept_machine;
mod tail;

use std::io::{self, Write};
use std::num::NonZeroU32;
use std::ops::RangeInclusive;
use std::path::Path;

pub use part::{MergeFault, PartFault, PartFile, PartLabels, Shard};
pub use percentiles::Percentiles;
pub use search::{WorstEffect, WorstMachine};
pub use settings::SweepSettings;
pub use summary::{Counts, SweepSummary};
pub use swept_machine::{HoleErrors, SweptMachine};
pub use tail::TailShift;

pub(super) use machine_run::{RunRecorder, run_machine};

use records::{RecordWriter, Records};
use summary::summary;

use super::parallel::{cores, each_in_order};
use super::simulation::Simulation;
use crate::control::cycle::TapCycle;
use crate::gcode::program::{Action, PlanError, Planner};
use crate::gcode::{Command, CommandKind};

/// A sweep that was run. Memory does not grow with the number of machines: where they are many, what each came to lies in
/// a file, and what was drawn is drawn again from its number.
pub struct Sweep {
    /// The hole that each machine tapped.
    pub hole: TapCycle,
    /// What all machines come to.
    pub summary: SweepSummary,
    records: Records,
}

impl Sweep {
    fn new(hole: TapCycle, mut records: Records) -> io::Result<Self> {
        Ok(Self { hole, summary: summary(&mut records)?, records })
    }

    /// The machine with the worst first hole; of equals the first.
    #[must_use]
    pub fn worst(&self) -> Option<&SweptMachine> {
        self.summary.worst.first()
    }

    /// Each machine in the order of their numbers.
    ///
    /// # Errors
    /// Where the file that they lie in cannot be read.
    pub fn each(&mut self, see: &mut dyn FnMut(&SweptMachine)) -> io::Result<()> {
        self.records.each(see)
    }

    /// All machines, which take some hundred bytes of memory each.
    ///
    /// # Errors
    /// As [`Sweep::each`].
    pub fn machines(&mut self) -> io::Result<Vec<SweptMachine>> {
        let mut machines = Vec::new();
        self.each(&mut |machine| machines.push(*machine))?;
        Ok(machines)
    }

    /// The larger of measured and true error of each machine's first hole.
    ///
    /// # Errors
    /// As [`Sweep::each`].
    pub fn worst_um(&mut self) -> io::Result<Vec<f64>> {
        let mut values = Vec::new();
        self.records.each_outcome(&mut |machine| values.push(machine.first.worst_um))?;
        Ok(values)
    }
}

/// Why a sweep cannot run.
#[derive(Debug)]
pub enum SweepError {
    /// The program taps no hole.
    NoHole,
    /// The machine cannot carry out a command.
    Plan(PlanError),
    /// What the machines came to cannot be kept, or read again.
    Io(io::Error),
    /// Parts do not make this sweep: every reason.
    Merge(Vec<MergeFault>),
}

impl From<io::Error> for SweepError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
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
/// assert_eq!(found.summary.worst_um.max, found.worst().unwrap().first.worst_um);
/// assert_eq!((found.summary.counts.machines, found.summary.counts.unstable), (3, 0));
/// ```
pub fn sweep(
    commands: &[Command],
    base: &Simulation,
    settings: &SweepSettings,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Option<Sweep>, SweepError> {
    let holes = Holes::new(commands, base, settings)?;
    let all = 1..=settings.runs.get();
    let records = run(&holes, base, settings, all, &std::env::temp_dir(), go_on)?;
    records.map(|records| Ok(Sweep::new(holes.hole, records)?)).transpose()
}

/// Runs one part of a sweep and writes it to `to`, for [`merge`]; what is too much for memory lies in a nameless file of
/// `folder` meanwhile. Where `go_on` says no, nothing is written and there is no part.
///
/// # Errors
/// [`SweepError`].
///
/// ```
/// use std::num::NonZeroU32;
/// use std::io::Cursor;
/// use rigidtap::control::machine::Machine;
/// use rigidtap::gcode::{Dialect, Options, interpret};
/// use rigidtap::sim::Spread;
/// use rigidtap::study::{PartFile, PartLabels, Shard, Simulation, SweepSettings, merge, sweep, sweep_part};
/// let program = interpret(b"G90 M03 S1000 G81 X0 Y0 R3 Z-2 F1000 M30", &Dialect::PAPER, Options::default());
/// let runs = NonZeroU32::new(3).unwrap();
/// let settings = SweepSettings { runs, seed: 1, holes: NonZeroU32::MIN, spread: Some(Spread::default()), hard: None, jobs: None };
/// let (base, labels) = (Simulation::of(Machine::reference()), PartLabels::default());
/// let folder = std::env::temp_dir();
/// let part = |number| {
///     let (shard, mut bytes) = (Shard::new(number, 2).unwrap(), Vec::new());
///     sweep_part(&program.commands, &base, &settings, &labels, shard, &folder, &|| true, &mut bytes).unwrap().unwrap();
///     PartFile::new(format!("part {shard}"), Cursor::new(bytes))
/// };
/// let merged = merge(&program.commands, &base, &settings, &labels, vec![part(1), part(2)]).unwrap();
/// let whole = sweep(&program.commands, &base, &settings, &|| true).unwrap().unwrap();
/// assert_eq!(merged.summary.worst, whole.summary.worst);
/// ```
#[expect(clippy::too_many_arguments, reason = "a sweep's own, and what makes a part of it")]
pub fn sweep_part(
    commands: &[Command],
    base: &Simulation,
    settings: &SweepSettings,
    labels: &PartLabels,
    shard: Shard,
    folder: &Path,
    go_on: &(dyn Fn() -> bool + Sync),
    to: &mut dyn Write,
) -> Result<Option<Counts>, SweepError> {
    let holes = Holes::new(commands, base, settings)?;
    let Some(mut records) = run(&holes, base, settings, shard.runs(settings.runs), folder, go_on)? else {
        return Ok(None);
    };
    Ok(Some(part::write(to, labels, &holes.commands, base, settings, shard, &mut records)?))
}

/// Makes the whole of parts, which is the same as if it had been swept at once.
///
/// # Errors
/// [`SweepError::Merge`] where a part is missing, there twice, damaged, or of another sweep.
pub fn merge(
    commands: &[Command],
    base: &Simulation,
    settings: &SweepSettings,
    labels: &PartLabels,
    parts: Vec<PartFile>,
) -> Result<Sweep, SweepError> {
    let holes = Holes::new(commands, base, settings)?;
    let records = part::join(parts, labels, &holes.commands, base, settings).map_err(SweepError::Merge)?;
    Ok(Sweep::new(holes.hole, records)?)
}

/// Searches the box that a sweep draws from for the machine with the largest error of its first hole, in `settings.runs`
/// runs; none where `go_on` said no, or where no machine's hole began.
///
/// # Errors
/// As [`sweep`].
pub fn worst_machine(
    commands: &[Command],
    base: &Simulation,
    settings: &SweepSettings,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Result<Option<WorstMachine>, SweepError> {
    let Holes { hole, actions, .. } = Holes::new(commands, base, settings)?;
    let search = search::Search { base, settings, actions: &actions, pitch_mm: hole.pitch_mm, go_on };
    Ok(search.worst())
}

/// What each machine does.
struct Holes {
    hole: TapCycle,
    commands: Vec<Command>,
    actions: Vec<Action>,
}

impl Holes {
    fn new(commands: &[Command], base: &Simulation, settings: &SweepSettings) -> Result<Self, SweepError> {
        let (hole, commands) = first_hole(commands, settings.holes).ok_or(SweepError::NoHole)?;
        let actions = plan(&commands, base).map_err(SweepError::Plan)?;
        Ok(Self { hole, commands, actions })
    }
}

/// Runs the machines with these numbers.
fn run(
    holes: &Holes,
    base: &Simulation,
    settings: &SweepSettings,
    runs: RangeInclusive<u32>,
    folder: &Path,
    go_on: &(dyn Fn() -> bool + Sync),
) -> io::Result<Option<Records>> {
    let first_run = *runs.start();
    let mut writer = RecordWriter::new(settings, folder);
    let mut written = Ok(());
    let all = each_in_order(
        settings.jobs.unwrap_or_else(cores),
        runs.count(),
        &|| RunRecorder::new(&base.machine, holes.hole.pitch_mm),
        &|recorder, index| run_machine(base, settings, &holes.actions, first_run + index as u32, recorder),
        go_on,
        &mut |machine| {
            if written.is_ok() {
                written = writer.add(&machine);
            }
            written.is_ok()
        },
    );
    written?;
    let stretch = writer.finish(first_run)?;
    Ok(all.then(|| Records::new(vec![stretch], settings, base.actual)))
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
