//! Data of synchronous strokes that are no canned cycle.

use super::modal::LengthUnit;
use crate::control::cycle::{Hand, TapCycle};
use crate::gcode::dialect::CodeName;

/// Which strokes a block makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StrokeKind {
    /// In and out again.
    Pair,
    In,
    Out,
}

impl StrokeKind {
    pub(crate) const fn name(self) -> CodeName {
        let tenths = match self {
            Self::Pair => 331,
            Self::In => 3310,
            Self::Out => 3320,
        };
        CodeName { letter: b'G', tenths }
    }
}

/// G331, before its G332.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrokeIn {
    pub(crate) start_mm: f64,
    pub(crate) bottom_mm: f64,
    pub(crate) pitch_mm: f64,
    pub(crate) hand: Hand,
    pub(crate) speed_rpm: f64,
    pub(crate) start_angle_rev: Option<f64>,
}

/// A hole that MCALL repeats at every position. Its levels count from the zero that is in force there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ModalHole {
    pub(crate) hole: TapCycle,
    /// SST was left out: S at the hole is the speed.
    pub(crate) speed_by_s: bool,
    /// The spindle after the hole (SDAC).
    pub(crate) hand_after: Option<Hand>,
    /// Unit that was in force.
    pub(crate) unit: LengthUnit,
}
