//! What the words of a block act on: modes, position, and the block itself.

use super::cycle::Cycle;
use super::frame::Frame;
use super::modal::Modal;
use super::stroke::{ModalHole, StrokeIn, StrokeKind};
use crate::gcode::blocks::{Block, Variables};
use crate::gcode::command::SpindleCommand;
use crate::gcode::dialect::{CodeName, Dialect};

/// What a block with axis words does.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Movement {
    /// Nothing was said yet, or G80 ended what was.
    None,
    /// Something was said that could not be read; reported already.
    Unknown,
    Rapid,
    Feed,
    Stroke(StrokeKind),
    Cycle(Cycle),
}

/// State of the control between blocks, and the block in hand.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) dialect: Dialect,
    pub(crate) modal: Modal,
    pub(crate) movement: Movement,
    /// X, Y, Z after the last command.
    pub(crate) position_mm: [f64; 3],
    pub(crate) frame: Frame,
    /// What the spindle was last commanded.
    pub(crate) turning: SpindleCommand,
    pub(crate) block: Block,
    pub(crate) variables: Variables,
    /// A stroke in that waits for its stroke out.
    pub(crate) stroke_in: Option<StrokeIn>,
    /// The hole that every block with a position makes (MCALL).
    pub(crate) modal_hole: Option<ModalHole>,
    /// What changes nothing is reported once.
    pub(crate) reported: Reported,
}

/// Codes and words already reported: M codes by number, letters by theirs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reported {
    pub(crate) m: u128,
    pub(crate) letters: u32,
    /// Pitch of the hole before.
    pub(crate) pitch_mm: f64,
}

impl State {
    pub(crate) fn new(dialect: &Dialect, start_mm: [f64; 3]) -> Self {
        Self {
            dialect: *dialect,
            modal: Modal::at_start(dialect),
            movement: Movement::None,
            position_mm: start_mm,
            frame: Frame::new(start_mm),
            turning: SpindleCommand::Off,
            block: Block::new(dialect),
            variables: Variables::new(dialect.syntax.macros),
            stroke_in: None,
            modal_hole: None,
            reported: Reported::default(),
        }
    }

    /// Whether this is the first time the code is reported.
    pub(crate) fn first_of_code(&mut self, name: CodeName) -> bool {
        let bit = 1u128.checked_shl(u32::from(name.tenths / 10)).unwrap_or(0);
        let first = self.reported.m & bit == 0;
        self.reported.m |= bit;
        first
    }

    /// An end point on one axis, counted from 0 for X.
    pub(crate) fn target_mm(&self, axis: usize, from_mm: f64, word_mm: Option<f64>) -> f64 {
        match word_mm {
            None => from_mm,
            Some(distance_mm) if self.modal.incremental => from_mm + distance_mm,
            Some(position_mm) => self.frame.zero_mm(self.modal.work_offset, axis) + position_mm,
        }
    }
}
