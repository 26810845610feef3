//! G-code: text → typed commands with their place in the text.
//!
//! Text → blocks → actions, each folder importing only from those above it:
//!
//! 1. `text`: lines, places, numbers as written ([`Text`], [`Span`])
//! 2. `dialect`: what a control's codes mean, as data ([`Dialect`])
//! 3. `command`, `canonical`: what a program does ([`Command`]), and its text
//! 4. `planning_error`, `warning`, `messages`, `diagnostics`: what is wrong, where, and what to do ([`Diagnostics`])
//! 5. `blocks`: text → the words of one line by letter and modal group; variables, expressions, statements
//! 6. `state`: what stays in force from block to block, data alone
//! 7. `actions`: blocks → commands, functions over the state
//! 8. `flow`: which line comes next, in loops and subprograms ([`Interpreter`], [`Commands`])
//! 9. [`program`]: commands → planned actions of one machine
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

mod actions;
mod blocks;
mod canonical;
mod command;
mod diagnostics;
mod dialect;
mod flow;
mod messages;
mod planning_error;
pub mod program;
mod state;
mod text;
mod warning;

pub use canonical::canonical;
pub use command::{Command, CommandKind, SpindleCommand};
pub use diagnostics::{Diagnostic, Diagnostics};
pub use dialect::{AUTO, Recognised, looks_like, recognise};
pub use dialect::{
    CodeAlone, CodeName, CycleRules, CycleWords, DecimalPoint, Dialect, DwellUnit, G81, GCode, GGroup, IdleWords,
    MCode, MGroup, Macros, PECK_BACK_MM, RULES, ReturnSpeed, Rule, Source, Syntax, WordMeaning, ZeroRepeats,
};
pub use flow::{Commands, Interpretation, Interpreter, Options, interpret};
pub use messages::{DiagnosticKind, FeedUse, Found, Severity, codes, explain};
pub use text::{Line, MAX_BLOCK_BYTES, Span, Subprograms, Text, lines};
pub use warning::{Warning, Warnings};

#[cfg(test)]
mod tests;
