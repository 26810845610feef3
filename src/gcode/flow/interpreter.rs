//! Lines → commands: where the program begins and ends; what its blocks do is in `execute`.

use crate::gcode::actions::{Output, end, execute};
use crate::gcode::blocks::{
    Content, Flow, Lexer, Statement, Token, Variables, begins_with_word, line_number, o_word, program_number, statement,
};
use crate::gcode::command::{Command, CommandKind};
use crate::gcode::diagnostics::Diagnostics;
use crate::gcode::dialect::{Dialect, MCode, MGroup, Macros, looks_like};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::State;
use crate::gcode::text::{Line, MAX_BLOCK_BYTES, Place, Span};

/// What the operator, not the program, decides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The block delete switch: on, blocks that begin with `/` are skipped; off (default), they run.
    pub block_delete: bool,
    /// Where X, Y, Z stand when the program starts. Default: 100 mm above the program's zero.
    pub start_mm: [f64; 3],
}

impl Default for Options {
    fn default() -> Self {
        Self { block_delete: false, start_mm: [0.0, 0.0, 100.0] }
    }
}

/// How far the program has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Phase {
    Running,
    /// After M30, M02, or the closing `%`: text that is not run is warned of once.
    Ended {
        /// `%` closed the tape: no control reads what follows.
        closed: bool,
        /// In a subprogram that was called.
        subprogram: bool,
    },
    /// The same, and the warning was given.
    Warned,
    /// It is no text, or does not end: what follows is not looked at.
    GivenUp,
}

/// The last block with words, where a program without an end stops.
#[derive(Clone, Copy, Debug)]
struct LastBlock {
    line: u32,
    offset: usize,
    place: Place,
    column: u32,
}

/// Interprets a program line by line, in memory that does not grow with it.
///
/// ```
/// use rigidtap::gcode::{Diagnostics, Dialect, Interpreter, Options, lines};
/// let mut interpreter = Interpreter::new(&Dialect::PAPER, Options::default());
/// let (mut count, mut diagnostics) = (0, Diagnostics::new());
/// for line in lines(b"G0 X10\nM30") {
///     interpreter.block(line, &mut |_| count += 1, &mut diagnostics);
/// }
/// interpreter.finish(&mut |_| count += 1, &mut diagnostics);
/// assert_eq!((count, diagnostics.has_errors()), (2, false));
/// ```
#[derive(Clone, Debug)]
pub struct Interpreter {
    options: Options,
    state: State,
    phase: Phase,
    /// A `%` opened the program.
    opened: bool,
    /// There were words, readable or not.
    any_words: bool,
    /// Subprograms that run around this block.
    pub(crate) depth: usize,
    last: LastBlock,
    /// Programs, and numbers of blocks, that were called.
    called: Vec<u32>,
    /// Another dialect that a line with an error looks like, and where.
    looks_like: Option<(&'static str, LastBlock)>,
}

impl Interpreter {
    /// At power on: the dialect's unit, G90, G94, G98 (linuxcnc G99), spindle at rest, no motion code.
    #[must_use]
    pub fn new(dialect: &Dialect, options: Options) -> Self {
        Self {
            options,
            state: State::new(dialect, options.start_mm),
            phase: Phase::Running,
            opened: false,
            any_words: false,
            depth: 0,
            last: LastBlock { line: 1, offset: 0, place: Place::default(), column: 1 },
            called: Vec::new(),
            looks_like: None,
        }
    }

    /// Interprets the next line. Commands go to `sink` as they arise; once there is an error the program must not run,
    /// and commands go on only so that all errors show.
    ///
    /// Statements that jump need the whole source, see [`interpret`](crate::gcode::interpret): here they are an error.
    pub fn block(&mut self, line: Line<'_>, sink: &mut dyn FnMut(&Command), diagnostics: &mut Diagnostics) {
        let jumps = match self.step(&line, false, sink, diagnostics) {
            Flow::Next | Flow::Statement(Statement::Next) => false,
            Flow::Statement(Statement::Set(variable, value)) => self.variables().write(variable, value).is_err(),
            Flow::Statement(_) | Flow::Call(_) | Flow::CallLabel { .. } | Flow::CallNamed { .. } | Flow::Return => true,
        };
        if jumps {
            let place = Place::new(0, line.text.len());
            let mut output = Output { line: &line, place, damaged: false, again: false, sink, diagnostics };
            output.report(DiagnosticKind::JumpInStream, place);
        }
    }

