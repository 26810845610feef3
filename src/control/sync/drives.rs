//! The last step of a period: the commanded motion as each drive is to be told it.

use crate::control::machine::{Machine, Takes};
use crate::control::model::closed_loop::ClosedLoop;
use crate::control::units::m_from_mm;

use super::feedforward::DriveInverse;
use super::plant_model::IdentifiedDrives;
use super::step::Step;
use super::strategy::{Compensation, Settings};

/// Both drives' inverses. They come after the bounds of supervision, which hold for the commanded motion.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drives {
    spindle: DriveInverse,
    z: DriveInverse,
}

impl Drives {
    /// For a hole. Without a model, drives are sent the commanded motion as it is.
    pub(super) fn new(machine: &Machine, settings: Settings) -> Self {
        let spec = machine.spec();
        let (drive, period_s) = (&spec.drive, spec.control.period_s);
        let by_model = settings.compensation == Compensation::ModelBased;
        let taken = |takes: Takes| if by_model { takes } else { Takes::Torque };
        let (spindle_loops, z_loops) = (ClosedLoop::of_spindle(drive), ClosedLoop::of_z(drive));
        let kg_m_per_mm = m_from_mm(spec.z_axis.mass_kg);
        Self {
            spindle: DriveInverse::new(
                taken(drive.spindle_takes),
                spindle_loops,
                machine.motor().torque_for_nm(1.0),
                period_s,
            ),
            z: DriveInverse::new(taken(drive.z_takes), z_loops, kg_m_per_mm, period_s),
        }
    }

    /// The hole begins with Z's reference so far above R, by drives that are known so well.
    pub(super) fn begin(&mut self, z_mm: f64, known: &IdentifiedDrives) {
        self.spindle.take_loops(known.spindle);
        self.z.take_loops(known.z);
        self.z.rest_beside(z_mm);
    }

    /// A step as it is sent.
    pub(super) fn sent(&mut self, step: &Step) -> Step {
        let (spindle, spindle_torque_nm) = self.spindle.setpoint(&step.spindle, step.spindle_torque_nm);
        let (z, z_force_n) = self.z.setpoint(&step.z, step.z_force_n);
        Step { spindle, z, spindle_torque_nm, z_force_n, ..*step }
    }
}
