//! Runs a text line by line.

use std::io::{Read, Seek};

use super::fanuc::{fanuc_end, fanuc_while, go_to};
use super::interpreter::Interpreter;
use super::ngc::word;
use super::run_state::Running;
use crate::gcode::actions::Output;
use crate::gcode::blocks::{Flow, Statement};
use crate::gcode::command::Command;
use crate::gcode::diagnostics::Diagnostics;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::text::{Line, Place};

/// Most blocks, and commands of theirs, that are run another time. It ends what would go on for ever.
const MAX_STEPS: usize = if cfg!(fuzzing) { 2_000 } else { 250_000 };
/// Most commands that repeats make beyond [`OWN_COMMANDS`] of each block.
const MAX_REPEATED: usize = if cfg!(fuzzing) { 20_000 } else { 2_000_000 };
/// What a block makes without repeats: a drilled hole is five commands.
const OWN_COMMANDS: usize = 8;

/// Runs the next line; false where there is none.
pub(super) fn run_line<R: Read + Seek>(
    run: &mut Running<'_, R>,
    interpreter: &mut Interpreter,
    sink: &mut dyn FnMut(&Command),
    diagnostics: &mut Diagnostics,
) -> bool {
    if run.stopped || interpreter.is_done() {
        return false;
    }
    // The file of a subprogram stands behind all that was run, and may run many times.
    let appended = run.text.is_appended(run.next.offset);
    let Some((line, next)) = run.text.line_at(run.next) else { return false };
    run.next = next;
    let again = appended || line.offset < run.high;
    if !appended {
        run.high = run.high.max(line.offset + 1);
    }
    let mut commands = 0;
    let mut counting = |command: &Command| {
        commands += 1;
        sink(command);
    };
    interpreter.depth = run.calls.len();
    let flow = interpreter.step(&line, again, &mut counting, diagnostics);
    let (number, span) = (line.number, Place::new(0, line.text.len()).span(line.offset));
    if !matches!(flow, Flow::Next) {
        // Jumps read other lines in place of this one.
        let kept = line.text.to_vec();
        let line = Line { text: &kept, ..line };
        let mut output =
            Output { line: &line, place: Place::default(), damaged: false, again, sink: &mut counting, diagnostics };
        follow(run, flow, line, interpreter, &mut output);
    }
    if again {
        run.steps += 1 + commands;
    }
    run.repeated += commands.saturating_sub(OWN_COMMANDS);
    let limit = match () {
        () if run.steps > MAX_STEPS => DiagnosticKind::TooManySteps { limit: MAX_STEPS },
        () if run.repeated > MAX_REPEATED => DiagnosticKind::TooManyCommands { limit: MAX_REPEATED },
        () => return true,
    };
    diagnostics.report(limit, span, number, || 1);
    interpreter.give_up();
    run.stopped = true;
    false
}

fn follow<R: Read + Seek>(
    run: &mut Running<'_, R>,
    flow: Flow,
    line: Line<'_>,
    interpreter: &mut Interpreter,
    output: &mut Output<'_, '_>,
) {
    let whole = Place::new(0, line.text.len());
    let result = match flow {
        Flow::Next | Flow::Statement(Statement::Next) => Ok(()),
        Flow::Statement(Statement::Set(variable, value)) => interpreter.variables().write(variable, value),
        Flow::Statement(Statement::Goto(number)) => go_to(run, number, line),
        Flow::Statement(Statement::While { number, holds }) => fanuc_while(run, number, holds, line),
        Flow::Statement(Statement::End { number }) => fanuc_end(run, number),
        Flow::Statement(Statement::Word { label, keyword, rest }) => {
            match word(run, &label, keyword, rest, line, interpreter.variables()) {
                Ok(()) => Ok(()),
                Err((kind, place)) => return output.report(kind, place),
            }
        }
        Flow::Call(call) => {
            let place = call.place;
            match run.call_program(call, interpreter.variables()) {
                Ok(program) => {
                    interpreter.remember_call(program);
                    Ok(())
                }
                Err(kind) => return output.report(kind, place),
            }
        }
        Flow::CallLabel { label, repeats, place } => match run.call_label(label, repeats, line.offset) {
            Ok(()) => {
                interpreter.remember_call(label as u32);
                Ok(())
            }
            Err(kind) => return output.report(kind, place),
        },
        Flow::CallNamed { name, repeats, place } => match run.call_named(&name, repeats) {
            Ok(()) => Ok(()),
            Err(kind) => return output.report(kind, place),
        },
        Flow::Return => {
            run.return_from_call(interpreter.variables());
            Ok(())
        }
    };
    if let Err(kind) = result {
        output.report(kind, whole);
    }
}
