//! What one period of a hole yields.

use super::adaptation::Lingering;
use crate::control::cycle::LegState;
use crate::control::math::poly::State;
use crate::control::port::Setpoint;

/// Where in the hole a period lies.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Stage {
    /// Spindle and Z come to rest at R, before the first synchronous period or after the last.
    #[default]
    Settling,
    /// Synchronous, on this leg.
    Synchronous(LegState),
    /// The hole is done: the spindle is at rest, and Z is free, but for what [`Adaptation`](super::Adaptation) lets linger
    /// under compensation `full`.
    Done,
}

/// What one period yields.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Step {
    /// Where in the hole the period lies.
    pub stage: Stage,
    /// The spindle's setpoint, machine coordinates in rev.
    pub spindle: State,
    /// Z's setpoint, machine coordinates in mm.
    pub z: State,
    /// Torque feedforward of the spindle beyond its acceleration's.
    pub spindle_torque_nm: f64,
    /// Force feedforward of Z, likewise.
    pub z_force_n: f64,
    /// e(k) of this period's feedback; 0 while settling.
    pub error_mm: f64,
    /// Correction in force on Z, positive into the hole.
    pub correction_mm: f64,
    /// Share by which the governor lets the plan run slower than the clock, 0 for not at all.
    pub slowed: f64,
}

impl Step {
    /// The setpoint to hand over, X and Y resting where they are.
    #[must_use]
    pub fn setpoint(&self, x: State, y: State) -> Setpoint {
        let Self { spindle, z, spindle_torque_nm, z_force_n, .. } = *self;
        Setpoint { spindle, x, y, z, spindle_torque_nm, z_force_n }
    }

    /// The same with what lingers of the hole before.
    pub(super) fn with(self, left: &Lingering) -> Self {
        let Setpoint { z, z_force_n, .. } = left.onto(self.setpoint(State::default(), State::default()));
        Self { z, z_force_n, ..self }
    }
}

/// Both axes' commands in rev and mm, and efforts beyond their accelerations', positive into the hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pair {
    pub(super) spindle: State,
    pub(super) spindle_nm: f64,
    pub(super) z: State,
    pub(super) z_n: f64,
    /// Correction that is part of `z`.
    pub(super) correction_mm: f64,
    /// Share by which the plan's time runs slower than the clock's.
    pub(super) slowed: f64,
}
