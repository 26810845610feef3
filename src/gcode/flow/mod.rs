//! Which line comes next: loops, jumps and subprograms over a source that is in memory.

mod index;
mod ngc;
mod statement;

pub(crate) use statement::{Statement, statement};

use super::command::Command;
use super::diagnostics::Diagnostics;
use super::interpreter::Interpreter;
use super::messages::DiagnosticKind;
use super::output::Output;
use super::span::{Line, Place, line_at, text_start};
use index::Index;
use ngc::Loop;

/// Deepest nesting of calls, and of loops. A Fanuc takes 4 calls of M98, LinuxCNC 10.
const MAX_DEPTH: usize = 32;
/// Most blocks, and commands of theirs, that are run another time. It ends what would go on for ever.
const MAX_STEPS: usize = 250_000;

/// A line's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cursor {
    offset: usize,
    /// Number of that line.
    number: u32,
}

/// What a line says about the next one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Flow {
    Next,
    Statement(Statement),
    /// M98.
    Call {
        program: u32,
        repeats: u32,
        place: Place,
    },
    /// M99.
    Return,
}

/// A subprogram that runs.
#[derive(Clone, Copy, Debug)]
struct Call {
    back: Cursor,
    start: Cursor,
    repeats_left: u32,
    /// Loops around the call.
    loops: usize,
    /// It has variables of its own.
    level: bool,
}

/// Runs a source.
struct Runner<'a> {
    source: &'a [u8],
    next: Cursor,
    /// One past the last byte that was run: what stands before runs another time.
    high: usize,
    steps: usize,
    loops: Vec<Loop>,
    calls: Vec<Call>,
    index: Option<Index>,
}

/// Runs a whole source through an interpreter.
pub(crate) fn run(
    source: &[u8],
    interpreter: &mut Interpreter,
    sink: &mut dyn FnMut(Command),
    diagnostics: &mut Diagnostics,
) {
    let next = Cursor { offset: text_start(source), number: 1 };
    let mut runner = Runner { source, next, high: 0, steps: 0, loops: Vec::new(), calls: Vec::new(), index: None };
    while let Some(line) = runner.take_line() {
        let again = line.offset < runner.high;
        runner.high = runner.high.max(line.offset + 1);
        let mut commands = 0;
        let mut counting = |command| {
            commands += 1;
            sink(command);
        };
        interpreter.depth = runner.calls.len();
        let flow = interpreter.step(line, again, &mut counting, diagnostics);
        let mut output =
            Output { line, place: Place::default(), damaged: false, again, sink: &mut counting, diagnostics };
        runner.follow(flow, line, interpreter, &mut output);
        if again {
            runner.steps += 1 + commands;
        }
        if runner.steps > MAX_STEPS {
            let span = Place::new(0, line.text.len()).span(line.offset);
            diagnostics.report(DiagnosticKind::TooManySteps { limit: MAX_STEPS }, span, line.number, || 1);
            break;
        }
    }
}

