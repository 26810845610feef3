//! The speed bands of `torque-curve`, tuned: from the motor's torque curve and the strokes that matter to band tops and
//! accelerations, with their price against the fastest stroke there is.
//!
//! A band's acceleration is the least that the share of the motor leaves anywhere in the band, so the staircase of the
//! bands lies under the curve everywhere. (Straight lines between points *on* the curve would not: a curve of constant
//! power is convex.) What is free is where the bands end.

mod error;
mod estimate;
mod run_up;
#[cfg(test)]
mod run_up_tests;
mod search;
mod staircase;
mod task;
#[cfg(test)]
mod tests;

pub use error::TuneError;
pub use run_up::{RunUp, RunUpError, RunUpFault};
pub use staircase::{Staircase, TunedBand};
pub use task::TuneTask;

use crate::control::machine::{BandSpec, Machine, Ramp};
use crate::control::motor::TorqueCurve;

/// Strokes that bands are tuned for unless others are asked for, in rev: figures.md, "Segmentation".
pub const STROKES_REV: [f64; 4] = [5.0, 10.0, 25.0, 50.0];

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

/// The machine with `torque-curve`'s bands tuned anew, as many as it has, for `share` of the motor and [`STROKES_REV`];
/// `law.motor_share` becomes the share, too.
///
/// # Errors
/// [`TuneError::Machine`] for a share that a machine file could not have either.
///
/// ```
/// use rigidtap::{control::machine::Machine, study::retuned};
/// let machine = retuned(&Machine::reference(), 0.6).unwrap();
/// assert_eq!((machine.torque_curve().bands.len(), machine.spec().law.motor_share), (4, 0.6));
/// ```
pub fn retuned(machine: &Machine, share: f64) -> Result<Machine, TuneError> {
    let machine = machine.with_motor_share(share).map_err(TuneError::Machine)?;
    let task = TuneTask::new(machine.motor().clone(), machine.spec().spindle.max_rpm, share, &STROKES_REV)?;
    let tuned = task.best(machine.torque_curve().bands.len())?;
    let specs = tuned.bands.iter().map(|&TunedBand { to_rpm, rate_rpm_per_s: rate, .. }| BandSpec {
        to_rpm,
        ramp: Ramp::Rate { accel_rpm_per_s: rate, decel_rpm_per_s: rate },
    });
    machine.with(|spec| spec.law.torque_curve.bands = specs.collect()).map_err(TuneError::Machine)
}
