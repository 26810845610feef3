//! Figures of measured holes: e(k), speed, Z, over seconds.

use super::html::{Chart, ChartSet, Line, Table};
use super::parts::{MOST_HOLES, MOST_POINTS, rounded, with_tolerance};
use crate::control::units::rpm_from_rev_per_s;
use crate::link::sample::Scale;
use crate::run::analysis::{AnalysisListener, MeasuredHole, MeasuredRow};

/// Speed is the mean over this time: over one reading it would be mostly the encoder's steps.
const SPEED_WINDOW_S: f64 = 0.01;

/// A sample of a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Point {
    time_s: f64,
    error_um: Option<f64>,
    spindle_counts: f64,
    z_counts: f64,
}

/// A listener that keeps the curves of measured holes: the first ones, and whichever is worse than all before.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredRecorder {
    scale: Scale,
    points: Vec<Point>,
    holes: Vec<(MeasuredHole, Vec<Point>)>,
}

impl MeasuredRecorder {
    /// Of encoders of this scale.
    #[must_use]
    pub const fn new(scale: Scale) -> Self {
        Self { scale, points: Vec::new(), holes: Vec::new() }
    }

    /// The figures of each hole that was kept, the widest error first.
    #[must_use]
    pub fn charts(mut self, name: &str) -> Vec<ChartSet> {
        self.holes.sort_by(|(left, _), (right, _)| {
            let width = |hole: &MeasuredHole| hole.error_um.peak_to_peak();
            width(right).total_cmp(&width(left)).then(left.hole.cmp(&right.hole))
        });
        self.holes.iter().map(|(hole, points)| of_hole(name, self.scale, hole, points)).collect()
    }
}

impl AnalysisListener for MeasuredRecorder {
    fn row(&mut self, row: &MeasuredRow) {
        if row.kind.is_none() {
            return;
        }
        let MeasuredRow { sample, error_um, .. } = *row;
        self.points.push(Point {
            time_s: sample.time_s,
            error_um,
            spindle_counts: sample.spindle_counts,
            z_counts: sample.z_counts,
        });
    }

    /// Its samples came just before.
    fn hole(&mut self, hole: &MeasuredHole) {
        let points = std::mem::take(&mut self.points);
        let width = |hole: &MeasuredHole| hole.error_um.peak_to_peak();
        if self.holes.len() < MOST_HOLES {
            self.holes.push((hole.clone(), points));
        } else if let Some(least) =
            self.holes.iter_mut().skip(1).min_by(|(left, _), (right, _)| width(left).total_cmp(&width(right)))
            && width(&least.0) < width(hole)
        {
            *least = (hole.clone(), points);
        }
    }
}

/// Every measured hole in one line.
#[must_use]
pub fn table_of_measured(holes: &[MeasuredHole]) -> Table {
    let head = ["hole", "verdict", "start s", "time s", "depth mm", "peak rpm", "e(k) µm", "tolerance µm", "missing"];
    let rows = holes.iter().map(|hole| {
        let peak_rpm = hole.strokes.iter().map(|stroke| stroke.peak_rpm).fold(0.0, f64::max);
        vec![
            hole.hole.to_string(),
            hole.judgement().name().to_owned(),
            format!("{:.3}", hole.zero.time_s),
            format!("{:.4}", hole.end_s - hole.zero.time_s),
            format!("{:.3}", hole.reversal.depth_mm),
            format!("{peak_rpm:.0}"),
            format!("{:.1}", hole.error_um.peak_to_peak()),
            hole.tolerance_um.map_or_else(String::new, |um| format!("{um:.1}")),
            hole.missing.to_string(),
        ]
    });
    Table { head: head.map(str::to_owned).to_vec(), rows: rows.collect() }
}

fn of_hole(name: &str, scale: Scale, hole: &MeasuredHole, points: &[Point]) -> ChartSet {
    let step = points.len().div_ceil(MOST_POINTS).max(1);
    let zero = hole.zero;
    let line = |name: &str, value: &dyn Fn(usize, &Point) -> Option<f64>| {
        let kept = || points.iter().enumerate().step_by(step);
        Line {
            name: name.into(),
            x: kept().map(|(_, point)| rounded(point.time_s - zero.time_s)).collect(),
            y: kept().map(|(index, point)| value(index, point).map(rounded).filter(|um| um.is_finite())).collect(),
        }
    };
    let chart = |title: &str, y_label: &str, line: Line| Chart {
        title: title.into(),
        group: name.to_owned(),
        x_label: "time from the hole's first synchronous reading, s".into(),
        y_label: y_label.into(),
        series: vec![line],
        ..Chart::default()
    };
    let speed_rpm = |index: usize, point: &Point| {
        let before = points[..index].iter().rev().find(|before| point.time_s - before.time_s >= SPEED_WINDOW_S)?;
        let rev = (point.spindle_counts - before.spindle_counts) / scale.counts_per_rev;
        Some(rpm_from_rev_per_s(rev / (point.time_s - before.time_s)))
    };
    let error = chart("", "µm", line("measured", &|_, point| point.error_um));
    ChartSet {
        name: format!(
            "hole {}: {}, {:.1} µm peak to peak",
            hole.hole,
            hole.judgement().name(),
            hole.error_um.peak_to_peak()
        ),
        charts: vec![
            with_tolerance(error, &hole.error_um, hole.tolerance_um),
            chart("Spindle speed, mean of 10 ms", "rpm", line("measured", &speed_rpm)),
            chart(
                "Z from where the hole began",
                "mm",
                line("measured", &|_, point| Some((point.z_counts - zero.z_counts) / scale.counts_per_mm)),
            ),
        ],
    }
}
