//! A hole found in the data, judged.

use crate::control::cycle::{Hand, StrokeKind};
use crate::control::sync::ErrorBand;
use crate::control::units::{mm_from_um, rpm_from_rev_per_s};
use crate::link::sample::{Gap, Sample};
use crate::run::monitor::Verdict;

use super::estimate::{Estimates, estimates};
use super::point::{Point, band};
use super::row::MeasuredRow;
use super::settings::AnalysisSettings;
use super::stroke::{MeasuredStroke, kinds, strokes};
use super::travel::Travel;

/// A spindle this close to its furthest angle is at the bottom.
const BOTTOM_REV: f64 = 1e-3;
/// At the bottom for longer is a dwell.
const DWELL_S: f64 = 0.025;
/// Half the time around the reversal that its detail spans.
const REVERSAL_S: f64 = 0.02;
/// The lead-in of a stroke from rest is its first revolution.
const LEAD_IN_REV: f64 = 1.0;
/// Strokes are compared where the spindle has this share of its peak speed.
const FAST_SHARE: f64 = 0.95;

/// What a hole gets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judgement {
    /// Every reading is there.
    Judged(Verdict),
    /// Readings are missing, and what is there is within the tolerance: no pass.
    Gap,
    /// Its recording has readings that cannot be, and what is left is within the tolerance: no pass.
    Corrupt,
    /// Nobody knows what this thread bears.
    NoTolerance,
}

impl Judgement {
    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Judged(verdict) => verdict.name(),
            Self::Gap => "gap",
            Self::Corrupt => "corrupt",
            Self::NoTolerance => "no tolerance",
        }
    }
}

/// The beginning of the stroke in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeadIn {
    /// The spindle turned when Z set off: the lead-in lasts until Z had its speed, and is not judged. From rest it is
    /// the first revolution, and is judged.
    pub running_start: bool,
    /// How long.
    pub duration_s: f64,
    /// e(k) in it, µm.
    pub error_um: ErrorBand,
}

/// Around the furthest angle of the spindle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reversal {
    /// When the spindle was furthest.
    pub time_s: f64,
    /// How far.
    pub spindle_rev: f64,
    /// How deep Z was at most.
    pub depth_mm: f64,
    /// Z's deepest point less the spindle's furthest, in time: positive, Z turns later.
    pub z_later_s: f64,
    /// e(k) 20 ms to both sides, µm.
    pub error_um: ErrorBand,
}

/// What lies between stroke in and stroke out at speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InOutOffset {
    /// Mean e(k) of the stroke out less that of the stroke in.
    pub offset_um: f64,
    /// Mean speed of both, a magnitude.
    pub speed_rpm: f64,
    /// The offset in sampling periods of travel at that speed.
    pub periods: f64,
}

/// One hole of real encoders.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredHole {
    /// Number, from 1.
    pub hole: u32,
    /// Its first synchronous period, where both travels are zero.
    pub zero: Sample,
    /// Last of its samples.
    pub end_s: f64,
    /// Direction of the thread.
    pub hand: Hand,
    /// Nominal pitch.
    pub pitch_mm: f64,
    /// What the thread bears, peak to peak.
    pub tolerance_um: Option<f64>,
    /// e(k) of all judged samples, µm.
    pub error_um: ErrorBand,
    /// Strokes in their order.
    pub strokes: Vec<MeasuredStroke>,
    /// The beginning.
    pub lead_in: LeadIn,
    /// The bottom.
    pub reversal: Reversal,
    /// Between the strokes, where it stands out of what e(k) does within each.
    pub in_out_offset: Option<InOutOffset>,
    /// Places where readings are missing.
    pub gaps: u32,
    /// Readings missing there.
    pub missing: u64,
    /// The data end in it, or spindle and Z parted for good.
    pub broken: bool,
    /// Its recording has readings that no machine of these limits can show.
    pub corrupt: bool,
    /// What the data alone let one guess; none of a hole with too few samples, or with an e(k) of other causes.
    pub estimates: Option<Estimates>,
}

