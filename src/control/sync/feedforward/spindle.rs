//! Torque that the spindle needs beyond its file's inertia: friction, expected cutting torque, identified inertia.

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
pub(in crate::control::sync) struct SpindleFeedforward {
    motor: Motor,
    coulomb_nm: f64,
    viscous_nm_per_rpm: f64,
    /// Identified inertia over the file's.
    inertia_ratio: f64,
    pitch_mm: f64,
    /// Of the work piece below the R plane.
    surface_mm: f64,
    /// Travel over which the cutting torque rises.
    chamfer_mm: f64,
    /// Cutting torque with the whole chamfer engaged, on the way in and on the way out.
    in_nm: f64,
    out_nm: f64,
}

impl SpindleFeedforward {
    /// For a hole, with the inertia over the file's as it is known.
    pub(in crate::control::sync) fn new(machine: &Machine, cycle: &TapCycle, inertia_ratio: f64) -> Self {
        let (spindle, tap) = (&machine.spec().spindle, &machine.spec().tap);
        let full_nm = machine
            .tap_size(cycle.pitch_mm)
            .map_or(0.0, |(major_mm, hole_mm)| tapping_torque_nm(major_mm, hole_mm, tap.kc_n_per_mm2, tap.tool_factor));
        Self {
            motor: machine.motor().clone(),
            coulomb_nm: spindle.coulomb_nm,
            viscous_nm_per_rpm: spindle.viscous_nm_per_rpm,
            inertia_ratio,
            pitch_mm: cycle.pitch_mm,
            surface_mm: tap.surface_below_r_mm,
            chamfer_mm: tap.ramp_pitches * cycle.pitch_mm,
            in_nm: full_nm,
            out_nm: full_nm * tap.out_torque_ratio,
        }
    }

    /// Torque for a state of the plan, in rev.
    pub(in crate::control::sync) fn torque_nm(&self, state: &State) -> f64 {
        let turning = (state.velocity / TURNING_REV_PER_S).clamp(-1.0, 1.0);
        let full_nm = if state.velocity > 0.0 { self.in_nm } else { self.out_nm };
        let cutting_nm = full_nm * engagement(self.pitch_mm * state.position - self.surface_mm, self.chamfer_mm);
        let viscous_nm = self.viscous_nm_per_rpm * rpm_from_rev_per_s(state.velocity);
        let inertia_nm = (self.inertia_ratio - 1.0) * self.motor.torque_for_nm(state.acceleration);
        (self.coulomb_nm + cutting_nm) * turning + viscous_nm + inertia_nm
    }
}

#[cfg(test)]
mod tests {
    use super::SpindleFeedforward;
    use crate::control::cycle::TapCycle;
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;

    /// Of M6 in AlSi: tap makers' handbooks.
    const CUTTING_NM: f64 = 0.525;
    /// The reference machine's at 3000 rpm.
    const FRICTION_NM: f64 = 0.3 + 0.3 * 3.0 / 8.0;

    fn torque_nm(inertia_ratio: f64, position: f64, velocity: f64, acceleration: f64) -> f64 {
        let cycle = TapCycle::right_hand(0.0, -20.0, 1.0, 3000.0);
        SpindleFeedforward::new(&Machine::reference(), &cycle, inertia_ratio).torque_nm(&State {
            position,
            velocity,
            acceleration,
            jerk: 0.0,
        })
    }

    fn assert_near_nm(actual: f64, expected: f64) {
        assert!((actual - expected).abs() < 0.002, "{actual} {expected}");
    }

    #[test]
    fn friction_alone_above_the_surface() {
        assert_near_nm(torque_nm(1.0, 1.9, 50.0, 0.0), FRICTION_NM);
        assert_near_nm(torque_nm(1.0, 1.9, -50.0, 0.0), -FRICTION_NM);
        assert_eq!(torque_nm(1.0, 1.9, 0.0, 0.0), 0.0);
    }

    /// The surface lies 2 mm below R, and the chamfer is 4 mm long.
    #[test]
    fn cutting_rises_over_the_chamfer_and_is_less_on_the_way_out() {
        assert_near_nm(torque_nm(1.0, 4.0, 50.0, 0.0), FRICTION_NM + 0.5 * CUTTING_NM);
        assert_near_nm(torque_nm(1.0, 6.0, 50.0, 0.0), FRICTION_NM + CUTTING_NM);
        assert_near_nm(torque_nm(1.0, 20.0, 50.0, 0.0), FRICTION_NM + CUTTING_NM);
        assert_near_nm(torque_nm(1.0, 20.0, -50.0, 0.0), -FRICTION_NM - 0.3 * CUTTING_NM);
    }

    #[test]
    fn turns_round_without_a_step() {
        for (position, limit_nm) in [(0.0, 0.001), (20.0, 0.002)] {
            let step_nm = torque_nm(1.0, position, 5e-4, 0.0) - torque_nm(1.0, position, -5e-4, 0.0);
            assert!(step_nm > 0.0 && step_nm < limit_nm, "{step_nm}");
        }
    }

    #[test]
    fn inertia_beyond_the_files() {
        let (file_nm, rest_nm) = (100.0 * std::f64::consts::TAU * 0.004, torque_nm(1.0, 0.0, 0.0, 100.0));
        assert_eq!(rest_nm, 0.0, "the drive's own share is the file's");
        assert!((torque_nm(1.2, 0.0, 0.0, 100.0) - 0.2 * file_nm).abs() < 1e-9);
        assert!((torque_nm(0.9, 0.0, 0.0, -100.0) - 0.1 * file_nm).abs() < 1e-9);
    }
}
