//! Which line comes next: loops, jumps and subprograms over a text that can be read again.

mod index;
mod ngc;
mod statement;

pub(crate) use statement::{Statement, statement};

use std::io::{Read, Seek};

use super::command::Command;
use super::diagnostics::Diagnostics;
use super::interpreter::Interpreter;
use super::messages::DiagnosticKind;
use super::output::Output;
use super::span::{Cursor, Line, Place};
use super::text::Text;
use index::Index;
use ngc::Loop;

/// Deepest nesting of calls, and of loops. A Fanuc takes 4 calls of M98, LinuxCNC 10.
const MAX_DEPTH: usize = 32;
/// Most blocks, and commands of theirs, that are run another time. It ends what would go on for ever.
const MAX_STEPS: usize = if cfg!(fuzzing) { 2_000 } else { 250_000 };
/// Most commands that repeats make beyond [`OWN_COMMANDS`] of each block.
const MAX_REPEATED: usize = if cfg!(fuzzing) { 20_000 } else { 2_000_000 };
/// What a block makes without repeats: a drilled hole is five commands.
const OWN_COMMANDS: usize = 8;

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

/// Runs a text.
#[derive(Debug)]
pub(crate) struct Runner<'t, R> {
    text: &'t mut Text<R>,
    next: Cursor,
    /// One past the last byte that was run: what stands before runs another time.
    high: usize,
    steps: usize,
    repeated: usize,
    loops: Vec<Loop>,
    calls: Vec<Call>,
    index: Option<Index>,
    /// The index has labels.
    labelled: bool,
    /// A limit was reached.
    stopped: bool,
}

impl<'t, R: Read + Seek> Runner<'t, R> {
    /// At the text's first line.
    pub(crate) fn new(text: &'t mut Text<R>) -> Self {
        let next = text.first();
        Self {
            text,
            next,
            high: 0,
            steps: 0,
            repeated: 0,
            loops: Vec::new(),
            calls: Vec::new(),
            index: None,
            labelled: false,
            stopped: false,
        }
    }

    /// Runs the next line; false where there is none.
    pub(crate) fn run_line(
        &mut self,
        interpreter: &mut Interpreter,
        sink: &mut dyn FnMut(&Command),
        diagnostics: &mut Diagnostics,
    ) -> bool {
        if self.stopped || interpreter.is_done() {
            return false;
        }
        let Some((line, next)) = self.text.line_at(self.next) else { return false };
        self.next = next;
        let again = line.offset < self.high;
        self.high = self.high.max(line.offset + 1);
        let mut commands = 0;
        let mut counting = |command: &Command| {
            commands += 1;
            sink(command);
        };
        interpreter.depth = self.calls.len();
        let flow = interpreter.step(&line, again, &mut counting, diagnostics);
        let (number, span) = (line.number, Place::new(0, line.text.len()).span(line.offset));
        if flow != Flow::Next {
            // Jumps read other lines in place of this one.
            let kept = line.text.to_vec();
            let line = Line { text: &kept, ..line };
            let mut output = Output {
                line: &line,
                place: Place::default(),
                damaged: false,
                again,
                sink: &mut counting,
                diagnostics,
            };
            self.follow(flow, line, interpreter, &mut output);
        }
        if again {
            self.steps += 1 + commands;
        }
        self.repeated += commands.saturating_sub(OWN_COMMANDS);
        let limit = match () {
            () if self.steps > MAX_STEPS => DiagnosticKind::TooManySteps { limit: MAX_STEPS },
            () if self.repeated > MAX_REPEATED => DiagnosticKind::TooManyCommands { limit: MAX_REPEATED },
            () => return true,
        };
        diagnostics.report(limit, span, number, || 1);
        interpreter.give_up();
        self.stopped = true;
        false
    }

    fn take_line(&mut self) -> Option<Line<'_>> {
        let (line, next) = self.text.line_at(self.next)?;
        self.next = next;
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

    /// Labels are asked for by GOTO alone.
    fn index(&mut self, with_labels: bool) -> &Index {
        if with_labels && !self.labelled {
            (self.index, self.labelled) = (None, true);
        }
        let (text, labelled) = (&mut *self.text, self.labelled);
        self.index.get_or_insert_with(|| Index::of(text, labelled))
    }

    fn at(line: Line<'_>) -> Cursor {
        Cursor { offset: line.offset, number: line.number }
    }

    /// GOTO: searched from here on, then from the program's start, as a Fanuc does.
    fn go_to(&mut self, number: f64, line: Line<'_>) -> Result<(), DiagnosticKind> {
        let from = line.offset;
        let target = self.index(true).label(number, from).ok_or(DiagnosticKind::LabelMissing { number })?;
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
        // Skipping costs time, too, where it happens again and again.
        let costs = self.costs_steps();
        while let Some(line) = self.take_line() {
            let found = wanted(line.text);
            self.steps += costs;
            if found {
                return Some(());
            }
        }
        self.next = before;
        None
    }

    /// What a skipped line counts as.
    fn costs_steps(&self) -> usize {
        usize::from(self.steps > 0 || !self.loops.is_empty() || !self.calls.is_empty())
    }

    fn call_program(&mut self, program: u32, repeats: u32) -> Result<(), DiagnosticKind> {
        let start = self.index(false).program(program).ok_or(DiagnosticKind::ProgramMissing { program })?;
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