impl MeasuredHole {
    /// The verdict. A hole with a gap, or of a recording with corrupt readings, can fail by what is there, and cannot
    /// pass.
    #[must_use]
    pub fn judgement(&self) -> Judgement {
        let Some(tolerance_um) = self.tolerance_um else { return Judgement::NoTolerance };
        match Verdict::of(self.error_um.peak_to_peak(), tolerance_um) {
            Verdict::Fail => Judgement::Judged(Verdict::Fail),
            _ if self.corrupt => Judgement::Corrupt,
            _ if self.gaps > 0 || self.broken => Judgement::Gap,
            verdict => Judgement::Judged(verdict),
        }
    }
}

/// What the candidate knows of its hole.
pub(super) struct Found {
    pub(super) number: u32,
    pub(super) running: bool,
    pub(super) hand: f64,
    pub(super) judged_from: usize,
    pub(super) broken: bool,
}

/// Judges the samples of a hole, its zero first.
pub(super) fn measure(
    settings: &AnalysisSettings,
    found: &Found,
    samples: &[Sample],
) -> (MeasuredHole, Vec<MeasuredRow>) {
    let pitch_mm = settings.pitch_mm;
    let zero = samples.first().copied().unwrap_or_default();
    let period_s = period_s(samples);
    // What is missing before the zero is none of the hole's.
    let steps = samples.windows(2).filter(|pair| pair[1].gap != Gap::None);
    let gaps: Vec<u64> = steps.map(|pair| pair[1].k.saturating_sub(pair[0].k.saturating_add(1))).collect();
    let points = points(settings, period_s, found.hand, &zero, samples);
    let furthest_rev = points.iter().map(|point| point.spindle_rev).fold(0.0, f64::max);
    let at_bottom = |point: &Point| furthest_rev - point.spindle_rev <= BOTTOM_REV;
    let first = points.iter().position(at_bottom).unwrap_or(0);
    let last = points.iter().rposition(at_bottom).unwrap_or(0);
    let time_s = |index: usize| points.get(index).map_or(zero.time_s, |point| point.time_s);
    let dwells = time_s(last) - time_s(first) > DWELL_S;
    let turn = points.iter().position(|point| point.spindle_rev >= furthest_rev).unwrap_or(0);
    let mut kinds = kinds(pitch_mm, &points);
    if dwells {
        kinds.iter_mut().take(last + 1).skip(first).for_each(|kind| *kind = StrokeKind::Dwell);
    }
    let judged = points.get(found.judged_from..).unwrap_or_default();
    let rows = points.iter().zip(samples).zip(&kinds).map(|((point, sample), kind)| MeasuredRow {
        sample: *sample,
        hole: found.number,
        kind: Some(*kind),
        error_um: Some(point.error_um),
    });
    let deepest = points.iter().max_by(|a, b| a.z_mm.total_cmp(&b.z_mm)).copied().unwrap_or_default();
    let turn_s = time_s(turn);
    let lead_in: Vec<_> = if found.running {
        points.iter().take(found.judged_from).collect()
    } else {
        points.iter().take_while(|point| point.spindle_rev <= LEAD_IN_REV).collect()
    };
    let hole = MeasuredHole {
        hole: found.number,
        zero,
        end_s: points.last().map_or(zero.time_s, |point| point.time_s),
        hand: if found.hand > 0.0 { Hand::Right } else { Hand::Left },
        pitch_mm,
        tolerance_um: settings.tolerance_um,
        error_um: band(judged),
        strokes: strokes(kinds.get(found.judged_from..).unwrap_or_default(), judged),
        lead_in: LeadIn {
            running_start: found.running,
            duration_s: lead_in.last().map_or(0.0, |point| point.time_s - zero.time_s),
            error_um: band(lead_in),
        },
        reversal: Reversal {
            time_s: turn_s,
            spindle_rev: furthest_rev,
            depth_mm: deepest.z_mm,
            z_later_s: deepest.time_s - turn_s,
            error_um: band(points.iter().filter(|point| (point.time_s - turn_s).abs() <= REVERSAL_S)),
        },
        in_out_offset: in_out_offset(settings.pitch_mm, period_s, judged),
        gaps: gaps.len() as u32,
        missing: gaps.iter().sum(),
        broken: found.broken,
        corrupt: false,
        estimates: estimates(pitch_mm, judged),
    };
    let rows = rows.collect();
    (hole, rows)
}

