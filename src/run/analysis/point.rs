//! A sample of a hole in travels.

use crate::control::sync::ErrorBand;

/// A sample of a hole in travels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Point {
    pub(super) time_s: f64,
    pub(super) z_mm: f64,
    pub(super) spindle_rev: f64,
    pub(super) spindle_rev_per_s: f64,
    pub(super) spindle_rev_per_s2: f64,
    pub(super) error_um: f64,
}

/// e(k) over some points.
pub(super) fn band<'a>(points: impl IntoIterator<Item = &'a Point>) -> ErrorBand {
    let mut band = ErrorBand::default();
    points.into_iter().for_each(|point| band.add(point.error_um));
    band
}
