//! What the data alone let one guess of the machine. Guesses: nothing of them enters e(k) or a verdict.
//!
//! The synchronizer's identification needs forces, the motor's encoder and the machine; here there are two counts and a
//! pitch, so this fits the causes of e(k) instead.

use std::f64::consts::TAU;

use nalgebra::{SMatrix, SVector};

use crate::control::units::{DEG_PER_REV, mm_from_um, um_from_mm};

use super::point::Point;

/// Estimates by one linear least-squares fit of e(k) on five causes at once, and a constant, where the spindle has at
/// least a quarter of its peak speed: starts and reversals ring.
/// e = c + (ratio − 1)·p·θ − lag·p·ω + lag²/2·p·dω/dt − backlash/2·sign ω + a·sin 2πθ + b·cos 2πθ, the lag's square from a
/// first fit without it: left free, the acceleration passes for a pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimates {
    /// Real pitch over the nominal one.
    pub pitch_ratio: f64,
    /// How much later Z is than the spindle; negative, Z is ahead.
    pub z_lag_s: f64,
    /// What e(k) gains at the reversal, lag apart: positive where Z stays behind the turn, as lost motion makes it.
    pub backlash_um: f64,
    /// Amplitude of what repeats with each revolution, as an angle of the spindle.
    pub eccentricity_deg: f64,
    /// The same as an axial error.
    pub eccentricity_um: f64,
    /// What the fit leaves of e(k), root mean square.
    pub residual_um: f64,
}

const CAUSES: usize = 6;
/// Place of the lag among them.
const LAG: usize = 2;
/// Fewer samples say nothing.
const LEAST_SAMPLES: usize = 50;
/// Slower than this share of the peak speed the axes ring.
const STEADY_SHARE: f64 = 0.25;

type Causes = SVector<f64, CAUSES>;

fn causes(pitch_mm: f64, point: &Point) -> Causes {
    let (sin, cos) = (TAU * point.spindle_rev).sin_cos();
    let speed = point.spindle_rev_per_s;
    Causes::from([1.0, pitch_mm * point.spindle_rev, -pitch_mm * speed, -speed.signum() / 2.0, sin, cos])
}

/// What the fit may leave of e(k), in pitches: beyond it e(k) has causes that are not looked for.
const MOST_RESIDUAL: f64 = 0.01;

/// None where the samples cannot tell the causes apart, or where e(k) has others.
pub(super) fn estimates(pitch_mm: f64, points: &[Point]) -> Option<Estimates> {
    let peak = points.iter().map(|point| point.spindle_rev_per_s.abs()).fold(0.0, f64::max);
    let points: Vec<_> =
        points.iter().filter(|point| peak > 0.0 && point.spindle_rev_per_s.abs() >= STEADY_SHARE * peak).collect();
    if points.len() < LEAST_SAMPLES {
        return None;
    }
    let first = fit(pitch_mm, &points, 0.0)?;
    let lag_s = first[LAG];
    let fit = fit(pitch_mm, &points, lag_s)?;
    let square = |point: &&Point| (left_mm(pitch_mm, point, lag_s) - causes(pitch_mm, point).dot(&fit)).powi(2);
    let residual_mm = (points.iter().map(square).sum::<f64>() / points.len() as f64).sqrt();
    let eccentricity_mm = fit[4].hypot(fit[5]);
    Some(Estimates {
        pitch_ratio: 1.0 + fit[1],
        z_lag_s: fit[LAG],
        backlash_um: um_from_mm(fit[3]),
        eccentricity_deg: eccentricity_mm / pitch_mm * DEG_PER_REV,
        eccentricity_um: um_from_mm(eccentricity_mm),
        residual_um: um_from_mm(residual_mm),
    })
    .filter(|found| mm_from_um(found.residual_um) <= MOST_RESIDUAL * pitch_mm)
}

/// e(k) less what the square of a lag makes of an acceleration.
fn left_mm(pitch_mm: f64, point: &Point, lag_s: f64) -> f64 {
    mm_from_um(point.error_um) - pitch_mm * lag_s * lag_s / 2.0 * point.spindle_rev_per_s2
}

/// The causes' shares in e(k); none where they cannot be told apart.
fn fit(pitch_mm: f64, points: &[&Point], lag_s: f64) -> Option<Causes> {
    let mut normal = SMatrix::<f64, CAUSES, CAUSES>::zeros();
    let mut moment = Causes::zeros();
    for point in points {
        let causes = causes(pitch_mm, point);
        normal += causes * causes.transpose();
        moment += causes * left_mm(pitch_mm, point, lag_s);
    }
    // To one diagonal of ones, so that units do not decide what counts as singular.
    let size = normal.diagonal().map(f64::sqrt);
    if size.iter().any(|size| !(*size > 0.0)) {
        return None;
    }
    let scaled =
        SMatrix::<f64, CAUSES, CAUSES>::from_fn(|row, column| normal[(row, column)] / (size[row] * size[column]));
    Some(scaled.cholesky()?.solve(&moment.component_div(&size)).component_div(&size))
}
