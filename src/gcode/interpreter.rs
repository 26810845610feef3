//! Blocks → commands: the order in which the words of a block act, and the modal state between blocks.

use crate::control::cycle::Hand;

use super::block::{Block, Content, Value};
use super::command::{Command, CommandKind, SpindleCommand};
use super::cycle::Cycle;
use super::diagnostics::Diagnostics;
use super::dialect::{DecimalPoint, Dialect, GCode, GGroup, MCode, MGroup};
use super::lexer::{Lexer, Token};
use super::messages::DiagnosticKind;
use super::modal::{FeedMode, LengthUnit, Modal, ReturnTo};
use super::output::Output;
use super::span::{Line, Place, Span};
use super::state::State;

/// Longest block in bytes. No control takes a hundredth of it; what is longer is no program.
pub const MAX_BLOCK_BYTES: usize = 64 * 1024;

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
    /// After M30, M02 or the closing `%`. Then the first text is warned, and no more.
    Ended {
        warned: bool,
    },
    /// It is no text: what follows is not looked at.
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
    movement: Movement,
    phase: Phase,
    /// A `%` opened the program.
    opened: bool,
    /// There were words, readable or not.
    any_words: bool,
    last: LastBlock,
}

/// What a block with axis words does.
#[derive(Clone, Copy, Debug)]
enum Movement {
    /// Nothing was said yet, or G80 ended what was.
    None,
    /// Something was said that could not be read; reported already.
    Unknown,
    Rapid,
    Feed,
    Cycle(Cycle),
}

impl Interpreter {
    /// At power on: millimetres, G90, G94, G98, spindle at rest, no motion code.
    #[must_use]
    pub fn new(dialect: &Dialect, options: Options) -> Self {
        Self {
            options,
            state: State { dialect: *dialect, modal: Modal::START, position_mm: options.start_mm, block: Block::new() },
            movement: Movement::None,
            phase: Phase::Running,
            opened: false,
            any_words: false,
            last: LastBlock { line: 1, offset: 0, place: Place::default(), column: 1 },
        }
    }

    /// Interprets the next line. Commands go to `sink` as they arise; once there is an error the program must not run,
    /// and commands go on only so that all errors show.
    pub fn block(&mut self, line: Line<'_>, sink: &mut dyn FnMut(Command), diagnostics: &mut Diagnostics) {
        let mut output = Output { line, place: Place::default(), damaged: false, sink, diagnostics };
        match self.phase {
            Phase::Running if line.text.len() > MAX_BLOCK_BYTES => {
                self.any_words = true;
                let kind = DiagnosticKind::BlockTooLong { bytes: line.text.len(), limit: MAX_BLOCK_BYTES };
                output.report(kind, Place::new(0, 1));
            }
            Phase::Running => self.run(line.text, &mut output),
            Phase::Ended { warned: false } => self.after_end(line.text, &mut output),
            Phase::Ended { warned: true } | Phase::GivenUp => {}
        }
    }

    /// Ends the program: the end command, if none was there, and what only the end shows.
    pub fn finish(&mut self, sink: &mut dyn FnMut(Command), diagnostics: &mut Diagnostics) {
        let LastBlock { line, offset, place, column } = self.last;
        let span = place.span(offset);
        if !self.any_words {
            diagnostics.report(DiagnosticKind::EmptyProgram, Span::default(), 1, || 1);
        } else if self.phase == Phase::Running {
            diagnostics.report(DiagnosticKind::NoProgramEnd, span, line, || column);
        }
        if self.phase == Phase::Running {
            sink(Command { kind: CommandKind::End, line, span });
            self.phase = Phase::Ended { warned: true };
        }
    }

    /// Text behind the end is not part of the program.
    fn after_end(&mut self, text: &[u8], output: &mut Output<'_, '_>) {
        let (length, start) = (text.len().min(MAX_BLOCK_BYTES), text.iter().position(|b| !b.is_ascii_whitespace()));
        let mut words = Lexer::new(text.get(..length).unwrap_or(text));
        let wordless = |token| matches!(token, Ok(Token::Percent(_)));
        if let Some(start) = start
            && !words.all(wordless)
        {
            output.report(DiagnosticKind::TextAfterEnd, Place::new(start, length.max(start + 1)));
            self.phase = Phase::Ended { warned: true };
        }
    }

