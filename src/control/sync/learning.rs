//! Learning over holes of the same tap, pitch and depth: what was wrong at a point of the path is put right there.

use crate::control::cycle::TapCycle;
use crate::control::machine::SyncSpec;
use crate::control::math::{ceil, floor, poly::State};
use crate::control::units::mm_from_um;

/// Points of a learned path.
const POINTS: usize = 1024;
/// A correction beyond this is no correction.
const MAX_UM: f64 = 30.0;

/// e(k) along the path, and the correction learned from it. Indexed by the plan's time, which is the path itself: an angle
/// would mix the two ways through a point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Learning {
    sync: SyncSpec,
    period_s: f64,
    /// Which holes it is for: their cycle, and whether Z comes to R moving into them, which leaves its friction and lost
    /// motion the other way round.
    of: Option<(TapCycle, bool)>,
    point_s: f64,
    duration_s: f64,
    /// mm, positive into the hole.
    correction: [f32; POINTS],
    error: [f32; POINTS],
    count: [u8; POINTS],
}

impl Learning {
    pub(super) fn new(sync: SyncSpec, period_s: f64) -> Self {
        Self {
            sync,
            period_s,
            of: None,
            point_s: period_s,
            duration_s: 0.0,
            correction: [0.0; POINTS],
            error: [0.0; POINTS],
            count: [0; POINTS],
        }
    }

    /// A hole begins; another kind of hole forgets all.
    pub(super) fn begin(&mut self, cycle: &TapCycle, duration_s: f64, from_above: bool) {
        let bottom_mm = -cycle.depth_mm();
        let shape = TapCycle { x_mm: 0.0, y_mm: 0.0, r_plane_mm: 0.0, bottom_mm, return_mm: 0.0, ..*cycle };
        let kind = Some((shape, from_above));
        if self.of != kind {
            self.correction = [0.0; POINTS];
            self.of = kind;
        }
        self.duration_s = duration_s;
        self.point_s = self.period_s * ceil(duration_s / self.period_s / (POINTS - 2) as f64).max(1.0);
        self.error = [0.0; POINTS];
        self.count = [0; POINTS];
    }

    /// e(k) at an instant of the plan.
    pub(super) fn observe(&mut self, plan_s: f64, error_mm: f64) {
        if plan_s < 0.0 {
            return;
        }
        let point = floor(plan_s / self.point_s + 0.5) as usize;
        if let (Some(sum), Some(count)) = (self.error.get_mut(point), self.count.get_mut(point))
            && *count < u8::MAX
        {
            *sum += error_mm as f32;
            *count += 1;
        }
    }

    /// The correction at an instant of the plan, with its rate by the plan's time.
    pub(super) fn correction(&self, plan_s: f64) -> State {
        let at = plan_s / self.point_s;
        let index = floor(at);
        if !(index >= 0.0) {
            return State::default();
        }
        let value = |offset: usize| self.correction.get(index as usize + offset).copied().map_or(0.0, f64::from);
        let (from, to) = (value(0), value(1));
        State { position: from + (at - index) * (to - from), velocity: (to - from) / self.point_s, ..State::default() }
    }

    /// The hole is done: learns from it.
    pub(super) fn finish(&mut self) {
        let mut last = 0.0;
        for (sum, count) in self.error.iter_mut().zip(&self.count) {
            if *count > 0 {
                last = *sum / f32::from(*count);
            }
            *sum = last;
        }
        let lead = floor(self.sync.learning_lead_s / self.point_s + 0.5) as usize;
        let width = floor(self.sync.learning_smoothing_s / self.point_s + 0.5) as usize;
        let limit = mm_from_um(MAX_UM) as f32;
        let (gain, kept) = (self.sync.learning_gain as f32, self.sync.learning_forgetting as f32);
        let taper_points = self.sync.learning_taper_s / self.point_s;
        let end = self.duration_s / self.point_s;
        for index in 0..POINTS {
            // A triangle about the point: zero phase.
            let (mut sum, mut weight) = (0.0, 0.0);
            for offset in 0..=2 * width {
                let share = (width + 1 - offset.abs_diff(width)) as f32;
                let value = (index + lead + offset).checked_sub(width).and_then(|at| self.error.get(at));
                if let Some(value) = value {
                    sum += share * value;
                    weight += share;
                }
            }
            // At rest before and after, whatever was learned: a correction that stayed on would shift the next hole's zero.
            let from_ends = (index as f64).min(end - index as f64) / taper_points;
            let taper = from_ends.clamp(0.0, 1.0) as f32;
            if let (Some(correction), true) = (self.correction.get_mut(index), weight > 0.0) {
                let learned = kept * *correction - gain * taper * sum / weight;
                *correction = learned.max(-limit).min(limit);
            }
        }
    }
}
