//! The best stroke under a law's limits, by bisection and quadrature alone.

use rigidtap::control::profile::{ImprovedSCurveLaw, SCurveLaw, SpeedBand, TorqueCurveLaw, TrapezoidJerkLaw};

/// Halvings that leave one ulp of any bracket.
const HALVINGS: u32 = 200;
/// Panels between two corners of a limit that is no polynomial.
const PANELS: u32 = 16;

/// What a stroke can at best be, found without any planner's formula.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Best {
    pub(crate) duration_s: f64,
    pub(crate) peak: f64,
}

/// The largest `x` in the bracket for which `fits` holds; it holds at `low`.
fn bisect(mut low: f64, mut high: f64, fits: impl Fn(f64) -> bool) -> f64 {
    if fits(high) {
        return high;
    }
    for _ in 0..HALVINGS {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            break;
        }
        if fits(middle) { low = middle } else { high = middle }
    }
    low
}

/// Simpson's rule on equal panels.
fn simpson(low: f64, high: f64, panels: u32, f: impl Fn(f64) -> f64) -> f64 {
    let step = (high - low) / f64::from(panels);
    (0..panels)
        .map(|panel| {
            let left = low + step * f64::from(panel);
            step / 6.0 * (f(left) + 4.0 * f(left + step / 2.0) + f(left + step))
        })
        .sum()
}

/// What follows from two ramps that meet at a peak, each as (time, distance).
fn best(distance: f64, ends: f64, command: f64, ramps: impl Fn(f64) -> (f64, f64)) -> Option<Best> {
    if ramps(ends).1 > distance {
        return None;
    }
    let peak = bisect(ends, command, |peak| ramps(peak).1 <= distance);
    let (ramp_s, ramp_distance) = ramps(peak);
    Some(Best { duration_s: ramp_s + (distance - ramp_distance) / peak, peak })
}

pub(crate) fn top(law: &TorqueCurveLaw) -> f64 {
    law.bands.iter().fold(0.0, |top: f64, band| top.max(band.to_rev_per_s))
}

/// The greatest rate that any band holding this speed allows, rounding at its edges forgiven.
pub(crate) fn band_limit(bands: &[SpeedBand], speed: f64, rate: impl Fn(&SpeedBand) -> f64) -> f64 {
    let slack = 1e-9 * speed.max(1.0);
    let mut below = 0.0;
    let mut limit = 0.0_f64;
    for band in bands {
        if speed >= below - slack && speed <= band.to_rev_per_s + slack {
            limit = limit.max(rate(band));
        }
        below = band.to_rev_per_s;
    }
    limit
}

/// Time and distance of one flank, ∫ dv/a and ∫ v·dv/a, cut where the acceleration steps.
fn flank(bands: &[SpeedBand], low: f64, high: f64, rate: impl Fn(&SpeedBand) -> f64) -> (f64, f64) {
    let (mut time_s, mut distance, mut below) = (0.0, 0.0, 0.0);
    for band in bands {
        let (from, to) = (low.clamp(below, band.to_rev_per_s), high.clamp(below, band.to_rev_per_s));
        time_s += simpson(from, to, 2, |_| 1.0 / rate(band));
        distance += simpson(from, to, 2, |v| v / rate(band));
        below = band.to_rev_per_s;
    }
    (time_s, distance)
}

/// Time and distance of both flanks of a torque-curve stroke with this peak.
pub(crate) fn banded_ramps(law: &TorqueCurveLaw, peak: f64) -> (f64, f64) {
    let up = flank(&law.bands, law.start_rev_per_s, peak, |band| band.accel_rev_per_s2);
    let down = flank(&law.bands, law.end_rev_per_s, peak, |band| band.decel_rev_per_s2);
    (up.0 + down.0, up.1 + down.1)
}

/// None where the stroke is too short.
pub(crate) fn banded(law: &TorqueCurveLaw, distance: f64, command: f64) -> Option<Best> {
    let ends = law.start_rev_per_s.max(law.end_rev_per_s);
    best(distance, ends, command.min(top(law)), |peak| banded_ramps(law, peak))
}

