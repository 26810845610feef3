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

    /// The plan, to be interrupted or let go on: what was kept of it may change.
    pub(super) fn interrupt(&mut self) -> &mut CyclePlan {
        self.legs = [const { None }; KEPT];
        self.interrupted = true;
        &mut self.plan
    }

    /// Whether the plan was not left to itself.
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
