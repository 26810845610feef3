//! What bands are tuned for, and what some bands cost.

use crate::control::motor::Motor;
use crate::control::profile::{MAX_BANDS, SpeedBand, StrokeRequest, TorqueCurveLaw};
use crate::control::units::{rev_per_s_from_rpm, rpm_from_rev_per_s};

use super::error::TuneError;
use super::staircase::{Staircase, TunedBand};

/// Strokes that bands are tuned for unless others are asked for, in rev: figures.md, "Segmentation".
pub const STROKES_REV: [f64; 4] = [5.0, 10.0, 25.0, 50.0];

/// A stroke with what the motor could do at best.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    request: StrokeRequest,
    pub(super) bound_s: f64,
    pub(super) peak_rev_per_s: f64,
}

/// What bands are tuned for: a motor, the share of it that may be used, and strokes at the greatest speed.
#[derive(Clone, Debug)]
pub struct TuneTask {
    pub(super) motor: Motor,
    pub(super) max_rpm: f64,
    pub(super) share: f64,
    pub(super) targets: Vec<Target>,
}

impl TuneTask {
    /// Strokes of `strokes_rev` commanded at `max_rpm`, with `share` of the motor in (0, 1].
    ///
    /// # Errors
    /// [`TuneError`] for a number outside its range, or no stroke.
    pub fn new(motor: Motor, max_rpm: f64, share: f64, strokes_rev: &[f64]) -> Result<Self, TuneError> {
        if !(max_rpm > 0.0 && max_rpm.is_finite()) {
            return Err(TuneError::Speed { max_rpm });
        }
        if !(share > 0.0 && share <= 1.0) {
            return Err(TuneError::Share { share });
        }
        if strokes_rev.is_empty() {
            return Err(TuneError::NoStrokes);
        }
        let command = rev_per_s_from_rpm(max_rpm);
        let target = |&distance_rev: &f64| {
            if !(distance_rev > 0.0 && distance_rev.is_finite()) {
                return Err(TuneError::Stroke { distance_rev });
            }
            let bound = motor.fastest_stroke(distance_rev, command, share);
            let request = StrokeRequest { distance: distance_rev, command };
            Ok(Target { request, bound_s: bound.duration_s, peak_rev_per_s: bound.peak_rev_per_s })
        };
        let targets = strokes_rev.iter().map(target).collect::<Result<_, _>>()?;
        Ok(Self { motor, max_rpm, share, targets })
    }

    /// The staircase under the curve with band tops of one's own.
    ///
    /// # Errors
    /// [`TuneError::BandCount`]; [`TuneError::Tops`] unless they rise from above 0 to the greatest speed.
    pub fn with_tops(&self, tops_rpm: &[f64]) -> Result<Staircase, TuneError> {
        if !(1..=MAX_BANDS).contains(&tops_rpm.len()) {
            return Err(TuneError::BandCount { count: tops_rpm.len() });
        }
        let stroke_over_bound =
            self.price(tops_rpm).filter(|_| tops_rpm.last() == Some(&self.max_rpm)).ok_or(TuneError::Tops)?;
        let mut below_rpm = 0.0;
        let bands = tops_rpm.iter().map(|&to_rpm| {
            let rate_rpm_per_s = rpm_from_rev_per_s(self.least_acceleration(below_rpm, to_rpm));
            below_rpm = to_rpm;
            let motor = rpm_from_rev_per_s(self.motor.acceleration_rev_per_s2(rev_per_s_from_rpm(to_rpm), 1.0));
            TunedBand { to_rpm, rate_rpm_per_s, motor_ratio_at_top: rate_rpm_per_s / motor }
        });
        Ok(Staircase { bands: bands.collect(), stroke_over_bound })
    }

    /// Mean over the strokes of stroke time over the bound; none where the tops do not rise.
    pub(super) fn price(&self, tops_rpm: &[f64]) -> Option<f64> {
        let mut below_rpm = 0.0;
        let bands: arrayvec::ArrayVec<SpeedBand, MAX_BANDS> = tops_rpm
            .iter()
            .take(MAX_BANDS)
            .map(|&to_rpm| {
                let rate = self.least_acceleration(below_rpm, to_rpm);
                below_rpm = to_rpm;
                SpeedBand { to_rev_per_s: rev_per_s_from_rpm(to_rpm), accel_rev_per_s2: rate, decel_rev_per_s2: rate }
            })
            .collect();
        let law = TorqueCurveLaw { start_rev_per_s: 0.0, end_rev_per_s: 0.0, bands };
        let mut sum = 0.0;
        for target in &self.targets {
            sum += law.plan(target.request).ok()?.duration_s() / target.bound_s;
        }
        Some(sum / self.targets.len() as f64)
    }

    /// Least acceleration in rev/s² that the share leaves between two speeds. The curve is monotonic between its points.
    fn least_acceleration(&self, low_rpm: f64, high_rpm: f64) -> f64 {
        let inside = self.motor.curve.points().iter().map(|point| point.speed_rpm);
        let inside = inside.filter(|speed_rpm| (low_rpm..high_rpm).contains(speed_rpm));
        [low_rpm, high_rpm]
            .into_iter()
            .chain(inside)
            .map(|rpm| self.motor.acceleration_rev_per_s2(rev_per_s_from_rpm(rpm), self.share))
            .fold(f64::INFINITY, f64::min)
    }
}
