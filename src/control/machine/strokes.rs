//! The spindle's strokes under each of the time laws.

use super::Machine;
use super::law::Law;
use crate::control::profile::{Profile, ProfileError, StrokeRequest, Turns};

impl Machine {
    /// A stroke of the spindle in rev and rev/s, from rest to rest unless the law says otherwise.
    ///
    /// # Errors
    /// As the law's planner.
    ///
    /// ```
    /// use rigidtap::control::{machine::{Law, Machine}, profile::StrokeRequest};
    /// let machine = Machine::reference();
    /// let request = StrokeRequest { distance: 25.0, command: 3000.0 / 60.0 };
    /// let [banded, s_curve] = [Law::TorqueCurve, Law::SCurve].map(|law| machine.stroke(law, request).unwrap());
    /// assert!(banded.duration_s() < s_curve.duration_s());
    /// ```
    pub fn stroke(&self, law: Law, request: StrokeRequest) -> Result<Profile, ProfileError> {
        self.turning_stroke(law, request, Turns::default())
    }

    /// A stroke as [`Machine::stroke`], with the accelerations at its ends that [`Machine::turn_acceleration`] allows.
    /// Laws that cannot turn without coming to rest ignore them.
    ///
    /// # Errors
    /// As the law's planner.
    pub fn turning_stroke(&self, law: Law, request: StrokeRequest, turns: Turns) -> Result<Profile, ProfileError> {
        match law {
            Law::TorqueCurve => self.torque_curve.plan(request),
            Law::SCurve => self.s_curve.plan(request),
            Law::Linear => self.linear.plan(request),
            Law::TrapezoidJerk => self.trapezoid_jerk.plan(request),
            Law::ImprovedSCurve => self.improved_s_curve.plan(request),
            Law::TorqueLimit => self.torque_limit.plan(request),
            Law::TorqueCurveSmooth => self.torque_curve_smooth.plan(request, turns),
        }
    }

    /// The acceleration in rev/s² that the spindle can keep through its reversal from one stroke to the next: the
    /// greatest that both can take; 0 under laws that cannot turn without coming to rest.
    ///
    /// # Errors
    /// As the law's planner.
    pub fn turn_acceleration(&self, law: Law, strokes: [StrokeRequest; 2]) -> Result<f64, ProfileError> {
        match law {
            Law::TorqueCurveSmooth => {
                let [before, after] = strokes;
                let law = &self.torque_curve_smooth;
                Ok(law.turn_acceleration(before)?.min(law.turn_acceleration(after)?))
            }
            Law::TorqueCurve
            | Law::SCurve
            | Law::Linear
            | Law::TrapezoidJerk
            | Law::ImprovedSCurve
            | Law::TorqueLimit => Ok(0.0),
        }
    }
}
