//! What the panels of the error figure show, in words and in what room.

use crate::run::Verdict;
use crate::study::ErrorPoint;

use super::axis::Range;
use super::style::{WIDTH_PX, measured};

pub(super) const LEFT_PX: f64 = 72.0;
/// Room for the band's values.
pub(super) const RIGHT_PX: f64 = 108.0;

/// Points of one picture, and strokes that it marks one by one: they keep the file under 300 kB.
const MOST_POINTS: usize = 10_000;
const MOST_STROKES: usize = 400;
/// Narrower strokes than this are not marked.
const LEAST_STROKE_PX: f64 = 3.0;

/// e(k) of one law or setting.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ErrorPanel {
    /// What was run.
    pub title: String,
    /// What the thread bears, peak to peak.
    pub tolerance_um: f64,
    /// Widest band of one hole, peak to peak: what is judged. The panel's own band spans all holes.
    pub peak_to_peak_um: f64,
    /// How it was judged; the true error, which is not drawn, has a say in it.
    pub verdict: Verdict,
    /// Time from k to k + 1, in s; at 0 there is no axis of time.
    pub period_s: f64,
    /// The synchronous periods in their order; none draws an empty panel.
    pub points: Vec<ErrorPoint>,
}

/// The strokes and dwells among some points.
pub(super) fn strokes(points: &[ErrorPoint]) -> impl Iterator<Item = &[ErrorPoint]> {
    points.chunk_by(|a, b| a.hole == b.hole && a.kind == b.kind)
}

/// The panel's band in words, against its tolerance.
pub(super) fn verdict_text(panel: &ErrorPanel, band: Option<Range>) -> String {
    match band {
        None => "no synchronous periods".into(),
        Some(_) if panel.tolerance_um > 0.0 => {
            format!("peak to peak {} of {} µm", measured(panel.peak_to_peak_um), measured(panel.tolerance_um))
        }
        Some(_) => format!("peak to peak {} µm", measured(panel.peak_to_peak_um)),
    }
}

/// Where the tolerance is shaded: around the band's middle where it can hold both the band and zero, where e(k) starts.
pub(super) fn allowed(panel: &ErrorPanel, band: Option<Range>) -> Range {
    let half = panel.tolerance_um.max(0.0) / 2.0;
    let middle = match band {
        Some(band) if band.span() <= 2.0 * half => ((band.low + band.high) / 2.0).max(-half).min(half),
        _ => 0.0,
    };
    Range { low: middle - half, high: middle + half }
}

/// What the file's size leaves for each panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Budget {
    /// Columns over the whole width that keep their band.
    pub(super) columns: usize,
    /// Whether strokes and holes are marked.
    pub(super) strokes: bool,
    /// Marks of cuts this close are one.
    pub(super) gap_px: f64,
}

impl Budget {
    pub(super) fn of(panels: &[ErrorPanel]) -> Self {
        let width_px = WIDTH_PX - LEFT_PX - RIGHT_PX;
        let columns = (MOST_POINTS / (2 * panels.len())).clamp(50, width_px as usize);
        let counts: Vec<usize> = panels.iter().map(|panel| strokes(&panel.points).count()).collect();
        let narrow = counts.iter().any(|count| *count as f64 > width_px / LEAST_STROKE_PX);
        let marked = !narrow && counts.iter().sum::<usize>() <= MOST_STROKES;
        Self { columns, strokes: marked, gap_px: (panels.len() as f64).max(3.0) }
    }
}
