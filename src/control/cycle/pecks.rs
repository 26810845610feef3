//! The strokes of a hole by their number: where each begins and ends. Nothing is stored, so that any number of pecks takes
//! the same memory.

use super::hole::{Retract, TapCycle};
use super::stroke::StrokeKind;
use crate::control::math::ceil;

/// Most pecks of a hole: beyond it a peck is shallower than any chip is long.
pub const MAX_PECKS: usize = 50;
/// Most strokes of a hole: in and out of each peck, and the dwell.
pub const MAX_STROKES: usize = 2 * MAX_PECKS + 1;

/// One stroke before it has a time law. Depths count from the R plane, in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct StrokeSpan {
    pub(super) kind: StrokeKind,
    pub(super) from_mm: f64,
    pub(super) to_mm: f64,
}

/// How a hole is divided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pecks {
    depth_mm: f64,
    peck_mm: f64,
    /// Depth that a peck's stroke out ends at, below the peck's own; none is the R plane.
    back_mm: Option<f64>,
    count: usize,
    dwells: bool,
}

impl Pecks {
    /// Of a checked cycle; how many pecks it would need, where those are too many.
    pub(super) fn of(cycle: &TapCycle) -> Result<Self, f64> {
        let depth_mm = cycle.depth_mm();
        let peck_mm = cycle.peck_mm.unwrap_or(depth_mm).min(depth_mm);
        // A last peck of less than a billionth is rounding.
        let needed = ceil(depth_mm / peck_mm - 1e-9).max(1.0);
        if !(needed <= MAX_PECKS as f64) {
            return Err(needed);
        }
        let back_mm = match cycle.retract {
            Some(Retract::ChipBreak { back_mm }) => Some(back_mm),
            Some(Retract::Full) | None => None,
        };
        Ok(Self { depth_mm, peck_mm, back_mm, count: needed as usize, dwells: cycle.dwell_s > 0.0 })
    }

    /// How many strokes there are.
    pub(super) fn strokes(&self) -> usize {
        2 * self.count + usize::from(self.dwells)
    }

    /// The stroke of a number below [`Pecks::strokes`]: in, out, in, out, …, the dwell before the last stroke out.
    pub(super) fn stroke(&self, index: usize) -> StrokeSpan {
        let last_in = 2 * self.count - 2;
        if index > last_in {
            let kind = if self.dwells && index == last_in + 1 { StrokeKind::Dwell } else { StrokeKind::Out };
            let to_mm = if kind == StrokeKind::Dwell { self.depth_mm } else { 0.0 };
            return StrokeSpan { kind, from_mm: self.depth_mm, to_mm };
        }
        let peck = index / 2;
        let bottom_mm = self.bottom_mm(peck);
        if index.is_multiple_of(2) {
            let from_mm = peck.checked_sub(1).map_or(0.0, |before| self.turn_mm(before));
            StrokeSpan { kind: StrokeKind::In, from_mm, to_mm: bottom_mm }
        } else {
            StrokeSpan { kind: StrokeKind::Out, from_mm: bottom_mm, to_mm: self.turn_mm(peck) }
        }
    }

    fn bottom_mm(&self, peck: usize) -> f64 {
        if peck + 1 == self.count { self.depth_mm } else { (peck + 1) as f64 * self.peck_mm }
    }

    /// Where a peck's stroke out ends, the last one apart.
    fn turn_mm(&self, peck: usize) -> f64 {
        self.back_mm.map_or(0.0, |back_mm| (self.bottom_mm(peck) - back_mm).max(0.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn depths(retract: Retract, dwell_s: f64) -> Vec<(StrokeKind, f64, f64)> {
        let hole = TapCycle::right_hand(2.0, -8.0, 1.0, 1000.0);
        let pecks = Pecks::of(&TapCycle { peck_mm: Some(4.0), retract: Some(retract), dwell_s, ..hole }).unwrap();
        let span = |index| pecks.stroke(index);
        (0..pecks.strokes()).map(span).map(|stroke| (stroke.kind, stroke.from_mm, stroke.to_mm)).collect()
    }

    #[test]
    fn both_kinds_reach_the_bottom_and_come_back_to_r() {
        use StrokeKind::{Dwell, In, Out};
        assert_eq!(
            depths(Retract::ChipBreak { back_mm: 0.5 }, 0.0),
            [(In, 0.0, 4.0), (Out, 4.0, 3.5), (In, 3.5, 8.0), (Out, 8.0, 7.5), (In, 7.5, 10.0), (Out, 10.0, 0.0)]
        );
        assert_eq!(
            depths(Retract::Full, 0.1),
            [
                (In, 0.0, 4.0),
                (Out, 4.0, 0.0),
                (In, 0.0, 8.0),
                (Out, 8.0, 0.0),
                (In, 0.0, 10.0),
                (Dwell, 10.0, 10.0),
                (Out, 10.0, 0.0)
            ]
        );
        // Further back than it went: the R plane.
        assert_eq!(depths(Retract::ChipBreak { back_mm: 5.0 }, 0.0)[1], (Out, 4.0, 0.0));
    }
}
