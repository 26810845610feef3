//! A hole's strokes: in and out, with pecks several times.

use crate::control::cycle::StrokeKind;
use crate::control::sync::ErrorBand;
use crate::control::units::rpm_from_rev_per_s;

use super::point::{Point, band};

/// Spindle and Z both turned back this far, Z in pitches: another stroke.
const TURN_REV: f64 = 0.05;

/// e(k) of one stroke, with the hole's zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredStroke {
    /// In, dwell or out.
    pub kind: StrokeKind,
    /// First to last sample.
    pub duration_s: f64,
    /// Greatest speed, a magnitude.
    pub peak_rpm: f64,
    /// e(k), µm.
    pub error_um: ErrorBand,
}

/// In or out, point by point: a stroke ends where the spindle turned, once Z turned with it.
pub(super) fn kinds(pitch_mm: f64, points: &[Point]) -> Vec<StrokeKind> {
    let mut kinds = Vec::with_capacity(points.len());
    let (mut kind, mut sign, mut turn) = (StrokeKind::In, 1.0, 0);
    let (mut spindle_rev, mut z_rev) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    for (index, point) in points.iter().enumerate() {
        kinds.push(kind);
        let (spindle_now_rev, z_now_rev) = (sign * point.spindle_rev, sign * point.z_mm / pitch_mm);
        if spindle_now_rev >= spindle_rev {
            (spindle_rev, turn) = (spindle_now_rev, index);
        }
        z_rev = f64::max(z_rev, z_now_rev);
        if spindle_rev - spindle_now_rev > TURN_REV && z_rev - z_now_rev > TURN_REV {
            kind = if kind == StrokeKind::In { StrokeKind::Out } else { StrokeKind::In };
            sign = -sign;
            kinds.iter_mut().skip(turn + 1).for_each(|place| *place = kind);
            (spindle_rev, z_rev, turn) = (-spindle_now_rev, -z_now_rev, index);
        }
    }
    kinds
}

/// The strokes of points and their kinds.
pub(super) fn strokes(kinds: &[StrokeKind], points: &[Point]) -> Vec<MeasuredStroke> {
    let mut rest = points;
    let next = kinds.chunk_by(PartialEq::eq).filter_map(|kinds| {
        let (points, after) = rest.split_at_checked(kinds.len())?;
        rest = after;
        stroke(*kinds.first()?, points)
    });
    next.collect()
}

fn stroke(kind: StrokeKind, points: &[Point]) -> Option<MeasuredStroke> {
    let (first, last) = (points.first()?, points.last()?);
    let peak = points.iter().map(|point| point.spindle_rev_per_s.abs()).fold(0.0, f64::max);
    Some(MeasuredStroke {
        kind,
        duration_s: last.time_s - first.time_s,
        peak_rpm: rpm_from_rev_per_s(peak),
        error_um: band(points),
    })
}
