//! A trapezoid-jerk stroke in whole interpolation periods (trapezoid-jerk paper, eq. 8 and 9).
//!
//! A stroke of this law is its distance smoothed by four moving averages, whose widths p ≤ q ≤ r ≤ w are the times over
//! which snap makes jerk, jerk acceleration, acceleration speed, and speed distance: S = v·w, v = a·r, a = j·q, j = l·p.
//! Phases are whole periods when the widths are, and each limit bounds one product of widths from below.

use super::trapezoid_jerk::{Shape, TrapezoidJerkLaw};
use crate::control::math::{ceil, floor};

/// What a quantised stroke has to keep.
pub(super) struct Limits<'a> {
    pub(super) command: f64,
    pub(super) law: &'a TrapezoidJerkLaw,
}

/// Widths in periods; whole numbers, as f64 since a cruise may be longer than any integer type.
#[derive(Clone, Copy)]
struct Widths {
    p: f64,
    q: f64,
    r: f64,
    w: f64,
}

impl Widths {
    fn periods(&self) -> f64 {
        self.p + self.q + self.r + self.w
    }
}

/// The shortest stroke that keeps the limits, of the fastest stroke's p, q and r each rounded down or up.
pub(super) fn whole_periods(distance: f64, period_s: f64, limits: &Limits<'_>, fastest: Shape) -> (Shape, f64) {
    let p = fastest.snap_s / period_s;
    let q = p + fastest.jerk_s / period_s;
    let r = p + q + fastest.constant_s / period_s;
    let mut best = widths(distance, period_s, limits, whole(p), whole(q), whole(r));
    for choice in 0..8_u8 {
        let rounded = |value: f64, bit: u8| if choice & bit == 0 { floor(value) } else { whole(value) };
        let found = widths(distance, period_s, limits, rounded(p, 1), rounded(q, 2), rounded(r, 4));
        if found.periods() < best.periods() {
            best = found;
        }
    }
    let Widths { p, q, r, w } = best;
    let shape = Shape { snap_s: p * period_s, jerk_s: (q - p) * period_s, constant_s: (r - q - p) * period_s };
    (shape, (w - r - q - p) * period_s)
}

/// The least whole number not below, but for rounding.
fn whole(value: f64) -> f64 {
    ceil(value * (1.0 - 4.0 * f64::EPSILON))
}

/// These p, q and r, widened until they nest, and the least w for which every limit is kept.
fn widths(distance: f64, period_s: f64, limits: &Limits<'_>, p: f64, q: f64, r: f64) -> Widths {
    let p = p.max(1.0);
    let q = q.max(p);
    let r = r.max(p + q);
    let speed = distance / period_s;
    let acceleration = speed / (r * period_s);
    let jerk = acceleration / (q * period_s);
    let snap = jerk / (p * period_s);
    let law = limits.law;
    let least = (speed / limits.command).max(acceleration / law.acceleration).max(jerk / law.jerk).max(snap / law.snap);
    Widths { p, q, r, w: whole(least).max(p + q + r) }
}
