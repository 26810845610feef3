//! What passes the interface each period, and what is asked of a state, laid out as the header says.

use super::data::RigidtapHole;
use crate::control::math::poly::State;
use crate::control::port::{AxisStatus, DriveState, Feedback, Setpoint};
use crate::control::sync::{Alarm, Axis, Identified};
use crate::control::tapping::Counters;
use crate::control::units::um_from_mm;

/// Bits of `reported`: which fields of a feedback a drive reports. The others are not looked at.
pub mod reports {
    /// `z_motor_counts`.
    pub const Z_MOTOR: u32 = 1;
    /// `spindle_torque_nm`.
    pub const SPINDLE_TORQUE: u32 = 2;
    /// `z_force_n`.
    pub const Z_FORCE: u32 = 4;
    /// `status::SPINDLE_SATURATED`.
    pub const SPINDLE_SATURATED: u32 = 8;
    /// `status::Z_SATURATED`.
    pub const Z_SATURATED: u32 = 16;
    /// `status::SPINDLE_NOT_READY`.
    pub const SPINDLE_DRIVE: u32 = 32;
    /// `status::Z_NOT_READY`.
    pub const Z_DRIVE: u32 = 64;
}

/// Bits of `status`.
pub mod status {
    /// The spindle's sample is old, or did not arrive whole.
    pub const SPINDLE_INVALID: u32 = 1;
    /// Z's likewise.
    pub const Z_INVALID: u32 = 2;
    /// The spindle's drive stood at its torque limit in the period.
    pub const SPINDLE_SATURATED: u32 = 4;
    /// Z's drive at its force limit.
    pub const Z_SATURATED: u32 = 8;
    /// The spindle's drive is off or tripped.
    pub const SPINDLE_NOT_READY: u32 = 16;
    /// Z's drive likewise.
    pub const Z_NOT_READY: u32 = 32;
}

/// `rigidtap_feedback` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapFeedback {
    pub spindle_counts: i64,
    pub z_counts: i64,
    pub z_motor_counts: i64,
    pub spindle_torque_nm: f64,
    pub z_force_n: f64,
    pub reported: u32,
    pub status: u32,
}

impl From<&RigidtapFeedback> for Feedback {
    fn from(told: &RigidtapFeedback) -> Self {
        let (reported, has) = (|bit: u32| told.reported & bit != 0, |bit: u32| told.status & bit != 0);
        let drive = |told: bool, not_ready: bool| {
            told.then_some(if not_ready { DriveState::NotReady } else { DriveState::Ready })
        };
        Self {
            spindle_counts: told.spindle_counts,
            z_counts: told.z_counts,
            z_motor_counts: reported(reports::Z_MOTOR).then_some(told.z_motor_counts),
            spindle_torque_nm: reported(reports::SPINDLE_TORQUE).then_some(told.spindle_torque_nm),
            z_force_n: reported(reports::Z_FORCE).then_some(told.z_force_n),
            spindle: AxisStatus {
                sample_valid: !has(status::SPINDLE_INVALID),
                drive: drive(reported(reports::SPINDLE_DRIVE), has(status::SPINDLE_NOT_READY)),
                saturated: reported(reports::SPINDLE_SATURATED).then_some(has(status::SPINDLE_SATURATED)),
            },
            z: AxisStatus {
                sample_valid: !has(status::Z_INVALID),
                drive: drive(reported(reports::Z_DRIVE), has(status::Z_NOT_READY)),
                saturated: reported(reports::Z_SATURATED).then_some(has(status::Z_SATURATED)),
            },
        }
    }
}

/// `rigidtap_alarm` of the header; code 0 is none.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapAlarm {
    pub value: f64,
    pub limit: f64,
    pub code: u32,
    pub axis: u32,
}

impl From<Option<Alarm>> for RigidtapAlarm {
    fn from(alarm: Option<Alarm>) -> Self {
        let Some(alarm) = alarm else { return Self::default() };
        let (value, limit) = alarm.value_and_limit();
        let axis = match alarm.axis() {
            Axis::Spindle => 1,
            Axis::Z => 2,
        };
        Self { value, limit, code: alarm.code(), axis }
    }
}

/// `rigidtap_identified` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapIdentified {
    pub spindle_inertia_ratio: f64,
    pub spindle_torque_limit_ratio: f64,
    pub spindle_drag_nm: f64,
    pub z_friction_n: f64,
    pub z_viscous_n_s_per_mm: f64,
    pub z_weight_n: f64,
    pub z_lost_motion_um: f64,
    pub z_compliance_ratio: f64,
    pub z_deflection_middle_um: f64,
    pub spindle_latency_s: f64,
    pub z_latency_s: f64,
    pub spindle_position_gain_per_s: f64,
    pub spindle_velocity_gain_per_s: f64,
    pub z_position_gain_per_s: f64,
    pub z_velocity_gain_per_s: f64,
    pub z_middle_known: u32,
    pub reserved: u32,
}