/// Acceleration of a jerk-limited change of speed at time `t` of `total`: as much as both ends and the limit leave.
fn bell(law: &SCurveLaw, t: f64, total: f64) -> f64 {
    (law.jerk * t).min(law.jerk * (total - t)).min(law.acceleration).max(0.0)
}

/// Time and distance of one jerk-limited change of speed. The time is found by bisection on the speed it gains.
fn jerk_ramp(law: &SCurveLaw, from: f64, to: f64) -> (f64, f64) {
    let change = (to - from).abs();
    if change == 0.0 {
        return (0.0, 0.0);
    }
    // The bell is piecewise straight, with corners at these times: Simpson between them is exact.
    let corners = |total: f64| {
        let ramp = (law.acceleration / law.jerk).min(total / 2.0);
        [0.0, ramp, total - ramp, total]
    };
    let gained = |total: f64| -> f64 {
        corners(total).windows(2).map(|piece| simpson(piece[0], piece[1], 1, |t| bell(law, t, total))).sum()
    };
    let longest = change / law.acceleration + 2.0 * (change / law.jerk).sqrt() + law.acceleration / law.jerk;
    let total = bisect(0.0, longest, |total| gained(total) <= change);
    let (mut speed, mut distance) = (from.min(to), 0.0);
    for piece in corners(total).windows(2) {
        // Distance of the piece: its speed at first, and what the acceleration adds, weighted by the time left.
        let span = piece[1] - piece[0];
        distance += speed * span + simpson(piece[0], piece[1], 1, |t| bell(law, t, total) * (piece[1] - t));
        speed += simpson(piece[0], piece[1], 1, |t| bell(law, t, total));
    }
    (total, distance)
}

/// None where the stroke is too short.
pub(crate) fn s_curve(law: &SCurveLaw, distance: f64, command: f64, start: f64, end: f64) -> Option<Best> {
    let ends = start.max(end);
    best(distance, ends, command, |peak| {
        let (up, down) = (jerk_ramp(law, start, peak), jerk_ramp(law, end, peak));
        (up.0 + down.0, up.1 + down.1)
    })
}

/// The fastest stroke from rest to rest under limits of acceleration and braking over speed, smooth between the corners.
pub(crate) fn limited(
    distance: f64,
    command: f64,
    corners: &[f64],
    limits: impl Fn(f64) -> (f64, f64),
) -> Option<Best> {
    best(distance, 0.0, command, |peak| {
        let (mut time_s, mut ramps) = (0.0, 0.0);
        for pair in corners.windows(2) {
            let (low, high) = (pair[0].min(peak), pair[1].min(peak));
            let slowness = |v: f64| 1.0 / limits(v).0 + 1.0 / limits(v).1;
            time_s += simpson(low, high, PANELS, slowness);
            ramps += simpson(low, high, PANELS, |v| v * slowness(v));
        }
        (time_s, ramps)
    })
}

/// A change of speed from rest whose jerk is trapezoids: up, a hold at constant acceleration, down. All by quadrature.
#[derive(Clone, Copy, Debug)]
pub(crate) struct JerkRamp {
    pub(crate) gain: f64,
    pub(crate) duration_s: f64,
    pub(crate) distance: f64,
}

/// ∫ jerk(t)·weight(t) of one trapezoid of jerk that lasts `total`: as much as both ends and the limit leave. Its second
/// half is the first, mirrored: counted from its own end, a steep slope's time is not rounded.
fn jerk_integral(law: &TrapezoidJerkLaw, total: f64, weight: impl Fn(f64) -> f64) -> f64 {
    let jerk = |t: f64| (law.snap * t).min(law.jerk);
    let corner = (law.jerk / law.snap).min(total / 2.0);
    [(0.0, corner), (corner, total / 2.0)]
        .iter()
        .map(|(from, to)| simpson(*from, *to, 1, |t| jerk(t) * (weight(t) + weight(total - t))))
        .sum()
}

