//! What a command reads: the machine file and the programs, each rejected with its place.

use std::fs::File;
use std::io::{self, IsTerminal, Read};
use std::path::{Path, PathBuf};

use crate::config::{ConfigDiagnostic, GcodeOptions, MachineFile};
use crate::control::machine::{Law, Machine, MachineError, MachineSpec};
use crate::control::model::cutting::Material;
use crate::control::thread::StandardThread;
use crate::gcode::program::{Checker, Overrides};
use crate::gcode::{
    AUTO, Command, Commands, Diagnostic, DiagnosticKind, Diagnostics, Dialect, Options, Recognised, Text, Warnings,
    recognise,
};
use crate::laws::{TuneError, retuned};
use crate::report::json::DiagnosticAnswer;
use crate::report::table::HoleGroups;
use crate::report::{diagnostics, printable};

use super::args::{ColorChoice, Common, OverrideArgs};
use super::outcome::{Stop, report, report_styled};
use super::subprograms::Folders;

/// Name of standard input on the command line.
const STDIN: &str = "-";

/// Most commands that are kept in memory.
const MOST_COLLECTED: usize = 1_000_000;

/// A program that was read once and checked, and can be read again: it is not kept in memory.
pub(super) struct Program {
    pub(super) name: String,
    text: Text<File>,
    dialect: Dialect,
    options: Options,
    /// How many commands there are.
    pub(super) commands: usize,
    pub(super) holes: HoleGroups,
    pub(super) diagnostics: Diagnostics,
    /// What is unwise about it.
    warnings: Diagnostics,
}

impl Program {
    /// Adds what is unwise about a program that has no errors.
    pub(super) fn add_warnings(&mut self) {
        if !self.diagnostics.has_errors() {
            self.diagnostics.append(&self.warnings);
        }
    }

    /// What was found, for JSON.
    pub(super) fn diagnostic_answers(&self) -> Vec<DiagnosticAnswer> {
        let file = |found: &Diagnostic| self.text.subprogram(found.span.start).map(|(name, ..)| name);
        self.diagnostics.as_slice().iter().map(|found| DiagnosticAnswer::in_file(found, file(found))).collect()
    }

    /// Interprets it again, command by command; see [`Program::intact`].
    pub(super) fn commands(&mut self) -> Commands<'_, File> {
        Commands::new(&mut self.text, &self.dialect, self.options)
    }

    /// All commands at once, for what runs them many times over.
    pub(super) fn collect(&mut self) -> Result<Vec<Command>, Stop> {
        let (name, count) = (&self.name, self.commands);
        if count > MOST_COLLECTED {
            return Err(Stop::Usage(format!(
                "at most {MOST_COLLECTED} commands are run many times over: {name} has {count}"
            )));
        }
        let commands = self.commands().collect();
        self.intact().map(|()| commands)
    }

    /// Whether it could be read to its end.
    pub(super) fn intact(&mut self) -> Result<(), Stop> {
        self.text.error().map_or(Ok(()), |error| Err(unreadable(&self.name, &error)))
    }
}

/// Whether messages are coloured.
pub(super) fn color(common: &Common) -> bool {
    match common.color {
        ColorChoice::Always => true,
        ColorChoice::Never => false,
        ColorChoice::Auto => {
            io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
        }
    }
}

/// The machine file in use, or the reference machine. Warnings of laws that are not in use are not told.
pub(super) fn machine_file(common: &Common, laws: &[Law]) -> Result<MachineFile, Stop> {
    let Some(path) = &common.machine else { return Ok(MachineFile::reference()) };
    let bytes = read(path)?;
    let name = name(path);
    let (file, found) = match MachineFile::read(&bytes) {
        Ok(file) => {
            let in_use = |found: &&ConfigDiagnostic| found.law().is_none_or(|law| laws.contains(&law));
            let warnings = file.warnings.iter().filter(in_use).cloned().collect();
            (Ok(file), warnings)
        }
        Err(faults) => (Err(Stop::Reported), faults),
    };
    if !found.is_empty() && (file.is_err() || !common.quiet) {
        report_styled(&diagnostics::render_machine_file(&name, &bytes, &found, color(common)));
    }
    file
}

/// Changes the machine as the command line says, and checks it again.
pub(super) fn changed(
    machine: Machine,
    tap: Option<&str>,
    material: Option<Material>,
    share: Option<f64>,
) -> Result<Machine, Stop> {
    let mut machine = machine;
    if let Some(name) = tap {
        let size = StandardThread::by_name(name).map_err(|error| {
            Stop::Usage(format!("--tap {name}: {error}; expected a designation such as M6, M10x1.25, 1/4-28 or G1/8"))
        })?;
        machine = with(&machine, |spec| {
            spec.tap.pitch_mm = Some(size.pitch_mm);
            spec.tolerance.error_um.get_or_insert(size.sync_tolerance_um());
            spec.tap.major_mm = Some(size.major_mm);
            spec.tap.hole_mm = Some(size.hole_mm);
        })?;
    }
    if let Some(material) = material {
        machine = with(&machine, |spec| {
            spec.tap.kc_n_per_mm2 = material.kc_n_per_mm2();
            spec.tap.tool_factor = material.tool_factor();
        })?;
    }
    match share {
        Some(share) => retuned(&machine, share).map_err(|error| untunable(&error)),
        None => Ok(machine),
    }
}

