//! Data of the canned cycle in force.

use super::modal::LengthUnit;
use crate::control::cycle::Hand;
use crate::gcode::blocks::Code;
use crate::gcode::dialect::{CodeName, GCode};
use crate::gcode::text::Place;

/// A level as it was programmed, in the coordinate system that is in force when a hole is made with it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Level {
    pub(crate) value_mm: f64,
    /// G91 was in force: a distance from the initial level (R), from the R plane (Z).
    pub(crate) incremental: bool,
    /// Unit that was in force.
    pub(crate) unit: LengthUnit,
}

impl Level {
    /// Its position, where the coordinate system's zero and the level that distances count from are known.
    pub(crate) fn resolve_mm(self, incremental: bool, zero_mm: f64, reference_mm: f64) -> f64 {
        self.value_mm + if incremental { reference_mm } else { zero_mm }
    }
}

/// Data of the cycle in force, from its code to G80, G0 or G1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cycle {
    pub(crate) meaning: GCode,
    pub(crate) name: CodeName,
    /// Z where the cycle began; holes do not change it. Counted from the zero in force where the control does so.
    pub(crate) initial_mm: f64,
    pub(crate) r: Option<Level>,
    pub(crate) bottom: Option<Level>,
    pub(crate) bottom_place: Option<Place>,
    pub(crate) dwell_s: f64,
    pub(crate) peck_mm: Option<f64>,
    /// J as it was programmed.
    pub(crate) return_speed: Option<f64>,
    /// Pitch by a word of its own (I, J, E).
    pub(crate) pitch_mm: Option<f64>,
    /// `,R1`: synchronous.
    pub(crate) synchronous: bool,
    /// The block in hand makes holes.
    pub(crate) makes_holes: bool,
    /// The spindle's hand that was told to be replaced.
    pub(crate) hand_told: Option<Hand>,
    /// A mistake was reported; what follows from it is not, until the code is said again.
    pub(crate) broken: bool,
    /// F, S and pitch of the hole before.
    pub(crate) before: Option<(f64, f64, f64)>,
}

impl Cycle {
    pub(crate) const fn new(initial_mm: f64, code: Code<GCode>) -> Self {
        Self {
            meaning: code.meaning,
            name: code.name,
            initial_mm,
            r: None,
            bottom: None,
            bottom_place: None,
            dwell_s: 0.0,
            peck_mm: None,
            return_speed: None,
            pitch_mm: None,
            synchronous: false,
            makes_holes: false,
            hand_told: None,
            broken: false,
            before: None,
        }
    }

    /// Of its code.
    pub(crate) const fn meaning(&self) -> GCode {
        self.meaning
    }

    /// Another code within the cycle: it keeps the initial level, and what is stored if the control keeps it.
    pub(crate) fn change(&mut self, code: Code<GCode>, keeps: bool) {
        if keeps || self.name == code.name {
            (self.meaning, self.name) = (code.meaning, code.name);
        } else {
            *self = Self::new(self.initial_mm, code);
        }
    }
}