    /// Interprets a line; what it says about the next one.
    pub(crate) fn step(
        &mut self,
        line: &Line<'_>,
        again: bool,
        sink: &mut dyn FnMut(&Command),
        diagnostics: &mut Diagnostics,
    ) -> Flow {
        let mut output = Output { line, place: Place::default(), damaged: false, again, sink, diagnostics };
        match self.phase {
            Phase::Running if line.text.len() > MAX_BLOCK_BYTES => {
                self.any_words = true;
                let kind = DiagnosticKind::BlockTooLong { limit: MAX_BLOCK_BYTES };
                output.report(kind, Place::new(0, 1));
            }
            Phase::Running => {
                let before = output.diagnostics.error_count();
                let flow = self.run(line.text, &mut output);
                if output.diagnostics.error_count() > before && self.looks_like.is_none() {
                    self.recognise(line);
                }
                return flow;
            }
            Phase::Ended { closed, subprogram } => self.after_end(line.text, closed, subprogram, &mut output),
            Phase::Warned | Phase::GivenUp => {}
        }
        Flow::Next
    }

    /// Whether no further line can change anything.
    pub(crate) fn is_done(&self) -> bool {
        matches!(self.phase, Phase::GivenUp | Phase::Warned)
    }

    /// Reads no further.
    pub(crate) fn give_up(&mut self) {
        self.phase = Phase::GivenUp;
    }

    /// The program's variables.
    pub(crate) fn variables(&mut self) -> &mut Variables {
        &mut self.state.variables
    }

    /// Ends the program: the end command, if none was there, and what only the end shows.
    pub fn finish(&mut self, sink: &mut dyn FnMut(&Command), diagnostics: &mut Diagnostics) {
        if let Some((name, LastBlock { line, offset, place, column })) = self.looks_like.take() {
            diagnostics.report(DiagnosticKind::LooksLike { name }, place.span(offset), line, || column);
        }
        let LastBlock { line, offset, place, column } = self.last;
        let span = place.span(offset);
        if !self.any_words {
            diagnostics.report(DiagnosticKind::EmptyProgram, Span::default(), 1, || 1);
        } else if self.phase == Phase::Running {
            diagnostics.report(DiagnosticKind::NoProgramEnd, span, line, || column);
        }
        if self.phase == Phase::Running {
            sink(&Command { kind: CommandKind::End, line, column, span });
            self.phase = Phase::Warned;
        }
    }

    /// Remembers what a line with an error looks like.
    #[cold]
    fn recognise(&mut self, line: &Line<'_>) {
        if let Some((name, _)) = looks_like(line.text).filter(|(name, _)| *name != self.state.dialect.name) {
            let place = Place::new(0, line.text.len().clamp(1, MAX_BLOCK_BYTES));
            self.looks_like = Some((name, LastBlock { line: line.number, offset: line.offset, place, column: 1 }));
        }
    }

    /// A program, or a number of a block, that was called.
    pub(crate) fn remember_call(&mut self, number: u32) {
        if !self.called.contains(&number) {
            self.called.push(number);
        }
    }

