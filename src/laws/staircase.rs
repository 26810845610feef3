//! Tuned bands, and how a machine file has them.

use crate::control::machine::{BandSpec, Ramp};

/// One tuned band; it starts where the band below it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TunedBand {
    /// Its top.
    pub to_rpm: f64,
    /// Acceleration and deceleration throughout.
    pub rate_rpm_per_s: f64,
    /// Torque that this takes at the top, of what the whole motor has there; the share, unless the curve rises in the band.
    pub motor_ratio_at_top: f64,
}

/// Tuned bands with their price.
#[derive(Clone, Debug, PartialEq)]
pub struct Staircase {
    /// The bands, in rising order.
    pub bands: Vec<TunedBand>,
    /// Mean over the strokes of stroke time over the bound at the same motor share.
    pub stroke_over_bound: f64,
}

impl Staircase {
    /// The bands as a machine file has them: by time constants, which count from the law's start and end speed (both in
    /// rpm, usually 0). Rounded up to five digits, so that the rounding never asks for more than the motor's share.
    ///
    /// ```
    /// use rigidtap::{config, control::machine::Machine, laws::{STROKES_REV, TuneTask}};
    /// let task = TuneTask::new(Machine::reference().motor().clone(), 8000.0, 0.8, &STROKES_REV).unwrap();
    /// assert_eq!(
    ///     config::bands_to_toml(&task.best(2).unwrap().time_constants(0.0, 0.0)).lines().nth(2).unwrap(),
    ///     "  { to_rpm = 3000, accel_s = 0.07854, decel_s = 0.07854 },"
    /// );
    /// ```
    #[must_use]
    pub fn time_constants(&self, start_rpm: f64, end_rpm: f64) -> Vec<BandSpec> {
        let first_top = self.bands.first().map_or(0.0, |band| band.to_rpm);
        // As the machine resolves them: a speed above the first band leaves that band's constant counting from rest.
        let mut below = [start_rpm, end_rpm].map(|rpm| if rpm < first_top { rpm } else { 0.0 });
        let spec = |band: &TunedBand| {
            let [accel_s, decel_s] = below.map(|rpm| rounded_up((band.to_rpm - rpm) / band.rate_rpm_per_s));
            below = [band.to_rpm; 2];
            BandSpec { to_rpm: band.to_rpm, ramp: Ramp::Time { accel_s, decel_s } }
        };
        self.bands.iter().map(spec).collect()
    }
}

/// The next number up with five digits.
fn rounded_up(value: f64) -> f64 {
    const ULPS: f64 = 1e-12;
    let scale = 10f64.powf(4.0 - value.log10().floor());
    (value * scale * (1.0 - ULPS)).ceil() / scale
}
