//! Which tap cuts in what, so that what was measured of one is not taken for another.

use crate::control::cycle::CyclePlan;

/// Tap, pitch and material, as two numbers that a record of doubles keeps whole; zeros before the first hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct TapKind {
    high: f64,
    low: f64,
}

impl TapKind {
    pub(super) fn of(plan: &CyclePlan) -> Self {
        let cycle = plan.cycle();
        let mixed = plan.machine().tap_fingerprint() ^ cycle.pitch_mm.to_bits().rotate_left(17) ^ u64::from(cycle.tool);
        Self { high: (mixed >> 32) as f64, low: (mixed & 0xffff_ffff) as f64 }
    }

    /// To be written down and put back.
    pub(super) fn numbers_mut(&mut self) -> [&mut f64; 2] {
        [&mut self.high, &mut self.low]
    }
}