impl<'a> Runner<'a> {
    fn take_line(&mut self) -> Option<Line<'a>> {
        let (line, offset) = line_at(self.source, self.next.offset, self.next.number)?;
        self.next = Cursor { offset, number: line.number.saturating_add(1) };
        Some(line)
    }

    fn follow(&mut self, flow: Flow, line: Line<'_>, interpreter: &mut Interpreter, output: &mut Output<'_, '_>) {
        let whole = Place::new(0, line.text.len());
        let result = match flow {
            Flow::Next | Flow::Statement(Statement::Next) => Ok(()),
            Flow::Statement(Statement::Set(variable, value)) => interpreter.variables().write(variable, value),
            Flow::Statement(Statement::Goto(number)) => self.go_to(number, line),
            Flow::Statement(Statement::While { number, holds }) => self.fanuc_while(number, holds, line),
            Flow::Statement(Statement::End { number }) => self.fanuc_end(number),
            Flow::Statement(Statement::Word { label, keyword, rest }) => {
                match self.word(&label, keyword, rest, line, interpreter) {
                    Ok(()) => Ok(()),
                    Err((kind, place)) => return output.report(kind, place),
                }
            }
            Flow::Call { program, repeats, place } => match self.call_program(program, repeats) {
                Ok(()) => Ok(()),
                Err(kind) => return output.report(kind, place),
            },
            Flow::Return => {
                self.return_from_call(interpreter);
                Ok(())
            }
        };
        if let Err(kind) = result {
            output.report(kind, whole);
        }
    }

    fn index(&mut self) -> &Index {
        let source = self.source;
        self.index.get_or_insert_with(|| Index::of(source))
    }

    fn at(line: Line<'_>) -> Cursor {
        Cursor { offset: line.offset, number: line.number }
    }

    /// GOTO: searched from here on, then from the program's start, as a Fanuc does.
    fn go_to(&mut self, number: f64, line: Line<'_>) -> Result<(), DiagnosticKind> {
        let from = line.offset;
        let target = self.index().label(number, from).ok_or(DiagnosticKind::LabelMissing { number })?;
        self.loops.retain(|l| l.at.offset < target.offset || l.at.offset > from);
        self.next = target;
        Ok(())
    }

    /// WHILE [ ] DO m.
    fn fanuc_while(&mut self, number: u32, holds: bool, line: Line<'_>) -> Result<(), DiagnosticKind> {
        let outside = self.calls.last().map_or(0, |call| call.loops);
        let label = number.to_string().into_bytes();
        let mut index = 0;
        self.loops.retain(|l| {
            index += 1;
            index <= outside || l.label != label
        });
        if holds {
            return self.push_loop(Loop::head(label, Self::at(line)));
        }
        self.skip_past(|text| statement::is_fanuc_end(text, number)).ok_or(DiagnosticKind::LoopOpen)
    }

    /// END m.
    fn fanuc_end(&mut self, number: u32) -> Result<(), DiagnosticKind> {
        let label = number.to_string().into_bytes();
        let found = self.loops.iter().rev().find(|l| l.label == label).ok_or(DiagnosticKind::LoopOpen)?;
        self.next = found.at;
        Ok(())
    }

    fn push_loop(&mut self, new: Loop) -> Result<(), DiagnosticKind> {
        if self.loops.len() >= MAX_DEPTH {
            return Err(DiagnosticKind::TooDeep { limit: MAX_DEPTH });
        }
        self.loops.push(new);
        Ok(())
    }

    /// Goes on behind the first line from here that is as wanted.
    fn skip_past(&mut self, wanted: impl Fn(&[u8]) -> bool) -> Option<()> {
        let before = self.next;
        while let Some(line) = self.take_line() {
            // Skipping costs time, too, where it happens again and again.
            self.steps += usize::from(self.steps > 0 || !self.loops.is_empty() || !self.calls.is_empty());
            if wanted(line.text) {
                return Some(());
            }
        }
        self.next = before;
        None
    }

    fn call_program(&mut self, program: u32, repeats: u32) -> Result<(), DiagnosticKind> {
        let start = self.index().program(program).ok_or(DiagnosticKind::ProgramMissing { program })?;
        if repeats == 0 { Ok(()) } else { self.push_call(start, repeats, false) }
    }

    fn push_call(&mut self, start: Cursor, repeats: u32, level: bool) -> Result<(), DiagnosticKind> {
        if self.calls.len() >= MAX_DEPTH {
            return Err(DiagnosticKind::TooDeep { limit: MAX_DEPTH });
        }
        let call = Call { back: self.next, start, repeats_left: repeats - 1, loops: self.loops.len(), level };
        self.calls.push(call);
        self.next = start;
        Ok(())
    }

    /// Back to the caller, or once more.
    fn return_from_call(&mut self, interpreter: &mut Interpreter) {
        let Some(call) = self.calls.last_mut() else { return };
        self.loops.truncate(call.loops);
        if call.repeats_left > 0 {
            call.repeats_left -= 1;
            self.next = call.start;
            return;
        }
        self.next = call.back;
        if call.level {
            interpreter.variables().leave();
        }
        self.calls.pop();
    }
}
