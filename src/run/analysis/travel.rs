//! Travels of spindle and Z, and e(k) of them.

use crate::control::sync::synchronisation_error_mm;
use crate::control::units::um_from_mm;
use crate::link::sample::{Sample, Scale};

/// Both travels since a zero, in mm and rev, and e(k) of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Travel {
    pub(super) z_mm: f64,
    pub(super) spindle_rev: f64,
}

impl Travel {
    /// `hand` is 1 for a right-hand thread, −1 for a left-hand one.
    pub(super) fn between(zero: &Sample, sample: &Sample, hand: f64, scale: &Scale) -> Self {
        Self {
            z_mm: -(sample.z_counts - zero.z_counts) / scale.counts_per_mm,
            spindle_rev: hand * (sample.spindle_counts - zero.spindle_counts) / scale.counts_per_rev,
        }
    }

    pub(super) fn error_um(&self, pitch_mm: f64) -> f64 {
        um_from_mm(synchronisation_error_mm(self.z_mm, pitch_mm, self.spindle_rev))
    }
}
