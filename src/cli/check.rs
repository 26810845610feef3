//! `rigidtap check`.

use std::io::{self, Write};

use serde_json::json;

use crate::control::machine::Law;
use crate::gcode::explain;
use crate::gcode::program::Overrides;
use crate::report::json_writer::JsonWriter;
use crate::report::{json, table};

use super::args::{CheckArgs, Common, Format};
use super::input::{self, Program};
use super::outcome::{Outcome, Stop, print, stdout, unwritable};

/// Reads, interprets and plans every file; all of their errors show at once.
pub(super) fn check(common: &Common, args: &CheckArgs) -> Result<Outcome, Stop> {
    if let Some(code) = &args.explain {
        let story = explain(code).ok_or_else(|| {
            Stop::Usage(format!("there is no diagnostic {code}: codes are G101 to G702, as messages show them"))
        })?;
        print(&story)?;
        return Ok(Outcome::Good);
    }
    let file = input::machine_file(common)?;
    let dialect = input::dialect(common, &file)?;
    input::stdin_at_most_once(&args.files)?;
    let mut programs = Vec::new();
    for path in &args.files {
        let mut program =
            input::program(common, path, &dialect, &file.machine, &[Law::default()], Overrides::default())?;
        program.tell_concerns();
        if common.format == Format::Table {
            input::tell_found(common, &mut program);
        }
        programs.push(program);
    }
    let good = !programs.iter().any(|program| program.diagnostics.has_errors());
    let mut out = stdout();
    if common.format == Format::Json {
        write_json(&mut programs, &mut out)?;
    } else {
        for program in &mut programs {
            if args.canon {
                for command in program.commands() {
                    writeln!(out, "{command}").map_err(unwritable)?;
                }
                program.intact()?;
            } else {
                write_summary(program, &mut out).map_err(unwritable)?;
            }
        }
    }
    out.flush().map_err(unwritable)?;
    Ok(if good { Outcome::Good } else { Outcome::Rejected })
}

fn write_summary(program: &Program, out: &mut dyn Write) -> io::Result<()> {
    let Program { name, commands, holes, diagnostics, .. } = program;
    writeln!(
        out,
        "{name}: {commands} commands, {} tapped holes, {} errors, {} warnings",
        holes.holes(),
        diagnostics.error_count(),
        diagnostics.warning_count(),
    )?;
    out.write_all(table::holes(holes).as_bytes())
}

fn write_json(programs: &mut [Program], out: &mut dyn Write) -> Result<(), Stop> {
    let mut writer = JsonWriter::new(out);
    writer.begin_object(None).map_err(unwritable)?;
    writer.begin_array(Some("files")).map_err(unwritable)?;
    for program in programs {
        writer.begin_object(None).map_err(unwritable)?;
        writer.value(Some("file"), &json!(program.name)).map_err(unwritable)?;
        writer.begin_array(Some("commands")).map_err(unwritable)?;
        for command in program.commands() {
            writer.value(None, &json::command(&command)).map_err(unwritable)?;
        }
        program.intact()?;
        writer.end().map_err(unwritable)?;
        let diagnostics: Vec<_> = program.diagnostics.as_slice().iter().map(json::diagnostic).collect();
        writer.value(Some("diagnostics"), &json!(diagnostics)).map_err(unwritable)?;
        writer.end().map_err(unwritable)?;
    }
    writer.end().and_then(|()| writer.end()).map_err(unwritable)
}
