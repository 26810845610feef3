//! Who looks on while samples are analysed.

use crate::control::sync::ErrorBand;
use crate::link::sample::Sample;

use super::hole::MeasuredHole;
use super::row::MeasuredRow;

/// A hole under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutting {
    /// Hole, from 1.
    pub hole: u32,
    /// Newest sample.
    pub sample: Sample,
    /// Z's travel into the hole.
    pub z_travel_mm: f64,
    /// e(k).
    pub error_um: f64,
    /// e(k) so far.
    pub band_um: ErrorBand,
}

/// Who looks on.
pub trait AnalysisListener {
    /// A sample, some time after it came: its hole may have to be done first.
    fn row(&mut self, _row: &MeasuredRow) {}
    /// The newest sample of a hole under way, at once.
    fn cutting(&mut self, _cutting: &Cutting) {}
    /// e(k) has left the tolerance; once a hole, at once.
    fn alarm(&mut self, _cutting: &Cutting) {}
    /// A hole is done.
    fn hole(&mut self, _hole: &MeasuredHole) {}
}

/// Nobody looks.
impl AnalysisListener for () {}
