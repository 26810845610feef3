//! What runs and plans yield, made ready for the plots.

use crate::run::{ProgramOutcome, RowStage};
use crate::study::{ErrorSeries, TimelineEntry, TimelineKind};

use super::plot::{ErrorPanel, HoleMark, ProgramPicture, ZPoint};

/// A panel of one program's e(k).
#[must_use]
pub fn error_panel(title: String, outcome: &ProgramOutcome, series: ErrorSeries) -> ErrorPanel {
    // Holes of one program may differ in pitch; the tightest tolerance is drawn.
    let tolerance_um = outcome.holes.iter().map(|hole| hole.tolerance_um).fold(f64::INFINITY, f64::min);
    ErrorPanel {
        title,
        tolerance_um: if tolerance_um.is_finite() { tolerance_um } else { 0.0 },
        peak_to_peak_um: outcome.holes.iter().map(|hole| hole.error_um.peak_to_peak()).fold(0.0, f64::max),
        verdict: outcome.verdict(),
        points: series.points,
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