fn with(machine: &Machine, change: impl FnOnce(&mut MachineSpec)) -> Result<Machine, Stop> {
    machine.with(change).map_err(unusable)
}

/// A machine that the command line's own words made unusable.
pub(super) fn unusable(error: MachineError) -> Stop {
    Stop::Usage(format!("the machine cannot be as the command line asks: {error}"))
}

/// Bands that cannot be as the command line's own words ask.
pub(super) fn untunable(error: &TuneError) -> Stop {
    Stop::Usage(format!("the bands cannot be tuned as the command line asks: {error}"))
}

/// How programs are read: the dialect, or none where each program says it, with the machine file's options.
pub(super) struct Reading {
    dialect: Option<Dialect>,
    options: GcodeOptions,
}

impl Reading {
    /// The dialect of a program, and why, where the program says it.
    fn of(&self, text: &mut Text<File>) -> Result<(Dialect, Option<Recognised>), Stop> {
        let Some(dialect) = self.dialect else {
            let found = recognise(text);
            return Ok((self.options.apply(by_name(found.name)?), Some(found)));
        };
        Ok((self.options.apply(dialect), None))
    }
}

/// The dialect in use.
pub(super) fn dialect(common: &Common, file: &MachineFile) -> Result<Reading, Stop> {
    let name = common.dialect.as_deref().unwrap_or(&file.gcode.dialect);
    let dialect = if name == AUTO { None } else { Some(by_name(name)?) };
    Ok(Reading { dialect, options: file.gcode.clone() })
}

fn by_name(name: &str) -> Result<Dialect, Stop> {
    Dialect::by_name(name).ok_or_else(|| {
        let known: Vec<_> = Dialect::ALL.iter().map(|dialect| dialect.name).collect();
        Stop::Usage(Dialect::out_of_scope(name).map_or_else(
            || format!("dialect {name} is not known here: expected one of {}, {AUTO}", known.join(", ")),
            str::to_owned,
        ))
    })
}

/// Overrides as factors.
pub(super) fn overrides(args: &OverrideArgs) -> Overrides {
    Overrides { rapid: args.rapid_override / 100.0, feed: args.feed_override / 100.0 }
}

/// Reads a program, interprets it, and plans it on the machine under the overrides and each law; nothing moves.
pub(super) fn program(
    common: &Common,
    path: &Path,
    reading: &Reading,
    machine: &Machine,
    laws: &[Law],
    overrides: Overrides,
) -> Result<Program, Stop> {
    let options = Options { block_delete: common.block_delete, ..Options::default() };
    let own = Some(path).filter(|path| path.as_os_str() != STDIN);
    let mut text = open(path)?.with_subprograms(Box::new(Folders::of(own, &common.subprograms)));
    let (dialect, recognised) = reading.of(&mut text)?;
    let mut checks: Vec<_> =
        laws.iter().map(|law| (Checker::new(machine, *law, overrides, options.start_mm), Diagnostics::new())).collect();
    let mut unwise: Vec<_> = laws.iter().map(|law| Warnings::new(machine, *law)).collect();
    let (mut commands, mut holes) = (0, HoleGroups::default());
    // What is unwise counts by the first law; what is planned otherwise than the machine file says, by each.
    let (mut warnings, mut replanned) = (Diagnostics::new(), Diagnostics::new());
    let mut diagnostics = Commands::new(&mut text, &dialect, options).finish(&mut |command| {
        commands += 1;
        holes.add(command);
        for (checker, refused) in &mut checks {
            checker.command(command, &mut |refusal| refused.planning_error(&refusal.command, refusal.error));
        }
        for (index, unwise) in unwise.iter_mut().enumerate() {
            unwise.command(command, &mut |found| match found.changes_the_plan() {
                true => replanned.warn(command, found),
                false if index == 0 => warnings.warn(command, found),
                false => {}
            });
        }
    });
    // A program with errors was read in part only; what cannot be done of that part says little.
    for (_, refused) in &checks {
        if !diagnostics.has_errors() {
            diagnostics.append(refused);
        }
    }
    if !diagnostics.has_errors() {
        diagnostics.append(&replanned);
    }
    let name = name(path);
    if let Some(found) = recognised.filter(|_| !common.quiet) {
        report(&format!("{name}: {}", found.reason()));
    }
    let mut program = Program { name, text, dialect, options, commands, holes, diagnostics, warnings };
    program.intact()?;
    Ok(program)
}

