//! What one period of a hole yields.

use crate::control::cycle::{Interrupted, StrokeState};
use crate::control::math::poly::State;
use crate::control::port::Setpoint;

use super::supervision::Alarm;

/// Where in the hole a period lies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Stage {
    /// Spindle and Z come into position at R, before the first synchronous period or after the last.
    #[default]
    Settling,
    /// Synchronous, on this stroke or dwell; what a stopped hole does beside it.
    Synchronous(StrokeState, Option<Interrupted>),
    /// An alarm is latched, and both axes come to rest in synchronism: the spindle brakes with what torque there is, and Z
    /// goes with it.
    SynchronousStop,
    /// An alarm is latched, and an encoder or the clock is not to be trusted: both axes brake on the plan.
    ModelStop,
    /// An alarm is latched, and Z does not follow: the spindle brakes as hard as it can.
    ZLost,
    /// An alarm is latched, and both axes are held, in position or not, until it is acknowledged.
    Held,
    /// The hole is done: the spindle rests, and Z is free but for the
    /// [`ResidualFeedforward`](super::ResidualFeedforward) of model-based compensation.
    Done,
}

/// What one period yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Where in the hole the period lies.
    pub stage: Stage,
    /// The spindle's setpoint, machine coordinates in rev, as its drive takes it: beyond the commanded motion where its own loops
    /// have to find the torque.
    pub spindle: State,
    /// Z's setpoint, machine coordinates in mm, likewise.
    pub z: State,
    /// Torque feedforward of the spindle beyond its acceleration's, N·m; 0 where its drive takes none.
    pub spindle_torque_nm: f64,
    /// Force feedforward of Z, likewise, N, positive upwards; 0 where its drive takes none.
    pub z_force_n: f64,
    /// e(k) of this period's feedback in mm; 0 while settling.
    pub error_mm: f64,
    /// Correction in force on Z in mm, positive into the hole.
    pub correction_mm: f64,
    /// How fast the plan's time runs against the clock's: 1, and less where time scaling slows a path that the motor cannot
    /// follow.
    pub path_rate: f64,
    /// The alarm that is latched.
    pub alarm: Option<Alarm>,
    /// What a hole that is done is warned of: it brakes nothing, and need not be acknowledged. With [`Stage::Done`] alone.
    pub warning: Option<Alarm>,
    /// A sample of spindle or Z was missing or repeated, and the model stood in for it.
    pub bridged: bool,
}

impl Default for Step {
    fn default() -> Self {
        Self {
            stage: Stage::default(),
            spindle: State::default(),
            z: State::default(),
            spindle_torque_nm: 0.0,
            z_force_n: 0.0,
            error_mm: 0.0,
            correction_mm: 0.0,
            path_rate: 1.0,
            alarm: None,
            warning: None,
            bridged: false,
        }
    }
}

impl Step {
    /// The setpoint to hand over, X and Y resting where they are.
    #[must_use]
    pub fn setpoint(&self, x: State, y: State) -> Setpoint {
        let Self { spindle, z, spindle_torque_nm, z_force_n, .. } = *self;
        Setpoint { spindle, x, y, z, spindle_torque_nm, z_force_n }
    }
}
