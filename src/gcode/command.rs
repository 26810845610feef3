//! What a program does, one typed command after the other, in absolute coordinates and base units.

use crate::control::cycle::{Hand, TapCycle};
use crate::gcode::text::Span;

/// A command with its place in the program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    /// What is done.
    pub kind: CommandKind,
    /// Line of its block, counted from 1.
    pub line: u32,
    /// Column of its block, counted from 1 in characters.
    pub column: u32,
    /// Bytes of its block.
    pub span: Span,
}

/// What is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CommandKind {
    /// Straight move as fast as the axes can.
    Rapid {
        /// End point X, Y, Z.
        to_mm: [f64; 3],
    },
    /// Straight move at feed.
    Feed {
        /// End point X, Y, Z.
        to_mm: [f64; 3],
        /// Speed along the path, above zero.
        feed_mm_per_s: f64,
    },
    /// All axes stand.
    Dwell {
        /// How long.
        dwell_s: f64,
    },
    /// Spindle on, off, or another speed.
    Spindle(SpindleCommand),
    /// A tapped hole, with approach and return. It leaves the spindle at rest; M03 and S stay in force for the next
    /// hole, free rotation begins again with the next [`SpindleCommand::On`].
    Tap(TapCycle),
    /// The program's end; the last command, and the only one of its kind.
    End,
}

/// What the spindle does from now on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpindleCommand {
    /// To rest.
    Off,
    /// Turns freely.
    On {
        /// Direction.
        hand: Hand,
        /// Speed, above zero.
        speed_rpm: f64,
    },
}
