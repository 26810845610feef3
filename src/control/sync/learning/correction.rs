//! The correction that holes of one kind taught, along their path.

use super::kind::HoleKind;
use crate::control::math::{floor, poly::State, round};

/// Points of a learned path.
pub(super) const POINTS: usize = 1024;
/// A correction beyond this is no correction.
pub(super) const LIMIT_UM: f64 = 30.0;
/// Corrections are kept in nm: their error is far below any encoder's, and they fit two bytes.
const NM_PER_MM: f64 = 1e6;

/// What is known of one kind of hole. Indexed by the plan's time, which is the path itself: an angle would mix the stroke in
/// with the stroke out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Learned {
    pub(super) kind: HoleKind,
    /// The plan's time from one point to the next.
    pub(super) point_s: f64,
    /// Holes that taught it.
    pub(super) holes: u32,
    /// How far e(k) of these holes mostly was off zero, mm: what a further hole is judged by. 0 before the first.
    pub(super) usual_mm: f32,
    /// nm, positive into the hole.
    pub(super) correction_nm: [i16; POINTS],
}

impl Learned {
    /// Nothing learned yet.
    pub(super) fn new(kind: HoleKind, point_s: f64) -> Self {
        Self { kind, point_s, holes: 0, usual_mm: 0.0, correction_nm: [0; POINTS] }
    }

    /// The correction at an instant of the plan, with its rate by the plan's time.
    pub(super) fn at(&self, plan_s: f64) -> State {
        let at = plan_s / self.point_s;
        let index = floor(at);
        if !(index >= 0.0) {
            return State::default();
        }
        let last = POINTS - 1;
        let value = |offset: usize| {
            let nm = self.correction_nm.get((index as usize).saturating_add(offset).min(last));
            nm.map_or(0.0, |nm| f64::from(*nm) / NM_PER_MM)
        };
        let (from, to) = (value(0), value(1));
        State { position: from + (at - index) * (to - from), velocity: (to - from) / self.point_s, ..State::default() }
    }
}

/// A correction in mm as it is kept.
pub(super) fn nm(mm: f64) -> i16 {
    round(NM_PER_MM * mm) as i16
}

/// A kept correction in mm.
pub(super) fn mm(nm: i16) -> f64 {
    f64::from(nm) / NM_PER_MM
}
