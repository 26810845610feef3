//! The synchronisation error e(k): its only definition, and its band.

use crate::control::math::sqrt;
use crate::control::units::mm_from_um;

/// e(k) = Z travel − pitch × spindle travel, both counted from the hole's first synchronous period.
///
/// Z travel is positive into the hole, spindle travel positive in the thread's hand; e > 0 means that Z leads. The
/// torque-curve paper's listing has the opposite sign. Not the following error, which is command minus actual of one axis.
///
/// ```
/// use rigidtap::control::sync::synchronisation_error_mm;
/// assert_eq!(synchronisation_error_mm(10.5, 1.0, 10.0), 0.5);
/// ```
#[must_use]
pub fn synchronisation_error_mm(z_travel_mm: f64, pitch_mm: f64, spindle_travel_rev: f64) -> f64 {
    z_travel_mm - pitch_mm * spindle_travel_rev
}

/// The spindle angle in rev that an axial error amounts to, at a pitch above 0.
#[must_use]
pub fn spindle_rev_from_error_um(error_um: f64, pitch_mm: f64) -> f64 {
    mm_from_um(error_um) / pitch_mm
}

/// The band that an error stays in: least, greatest, root mean square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorBand {
    min: f64,
    max: f64,
    sum_of_squares: f64,
    count: u64,
}

impl Default for ErrorBand {
    fn default() -> Self {
        Self { min: f64::INFINITY, max: f64::NEG_INFINITY, sum_of_squares: 0.0, count: 0 }
    }
}

impl ErrorBand {
    /// Takes in one value.
    ///
    /// ```
    /// use rigidtap::control::sync::ErrorBand;
    /// let mut band = ErrorBand::default();
    /// [3.0, -4.0].into_iter().for_each(|error| band.add(error));
    /// assert_eq!((band.min(), band.max(), band.peak_to_peak()), (-4.0, 3.0, 7.0));
    /// assert_eq!(band.rms(), 12.5f64.sqrt());
    /// band.add(f64::NAN);
    /// band.add(1.0);
    /// assert!(band.peak_to_peak().is_nan());
    /// ```
    pub fn add(&mut self, error: f64) {
        // A judge must not lose a value that is no number: once in, it stays.
        self.min = if self.min <= error || self.min.is_nan() { self.min } else { error };
        self.max = if self.max >= error || self.max.is_nan() { self.max } else { error };
        self.sum_of_squares += error * error;
        self.count += 1;
    }

    /// Values taken in.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Least value; 0 before any.
    #[must_use]
    pub fn min(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.min }
    }

    /// Greatest value; 0 before any.
    #[must_use]
    pub fn max(&self) -> f64 {
        if self.count == 0 { 0.0 } else { self.max }
    }

    /// Greatest less least value.
    #[must_use]
    pub fn peak_to_peak(&self) -> f64 {
        self.max() - self.min()
    }

    /// Root mean square about zero; 0 before any.
    #[must_use]
    pub fn rms(&self) -> f64 {
        if self.count == 0 { 0.0 } else { sqrt(self.sum_of_squares / self.count as f64) }
    }

    /// Greatest magnitude.
    #[must_use]
    pub fn magnitude(&self) -> f64 {
        if self.max() >= -self.min() { self.max() } else { -self.min() }
    }

    /// The same band in another unit, `factor` of which make one of this; positive.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            min: self.min * factor,
            max: self.max * factor,
            sum_of_squares: self.sum_of_squares * factor * factor,
            count: self.count,
        }
    }
}
