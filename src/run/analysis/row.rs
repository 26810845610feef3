//! A sample with what the analysis says of it.

use crate::control::cycle::StrokeKind;
use crate::link::sample::Sample;

/// A sample, classified.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredRow {
    /// The sample.
    pub sample: Sample,
    /// Hole, from 1; 0 outside.
    pub hole: u32,
    /// Stroke of the hole; none outside.
    pub kind: Option<StrokeKind>,
    /// e(k); none outside.
    pub error_um: Option<f64>,
}
