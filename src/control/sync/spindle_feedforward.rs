//! Torque that the spindle needs beyond its file's inertia: friction, the expected cutting, the inertia found.

use crate::control::cycle::TapCycle;
use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::model::cutting::{engagement, tapping_torque_nm};
use crate::control::motor::Motor;
use crate::control::units::rpm_from_rev_per_s;

/// Speed at which friction and cutting have turned to their full value: passed within a millisecond of a reversal.
const TURNING_REV_PER_S: f64 = 0.5;

/// What is known of the spindle's load along one hole, positive into it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SpindleFeedforward {
    motor: Motor,
    coulomb_nm: f64,
    viscous_nm_per_rpm: f64,
    inertia_ratio: f64,
    surface_mm: f64,
    chamfer_mm: f64,
    in_nm: f64,
    out_nm: f64,
}

impl SpindleFeedforward {
    pub(super) fn new(machine: &Machine, cycle: &TapCycle) -> Self {
        let (spindle, tap) = (&machine.spec().spindle, &machine.spec().tap);
        let full_nm = machine
            .tap_size(cycle.pitch_mm)
            .map_or(0.0, |(major_mm, hole_mm)| tapping_torque_nm(major_mm, hole_mm, tap.kc_n_per_mm2, tap.tool_factor));
        Self {
            motor: machine.motor.clone(),
            coulomb_nm: spindle.coulomb_nm,
            viscous_nm_per_rpm: spindle.viscous_nm_per_rpm,
            inertia_ratio: 1.0,
            surface_mm: tap.surface_below_r_mm,
            chamfer_mm: tap.ramp_pitches * cycle.pitch_mm,
            in_nm: full_nm,
            out_nm: full_nm * tap.out_torque_ratio,
        }
    }

    /// A hole begins, with what is known of the inertia.
    pub(super) fn begin(&mut self, inertia_ratio: f64) {
        self.inertia_ratio = inertia_ratio;
    }

    /// Torque for a state of the plan.
    pub(super) fn torque_nm(&self, state: &State, pitch_mm: f64) -> f64 {
        let turning = (state.velocity / TURNING_REV_PER_S).clamp(-1.0, 1.0);
        let full_nm = if state.velocity > 0.0 { self.in_nm } else { self.out_nm };
        let cutting_nm = full_nm * engagement(pitch_mm * state.position - self.surface_mm, self.chamfer_mm);
        let viscous_nm = self.viscous_nm_per_rpm * rpm_from_rev_per_s(state.velocity);
        let inertia_nm = (self.inertia_ratio - 1.0) * self.motor.torque_for_nm(state.acceleration);
        (self.coulomb_nm + cutting_nm) * turning + viscous_nm + inertia_nm
    }
}