impl From<Identified> for RigidtapIdentified {
    fn from(Identified { spindle, z, latency, drives }: Identified) -> Self {
        Self {
            spindle_inertia_ratio: spindle.inertia_ratio,
            spindle_torque_limit_ratio: spindle.torque_limit_ratio,
            spindle_drag_nm: spindle.drag_nm,
            z_friction_n: z.friction_n,
            z_viscous_n_s_per_mm: z.viscous_n_s_per_mm,
            z_weight_n: z.weight_n,
            z_lost_motion_um: um_from_mm(z.lost_motion_mm),
            z_compliance_ratio: z.compliance_ratio,
            z_deflection_middle_um: um_from_mm(z.deflection_middle_mm.unwrap_or(0.0)),
            spindle_latency_s: latency.spindle_s,
            z_latency_s: latency.z_s,
            spindle_position_gain_per_s: drives.spindle.position_gain_per_s,
            spindle_velocity_gain_per_s: drives.spindle.velocity_gain_per_s,
            z_position_gain_per_s: drives.z.position_gain_per_s,
            z_velocity_gain_per_s: drives.z.velocity_gain_per_s,
            z_middle_known: u32::from(z.deflection_middle_mm.is_some()),
            reserved: 0,
        }
    }
}

/// `rigidtap_counters` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapCounters {
    pub periods: u64,
    pub invalid_samples: u64,
    pub gaps: u64,
    pub saturated_periods: u64,
}

impl From<Counters> for RigidtapCounters {
    fn from(counters: Counters) -> Self {
        let Counters { periods, invalid_samples, gaps, saturated_periods } = counters;
        Self { periods, invalid_samples, gaps, saturated_periods }
    }
}

/// `rigidtap_residual` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapResidual {
    pub z: RigidtapState,
    pub z_force_n: f64,
}

/// `rigidtap_state` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapState {
    pub position: f64,
    pub velocity: f64,
    pub acceleration: f64,
}

impl From<State> for RigidtapState {
    fn from(state: State) -> Self {
        Self { position: state.position, velocity: state.velocity, acceleration: state.acceleration }
    }
}

impl From<RigidtapState> for State {
    fn from(RigidtapState { position, velocity, acceleration }: RigidtapState) -> Self {
        Self { position, velocity, acceleration, jerk: 0.0 }
    }
}

/// `rigidtap_commanded` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapCommanded {
    pub spindle: RigidtapState,
    pub z: RigidtapState,
    pub spindle_torque_nm: f64,
    pub z_force_n: f64,
}

impl From<RigidtapCommanded> for Setpoint {
    fn from(RigidtapCommanded { spindle, z, spindle_torque_nm, z_force_n }: RigidtapCommanded) -> Self {
        Self { spindle: spindle.into(), z: z.into(), spindle_torque_nm, z_force_n, ..Self::default() }
    }
}

/// `rigidtap_setpoint` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapSetpoint {
    pub spindle: RigidtapState,
    pub z: RigidtapState,
    pub spindle_torque_nm: f64,
    pub z_force_n: f64,
    pub error_mm: f64,
    pub correction_mm: f64,
    pub path_rate: f64,
    pub alarm: RigidtapAlarm,
    pub stage: u32,
    pub stroke: u32,
}

/// `rigidtap_block_request` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapBlockRequest {
    pub hole: RigidtapHole,
    pub start_x_mm: f64,
    pub start_y_mm: f64,
    pub start_z_mm: f64,
    pub step_x_mm: f64,
    pub step_y_mm: f64,
    pub spindle_rpm: f64,
    pub spindle_counts: i64,
    pub holes: u32,
    pub reserved: u32,
}

/// `rigidtap_axes` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[allow(missing_docs, reason = "the header says it")]
pub struct RigidtapAxes {
    pub spindle: RigidtapState,
    pub x: RigidtapState,
    pub y: RigidtapState,
    pub z: RigidtapState,
    pub spindle_torque_nm: f64,
    pub z_force_n: f64,
    pub error_mm: f64,
    pub correction_mm: f64,
    pub path_rate: f64,
    pub alarm: RigidtapAlarm,
    pub stage: u32,
    pub stroke: u32,
    pub hole: u32,
    pub reserved: u32,
}