impl JerkRamp {
    fn of(law: &TrapezoidJerkLaw, rise_s: f64, hold_s: f64) -> Self {
        let acceleration = jerk_integral(law, rise_s, |_| 1.0);
        // Speed and distance that each instant's jerk makes until the end of its rise.
        let speed = jerk_integral(law, rise_s, |t| rise_s - t);
        let distance = jerk_integral(law, rise_s, |t| (rise_s - t) * (rise_s - t) / 2.0);
        let held = speed + acceleration * hold_s;
        let after_hold = distance + (speed + held) / 2.0 * hold_s;
        // The fall takes its own jerk's share off what the acceleration alone would have made.
        let gain = held + acceleration * rise_s - speed;
        let distance = after_hold + held * rise_s + acceleration * rise_s * rise_s / 2.0 - distance;
        Self { gain, duration_s: 2.0 * rise_s + hold_s, distance }
    }

    /// Longest rise: the acceleration's limit is reached at its end.
    fn longest_rise_s(law: &TrapezoidJerkLaw) -> f64 {
        let longest = 2.0 * (law.acceleration / law.snap).sqrt() + 2.0 * law.acceleration / law.jerk;
        bisect(0.0, longest, |rise_s| jerk_integral(law, rise_s, |_| 1.0) <= law.acceleration)
    }

    /// The change that just reaches the greatest acceleration.
    pub(crate) fn greatest(law: &TrapezoidJerkLaw) -> Self {
        Self::of(law, Self::longest_rise_s(law), 0.0)
    }

    /// The quickest change from rest to a speed.
    pub(crate) fn to(law: &TrapezoidJerkLaw, speed: f64) -> Self {
        let longest_s = Self::longest_rise_s(law);
        let rest = speed - Self::of(law, longest_s, 0.0).gain;
        if rest >= 0.0 {
            return Self::of(law, longest_s, rest / law.acceleration);
        }
        Self::of(law, bisect(0.0, longest_s, |rise_s| Self::of(law, rise_s, 0.0).gain <= speed), 0.0)
    }
}

pub(crate) fn trapezoid_jerk(law: &TrapezoidJerkLaw, distance: f64, command: f64) -> Option<Best> {
    best(distance, 0.0, command, |peak| {
        let ramp = JerkRamp::to(law, peak);
        // The way down is the way up, filmed backwards: the same distance.
        (2.0 * ramp.duration_s, 2.0 * ramp.distance)
    })
}

/// Acceleration of eq. 11 over J·T, at a time in phases T.
fn rounded_cusp(phase: f64) -> f64 {
    match phase {
        ..1.0 => phase,
        ..2.0 => 1.0 + (phase - 1.0) - (phase - 1.0).powi(2) / 2.0,
        ..3.0 => 1.5 - (phase - 2.0).powi(2) / 2.0,
        _ => 4.0 - phase,
    }
}

/// Time and distance of one change of speed with a rounded cusp.
pub(crate) fn cusp_ramp(law: &ImprovedSCurveLaw, from: f64, to: f64) -> (f64, f64) {
    let piecewise = |weight: fn(f64) -> f64| -> f64 {
        [0.0, 1.0, 2.0, 3.0].iter().map(|at| simpson(*at, at + 1.0, 1, |t| rounded_cusp(t) * weight(t))).sum()
    };
    let (low, gain) = (from.min(to), (to - from).abs());
    let phase_s = gain * 1.5 / (law.acceleration * piecewise(|_| 1.0));
    let rate = law.acceleration / 1.5;
    (4.0 * phase_s, 4.0 * phase_s * low + rate * phase_s * phase_s * piecewise(|t| 4.0 - t))
}

/// None where the stroke is too short.
pub(crate) fn improved_s_curve(
    law: &ImprovedSCurveLaw,
    distance: f64,
    command: f64,
    start: f64,
    end: f64,
) -> Option<Best> {
    let ends = start.max(end);
    best(distance, ends, command, |peak| {
        let (up, down) = (cusp_ramp(law, start, peak), cusp_ramp(law, end, peak));
        (up.0 + down.0, up.1 + down.1)
    })
}
