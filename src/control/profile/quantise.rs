//! A trapezoid-jerk stroke in whole interpolation periods (trapezoid-jerk paper, eq. 8 and 9).
//!
//! A stroke of this law is its distance smoothed by four moving averages, whose widths p ≤ q ≤ r ≤ w are the times over
//! which snap makes jerk, jerk acceleration, acceleration speed, and speed distance: S = v·w, v = a·r, a = j·q, j = l·p.
//! Phases are whole periods when the widths are, and each limit bounds one product of widths from below.

use crate::control::math::{ceil, floor};

/// A change of speed from rest: seven phases, symmetrical about its middle, so it covers its mean speed times its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shape {
    /// Each of the four phases in which jerk rises or falls, t_j of eq. 7.
    pub(super) snap_s: f64,
    /// Each of the two phases of constant jerk, t_q − 2·t_j of eq. 10.
    pub(super) jerk_s: f64,
    /// The phase of constant acceleration.
    pub(super) constant_s: f64,
}

impl Shape {
    pub(super) fn duration_s(&self) -> f64 {
        self.jerk_rise_s() + self.acceleration_s() + self.snap_s
    }

    /// Peak jerk over this is the snap… and so on up the derivatives: l·t = j, j·t = a, a·t = v.
    pub(super) fn jerk_rise_s(&self) -> f64 {
        self.snap_s + self.jerk_s
    }

    pub(super) fn acceleration_s(&self) -> f64 {
        2.0 * self.snap_s + self.jerk_s + self.constant_s
    }
}

/// What a quantised stroke has to keep.
pub(super) struct Limits {
    pub(super) command: f64,
    pub(super) acceleration: f64,
    pub(super) jerk: f64,
    pub(super) snap: f64,
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
pub(super) fn whole_periods(distance: f64, period_s: f64, limits: &Limits, fastest: Shape) -> (Shape, f64) {
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
fn widths(distance: f64, period_s: f64, limits: &Limits, p: f64, q: f64, r: f64) -> Widths {
    let p = p.max(1.0);
    let q = q.max(p);
    let r = r.max(p + q);
    let speed = distance / period_s;
    let acceleration = speed / (r * period_s);
    let jerk = acceleration / (q * period_s);
    let snap = jerk / (p * period_s);
    let least = (speed / limits.command)
        .max(acceleration / limits.acceleration)
        .max(jerk / limits.jerk)
        .max(snap / limits.snap);
    Widths { p, q, r, w: whole(least).max(p + q + r) }
}
