//! The plan of a hole on the clock: its time, and where the spindle is to be around the present.

use crate::control::cycle::{CyclePlan, Interrupted, InterruptionError, Stroke, StrokeKind, StrokeState};
use crate::control::math::{ceil, poly::State};

/// Strokes kept: the one in force and those beside it, since looking ahead may reach over a joint.
const KEPT: usize = 3;
/// Share of a period that a sum of periods may be off by rounding.
const ROUNDING: f64 = 1e-6;

/// A plan with the strokes around the present kept, so that any instant near it costs no planning.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync) struct Trajectory {
    plan: CyclePlan,
    /// Each at its number modulo the size.
    strokes: [Option<(usize, Stroke)>; KEPT],
    interrupted: bool,
    /// From when on the plan says what was commanded: before its last change it may have said something else.
    valid_from_s: f64,
    period_s: f64,
    /// When the hole's first synchronous period was.
    start_s: Option<f64>,
    /// By so much the plan's time is behind the clock's, and by how much more in the next period.
    delay_s: f64,
    next_delay_s: f64,
    /// The axes' motion ends so many periods after the plan.
    tail_periods: f64,
}

impl Trajectory {
    /// A plan that has not begun; the axes' motion ends `tail_s` after it.
    pub(in crate::control::sync) fn new(plan: CyclePlan, period_s: f64, tail_s: f64) -> Self {
        Self {
            plan,
            strokes: [const { None }; KEPT],
            interrupted: false,
            valid_from_s: f64::NEG_INFINITY,
            period_s,
            start_s: None,
            delay_s: 0.0,
            next_delay_s: 0.0,
            tail_periods: ceil(tail_s / period_s - ROUNDING),
        }
    }

    pub(in crate::control::sync) fn plan(&self) -> &CyclePlan {
        &self.plan
    }

    /// The hole's first synchronous period is that of `now_s`.
    pub(in crate::control::sync) fn begin(&mut self, now_s: f64) {
        self.start_s = Some(now_s);
    }

    pub(in crate::control::sync) fn has_begun(&self) -> bool {
        self.start_s.is_some()
    }

    /// The plan's time in the period of `now_s`; 0 before the hole's first.
    pub(in crate::control::sync) fn plan_s(&self, now_s: f64) -> f64 {
        self.start_s.map_or(0.0, |start_s| now_s - start_s - self.delay_s)
    }

    /// The same, later by what a sum of periods may be off by rounding. A joint of the plan that lies on a period has then begun
    /// in it, whatever the clock's time is.
    pub(in crate::control::sync) fn joint_safe_plan_s(&self, now_s: f64) -> f64 {
        self.plan_s(now_s) + 0.5 * ROUNDING * self.period_s
    }

    /// One period in which the plan's time runs at a path rate of at most 1.
    pub(in crate::control::sync) fn scale_time(&mut self, rate: f64) {
        self.next_delay_s = (1.0 - rate) * self.period_s;
        self.delay_s += self.next_delay_s;
    }

    /// Whether the axes still move at a time of the plan: its end acts a whole number of periods after the first, and then as
    /// late as any other setpoint.
    pub(in crate::control::sync) fn is_synchronous(&self, plan_s: f64) -> bool {
        let whole_periods = ceil(self.plan.duration_s() / self.period_s - ROUNDING);
        plan_s <= (whole_periods + self.tail_periods + ROUNDING) * self.period_s
    }

    /// The plan's time of the period of `now_s`, which has not been commanded yet.
    fn upcoming_s(&self, now_s: f64) -> f64 {
        if self.has_begun() { self.plan_s(now_s) - self.next_delay_s } else { 0.0 }
    }

    /// The plan, to be changed from a time on: nothing that was kept of it stands.
    fn change(&mut self, from_s: f64) -> &mut CyclePlan {
        self.strokes = [const { None }; KEPT];
        self.valid_from_s = from_s;
        &mut self.plan
    }

    /// [`CyclePlan::stop`] from the period of `now_s` on.
    pub(in crate::control::sync) fn stop(&mut self, now_s: f64) {
        let plan_s = self.upcoming_s(now_s);
        self.change(plan_s).stop(plan_s);
        self.interrupted |= self.plan.interrupted_at(plan_s).is_some();
    }

    /// [`CyclePlan::hold_at`] from the period of `now_s` on.
    pub(in crate::control::sync) fn hold_at(&mut self, now_s: f64, rest_rev: f64) {
        let plan_s = self.upcoming_s(now_s);
        self.change(plan_s).hold_at(plan_s, rest_rev);
        self.interrupted = true;
    }

    /// [`CyclePlan::retract`].
    pub(in crate::control::sync) fn retract(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        let plan_s = self.upcoming_s(now_s);
        self.change(plan_s).retract(plan_s)
    }

    /// [`CyclePlan::resume`].
    pub(in crate::control::sync) fn resume(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        let plan_s = self.upcoming_s(now_s);
        self.change(plan_s).resume(plan_s)
    }

    /// What a stopped hole does at a time of the plan.
    pub(in crate::control::sync) fn interruption(&self, plan_s: f64) -> Option<Interrupted> {
        self.plan.interrupted_at(plan_s)
    }