    fn run(&mut self, text: &[u8], output: &mut Output<'_, '_>) {
        let mut given_up = false;
        let content =
            self.state.block.read(text, &self.state.dialect, self.options.block_delete, &mut |(kind, place)| {
                // After the first zero byte the rest of the line is noise.
                if !given_up {
                    output.report(kind, place);
                }
                given_up |= kind == DiagnosticKind::NotText;
            });
        output.place = self.state.block.place;
        output.damaged = self.state.block.damaged;
        match content {
            Content::Nothing | Content::Deleted => {}
            Content::Percent(_) if !self.opened && !self.any_words => self.opened = true,
            Content::Percent(place) => {
                output.place = place;
                output.emit(CommandKind::End);
                self.phase = Phase::Ended { warned: false };
            }
            Content::Words => {
                self.any_words = true;
                let (Line { number: line, offset, text }, place) = (output.line, self.state.block.place);
                self.last = LastBlock { line, offset, place, column: place.column(text) };
                self.execute(output);
            }
        }
        if given_up {
            self.any_words = true;
            self.phase = Phase::GivenUp;
        }
    }

    /// The words of a block act in this order, whatever theirs is:
    ///
    /// 1. units, feed mode, G90/G91, G98/G99, work offset
    /// 2. F, S
    /// 3. M03, M04, M05
    /// 4. the motion or the canned cycle
    /// 5. M02, M30
    ///
    /// What no step acted on is an error.
    fn execute(&mut self, output: &mut Output<'_, '_>) {
        self.set_modes(output);
        self.set_feed(output);
        self.set_spindle(output);
        self.move_axes(output);
        while let Some((letter, place)) = self.state.block.take_leftover() {
            // In a damaged block the code that would have acted on it may be the one not understood.
            output.report_if_whole(DiagnosticKind::UnusedWord { letter }, place);
        }
        if self.state.block.m(MGroup::Stop).is_some() {
            output.emit(CommandKind::End);
            self.phase = Phase::Ended { warned: false };
        }
    }

    fn set_modes(&mut self, output: &mut Output<'_, '_>) {
        for group in [GGroup::Units, GGroup::FeedMode, GGroup::Distance, GGroup::Return, GGroup::WorkOffset] {
            let Some(code) = self.state.block.g(group) else { continue };
            match code.meaning {
                GCode::Inch => self.state.modal.unit = LengthUnit::Inch,
                GCode::Millimetre => self.state.modal.unit = LengthUnit::Millimetre,
                GCode::FeedPerMinute => self.set_feed_mode(FeedMode::PerMinute),
                GCode::FeedPerRevolution => self.set_feed_mode(FeedMode::PerRevolution),
                GCode::Absolute => self.state.modal.incremental = false,
                GCode::Incremental => self.state.modal.incremental = true,
                GCode::ReturnInitial => self.state.modal.return_to = ReturnTo::Initial,
                GCode::ReturnR => self.state.modal.return_to = ReturnTo::R,
                GCode::WorkOffset(number) => {
                    if self.state.modal.work_offset.is_some_and(|before| before != number) {
                        output.report(DiagnosticKind::SameWorkOffset { number }, code.place);
                    }
                    self.state.modal.work_offset = Some(number);
                }
                // G17, G40, G49 say what always holds here; the rest moves, later.
                _ => {}
            }
        }
    }

    /// A speed is no pitch: F must be said anew when its meaning changes.
    fn set_feed_mode(&mut self, mode: FeedMode) {
        if self.state.modal.feed_mode != mode {
            self.state.modal.feed_mode = mode;
            self.state.modal.feed_mm = None;
        }
    }

