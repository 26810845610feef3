//! What the analysis has to know beside the samples.

use crate::link::sample::Scale;

/// What the analysis has to know beside the samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnalysisSettings {
    /// What the counts are.
    pub scale: Scale,
    /// Nominal pitch, above 0.
    pub pitch_mm: f64,
    /// What the thread bears, peak to peak; without it there is no verdict.
    pub tolerance_um: Option<f64>,
}
