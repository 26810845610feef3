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
//! 6. [`Text`] and flow: which line comes next, in loops and subprograms; [`Commands`]: one after the other
//! 7. [`canonical`]: commands as text
//! 8. [`program`]: commands → planned actions of one machine; why it cannot carry one out, in words; [`Concerns`]: what
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
mod commands;
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
mod text;
mod unsupported;
mod variables;

pub use canonical::canonical;
pub use command::{Command, CommandKind, SpindleCommand};
pub use commands::{Commands, Interpretation, interpret};
pub use concern::{Concern, Concerns};
pub use diagnostics::{Diagnostic, Diagnostics};
pub use dialect::{
    CodeName, CycleWords, DecimalPoint, Dialect, DwellUnit, G81, GCode, GGroup, MCode, MGroup, Macros, PECK_BACK_MM,
    ReturnSpeed, Syntax, WordMeaning,
};
pub use interpreter::{Interpreter, MAX_BLOCK_BYTES, Options};
pub use messages::{DiagnosticKind, FeedUse, Found, Severity, codes, explain};
pub use span::{Line, Span, lines};
pub use text::Text;

#[cfg(test)]
mod tests;