fn in_out_offset(pitch_mm: f64, period_s: f64, points: &[Point]) -> Option<InOutOffset> {
    let side = |sign: f64| {
        let speed = |point: &Point| sign * point.spindle_rev_per_s;
        let peak = points.iter().map(speed).fold(0.0, f64::max);
        let fast: Vec<_> = points.iter().filter(|point| peak > 1.0 && speed(point) >= FAST_SHARE * peak).collect();
        let mean = |of: &dyn Fn(&Point) -> f64| fast.iter().map(|point| of(point)).sum::<f64>() / fast.len() as f64;
        let wander_um = band(fast.iter().copied()).peak_to_peak();
        (!fast.is_empty()).then(|| (mean(&|point| point.error_um), mean(&speed), wander_um))
    };
    let ((in_um, in_speed, in_wander_um), (out_um, out_speed, out_wander_um)) = (side(1.0)?, side(-1.0)?);
    let speed = (in_speed + out_speed) / 2.0;
    let offset_um = out_um - in_um;
    let period_mm = pitch_mm * speed * period_s;
    (offset_um.abs() > in_wander_um.max(out_wander_um)).then(|| InOutOffset {
        offset_um,
        speed_rpm: rpm_from_rev_per_s(speed),
        periods: mm_from_um(offset_um) / period_mm,
    })
}

/// Mean time between readings, missing ones counted; 1 ms of a single one.
fn period_s(samples: &[Sample]) -> f64 {
    let ends = samples.first().zip(samples.last());
    let mean = ends.map(|(first, last)| (last.time_s - first.time_s) / last.k.saturating_sub(first.k) as f64);
    mean.filter(|mean| mean.is_normal() && *mean > 0.0).unwrap_or(1e-3)
}

/// Travels, error and speed at each sample. Speeds are chords of some 4 ms: finer ones would be count noise. Accelerations
/// are of some 20 ms, which an eccentric encoder's ripple hardly gets through.
fn points(settings: &AnalysisSettings, period_s: f64, hand: f64, zero: &Sample, samples: &[Sample]) -> Vec<Point> {
    let periods = |half_chord_s: f64| ((half_chord_s / period_s).round() as usize).max(1);
    let reach = periods(0.002);
    let travel = |sample: &Sample| Travel::between(zero, sample, hand, &settings.scale);
    let at = |(index, sample): (usize, &Sample)| {
        let from = samples.get(index.saturating_sub(reach)).unwrap_or(sample);
        let to = samples.get((index + reach).min(samples.len() - 1)).unwrap_or(sample);
        let Travel { z_mm, spindle_rev } = travel(sample);
        let seconds = to.time_s - from.time_s;
        let way_rev = travel(to).spindle_rev - travel(from).spindle_rev;
        Point {
            time_s: sample.time_s,
            z_mm,
            spindle_rev,
            spindle_rev_per_s: if seconds > 0.0 { way_rev / seconds } else { 0.0 },
            spindle_rev_per_s2: 0.0,
            error_um: travel(sample).error_um(settings.pitch_mm),
        }
    };
    let mut points: Vec<Point> = samples.iter().enumerate().map(at).collect();
    let reach = periods(0.01);
    for index in reach..points.len().saturating_sub(reach) {
        let (from, to) = (points[index - reach], points[index + reach]);
        let seconds = to.time_s - from.time_s;
        if seconds > 0.0 {
            points[index].spindle_rev_per_s2 = (to.spindle_rev_per_s - from.spindle_rev_per_s) / seconds;
        }
    }
    points
}
