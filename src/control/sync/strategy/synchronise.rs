//! What every strategy does, what it is given each period, and what it yields.

use crate::control::cycle::StrokeState;
use crate::control::sync::adaptation::Adaptation;
use crate::control::sync::frame::{AxisCommands, Measured, Travel};
use crate::control::sync::in_position::Window;
use crate::control::sync::trajectory::Trajectory;

/// What one period of a hole is computed from.
#[derive(Clone, Copy, Debug)]
pub(in crate::control::sync) struct Inputs<'a> {
    pub(in crate::control::sync) now_s: f64,
    /// Travels since the hole's zero, and e(k) from them.
    pub(in crate::control::sync) travel: Travel,
    /// The spindle's speed over the last period.
    pub(in crate::control::sync) spindle_rev_per_s: f64,
    pub(in crate::control::sync) error_mm: f64,
    pub(in crate::control::sync) measured: &'a Measured,
}

/// What one period of a hole yields, positive into the hole.
#[derive(Clone, Copy, Debug)]
pub(in crate::control::sync) struct Command {
    pub(in crate::control::sync) axes: AxisCommands,
    /// What Z's command is still to be deeper by.
    pub(in crate::control::sync) z_offset_mm: f64,
    /// Correction in force on Z, this one or part of `axes`.
    pub(in crate::control::sync) correction_mm: f64,
    /// What e(k) has of the way between Z's motor and the load, where the encoder is the motor's: no error of the thread.
    pub(in crate::control::sync) unseen_mm: f64,
    /// The plan's time, what it says of the spindle there, and how fast it runs against the clock.
    pub(in crate::control::sync) plan_s: f64,
    pub(in crate::control::sync) planned: StrokeState,
    pub(in crate::control::sync) path_rate: f64,
}

/// What every strategy does.
pub(in crate::control::sync) trait Synchronise {
    /// How long after the plan's end the axes still move.
    fn tail_s(&self) -> f64;

    /// When spindle and Z are in position for the start, and whether the hole is tapped with a start offset.
    fn start(&self) -> (Window, bool);

    /// Spindle and Z rest where the plan has them at a time, and the next [`Synchronise::step`] is the first from there.
    fn begin(&mut self, plan_s: f64, trajectory: &mut Trajectory, measured: &Measured, adaptation: &mut Adaptation);

    /// One synchronous period.
    fn step(&mut self, trajectory: &mut Trajectory, inputs: &Inputs<'_>, adaptation: &mut Adaptation) -> Command;

    /// The hole is done with Z commanded so far above R, and with such a force, in machine coordinates. One that was
    /// interrupted teaches nothing.
    fn finish(&self, adaptation: &mut Adaptation, interrupted: bool, z_mm: f64, z_force_n: f64);
}
