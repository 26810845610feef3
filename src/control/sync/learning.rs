//! Iterative learning control over holes of the same tap, pitch and depth (Bristow, Tharayil and Alleyne, A survey of
//! iterative learning control, IEEE Control Systems Magazine 26(3), 2006): what was wrong at a point of the path is put
//! right there in the next hole.

use crate::control::cycle::TapCycle;
use crate::control::machine::SyncSpec;
use crate::control::math::{ceil, floor, poly::State};
use crate::control::units::mm_from_um;

/// Points of a learned path.
const POINTS: usize = 1024;
/// A correction beyond this is no correction.
const LIMIT_UM: f64 = 30.0;

/// e(k) along the path, and the correction learned from it. Indexed by the plan's time, which is the path itself: an angle
/// would mix the stroke in with the stroke out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Learning {
    sync: SyncSpec,
    period_s: f64,
    /// Which holes it is for.
    of: Option<TapCycle>,
    /// The plan's time from one point to the next, whole periods.
    point_s: f64,
    duration_s: f64,
    /// mm, positive into the hole.
    correction: [f32; POINTS],
    /// Sum of this hole's e(k) at each point, in mm, and how many there were.
    error: [f32; POINTS],
    count: [u8; POINTS],
}

impl Learning {
    /// Nothing learned yet.
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

    /// A hole begins; another kind of hole forgets everything.
    pub(super) fn begin(&mut self, cycle: &TapCycle, duration_s: f64) {
        let bottom_mm = -cycle.depth_mm();
        let shape = Some(TapCycle { x_mm: 0.0, y_mm: 0.0, r_plane_mm: 0.0, bottom_mm, return_mm: 0.0, ..*cycle });
        // Another time law takes another time, and is at other places at the same one.
        if self.of != shape || self.duration_s != duration_s {
            self.correction = [0.0; POINTS];
            self.of = shape;
        }
        self.duration_s = duration_s;
        self.point_s = self.period_s * ceil(duration_s / self.period_s / (POINTS - 2) as f64).max(1.0);
        self.error = [0.0; POINTS];
        self.count = [0; POINTS];
    }

