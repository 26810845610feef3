//! Elementary functions, polynomial pieces, quadrature, bracketed roots and lists: the mathematics of the core.
//!
//! `core` has no `sqrt` or `floor`; they come from `libm`, with `std` too, so results are the same bits on every host.

pub mod least_squares;
pub(crate) mod list;
pub mod poly;
pub mod quadrature;
pub mod root;
pub(in crate::control) mod standing_out;

/// Square root; NaN below zero.
#[must_use]
#[inline]
pub fn sqrt(x: f64) -> f64 {
    libm::sqrt(x)
}

/// Cube root.
#[must_use]
#[inline]
pub fn cbrt(x: f64) -> f64 {
    libm::cbrt(x)
}

/// Largest integer not above `x`.
#[must_use]
#[inline]
pub fn floor(x: f64) -> f64 {
    libm::floor(x)
}

/// Smallest integer not below `x`.
#[must_use]
#[inline]
pub fn ceil(x: f64) -> f64 {
    libm::ceil(x)
}

/// Nearest integer, halves away from zero.
#[must_use]
#[inline]
pub fn round(x: f64) -> f64 {
    libm::round(x)
}

/// −1, 0 or 1, 0 for 0 alone: `f64::signum` has no 0.
#[must_use]
#[inline]
pub fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { 1f64.copysign(x) }
}

/// Share of the way to its input, 0…1, that a first-order low-pass goes in one period; 1 for no time constant.
#[must_use]
#[inline]
pub(crate) fn filter_share(period_s: f64, time_constant_s: f64) -> f64 {
    period_s / (period_s + time_constant_s)
}

/// e^x.
#[must_use]
#[inline]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Natural logarithm; NaN below zero.
#[must_use]
#[inline]
pub fn ln(x: f64) -> f64 {
    libm::log(x)
}

/// Sine of an angle in radians.
#[must_use]
#[inline]
pub fn sin(x: f64) -> f64 {
    libm::sin(x)
}

/// Cosine of an angle in radians.
#[must_use]
#[inline]
pub fn cos(x: f64) -> f64 {
    libm::cos(x)
}
