//! Tuning a machine to its motor, as its file or a recorded run-up has it.

mod estimate;
mod run_up;
#[cfg(test)]
mod run_up_tests;

pub use run_up::{RunUp, RunUpError, RunUpFault};

use crate::control::machine::BandSpec;
use crate::control::motor::TorqueCurve;
use crate::laws::Staircase;

/// What tuning came to, for reports.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuning {
    /// The bands.
    pub best: Staircase,
    /// The bands as a machine file has them.
    pub specs: Vec<BandSpec>,
    /// Price of the best 1, 2, … bands.
    pub prices: Vec<f64>,
    /// Share of the motor that they use.
    pub motor_share: f64,
    /// Commanded speed of the strokes.
    pub max_rpm: f64,
    /// The strokes.
    pub strokes_rev: Vec<f64>,
    /// The torque curve where it was measured.
    pub measured: Option<TorqueCurve>,
}
