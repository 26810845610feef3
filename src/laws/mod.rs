//! Laws that follow from the machine: the speed bands of `torque-curve` from the motor's torque curve and the strokes that
//! matter, with their price against the fastest stroke there is; and accelerations and jerks of the other laws.
//!
//! A band's acceleration is the least that the share of the motor leaves anywhere in the band, so the staircase of the
//! bands lies under the curve everywhere. (Straight lines between points *on* the curve would not: a curve of constant
//! power is convex.) What is free is where the bands end.

mod derived;
mod error;
mod search;
mod staircase;
mod task;
#[cfg(test)]
mod tests;

pub use derived::laws_of;
pub use error::TuneError;
pub use staircase::{Staircase, TunedBand};
pub use task::{STROKES_REV, TuneTask};

use crate::control::machine::{BandSpec, Machine, Ramp};

/// The machine with `torque-curve`'s bands tuned anew, as many as it has, for `share` of the motor and [`STROKES_REV`];
/// `law.motor_share` becomes the share, too.
///
/// # Errors
/// [`TuneError::Machine`] for a share that a machine file could not have either.
///
/// ```
/// use rigidtap::{control::machine::Machine, laws::retuned};
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
