//! Data of the canned cycle in force.

use crate::gcode::blocks::Code;
use crate::gcode::dialect::{CodeName, GCode};
use crate::gcode::text::Place;

/// A level as it was programmed: kept so, since R may be programmed anew without Z.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Level {
    /// G90.
    At(f64),
    /// G91: distance from the initial level (R), from the R plane (Z).
    From(f64),
}

impl Level {
    pub(crate) fn resolve_mm(self, reference_mm: f64) -> f64 {
        match self {
            Self::At(position_mm) => position_mm,
            Self::From(distance_mm) => reference_mm + distance_mm,
        }
    }
}

/// Data of the cycle in force, from its code to G80, G0 or G1.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cycle {
    pub(crate) meaning: GCode,
    pub(crate) name: CodeName,
    /// Z where the cycle began; holes do not change it.
    pub(crate) initial_mm: f64,
    pub(crate) r: Option<Level>,
    pub(crate) bottom: Option<Level>,
    pub(crate) bottom_place: Option<Place>,
    pub(crate) dwell_s: f64,
    pub(crate) peck_mm: Option<f64>,
    /// J as it was programmed.
    pub(crate) return_speed: Option<f64>,
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
            broken: false,
            before: None,
        }
    }

    /// Of its code.
    pub(crate) const fn meaning(&self) -> GCode {
        self.meaning
    }

    /// The same data under another code.
    pub(crate) const fn rename(&mut self, code: Code<GCode>) {
        (self.meaning, self.name) = (code.meaning, code.name);
    }
}
