//! `rigidtap check`.

use serde_json::json;

use crate::control::machine::Law;
use crate::gcode::program::Overrides;
use crate::gcode::{CommandKind, canonical, explain};
use crate::report::{json, table};

use super::args::{CheckArgs, Common, Format};
use super::input;
use super::outcome::{Outcome, Stop, print, print_json};

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
    let mut files = Vec::new();
    let mut text = String::new();
    let mut good = true;
    for path in &args.files {
        let mut program = input::program(common, path, &dialect, &file.machine, Law::default(), Overrides::default())?;
        program.find_concerns(&file.machine, Law::default());
        good &= !program.diagnostics.has_errors();
        if common.format == Format::Json {
            files.push(json::checked_file(&program.name, &program.commands, program.diagnostics.as_slice()));
            continue;
        }
        input::tell_found(common, &program);
        if args.canon {
            for command in &program.commands {
                text += &canonical(command);
                text.push('\n');
            }
        } else {
            let holes = program.commands.iter().filter(|command| matches!(command.kind, CommandKind::Tap(_))).count();
            text += &format!(
                "{}: {} commands, {holes} tapped holes, {} errors, {} warnings\n",
                program.name,
                program.commands.len(),
                program.diagnostics.error_count(),
                program.diagnostics.warning_count(),
            );
            text += &table::holes(&program.commands);
        }
    }
    if common.format == Format::Json {
        print_json(&json!({ "files": files }))?;
    } else {
        print(&text)?;
    }
    Ok(if good { Outcome::Good } else { Outcome::Rejected })
}
