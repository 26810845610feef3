//! What the words of a block act on: modes, position, and the block itself.

use super::cycle::Cycle;
use super::frame::{Frame, Rotation};
use super::modal::Modal;
use super::stroke::{ModalHole, StrokeIn, StrokeKind};
use crate::control::units::rev_from_deg;
use crate::gcode::blocks::{Block, Variables};
use crate::gcode::command::SpindleCommand;
use crate::gcode::dialect::{CodeName, Dialect};

/// Motion of group 01 that is in force: what a block with axis words does outside a canned cycle.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Motion {
    /// Nothing was said yet, or G80 ended what was.
    None,
    /// Something was said that could not be read; reported already.
    Unknown,
    Rapid,
    Feed,
    Stroke(StrokeKind),
}

/// State of the control between blocks, and the block in hand.
#[derive(Clone, Debug)]
pub(crate) struct State {
    pub(crate) dialect: Dialect,
    pub(crate) modal: Modal,
    pub(crate) motion: Motion,
    /// X and Y that K0 may have moved or not, by the control.
    pub(crate) unsure_xy: [bool; 2],
    /// P of the last cycle that had one.
    pub(crate) kept_dwell_s: f64,
    /// The canned cycle in force; boxed, since every block takes it out and puts it back.
    pub(crate) cycle: Option<Box<Cycle>>,
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
#[derive(Clone, Debug, Default)]
pub(crate) struct Reported {
    pub(crate) m: u128,
    /// G codes by ten times their numbers.
    pub(crate) g: Vec<u16>,
    /// That the tables of this dialect are from memory.
    pub(crate) from_memory: bool,
    pub(crate) letters: u32,
    /// Names by their place in the table.
    pub(crate) names: u64,
    /// Pitch of the hole before.
    pub(crate) pitch_mm: f64,
}

impl Reported {
    /// Whether this is the first time the G code is reported.
    pub(crate) fn first_g(&mut self, name: CodeName) -> bool {
        let first = !self.g.contains(&name.tenths);
        if first {
            self.g.push(name.tenths);
        }
        first
    }
}

impl State {
    pub(crate) fn new(dialect: &Dialect, start_mm: [f64; 3]) -> Self {
        Self {
            dialect: *dialect,
            modal: Modal::at_start(dialect),
            motion: Motion::None,
            unsure_xy: [false; 2],
            kept_dwell_s: 0.0,
            cycle: None,
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

    /// A hole's start angle in rev: its own in degrees, or that of all holes.
    pub(crate) fn start_angle_rev(&self, own_deg: Option<f64>) -> Option<f64> {
        own_deg.or(self.dialect.start_angle_deg).map(rev_from_deg)
    }

    /// Whether this is the first time the code is reported.
    pub(crate) fn first_of_code(&mut self, name: CodeName) -> bool {
        let bit = 1u128.checked_shl(u32::from(name.tenths / 10)).unwrap_or(0);
        let first = self.reported.m & bit == 0;
        self.reported.m |= bit;
        first
    }

    /// An end point on one axis, counted from 0 for X.
    #[inline]
    pub(crate) fn target_mm(&self, axis: usize, from_mm: f64, word_mm: Option<f64>) -> f64 {
        match word_mm {
            None => from_mm,
            Some(distance_mm) if self.is_distance(axis) => from_mm + distance_mm,
            Some(position_mm) => self.zero_mm(axis) + position_mm,
        }
    }

    /// An end point of X and Y, through G68.
    #[inline]
    pub(crate) fn target_xy_mm(&self, from_mm: [f64; 2], words_mm: [Option<f64>; 2]) -> [f64; 2] {
        let rotation = self.frame.rotation;
        if rotation.is_none() {
            return [self.target_mm(0, from_mm[0], words_mm[0]), self.target_mm(1, from_mm[1], words_mm[1])];
        }
        let [x_mm, y_mm] = Rotation::turned_back(from_mm, rotation);
        let to_mm = [self.target_mm(0, x_mm, words_mm[0]), self.target_mm(1, y_mm, words_mm[1])];
        // Without a word nothing moves, not even by rounding.
        if words_mm == [None; 2] { from_mm } else { Rotation::turned(to_mm, rotation) }
    }

    /// Whether X and Y of a block are no plain coordinates: G16 or G68 is in force.
    pub(crate) const fn plane_is_changed(&self) -> bool {
        self.modal.polar.is_some() || self.frame.rotation.is_some()
    }

    /// Where the tool stands, in the unit in force: in the work coordinates, and from the machine's zero.
    pub(crate) fn places(&self) -> ([f64; 3], [f64; 3]) {
        let mm = self.modal.unit.mm();
        let from = |zero_mm: f64, axis: usize| (self.position_mm.get(axis).copied().unwrap_or_default() - zero_mm) / mm;
        let axes = [0, 1, 2];
        (axes.map(|axis| from(self.zero_mm(axis), axis)), axes.map(|axis| from(self.frame.machine_mm(axis), axis)))
    }

    /// Whether the block's word of an axis is a distance: by its own IC( ) or AC( ), else by G90 and G91.
    #[inline]
    pub(crate) fn is_distance(&self, axis: usize) -> bool {
        self.block.is_distance.get(axis).copied().flatten().unwrap_or(self.modal.incremental)
    }

    /// Where the zero of the coordinate system in force lies on an axis.
    #[inline]
    pub(crate) fn zero_mm(&self, axis: usize) -> f64 {
        let shift_mm = self.frame.shift_mm.get(axis).copied().unwrap_or_default();
        self.frame.zero_mm(self.modal.work_offset, axis) + shift_mm
    }
}
