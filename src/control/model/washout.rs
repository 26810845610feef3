//! What an integrator has not taken over yet of what is asked of its loop.

use crate::control::math::exp;

/// The high-pass Ti·s/(Ti·s + 1) of a velocity loop with integral part: of a signal that is asked of the loop's effort, what its
/// proportional part gives. Between periods the signal goes straight, and the solution is exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Washout {
    integral_s: f64,
    period_s: f64,
    /// What a period leaves of the difference.
    kept: f64,
    asked: f64,
    integral: f64,
}

impl Washout {
    /// For an integral time, both above 0, and a signal that has been 0.
    #[must_use]
    pub fn new(integral_s: f64, period_s: f64) -> Self {
        Self { integral_s, period_s, kept: exp(-period_s / integral_s), asked: 0.0, integral: 0.0 }
    }

    /// The signal of the next period; returns what the integrator has not taken over of it.
    ///
    /// ```
    /// use rigidtap::control::model::washout::Washout;
    /// let mut washout = Washout::new(0.01, 0.001);
    /// let first = washout.step(1.0);
    /// let after_integral_time = (0..10).map(|_| washout.step(1.0)).last().unwrap();
    /// assert!((after_integral_time / first - (-1.0_f64).exp()).abs() < 1e-12);
    /// ```
    pub fn step(&mut self, asked: f64) -> f64 {
        let rate = (asked - self.asked) / self.period_s;
        // Behind a ramp a first-order lag is late by its time constant.
        let lag = rate * self.integral_s;
        self.integral = asked - lag + self.kept * (self.integral - self.asked + lag);
        self.asked = asked;
        asked - self.integral
    }

    /// The signal stands, and the integrator has taken over all of it but so much.
    pub fn rest(&mut self, asked: f64, left: f64) {
        (self.asked, self.integral) = (asked, asked - left);
    }
}
