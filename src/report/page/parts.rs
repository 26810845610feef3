//! What the figures of simulated and of measured holes share.

use super::html::{Chart, Level};
use crate::control::sync::ErrorBand;

/// Most holes whose curves are kept: the first ones, and whichever is worse than all before.
pub(super) const MOST_HOLES: usize = 60;
/// Most points of a line.
pub(super) const MOST_POINTS: usize = 4000;

/// Title, band and levels of a figure of e(k). The band has the tolerance's width about the middle of e(k): peak to peak
/// is judged, not the sign.
pub(super) fn with_tolerance(chart: Chart, error_um: &ErrorBand, tolerance_um: Option<f64>) -> Chart {
    let Some(tolerance_um) = tolerance_um else {
        return Chart { title: "Synchronisation error e(k)".into(), ..chart };
    };
    let band = (error_um.count() > 0).then(|| {
        let middle = f64::midpoint(error_um.min(), error_um.max());
        [middle - tolerance_um / 2.0, middle + tolerance_um / 2.0]
    });
    let name = format!("tolerance {tolerance_um:.1} µm peak to peak");
    Chart {
        title: format!("Synchronisation error e(k), {name}"),
        band,
        limits: band.iter().flatten().map(|y| Level { y: *y, name: name.clone() }).collect(),
        ..chart
    }
}

/// Six digits: more than any picture shows.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
