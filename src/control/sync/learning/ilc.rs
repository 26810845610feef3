//! The hole under way, and what it teaches its kind.

use super::correction::{LIMIT_UM, Learned, POINTS, mm, nm};
use super::kind::HoleKind;
use super::usual::Usual;
use crate::control::cycle::CyclePlan;
use crate::control::machine::SyncSpec;
use crate::control::math::{ceil, floor, poly::State};
use crate::control::units::mm_from_um;

/// Kinds of holes that are kept apart.
pub(super) const KINDS: usize = 8;
/// A point that is off by more than so many times what points mostly are teaches as if it were off by that.
const MOST_USUAL: f32 = 3.0;
/// A hole that is off by more than so many times what holes of its kind mostly are is judged by these.
const MOST_GROWTH: f32 = 2.0;
/// Below this no point stands out, µm: a tenth of what is asked for.
const LEAST_USUAL_UM: f64 = 0.5;
/// Memory of what holes of a kind are mostly off by, in holes.
const USUAL_HOLES: f32 = 4.0;

/// e(k) along the path, and what was learned of each kind of hole.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync) struct Learning {
    sync: SyncSpec,
    period_s: f64,
    pub(super) kinds: [Option<Learned>; KINDS],
    /// When each kind's last hole began, counted in holes.
    pub(super) used: [u32; KINDS],
    pub(super) holes: u32,
    /// The kind of the hole under way.
    active: Option<usize>,
    point_s: f64,
    /// Sum of this hole's e(k) at each point, in mm, and how many there were.
    error: [f32; POINTS],
    count: [u8; POINTS],
}

impl Learning {
    /// Nothing learned yet.
    pub(in crate::control::sync) fn new(sync: SyncSpec, period_s: f64) -> Self {
        Self {
            sync,
            period_s,
            kinds: [const { None }; KINDS],
            used: [0; KINDS],
            holes: 0,
            active: None,
            point_s: period_s,
            error: [0.0; POINTS],
            count: [0; POINTS],
        }
    }

    /// A hole begins. Where its kind is not known, the one that was used least lately gives way once it has taught anything.
    pub(in crate::control::sync) fn begin(&mut self, plan: &CyclePlan) {
        self.begin_kind(HoleKind::of(plan));
    }

    pub(super) fn begin_kind(&mut self, kind: HoleKind) {
        // A point holds at most as many periods as can be counted; longer paths have fewer points.
        self.point_s = self.period_s * ceil(kind.duration_s / self.period_s / (POINTS - 2) as f64).max(1.0);
        let known =
            self.kinds.iter().position(|learned| learned.as_ref().is_some_and(|learned| learned.kind.is(&kind)));
        let slot = known.unwrap_or_else(|| {
            let oldest = (0..).zip(&self.used).min_by_key(|(_, used)| **used);
            oldest.map_or(0, |(slot, _)| slot)
        });
        if let (None, Some(place)) = (known, self.kinds.get_mut(slot)) {
            *place = Some(Learned::new(kind, self.point_s));
        }
        self.holes = self.holes.saturating_add(1);
        if let Some(used) = self.used.get_mut(slot) {
            *used = self.holes;
        }
        self.active = Some(slot);
        self.error = [0.0; POINTS];
        self.count = [0; POINTS];
    }

    fn active(&self) -> Option<&Learned> {
        self.kinds.get(self.active?)?.as_ref()
    }

    /// The repeatable share of e(k) at an instant of the plan.
    pub(in crate::control::sync) fn observe(&mut self, plan_s: f64, error_mm: f64) {
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
    pub(in crate::control::sync) fn correction(&self, plan_s: f64) -> State {
        self.active().map_or_else(State::default, |learned| learned.at(plan_s))
    }

    /// Means in place of sums, the last one where a point has none; returns what the hole was mostly off by.
    fn mean_errors(&mut self) -> f32 {
        let (mut last, mut usual) = (0.0, Usual::new());
        for (sum, count) in self.error.iter_mut().zip(&self.count) {
            if *count > 0 {
                last = *sum / f32::from(*count);
                usual.add(last);
            }
            *sum = last;
        }
        usual.mm()
    }

    /// The hole is done: updates the correction by lead, smoothing and gain, from errors that are cut to what is usual.
    pub(in crate::control::sync) fn finish(&mut self) {
        let usual_mm = self.mean_errors();
        let Self { sync, point_s, error, kinds, active, .. } = self;
        let Some(learned) = active.take().and_then(|slot| kinds.get_mut(slot)?.as_mut()) else { return };
        let judged_mm = if learned.holes == 0 { usual_mm } else { usual_mm.min(MOST_GROWTH * learned.usual_mm) };
        let most_mm = MOST_USUAL * judged_mm.max(mm_from_um(LEAST_USUAL_UM) as f32);
        error.iter_mut().for_each(|error| *error = error.max(-most_mm).min(most_mm));
        learned.usual_mm += (judged_mm - learned.usual_mm) / (learned.holes as f32 + 1.0).min(USUAL_HOLES);
        learned.holes = learned.holes.saturating_add(1);

        let lead = floor(sync.learning_lead_s / *point_s + 0.5) as usize;
        let width = floor(sync.learning_smoothing_s / *point_s + 0.5) as usize;
        let limit_mm = mm_from_um(LIMIT_UM);
        let taper_points = sync.learning_taper_s / *point_s;
        for (index, correction) in learned.correction_nm.iter_mut().enumerate() {
            // A triangle about the point: zero phase.
            let (mut sum, mut weight) = (0.0, 0.0);
            for offset in 0..=2 * width {
                let share = (width + 1 - offset.abs_diff(width)) as f32;
                let value = (index + lead + offset).checked_sub(width).and_then(|at| error.get(at.min(POINTS - 1)));
                if let Some(value) = value {
                    sum += share * value;
                    weight += share;
                }
            }
            if !(weight > 0.0) {
                continue;
            }
            // At rest before, whatever was learned; what stays on at the end decays after the hole.
            let taper = (index as f64 / taper_points).clamp(0.0, 1.0);
            let taught = sync.learning_gain * taper * f64::from(sum / weight);
            *correction = nm((sync.learning_forgetting * mm(*correction) - taught).max(-limit_mm).min(limit_mm));
        }
    }
}
