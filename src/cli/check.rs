//! `rigidtap check`.

use std::cell::RefCell;
use std::io::{self, Write};

use crate::control::machine::{Law, Machine};
use crate::control::sync::Alarm;
use crate::gcode::explain;
use crate::gcode::program::Overrides;
use crate::report::json::{CheckAnswer, CheckedFile, CommandAnswer, Streamed};
use crate::report::table;

use super::answer::{answer, layout};
use super::args::{CheckArgs, Common, Format};
use super::input::{self, Program};
use super::outcome::{Outcome, Stop, print, print_json, stdout, unwritable};

/// Reads, interprets and plans every file; all of their errors show at once.
pub(super) fn check(common: &Common, args: &CheckArgs) -> Result<Outcome, Stop> {
    if let Some(code) = &args.explain {
        let alarm = || code.strip_prefix(['A', 'a']).and_then(|number| Alarm::explanation(number.parse().ok()?));
        let story = explain(code).or_else(|| alarm().map(str::to_owned)).ok_or_else(|| {
            Stop::Usage(format!(
                "there is no diagnostic {code}: codes are G101 to G702, and A101 to A112 for alarms, as messages show them"
            ))
        })?;
        print(&story)?;
        return Ok(Outcome::Good);
    }
    let file = input::machine_file(common, &[Law::default()])?;
    let reading = input::dialect(common, &file)?;
    input::stdin_at_most_once(&args.files)?;
    let mut programs = Vec::new();
    for path in &args.files {
        let mut program =
            input::program(common, path, &reading, &file.machine, &[Law::default()], Overrides::default())?;
        program.add_warnings();
        if common.format == Format::Table {
            input::report_findings(common, &mut program);
        }
        programs.push(program);
    }
    let good = !programs.iter().any(|program| program.diagnostics.has_errors());
    if common.format == Format::Json {
        write_json(common, &mut programs)?;
    } else {
        let mut out = stdout();
        for (index, program) in programs.iter_mut().enumerate() {
            if index > 0 && !args.canon {
                writeln!(out).map_err(unwritable)?;
            }
            if args.canon {
                for command in program.commands() {
                    writeln!(out, "{command}").map_err(unwritable)?;
                }
                program.intact()?;
            } else {
                write_summary(common, &file.machine, program, &mut out).map_err(unwritable)?;
            }
        }
        out.flush().map_err(unwritable)?;
    }
    Ok(if good { Outcome::Good } else { Outcome::Rejected })
}

fn write_summary(common: &Common, machine: &Machine, program: &Program, out: &mut dyn Write) -> io::Result<()> {
    let Program { name, commands, holes, diagnostics, .. } = program;
    writeln!(
        out,
        "{name}: {} errors, {} warnings, {commands} commands, {} tapped holes",
        diagnostics.error_count(),
        diagnostics.warning_count(),
        holes.holes(),
    )?;
    out.write_all(table::holes(layout(common), machine, holes).as_bytes())
}

/// What was read, as JSON, which is written while the programs are read again.
fn write_json(common: &Common, programs: &mut [Program]) -> Result<(), Stop> {
    let failed = RefCell::new(None);
    let files = Streamed::new(|add: &mut dyn FnMut(_)| {
        for program in programs {
            let file = program.name.clone();
            let diagnostics = program.diagnostic_answers();
            let commands = Streamed::new(|add: &mut dyn FnMut(_)| {
                program.commands().for_each(|command| add(CommandAnswer::from(&command)));
                if let Err(stop) = program.intact() {
                    failed.replace(Some(stop));
                }
            });
            add(CheckedFile { file, commands, diagnostics });
        }
    });
    let written = print_json(&answer(common, None, CheckAnswer { files }));
    failed.into_inner().map_or(written, Err)
}
