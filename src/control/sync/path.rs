//! The plan around one instant.

use crate::control::cycle::{CyclePlan, Leg, LegKind, LegState};
use crate::control::math::poly::State;

/// Legs kept: the one in force and those beside it, since a lag or a lead may reach over a joint.
const KEPT: usize = 3;

/// A plan with the legs around the present kept, so that any instant near it costs no planning.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Path {
    plan: CyclePlan,
    /// Each at its number modulo the size.
    legs: [Option<(usize, Leg)>; KEPT],
    interrupted: bool,
}

impl Path {
    pub(super) fn new(plan: CyclePlan) -> Self {
        Self { plan, legs: [const { None }; KEPT], interrupted: false }
    }

    pub(super) fn plan(&self) -> &CyclePlan {
        &self.plan
    }

    /// The plan, to be changed: nothing that was kept of it stands.
    pub(super) fn plan_mut(&mut self) -> &mut CyclePlan {
        self.legs = [const { None }; KEPT];
        &mut self.plan
    }

    /// [`CyclePlan::stop`].
    pub(super) fn stop(&mut self, t_s: f64) {
        self.plan_mut().stop(t_s);
        self.interrupted |= self.plan.interrupted_at(t_s).is_some();
    }

    /// Whether the plan was ever stopped on its way.
    pub(super) fn interrupted(&self) -> bool {
        self.interrupted
    }

    /// Where the spindle is to be at a time of the hole; at rest before its start and after its end.
    pub(super) fn at(&mut self, t_s: f64) -> LegState {
        if t_s < 0.0 {
            return LegState { kind: LegKind::In, phase: 0, spindle: State::default() };
        }
        let number = self.plan.leg_at(t_s);
        let plan = &self.plan;
        let at_rest = LegState { kind: LegKind::Out, phase: 0, spindle: State::default() };
        let Some(slot) = self.legs.get_mut(number % KEPT) else { return at_rest };
        if slot.as_ref().is_none_or(|(kept, _)| *kept != number) {
            *slot = Some((number, plan.leg(number)));
        }
        slot.as_ref().map_or(at_rest, |(_, leg)| leg.at(t_s))
    }
}

#[cfg(test)]
mod tests {
    use super::Path;
    use crate::control::cycle::{CyclePlan, Retract, TapCycle};
    use crate::control::machine::{Law, Machine};
    use crate::control::math::poly::State;

    /// What lags and leads reach for in one period, the earliest last.
    const AROUND_S: [f64; 4] = [0.0, 0.003, -0.0005, -0.004];

    fn plan() -> CyclePlan {
        let hole = TapCycle {
            peck_mm: Some(4.0),
            retract: Some(Retract::ChipBreak { back_mm: 1.0 }),
            dwell_s: 0.1,
            ..TapCycle::right_hand(0.0, -10.0, 1.0, 3000.0)
        };
        CyclePlan::new(hole, &Machine::reference(), Law::TorqueCurve).unwrap()
    }

    fn assert_same(path: &mut Path, plan: &CyclePlan, from_s: f64, to_s: f64) {
        for k in 0..((to_s - from_s) / 0.0007) as u32 {
            for around_s in AROUND_S {
                let t_s = from_s + 0.0007 * f64::from(k) + around_s;
                if t_s >= 0.0 {
                    assert_eq!(path.at(t_s), plan.at(t_s), "{t_s}");
                }
            }
        }
    }

    #[test]
    fn every_instant_is_the_plans() {
        let (plan, mut path) = (plan(), Path::new(plan()));
        assert!(plan.leg_count() > 4);
        assert_same(&mut path, &plan, 0.0, plan.duration_s() + 0.05);
    }

    #[test]
    fn rests_before_its_start_and_after_its_end() {
        let mut path = Path::new(plan());
        let end_s = path.plan().duration_s();
        for t_s in [-0.001, -1e-9, end_s + 0.001, end_s + 10.0] {
            let State { position, velocity, acceleration, .. } = path.at(t_s).spindle;
            assert!(position.abs() < 1e-9 && velocity == 0.0 && acceleration == 0.0, "{t_s}");
        }
    }

    #[test]
    fn what_was_kept_is_not_used_after_a_change() {
        // Just before a joint the leg after it is kept already, and a stop delays it.
        for leg in plan().legs().skip(1) {
            let stop_s = leg.start_s - 0.001;
            let (mut plan, mut path) = (plan(), Path::new(plan()));
            assert_same(&mut path, &plan, stop_s - 0.01, stop_s);
            path.stop(stop_s);
            plan.stop(stop_s);
            assert_same(&mut path, &plan, stop_s, 2.0);
            path.plan_mut().resume(2.0).unwrap();
            plan.resume(2.0).unwrap();
            assert_same(&mut path, &plan, 2.0, plan.duration_s() + 0.05);
            assert!(path.interrupted());
        }
    }

    #[test]
    fn interrupted_by_what_stops_it_alone() {
        let mut path = Path::new(plan());
        assert!(path.plan_mut().retract(0.1).is_err());
        let end_s = path.plan().duration_s();
        path.stop(end_s + 0.01);
        assert!(!path.interrupted());
        path.stop(0.1);
        assert!(path.interrupted());
    }
}
