//! What the words of a block act on: modes, position, and the block itself.

use crate::control::units::mm_per_s_from_mm_per_min;

use super::block::{Block, Value};
use super::dialect::{DecimalPoint, Dialect};
use super::messages::{DiagnosticKind, FeedUse};
use super::modal::{FeedMode, Modal};
use super::output::Output;
use super::span::Place;

/// State of the control between blocks, and the block in hand.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) dialect: Dialect,
    pub(crate) modal: Modal,
    /// X, Y, Z after the last command.
    pub(crate) position_mm: [f64; 3],
    pub(crate) block: Block,
}

impl State {
    /// Takes a length word, in mm.
    pub(crate) fn take_length_mm(&mut self, letter: u8, output: &mut Output<'_, '_>) -> Option<f64> {
        let Value { number, place } = self.block.take(letter)?;
        if self.dialect.decimal_point == DecimalPoint::Fanuc && !number.has_point && number.value != 0.0 {
            let mm = number.value * self.modal.unit.increment_mm();
            output.report(DiagnosticKind::CountedInIncrements { letter, mm }, place);
            return Some(mm);
        }
        Some(number.value * self.modal.unit.mm())
    }

    /// Speed of a move at feed; none after a mistake.
    pub(crate) fn feed_mm_per_s(&self, anchor: Place, output: &mut Output<'_, '_>) -> Option<f64> {
        let missing = DiagnosticKind::FeedMissing { needed_for: FeedUse::Move };
        let feed_mm = output.require(self.modal.feed_mm, missing, anchor)?;
        let feed_mm_per_min = match self.modal.feed_mode {
            FeedMode::PerMinute => feed_mm,
            FeedMode::PerRevolution => {
                let turning_rpm = self.modal.hand.and(self.modal.turning_rpm());
                feed_mm * output.require(turning_rpm, DiagnosticKind::SpindleNotTurning, anchor)?
            }
        };
        Some(mm_per_s_from_mm_per_min(feed_mm_per_min))
    }
}
