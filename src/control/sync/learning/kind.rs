//! What makes holes alike, so that what one of them taught is right for the next.

use crate::control::cycle::{CyclePlan, TapCycle};

/// R planes that differ by no more are one place of Z: what screw and guide are off by has hardly changed, and work pieces are
/// not clamped more alike.
const SAME_Z_MM: f64 = 0.5;
/// Depths and times that differ by no more are the same.
const SAME_RATIO: f64 = 1e-6;

/// Shape, tool, height and time law of a hole, and what it is cut in. Where X and Y stand and where Z returns to is of no matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct HoleKind {
    /// The cycle, moved to X0 Y0 with R at Z0.
    pub(super) shape: TapCycle,
    /// Where R lies on the machine: the screw's error is that of a place.
    pub(super) r_plane_mm: f64,
    /// Another time law takes another time, and is at other places at the same one.
    pub(super) duration_s: f64,
    /// [`Machine::tap_fingerprint`](crate::control::machine::Machine::tap_fingerprint): tap and material.
    pub(super) tap: u64,
}

impl HoleKind {
    pub(super) fn of(plan: &CyclePlan) -> Self {
        let cycle = plan.cycle();
        let bottom_mm = -cycle.depth_mm();
        Self {
            shape: TapCycle { x_mm: 0.0, y_mm: 0.0, r_plane_mm: 0.0, bottom_mm, return_mm: 0.0, ..*cycle },
            r_plane_mm: cycle.r_plane_mm,
            duration_s: plan.duration_s(),
            tap: plan.machine().tap_fingerprint(),
        }
    }

    /// Whether what one of them taught is right for the other. Depth and time of a hole that is shifted differ in their last bits.
    pub(super) fn is(&self, other: &Self) -> bool {
        let shape = TapCycle { bottom_mm: self.shape.bottom_mm, ..other.shape };
        let near = |left: f64, right: f64| (left - right).abs() <= SAME_RATIO * left.abs();
        self.shape == shape
            && self.tap == other.tap
            && near(self.shape.bottom_mm, other.shape.bottom_mm)
            && near(self.duration_s, other.duration_s)
            && (self.r_plane_mm - other.r_plane_mm).abs() <= SAME_Z_MM
    }
}