    /// Text behind the end: subprograms that were called have run, and anything else is warned of, once.
    fn after_end(&mut self, text: &[u8], closed: bool, subprogram: bool, output: &mut Output<'_, '_>) {
        let (length, start) = (text.len().min(MAX_BLOCK_BYTES), text.iter().position(|b| !b.is_ascii_whitespace()));
        let Some(start) = start else { return };
        let place = Place::new(start, length.max(start + 1));
        if !closed && text.get(start) == Some(&b'%') {
            self.phase = Phase::Ended { closed: true, subprogram: false };
            return;
        }
        let macros = self.state.dialect.syntax.macros;
        let begins = if closed || macros == Macros::None { None } else { program_number(text).or(line_number(text)) };
        if let Some(number) = begins.filter(|number| !subprogram || program_number(text) == Some(*number)) {
            if macros == Macros::Ngc || self.called.contains(&number) {
                self.phase = Phase::Ended { closed, subprogram: true };
                return;
            }
            if program_number(text).is_some() {
                output.report(DiagnosticKind::ProgramNotCalled { program: number }, place);
                self.phase = Phase::Warned;
                return;
            }
        }
        if subprogram || (macros == Macros::Ngc && o_word(text).is_some()) {
            self.phase = Phase::Ended { closed, subprogram: true };
            return;
        }
        let mut words =
            Lexer::new(text.get(..length).unwrap_or(text), 0, self.state.dialect.syntax, &self.state.variables);
        let wordless = |token| matches!(token, Ok(Token::Percent(_)));
        if !words.all(wordless) {
            output.report(DiagnosticKind::TextAfterEnd, place);
            self.phase = Phase::Warned;
        }
    }

    /// Before variables of a line are read, those of the position are set, if it has any.
    fn note_places(&mut self, text: &[u8]) {
        if memchr::memchr(b'#', text).is_some() {
            let (work, machine) = self.state.places();
            self.state.variables.set_places(work, machine);
        }
    }

    fn run(&mut self, text: &[u8], output: &mut Output<'_, '_>) -> Flow {
        let plain = begins_with_word(text);
        if !plain {
            self.note_places(text);
        }
        let deleted = self.options.block_delete && text.trim_ascii_start().starts_with(b"/");
        if !plain
            && !deleted
            && let Some(found) = statement(text, &self.state.variables)
        {
            self.any_words = true;
            let (Line { number: line, offset, text }, place) = (*output.line, Place::new(0, text.len()));
            self.last = LastBlock { line, offset, place, column: place.column(text) };
            return match found {
                Ok(statement) => Flow::Statement(statement),
                Err((kind, place)) => {
                    output.report(kind, place);
                    Flow::Next
                }
            };
        }
        let mut flow = Flow::Next;
        let mut given_up = false;
        let fault = &mut |(kind, place)| {
            // After the first zero byte the rest of the line is noise.
            if !given_up {
                output.report(kind, place);
            }
            given_up |= kind == DiagnosticKind::NotText;
        };
        let at = self.state.block.begin(text, &self.state.dialect, fault);
        if at < text.len() {
            self.note_places(text);
        }
        let state = &mut self.state;
        let skip_deleted = self.options.block_delete;
        let content = state.block.read_on(text, at, &state.dialect, &state.variables, skip_deleted, fault);
        output.place = self.state.block.place;
        output.damaged = self.state.block.damaged;
        match content {
            Content::Nothing | Content::Deleted => {}
            Content::Percent(_) if !self.opened && !self.any_words => self.opened = true,
            Content::Percent(place) => {
                output.place = place;
                end(&mut self.state, output);
                self.phase = Phase::Ended { closed: true, subprogram: false };
            }
            Content::Words => {
                self.any_words = true;
                let (Line { number: line, offset, text }, place) = (*output.line, self.state.block.place);
                self.last = LastBlock { line, offset, place, column: place.column(text) };
                flow = execute(&mut self.state, output);
                let ends = self.state.block.m(MGroup::Stop).is_some_and(|code| code.meaning == MCode::ProgramEnd);
                // On a SINUMERIK M02, M17 and M30 end the program they stand in (Programming Manual Fundamentals, "M
                // functions").
                if ends && self.depth > 0 && self.state.dialect.syntax.calls {
                    return Flow::Return;
                }
                // M99 of a main program starts it again, part after part: one part is what is wanted here.
                if ends || (self.depth == 0 && matches!(flow, Flow::Return)) {
                    end(&mut self.state, output);
                    self.phase = Phase::Ended { closed: false, subprogram: false };
                }
            }
        }
        if given_up {
            self.any_words = true;
            self.phase = Phase::GivenUp;
        }
        flow
    }
}
