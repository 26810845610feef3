//! What runs and plans yield, made ready for the plots.

use crate::control::cycle::StrokeKind;
use crate::run::{HoleOutcome, ProgramOutcome, RowStage};
use crate::study::{ErrorSeries, TimelineEntry, TimelineKind};

use super::plot::{ErrorPanel, HoleMark, ProgramPicture, ZPoint};

/// What of a program is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Selection {
    /// One hole; every hole without it.
    pub hole: Option<u32>,
    /// One stroke of each; every stroke without it.
    pub stroke: Option<StrokeKind>,
}

/// A panel of one program's e(k); the verdict is that of the holes drawn.
#[must_use]
pub fn error_panel(
    title: String,
    outcome: &ProgramOutcome,
    series: ErrorSeries,
    period_s: f64,
    selection: Selection,
) -> ErrorPanel {
    let Selection { hole, stroke } = selection;
    let drawn = || outcome.holes.iter().filter(|found| hole.is_none_or(|hole| found.hole == hole));
    // Holes of one program may differ in pitch; the tightest tolerance is drawn.
    let tolerance_um = drawn().map(|hole| hole.tolerance_um).fold(f64::INFINITY, f64::min);
    let mut points = series.points;
    points
        .retain(|point| hole.is_none_or(|hole| point.hole == hole) && stroke.is_none_or(|stroke| point.kind == stroke));
    let which = hole.map_or_else(String::new, |hole| format!(", hole {hole}"));
    let part = stroke.map_or_else(String::new, |stroke| format!(", stroke {}", stroke.name()));
    ErrorPanel {
        title: format!("{title}{which}{part}"),
        tolerance_um: if tolerance_um.is_finite() { tolerance_um } else { 0.0 },
        peak_to_peak_um: drawn().map(|hole| hole.error_um.peak_to_peak()).fold(0.0, f64::max),
        verdict: if hole.is_some() {
            drawn().map(HoleOutcome::verdict).max().unwrap_or_default()
        } else {
            outcome.verdict()
        },
        period_s,
        points,
    }
}

/// Adds a step of a planned program: its hole and its way, and Z over time.
pub fn add_step(picture: &mut ProgramPicture, entry: &TimelineEntry) {
    let [x_mm, y_mm, _] = entry.to_mm;
    let stage = match entry.what {
        TimelineKind::Stroke { kind, .. } => RowStage::Stroke(kind),
        TimelineKind::SpindleWait => RowStage::Orient,
        _ => RowStage::Rapid,
    };
    if let TimelineKind::Stroke { hole, .. } = entry.what
        && picture.holes.last().is_none_or(|last| last.hole != hole)
    {
        picture.holes.push(HoleMark { hole, x_mm, y_mm, verdict: None });
    }
    picture.path_mm.push([x_mm, y_mm]);
    for &(time_s, z_mm) in &entry.z {
        // Sums of durations: one that ends where the next begins may end a last bit after it.
        let time_s = picture.z.last().map_or(time_s, |before| time_s.max(before.time_s));
        picture.z.push(ZPoint { time_s, z_mm, stage });
    }
}
