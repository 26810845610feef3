//! What the words of a block act on: modes, position, and the block itself.

use crate::control::thread::StandardPitch;
use crate::control::units::mm_per_s_from_mm_per_min;

use super::block::{Block, Value};
use super::command::SpindleCommand;
use super::cycle::Cycle;
use super::dialect::{CodeName, DecimalPoint, Dialect};
use super::frame::Frame;
use super::messages::{DiagnosticKind, FeedUse};
use super::modal::{FeedMode, Modal};
use super::output::Output;
use super::span::Place;
use super::strokes::{ModalHole, StrokeIn, StrokeKind};
use super::variables::Variables;

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
    /// What changes nothing is told once.
    told: Told,
}

/// Codes and words already told of: M codes by number, letters by theirs.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    m: u128,
    letters: u32,
    /// Pitch of the hole before.
    pitch_mm: f64,
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
            told: Told::default(),
        }
    }

    /// Whether this is the first time the code is told of.
    pub(crate) fn first_of_code(&mut self, name: CodeName) -> bool {
        let bit = 1u128.checked_shl(u32::from(name.tenths / 10)).unwrap_or(0);
        let first = self.told.m & bit == 0;
        self.told.m |= bit;
        first
    }

    /// Takes a word that changes nothing, and says so the first time.
    pub(crate) fn take_idle(&mut self, letter: u8, output: &mut Output<'_, '_>) {
        let Some(Value { place, .. }) = self.block.take(letter) else { return };
        let bit = 1u32.wrapping_shl(u32::from(letter.wrapping_sub(b'A')));
        if self.told.letters & bit == 0 {
            output.report(DiagnosticKind::IdleWord { letter }, place);
        }
        self.told.letters |= bit;
    }

    /// A pitch that nearly is a standard one is told of where it begins.
    pub(crate) fn check_pitch(&mut self, pitch_mm: f64, place: Place, output: &mut Output<'_, '_>) {
        if self.told.pitch_mm != pitch_mm
            && let Some(meant) = StandardPitch::near_miss(pitch_mm)
        {
            output.report(DiagnosticKind::PitchNearStandard { pitch_mm, meant }, place);
        }
        self.told.pitch_mm = pitch_mm;
    }

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

    /// An end point on one axis, counted from 0 for X.
    pub(crate) fn target_mm(&self, axis: usize, from_mm: f64, word_mm: Option<f64>) -> f64 {
        match word_mm {
            None => from_mm,
            Some(distance_mm) if self.modal.incremental => from_mm + distance_mm,
            Some(position_mm) => self.frame.zero_mm(self.modal.work_offset, axis) + position_mm,
        }
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