    /// Whether the plan was ever stopped on its way.
    pub(in crate::control::sync) fn was_interrupted(&self) -> bool {
        self.interrupted
    }

    /// Where the spindle was commanded to be at a time of the plan in the past; none before the plan's last change.
    pub(in crate::control::sync) fn past(&mut self, t_s: f64) -> Option<State> {
        (t_s >= self.valid_from_s).then(|| self.at(t_s).spindle)
    }

    /// Where the spindle is to be at a time of the plan; at rest before its start and after its end.
    pub(in crate::control::sync) fn at(&mut self, t_s: f64) -> StrokeState {
        if t_s < 0.0 {
            return StrokeState { kind: StrokeKind::In, phase: 0, spindle: State::default() };
        }
        let number = self.plan.stroke_at(t_s);
        let plan = &self.plan;
        let at_rest = StrokeState { kind: StrokeKind::Out, phase: 0, spindle: State::default() };
        let Some(slot) = self.strokes.get_mut(number % KEPT) else { return at_rest };
        if slot.as_ref().is_none_or(|(kept, _)| *kept != number) {
            *slot = Some((number, plan.stroke(number)));
        }
        slot.as_ref().map_or(at_rest, |(_, stroke)| stroke.at(t_s))
    }
}

#[cfg(test)]
mod tests {
    use super::Trajectory;
    use crate::control::cycle::{CyclePlan, Retract, TapCycle};
    use crate::control::machine::{Law, Machine};
    use crate::control::math::poly::State;

    const PERIOD_S: f64 = 0.001;
    /// What looking ahead reaches for in one period.
    const AHEAD_S: [f64; 3] = [0.0, 0.003, 0.0005];

    fn plan() -> CyclePlan {
        let hole = TapCycle {
            peck_mm: Some(4.0),
            retract: Some(Retract::ChipBreak { back_mm: 1.0 }),
            dwell_s: 0.1,
            ..TapCycle::right_hand(0.0, -10.0, 1.0, 3000.0)
        };
        CyclePlan::new(hole, &Machine::reference(), Law::TorqueCurve).unwrap()
    }

    fn begun() -> Trajectory {
        let mut trajectory = Trajectory::new(plan(), PERIOD_S, 0.0);
        trajectory.begin(0.0);
        trajectory
    }

    fn assert_same(trajectory: &mut Trajectory, plan: &CyclePlan, from_s: f64, to_s: f64) {
        for k in 0..((to_s - from_s) / 0.0007) as u32 {
            for ahead_s in AHEAD_S {
                let t_s = from_s + 0.0007 * f64::from(k) + ahead_s;
                assert_eq!(trajectory.at(t_s), plan.at(t_s), "{t_s}");
            }
        }
    }

    #[test]
    fn every_instant_is_the_plans() {
        let (plan, mut trajectory) = (plan(), begun());
        assert!(plan.stroke_count() > 4);
        assert_same(&mut trajectory, &plan, 0.0, plan.duration_s() + 0.05);
    }

    #[test]
    fn rests_before_its_start_and_after_its_end() {
        let mut trajectory = begun();
        let end_s = trajectory.plan().duration_s();
        for t_s in [-0.001, -1e-9, end_s + 0.001, end_s + 10.0] {
            let State { position, velocity, acceleration, .. } = trajectory.at(t_s).spindle;
            assert!(position.abs() < 1e-9 && velocity == 0.0 && acceleration == 0.0, "{t_s}");
        }
    }

    #[test]
    fn what_was_kept_is_not_used_after_a_change() {
        // Just before a joint the stroke after it is kept already, and a stop delays it.
        for stroke in plan().strokes().skip(1) {
            let stop_s = stroke.start_s - 0.001;
            let (mut plan, mut trajectory) = (plan(), begun());
            assert_same(&mut trajectory, &plan, stop_s - 0.01, stop_s);
            trajectory.stop(stop_s);
            plan.stop(stop_s);
            assert_same(&mut trajectory, &plan, stop_s, 2.0);
            trajectory.resume(2.0).unwrap();
            plan.resume(2.0).unwrap();
            assert_same(&mut trajectory, &plan, 2.0, plan.duration_s() + 0.05);
            assert!(trajectory.was_interrupted());
        }
    }

    #[test]
    fn interrupted_by_what_stops_it_alone() {
        let mut trajectory = begun();
        assert!(trajectory.retract(0.1).is_err());
        trajectory.stop(trajectory.plan().duration_s() + 0.01);
        assert!(!trajectory.was_interrupted());
        trajectory.stop(0.1);
        assert!(trajectory.was_interrupted());
    }

    /// Ten periods at half the rate put the plan five behind the clock.
    #[test]
    fn a_slower_rate_delays_the_plan() {
        let mut trajectory = begun();
        (0..10).for_each(|_| trajectory.scale_time(0.5));
        assert!((trajectory.plan_s(0.02) - 0.015).abs() < 1e-12);
        let end_s = trajectory.plan().duration_s();
        assert!(trajectory.is_synchronous(end_s) && !trajectory.is_synchronous(end_s + 2.0 * PERIOD_S));
        assert!(!Trajectory::new(plan(), PERIOD_S, 0.0).has_begun());
    }
}
