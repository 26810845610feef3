//! A program's commands, one after the other.

use std::collections::VecDeque;
use std::io::{Read, Seek};

use super::interpreter::{Interpreter, Options};
use super::run_state::Running;
use super::runner::run_line;
use crate::gcode::command::Command;
use crate::gcode::diagnostics::Diagnostics;
use crate::gcode::dialect::Dialect;
use crate::gcode::text::Text;

/// The commands of a text, interpreted as they are asked for, in the order they run.
///
/// Memory does not grow with the program, except by 24 bytes for each numbered block of a program with GOTO; a block's
/// commands are at most what its repeats make, and all repeats together at most two million beyond a few a block.
///
/// ```
/// use rigidtap::gcode::{Commands, Dialect, Options, Text};
/// let mut text = Text::of(b"M03S1000 G0X0Y0Z10\nG81Z-5R2F1000\nM30\n");
/// let mut commands = Commands::new(&mut text, &Dialect::PAPER, Options::default());
/// assert_eq!(commands.by_ref().count(), 4);
/// assert!(!commands.diagnostics().has_errors());
/// ```
#[derive(Debug)]
pub struct Commands<'t, R> {
    running: Running<'t, R>,
    interpreter: Interpreter,
    diagnostics: Diagnostics,
    /// Of the block before.
    ready: VecDeque<Command>,
    finished: bool,
}

impl<'t, R: Read + Seek> Commands<'t, R> {
    /// From the text's first line.
    pub fn new(text: &'t mut Text<R>, dialect: &Dialect, options: Options) -> Self {
        Self {
            running: Running::new(text),
            interpreter: Interpreter::new(dialect, options),
            diagnostics: Diagnostics::new(),
            ready: VecDeque::new(),
            finished: false,
        }
    }

    /// What was found in the blocks so far. With errors the commands must not be run.
    pub fn diagnostics(&self) -> &Diagnostics {
        &self.diagnostics
    }

    /// Hands over the commands that are left, and yields what was found.
    pub fn finish(mut self, sink: &mut dyn FnMut(&Command)) -> Diagnostics {
        self.ready.iter().for_each(&mut *sink);
        while !self.finished {
            self.next_block(sink);
        }
        self.diagnostics
    }

    fn next_block(&mut self, sink: &mut dyn FnMut(&Command)) {
        let Self { running, interpreter, diagnostics, .. } = self;
        if !run_line(running, interpreter, sink, diagnostics) {
            interpreter.finish(sink, diagnostics);
            self.finished = true;
        }
    }
}

impl<R: Read + Seek> Iterator for Commands<'_, R> {
    type Item = Command;

    fn next(&mut self) -> Option<Command> {
        let mut ready = std::mem::take(&mut self.ready);
        while ready.is_empty() && !self.finished {
            self.next_block(&mut |command| ready.push_back(*command));
        }
        self.ready = ready;
        self.ready.pop_front()
    }
}

/// A whole program, interpreted.
#[derive(Clone, Debug, Default)]
pub struct Interpretation {
    /// In the order they run. With errors: as far as they could be read, not to be run.
    pub commands: Vec<Command>,
    /// In the order found.
    pub diagnostics: Diagnostics,
}

/// Interprets a program that is in memory. Never fails: what is wrong is in the diagnostics.
///
/// ```
/// use rigidtap::gcode::{CommandKind, Dialect, Options, interpret};
/// let program = interpret(b"M03S1000 G0X0Y0Z10\nG81Z-5R2F1000\nM30\n", &Dialect::PAPER, Options::default());
/// assert!(!program.diagnostics.has_errors());
/// let CommandKind::Tap(hole) = program.commands[2].kind else { panic!("a hole") };
/// assert_eq!((hole.depth_mm(), hole.pitch_mm), (7.0, 1.0));
/// ```
#[must_use]
pub fn interpret(source: &[u8], dialect: &Dialect, options: Options) -> Interpretation {
    let mut commands = Vec::new();
    let diagnostics =
        Commands::new(&mut Text::of(source), dialect, options).finish(&mut |command| commands.push(*command));
    Interpretation { commands, diagnostics }
}
