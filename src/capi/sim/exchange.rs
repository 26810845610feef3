//! What passes the interface of the simulated machine, laid out as its header says.

use core::ffi::c_char;

use super::super::exchange::{RigidtapFeedback, reports, status};
use crate::control::port::{AxisStatus, DriveState, Feedback, Truth};

/// `rigidtap_sim_options` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapSimOptions {
    pub machine_file: *const c_char,
    pub z_start_mm: f64,
    pub seed: u64,
    pub takes_given: u32,
    pub spindle_takes: u32,
    pub z_takes: u32,
    pub ideal: u32,
}

/// `rigidtap_sim_truth_data` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapSimTruth {
    pub spindle_rev: f64,
    pub z_mm: f64,
    pub spindle_rpm: f64,
    pub spindle_torque_nm: f64,
    pub z_force_n: f64,
}

impl From<Truth> for RigidtapSimTruth {
    fn from(Truth { spindle_rev, z_mm, spindle_rpm, spindle_torque_nm, z_force_n }: Truth) -> Self {
        Self { spindle_rev, z_mm, spindle_rpm, spindle_torque_nm, z_force_n }
    }
}

/// What the machine reports, as the control is told it.
pub(super) fn told(feedback: &Feedback) -> RigidtapFeedback {
    let Feedback { spindle_counts, z_counts, z_motor_counts, spindle_torque_nm, z_force_n, spindle, z } = *feedback;
    let bit = |on: bool, bit: u32| if on { bit } else { 0 };
    let reported = bit(z_motor_counts.is_some(), reports::Z_MOTOR)
        | bit(spindle_torque_nm.is_some(), reports::SPINDLE_TORQUE)
        | bit(z_force_n.is_some(), reports::Z_FORCE)
        | bit(spindle.saturated.is_some(), reports::SPINDLE_SATURATED)
        | bit(z.saturated.is_some(), reports::Z_SATURATED)
        | bit(spindle.drive.is_some(), reports::SPINDLE_DRIVE)
        | bit(z.drive.is_some(), reports::Z_DRIVE);
    let of_axis = |axis: AxisStatus, [invalid, saturated, not_ready]: [u32; 3]| {
        bit(!axis.sample_valid, invalid)
            | bit(axis.saturated == Some(true), saturated)
            | bit(axis.drive == Some(DriveState::NotReady), not_ready)
    };
    RigidtapFeedback {
        spindle_counts,
        z_counts,
        z_motor_counts: z_motor_counts.unwrap_or(0),
        spindle_torque_nm: spindle_torque_nm.unwrap_or(0.0),
        z_force_n: z_force_n.unwrap_or(0.0),
        reported,
        status: of_axis(spindle, [status::SPINDLE_INVALID, status::SPINDLE_SATURATED, status::SPINDLE_NOT_READY])
            | of_axis(z, [status::Z_INVALID, status::Z_SATURATED, status::Z_NOT_READY]),
    }
}
