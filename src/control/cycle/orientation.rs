//! Spindle orientation: from rest to a hole's start angle, by the shortest way.

use super::error::CycleError;
use super::hole::TapCycle;
use super::plan::CyclePlan;
use crate::control::math::{poly::State, round};
use crate::control::profile::{Profile, StrokeRequest};
use crate::control::units::rev_per_s_from_rpm;

/// An angle this small in rev is the rounding of one that is met already.
const NO_TURN_REV: f64 = 1e-9;

/// The spindle's way from rest to a start angle, at most half a turn.
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    /// Where it begins, rev.
    pub from_rev: f64,
    /// Where it ends, rev.
    pub to_rev: f64,
    /// The travel between, a magnitude, over time.
    pub profile: Profile,
}

impl Orientation {
    /// ±1: 1 where it turns as M03 does.
    #[must_use]
    pub fn direction(&self) -> f64 {
        if self.to_rev < self.from_rev { -1.0 } else { 1.0 }
    }

    /// The spindle at a time from its start.
    #[must_use]
    pub fn at(&self, t_s: f64) -> State {
        self.profile.at(t_s).scaled(self.direction()).shifted(self.from_rev)
    }
}

impl TapCycle {
    /// Where a spindle that has come to rest at an angle rests before the hole: the start angle in the turn that is nearest, or
    /// there where the hole has none.
    #[must_use]
    pub fn rest_rev(&self, from_rev: f64) -> f64 {
        self.start_angle_rev.map_or(from_rev, |angle_rev| angle_rev + round(from_rev - angle_rev))
    }
}

impl CyclePlan {
    /// The spindle's way from rest at an angle to the hole's start angle, under the S-curve, which has a stroke of any length; none
    /// where the hole has no start angle, or where the spindle rests there already.
    ///
    /// # Errors
    /// [`CycleError::Law`] for an angle that is no finite number.
    ///
    /// ```
    /// use rigidtap::control::{cycle::{CyclePlan, TapCycle}, machine::{Law, Machine}};
    /// let hole = TapCycle { start_angle_rev: Some(0.25), ..TapCycle::right_hand(0.0, -10.0, 1.0, 3000.0) };
    /// let plan = CyclePlan::new(hole, &Machine::reference(), Law::TorqueCurve).unwrap();
    /// let turn = plan.orientation(7.9).unwrap().unwrap();
    /// assert_eq!(turn.to_rev, 8.25);
    /// let end = turn.at(turn.profile.duration_s());
    /// assert!((end.position - 8.25).abs() < 1e-9 && end.velocity.abs() < 1e-9);
    /// ```
    pub fn orientation(&self, from_rev: f64) -> Result<Option<Orientation>, CycleError> {
        let to_rev = self.cycle().rest_rev(from_rev);
        let distance = (to_rev - from_rev).abs();
        if distance < NO_TURN_REV {
            return Ok(None);
        }
        let request = StrokeRequest { distance, command: rev_per_s_from_rpm(self.cycle().speed_rpm) };
        let profile = self.machine.s_curve().plan(request).map_err(CycleError::Law)?;
        Ok(Some(Orientation { from_rev, to_rev, profile }))
    }
}