    /// The repeatable share of e(k) at an instant of the plan.
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
        let last = POINTS - 1;
        let value =
            |offset: usize| self.correction.get((index as usize + offset).min(last)).copied().map_or(0.0, f64::from);
        let (from, to) = (value(0), value(1));
        State { position: from + (at - index) * (to - from), velocity: (to - from) / self.point_s, ..State::default() }
    }

    /// The hole is done: updates the correction by lead, smoothing and gain.
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
        let limit = mm_from_um(LIMIT_UM) as f32;
        let (gain, kept) = (self.sync.learning_gain as f32, self.sync.learning_forgetting as f32);
        let taper_points = self.sync.learning_taper_s / self.point_s;
        for index in 0..POINTS {
            // A triangle about the point: zero phase.
            let (mut sum, mut weight) = (0.0, 0.0);
            for offset in 0..=2 * width {
                let share = (width + 1 - offset.abs_diff(width)) as f32;
                let value =
                    (index + lead + offset).checked_sub(width).and_then(|at| self.error.get(at.min(POINTS - 1)));
                if let Some(value) = value {
                    sum += share * value;
                    weight += share;
                }
            }
            // At rest before, whatever was learned; what stays on at the end decays after the hole.
            let taper = (index as f64 / taper_points).clamp(0.0, 1.0) as f32;
            if let (Some(correction), true) = (self.correction.get_mut(index), weight > 0.0) {
                let learned = kept * *correction - gain * taper * sum / weight;
                *correction = learned.max(-limit).min(limit);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Learning;
    use crate::control::cycle::TapCycle;
    use crate::control::machine::{MachineSpec, SyncSpec};

    const PERIOD_S: f64 = 0.001;
    const DURATION_S: f64 = 0.5;

    fn sync() -> SyncSpec {
        MachineSpec::reference().sync
    }

    fn hole() -> TapCycle {
        TapCycle::right_hand(0.0, -10.0, 1.0, 3000.0)
    }

    /// Holes of one kind, with an error that depends on the plan's time.
    fn taught(holes: usize, duration_s: f64, error_mm: impl Fn(usize) -> f64) -> Learning {
        let mut learning = Learning::new(sync(), PERIOD_S);
        for _ in 0..holes {
            learning.begin(&hole(), duration_s);
            for k in 0..=(duration_s / PERIOD_S) as usize + 10 {
                learning.observe(k as f64 * PERIOD_S, error_mm(k));
            }
            learning.finish();
        }
        learning
    }

    fn at(learning: &Learning, plan_s: f64) -> f64 {
        learning.correction(plan_s).position
    }

    fn assert_near_mm(actual: f64, expected: f64) {
        assert!((actual - expected).abs() < 1e-7, "{actual} {expected}");
    }

    #[test]
    fn takes_off_its_share_of_the_error() {
        let gain = sync().learning_gain;
        assert_near_mm(at(&taught(1, DURATION_S, |_| 0.01), 0.25), -gain * 0.01);
        let twice = -gain * 0.01 * (1.0 + sync().learning_forgetting);
        assert_near_mm(at(&taught(2, DURATION_S, |_| 0.01), 0.25), twice);
        // Longer than there are points of a period each.
        assert_near_mm(at(&taught(1, 5.0, |_| 0.01), 4.5), -gain * 0.01);
    }

    #[test]
    fn nothing_at_the_start_and_what_it_was_after_the_end() {
        let learning = taught(20, DURATION_S, |_| 0.01);
        for plan_s in [-0.001, 0.0] {
            assert_near_mm(at(&learning, plan_s), 0.0);
        }
        for plan_s in [DURATION_S, DURATION_S + 0.005, 100.0] {
            assert_near_mm(at(&learning, plan_s), at(&learning, 0.25));
        }
        let learning = taught(1, DURATION_S, |_| 0.01);
        let halfway_s = 0.5 * sync().learning_taper_s;
        assert_near_mm(at(&learning, halfway_s), 0.5 * at(&learning, 0.25));
    }

    #[test]
    fn bounded() {
        for error_mm in [5.0, -5.0] {
            assert_near_mm(at(&taught(3, DURATION_S, |_| error_mm), 0.25), -0.03_f64.copysign(error_mm));
        }
    }

    /// One error comes back as a triangle about where it was, earlier by the lead.
    #[test]
    fn smoothing_has_no_phase() {
        let learning = taught(1, DURATION_S, |k| if k == 250 { 0.09 } else { 0.0 });
        let (lead, width) = (3, 2);
        assert_eq!(sync().learning_lead_s, f64::from(lead) * PERIOD_S);
        assert_eq!(sync().learning_smoothing_s, f64::from(width) * PERIOD_S);
        for offset in -4_i32..=4 {
            let share = f64::from((width + 1 - offset.abs()).max(0)) / 9.0;
            let plan_s = f64::from(250 - lead + offset) * PERIOD_S;
            assert_near_mm(at(&learning, plan_s), -sync().learning_gain * 0.09 * share);
        }
    }

    #[test]
    fn rate_is_that_of_the_correction() {
        let learning = taught(1, DURATION_S, |k| 0.01 * (k as f64 * 0.02).sin());
        let (before, after) = (learning.correction(0.2502), learning.correction(0.2508));
        let rate = (after.position - before.position) / 0.0006;
        assert!(rate.abs() > 1e-3 && (before.velocity - rate).abs() < 1e-9, "{rate} {before:?}");
    }

    #[test]
    fn kept_for_the_same_hole_elsewhere_and_for_no_other() {
        let learned = taught(1, DURATION_S, |_| 0.01);
        let after = |cycle: &TapCycle| {
            let mut learning = learned.clone();
            learning.begin(cycle, DURATION_S);
            at(&learning, 0.25)
        };
        let elsewhere = TapCycle { x_mm: 7.0, y_mm: 8.0, r_plane_mm: 5.0, bottom_mm: -5.0, return_mm: 20.0, ..hole() };
        assert_eq!(after(&elsewhere), at(&learned, 0.25));
        let others = [
            TapCycle { bottom_mm: -11.0, ..hole() },
            TapCycle { pitch_mm: 1.25, ..hole() },
            TapCycle { speed_rpm: 2000.0, ..hole() },
            TapCycle { dwell_s: 0.1, ..hole() },
        ];
        for other in others {
            assert_eq!(after(&other), 0.0, "{other:?}");
        }
    }
}
