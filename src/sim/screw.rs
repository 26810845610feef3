//! The ball screw as it was ground, and as it warms.

use super::actual::Actual;
use super::gap::Gap;
use super::wave::sin_turns;
use crate::control::units::{m_from_mm, mm_from_um};

/// Pitch error and growth of the screw: by how much the table's place of rest is off the motor's.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screw {
    amplitude_m: f64,
    lead_mm: f64,
    phase_turns: f64,
    growth_m_per_s: f64,
    grown_m: f64,
}

impl Screw {
    pub(crate) fn of(actual: &Actual) -> Self {
        Self {
            amplitude_m: m_from_mm(mm_from_um(actual.screw_error_um)),
            lead_mm: actual.screw_lead_mm,
            phase_turns: 0.0,
            growth_m_per_s: m_from_mm(mm_from_um(actual.thermal_um_per_s)),
            grown_m: 0.0,
        }
    }

    pub(crate) fn set_phase(&mut self, turns: f64) {
        self.phase_turns = turns;
    }

    #[inline]
    pub(crate) fn is_imperfect(&self) -> bool {
        self.amplitude_m != 0.0 || self.growth_m_per_s != 0.0
    }

    /// The error where the motor stands, with its slope, for the steps of one drive tick.
    pub(crate) fn tick(&self, motor_mm: f64, gap: &mut Gap) {
        if !self.is_imperfect() {
            return;
        }
        let turns = motor_mm / self.lead_mm + self.phase_turns;
        let error = self.amplitude_m * sin_turns(turns) + self.grown_m;
        let slope = self.amplitude_m * core::f64::consts::TAU / m_from_mm(self.lead_mm) * sin_turns(turns + 0.25);
        gap.set_error(error, slope, self.growth_m_per_s);
    }

    /// One plant step later.
    #[inline]
    pub(crate) fn step(&mut self, motor_travel_m: f64, step_s: f64, gap: &mut Gap) {
        self.grown_m += self.growth_m_per_s * step_s;
        gap.carry_error(motor_travel_m, step_s);
    }
}
