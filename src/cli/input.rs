//! What a command reads: the machine file and the programs, each rejected with its place.

use std::io::{self, IsTerminal, Read};
use std::path::{Path, PathBuf};

use crate::config::MachineFile;
use crate::control::machine::{Law, Machine, MachineError, MachineSpec};
use crate::control::model::cutting::Material;
use crate::control::thread::{METRIC_COARSE, StandardThread};
use crate::gcode::program::{Overrides, check};
use crate::gcode::{Command, Diagnostics, Dialect, Options, concerns, interpret};
use crate::report::diagnostics;
use crate::study::{TuneError, retuned};

use super::args::{ColorChoice, Common, OverrideArgs};
use super::outcome::{Stop, tell};

/// Name of standard input on the command line.
const STDIN: &str = "-";

/// A program that was read, with all that was found in it.
pub(super) struct Program {
    pub(super) name: String,
    source: Vec<u8>,
    pub(super) commands: Vec<Command>,
    pub(super) diagnostics: Diagnostics,
}

impl Program {
    /// Adds what is unwise about a program that has no errors.
    pub(super) fn find_concerns(&mut self, machine: &Machine, law: Law) {
        if !self.diagnostics.has_errors() {
            concerns(&self.commands, machine, law, &mut |command, concern| {
                self.diagnostics.warn(command, concern, &self.source);
            });
        }
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

/// The machine file in use, or the reference machine.
pub(super) fn machine_file(common: &Common) -> Result<MachineFile, Stop> {
    let Some(path) = &common.machine else { return Ok(MachineFile::reference()) };
    let bytes = read(path)?;
    let name = name(path);
    let (file, found) = match MachineFile::read(&bytes) {
        Ok(file) => {
            let warnings = file.warnings.clone();
            (Ok(file), warnings)
        }
        Err(faults) => (Err(Stop::Told), faults),
    };
    if !found.is_empty() && (file.is_err() || !common.quiet) {
        tell(&diagnostics::render_machine_file(&name, &bytes, &found, color(common)));
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
        let size = StandardThread::by_name(name).ok_or_else(|| {
            let known: Vec<_> = METRIC_COARSE.iter().map(|size| size.name).collect();
            Stop::Usage(format!("--tap {name} is not a size known here: expected one of {}", known.join(", ")))
        })?;
        machine = with(&machine, |spec| {
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

/// The dialect in use, with the machine file's options.
pub(super) fn dialect(common: &Common, file: &MachineFile) -> Result<Dialect, Stop> {
    let name = common.dialect.as_deref().unwrap_or(&file.gcode.dialect);
    let dialect = Dialect::by_name(name).ok_or_else(|| {
        let known: Vec<_> = Dialect::ALL.iter().map(|dialect| dialect.name).collect();
        Stop::Usage(Dialect::out_of_scope(name).map_or_else(
            || format!("dialect {name} is not known here: expected one of {}", known.join(", ")),
            str::to_owned,
        ))
    })?;
    Ok(file.gcode.apply(dialect))
}

/// Overrides as factors.
pub(super) fn overrides(args: &OverrideArgs) -> Overrides {
    Overrides { rapid: args.rapid_override / 100.0, feed: args.feed_override / 100.0 }
}

/// Reads a program, interprets it, and plans it on the machine under the overrides; nothing moves.
pub(super) fn program(
    common: &Common,
    path: &Path,
    dialect: &Dialect,
    machine: &Machine,
    law: Law,
    overrides: Overrides,
) -> Result<Program, Stop> {
    let source = read(path)?;
    let options = Options { block_delete: common.block_delete, ..Options::default() };
    let read = interpret(&source, dialect, options);
    let mut program = Program { name: name(path), source, commands: read.commands, diagnostics: read.diagnostics };
    // A program with errors was read in part only; what cannot be done of that part says little.
    if !program.diagnostics.has_errors() {
        let Program { commands, diagnostics, source, .. } = &mut program;
        check(commands, machine, law, overrides, options.start_mm, &mut |refusal| {
            diagnostics.refuse(&refusal, source);
        });
    }
    Ok(program)
}

/// Reads all programs and tells what was found in them; stops where one has an error.
pub(super) fn programs(
    common: &Common,
    paths: &[PathBuf],
    dialect: &Dialect,
    machine: &Machine,
    laws: &[Law],
    overrides: Overrides,
) -> Result<Vec<Program>, Stop> {
    stdin_at_most_once(paths)?;
    let mut good = true;
    let mut programs = Vec::new();
    for path in paths {
        let mut program =
            program(common, path, dialect, machine, laws.first().copied().unwrap_or_default(), overrides)?;
        for law in laws.iter().skip(1) {
            if program.diagnostics.has_errors() {
                break;
            }
            let Program { commands, diagnostics, source, .. } = &mut program;
            check(commands, machine, *law, overrides, Options::default().start_mm, &mut |refusal| {
                diagnostics.refuse(&refusal, source);
            });
        }
        tell_found(common, &program);
        good &= !program.diagnostics.has_errors();
        programs.push(program);
    }
    if good { Ok(programs) } else { Err(Stop::Told) }
}

/// Standard input ends where it was read; a second reading would find an empty program.
pub(super) fn stdin_at_most_once(paths: &[PathBuf]) -> Result<(), Stop> {
    if paths.iter().filter(|path| path.as_os_str() == STDIN).count() > 1 {
        return Err(Stop::Usage("standard input can be read only once".into()));
    }
    Ok(())
}

/// Tells what was found in a program; warnings only unless the user wants quiet.
pub(super) fn tell_found(common: &Common, program: &Program) {
    let found = program.diagnostics.as_slice();
    let told: Vec<_> = found.iter().filter(|found| !common.quiet || found.is_error()).copied().collect();
    if !told.is_empty() {
        tell(&diagnostics::render(&program.name, &program.source, &told, color(common)));
    }
}

/// Largest file read, in bytes: beyond it something else than a program or a machine was given.
const LARGEST: u64 = 1 << 30;

pub(super) fn read(path: &Path) -> Result<Vec<u8>, Stop> {
    let mut bytes = Vec::new();
    let result = if path.as_os_str() == STDIN {
        io::stdin().lock().take(LARGEST + 1).read_to_end(&mut bytes)
    } else {
        std::fs::File::open(path).and_then(|file| file.take(LARGEST + 1).read_to_end(&mut bytes))
    };
    let result = result.and_then(|length| {
        let fits = length as u64 <= LARGEST;
        if fits { Ok(()) } else { Err(io::Error::other(format!("more than {LARGEST} bytes"))) }
    });
    result.map_err(|error| {
        tell(&format!("error: {}: {error}", name(path)));
        Stop::Told
    })?;
    Ok(bytes)
}

/// A file's name in messages.
pub(super) fn name(path: &Path) -> String {
    if path.as_os_str() == STDIN { "<stdin>".into() } else { path.display().to_string() }
}
