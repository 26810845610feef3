//! G-code: text → typed commands with their place in the text.
//!
//! In order, each module knowing only those above it:
//!
//! 1. [`Span`], numbers; the messages and [`Diagnostics`]: what is wrong, where, and what to do
//! 2. lexer: bytes → words
//! 3. [`Dialect`]: what a control's codes mean, as data; variables and expressions
//! 4. block: the words of one line by letter and modal group
//! 5. modal state, work offsets, canned cycle, strokes, [`Interpreter`]: blocks → [`Command`]s, in the order the words of
//!    a block act
//! 6. flow: which line comes next, in loops and subprograms
//! 7. [`canonical`]: commands as text
//! 8. [`program`]: commands → planned actions of one machine; why it cannot carry one out, in words; [`concerns`]: what
//!    it can and should not
//!
//! Every word is acted on or diagnosed, and reading goes on after an error, so that all show at once.
//!
//! What holds in the `paper` dialect, and in the others unless their table says otherwise, beside the plain meaning of
//! the codes:
//!
//! - G81 taps (or drills, see [`Dialect::g81`]). Pitch = F/S under G94, F under G95. M03 is a right-hand thread, M04 a
//!   left-hand one. Out goes as fast as in.
//! - Under G91 R counts from the initial level and Z from the R plane. The initial level is Z where the cycle began.
//! - Return is to R under G99, under G98 to the initial level or R if that is higher.
//! - K or L repeat; under G91 each repeat steps on by X and Y. K0 stores the cycle's data and taps nothing (Fanuc).
//! - A later block with X, Y or Z makes another hole with the stored R, Z, P and the modal F, S. R, P, F or S alone
//!   only store. G80, G0, G1 end the cycle; after G80 a move says G0 or G1 anew.
//! - P is a dwell at the bottom in whole milliseconds (Fanuc).
//! - Every work offset has one zero until G10 writes it, there is no tool length: X, Y, Z are the tap's tip. The machine
//!   starts at [`Options::start_mm`], which is its own zero and reference point.
//! - `/` at the start of a block: see [`Options::block_delete`]. Comments are `( )`, `;` and `//`.
//! - A number follows its letter, blanks between them allowed, and has no blanks inside.

mod block;
mod canonical;
mod command;
mod concern;
mod cycle;
mod diagnostics;
mod dialect;
mod execute;
mod expression;
mod flow;
mod frame;
mod interpreter;
mod lexer;
mod messages;
mod modal;
mod number;
mod output;
pub mod program;
mod refusal;
mod span;
mod state;
mod strokes;
mod unsupported;
mod variables;

pub use canonical::canonical;
pub use command::{Command, CommandKind, SpindleCommand};
pub use concern::{Concern, concerns};
pub use diagnostics::{Diagnostic, Diagnostics};
pub use dialect::{
    CodeName, CycleWords, DecimalPoint, Dialect, DwellUnit, G81, GCode, GGroup, MCode, MGroup, Macros, PECK_BACK_MM,
    ReturnSpeed, Syntax, WordMeaning,
};
pub use interpreter::{Interpreter, MAX_BLOCK_BYTES, Options};
pub use messages::{DiagnosticKind, FeedUse, Found, Severity, codes, explain};
pub use span::{Line, Span, lines};

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
    let mut interpreter = Interpreter::new(dialect, options);
    let mut program = Interpretation::default();
    let mut beyond = None;
    let commands = &mut program.commands;
    let mut sink = |command: Command| match commands.len() {
        MAX_COMMANDS.. => beyond = beyond.or(Some(command)),
        _ => commands.push(command),
    };
    flow::run(source, &mut interpreter, &mut sink, &mut program.diagnostics);
    interpreter.finish(&mut sink, &mut program.diagnostics);
    if let Some(Command { span, line, .. }) = beyond {
        let kind = DiagnosticKind::TooManyCommands { limit: MAX_COMMANDS };
        program.diagnostics.report(kind, span, line, || 1);
    }
    program
}

/// Most commands of a program in memory: repeats and loops turn few bytes into many.
pub const MAX_COMMANDS: usize = 2_000_000;

#[cfg(test)]
mod tests;