/// Reads all programs and reports what was found in them; stops where one has an error.
pub(super) fn programs(
    common: &Common,
    paths: &[PathBuf],
    reading: &Reading,
    machine: &Machine,
    laws: &[Law],
    overrides: Overrides,
) -> Result<Vec<Program>, Stop> {
    stdin_at_most_once(paths)?;
    let mut good = true;
    let mut programs = Vec::new();
    for path in paths {
        let mut program = program(common, path, reading, machine, laws, overrides)?;
        report_findings(common, &mut program);
        good &= !program.diagnostics.has_errors();
        programs.push(program);
    }
    if good { Ok(programs) } else { Err(Stop::Reported) }
}

/// Refuses to draw a hole that no program has.
pub(super) fn check_selection(hole: Option<u32>, programs: &[Program]) -> Result<(), Stop> {
    let most = programs.iter().map(|program| program.holes.holes()).max().unwrap_or(0);
    match hole {
        Some(hole) if hole as usize > most => Err(Stop::Usage(format!("--hole {hole}: expected 1 to {most}"))),
        _ => Ok(()),
    }
}

/// Standard input ends where it was read; a second reading would find an empty program.
pub(super) fn stdin_at_most_once(paths: &[PathBuf]) -> Result<(), Stop> {
    if paths.iter().filter(|path| path.as_os_str() == STDIN).count() > 1 {
        return Err(Stop::Usage("standard input can be read only once".into()));
    }
    Ok(())
}

/// Reports what was found in a program; warnings only unless the user wants quiet.
pub(super) fn report_findings(common: &Common, program: &mut Program) {
    let found = program.diagnostics.as_slice();
    let is_idle = |found: &Diagnostic| found.kind.idle().is_some();
    let brief = common.verbose == 0;
    let mut shown: Vec<_> = found
        .iter()
        .filter(|found| if common.quiet { found.is_error() } else { !(brief && is_idle(found)) })
        .copied()
        .collect();
    // Another control's program explains all that is wrong with it.
    shown.sort_by_key(|found| !matches!(found.kind, DiagnosticKind::LooksLike { .. }));
    if !shown.is_empty() {
        report_styled(&diagnostics::render(&program.name, &mut program.text, &shown, color(common)));
    }
    // Every shop's program has some of these.
    let idle: Vec<_> = found.iter().filter_map(|found| found.kind.idle()).collect();
    if brief && !common.quiet && !idle.is_empty() {
        report(&format!("{}: nothing that is simulated depends on {}; -v shows where", program.name, idle.join(", ")));
    }
}

/// Largest file read, in bytes: beyond it something else than a program or a machine was given.
const LARGEST: u64 = 1 << 30;

/// A whole file, for what is short.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Stop> {
    let mut bytes = Vec::new();
    let result = if path.as_os_str() == STDIN {
        io::stdin().lock().take(LARGEST + 1).read_to_end(&mut bytes)
    } else {
        File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes))
    };
    let result = result.and_then(|length| fits(length as u64));
    result.map(|()| bytes).map_err(|error| unreadable(&name(path), &error))
}

/// A program's text.
fn open(path: &Path) -> Result<Text<File>, Stop> {
    twice(path, true).map(Text::new)
}

/// A recording, of any length.
pub(super) fn recording(path: &Path) -> Result<File, Stop> {
    twice(path, false)
}

/// What is read more than once. Standard input and the like go to a file without a name first.
fn twice(path: &Path, limited: bool) -> Result<File, Stop> {
    let file = if path.as_os_str() == STDIN {
        spooled(io::stdin().lock())
    } else {
        File::open(path).and_then(|file| {
            let known = file.metadata()?;
            match (known.is_file(), limited) {
                (true, true) => fits(known.len()).map(|()| file),
                (true, false) => Ok(file),
                (false, _) => spooled(file),
            }
        })
    };
    file.map_err(|error| unreadable(&name(path), &error))
}

fn spooled(input: impl Read) -> io::Result<File> {
    let mut file = tempfile::tempfile()?;
    let length = io::copy(&mut input.take(LARGEST + 1), &mut file)?;
    fits(length).map(|()| file)
}

fn fits(length: u64) -> io::Result<()> {
    if length <= LARGEST { Ok(()) } else { Err(io::Error::other(format!("more than {LARGEST} bytes"))) }
}

fn unreadable(name: &str, error: &io::Error) -> Stop {
    report(&format!("error: {name}: {error}"));
    Stop::Reported
}

/// Says what is wrong with a file, at its place.
pub(super) fn refused(name: &str, line: usize, column: usize, why: &impl std::fmt::Display) -> Stop {
    report(&format!("error: {name}:{line}:{column}: {}", printable(&why.to_string())));
    Stop::Reported
}

/// A file's name in messages, tables, pictures and JSON: a name may hold any character, and none of it commands a
/// terminal.
pub(super) fn name(path: &Path) -> String {
    if path.as_os_str() == STDIN { "<stdin>".into() } else { printable(&path.to_string_lossy()).into_owned() }
}