    fn set_feed(&mut self, output: &mut Output<'_, '_>) {
        let Some(Value { number, place }) = self.state.block.take(b'F') else { return };
        // Only mm/min has the same increment, 1, with and without a point.
        let ambiguous = self.state.dialect.decimal_point == DecimalPoint::Fanuc
            && !number.has_point
            && (self.state.modal.feed_mode, self.state.modal.unit) != (FeedMode::PerMinute, LengthUnit::Millimetre);
        if ambiguous {
            output.report(DiagnosticKind::FeedNeedsPoint, place);
        } else if number.value <= 0.0 {
            output.report(DiagnosticKind::FeedNotPositive { feed: number.value }, place);
        }
        // Also a wrong F is taken: it was given, and reported.
        self.state.modal.feed_mm = Some(number.value * self.state.modal.unit.mm());
    }

    fn set_spindle(&mut self, output: &mut Output<'_, '_>) {
        let speed = self.state.block.take(b'S');
        if let Some(Value { number, place }) = speed {
            if number.value < 0.0 {
                output.report(DiagnosticKind::SpeedNegative { rpm: number.value }, place);
            }
            self.state.modal.speed_rpm = Some(number.value.abs());
        }
        let code = self.state.block.m(MGroup::Spindle);
        match code.map(|code| code.meaning) {
            Some(MCode::SpindleRight) => self.state.modal.hand = Some(Hand::Right),
            Some(MCode::SpindleLeft) => self.state.modal.hand = Some(Hand::Left),
            Some(MCode::SpindleStop) => self.state.modal.hand = None,
            Some(MCode::ProgramEnd) | None => {}
        }
        let spindle = match (self.state.modal.hand, self.state.modal.turning_rpm()) {
            (Some(hand), Some(speed_rpm)) => SpindleCommand::On { hand, speed_rpm },
            _ => SpindleCommand::Off,
        };
        if code.is_some() || (speed.is_some() && self.state.modal.hand.is_some()) {
            output.emit(CommandKind::Spindle(spindle));
        }
        if let (Some(code), Some(_), SpindleCommand::Off) = (code, self.state.modal.hand, spindle) {
            output.report_if_whole(DiagnosticKind::SpindleWithoutSpeed { name: code.name }, code.place);
        }
    }

    fn move_axes(&mut self, output: &mut Output<'_, '_>) {
        let motion = self.state.block.g(GGroup::Motion).map(|code| code.meaning);
        let cycle = self.state.block.g(GGroup::Cycle).map(|code| code.meaning);
        self.movement = match (motion, cycle, self.movement) {
            (Some(GCode::Rapid), ..) => Movement::Rapid,
            (Some(_), ..) => Movement::Feed,
            (None, Some(GCode::CancelCycle), _) => Movement::None,
            // Within the cycle G81 keeps what is stored, and the initial level.
            (None, Some(_), Movement::Cycle(cycle)) => Movement::Cycle(cycle),
            (None, Some(_), _) => Movement::Cycle(Cycle::new(self.state.position_mm[2])),
            (None, None, before) => before,
        };
        if let Movement::Cycle(cycle) = self.movement {
            self.movement = Movement::Cycle(self.state.cycle_block(cycle, output));
            return;
        }
        let words = [b'X', b'Y', b'Z']
            .map(|letter| (self.state.block.place_of(letter), self.state.take_length_mm(letter, output)));
        let Some(anchor) = words.iter().find_map(|(place, _)| *place) else { return };
        let [from_x, from_y, from_z] = self.state.position_mm;
        let [(_, x), (_, y), (_, z)] = words;
        let target = |from_mm, word_mm| self.state.modal.target_mm(from_mm, word_mm);
        let to_mm = [target(from_x, x), target(from_y, y), target(from_z, z)];
        match self.movement {
            Movement::Rapid => output.emit(CommandKind::Rapid { to_mm }),
            Movement::Feed => {
                if let Some(feed_mm_per_s) = self.state.feed_mm_per_s(anchor, output) {
                    output.emit(CommandKind::Feed { to_mm, feed_mm_per_s });
                }
            }
            Movement::None => {
                output.report_if_whole(DiagnosticKind::NoMotionMode, anchor);
                // Said once; the next code that moves ends it.
                self.movement = Movement::Unknown;
            }
            Movement::Unknown | Movement::Cycle(_) => {}
        }
        self.state.position_mm = to_mm;
    }
}
