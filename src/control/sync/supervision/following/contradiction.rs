//! The drive's effort against its encoder: a drive pushes where its axis is off, and gives the torque that it is told.
//!
//! Where the encoder reads off and the drive does not push, one of the two is wrong. A drive that obeys gives what was commanded
//! and what friction takes; one that is off gives nothing, and its encoder is right.

use super::seen::{Followed, FollowingLimits, SpindleEffort};
use crate::control::sync::supervision::alarm::{Alarm, Axis};

/// Periods for which the drive's effort has to contradict the encoder.
const CONTRADICTED_PERIODS: u32 = 5;
/// Least push, as a share of the motor's torque, that the drive has to show for what its encoder says.
const PUSH_SHARE: f64 = 0.2;
/// A drive that was saturated has an integrator that says nothing of its error for so long.
const UNWINDING_S: f64 = 0.25;
/// Share of that push that has to be seen.
const SHOWN_SHARE: f64 = 0.25;
/// Torque up to this share of the motor's is none.
const NOTHING_SHARE: f64 = 0.02;
/// Periods for which a drive gives nothing where it is told to push.
const NOTHING_PERIODS: u32 = 3;

/// Counts periods.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ContradictionMonitor {
    contradicted: u32,
    /// Of those periods, torque in all, and how far it was from what a drive gives that obeys, N·m.
    given_nm: f64,
    disobeyed_nm: f64,
    /// Periods for which a drive that was saturated may still be winding down.
    unwinding: u32,
    nothing: u32,
}

/// How far a value is from a range that is moved by something.
fn distance(value: f64, [least, most]: [f64; 2], moved: f64) -> f64 {
    (least + moved - value).max(value - most - moved).max(0.0)
}

impl ContradictionMonitor {
    pub(super) fn check(
        &mut self,
        limits: &FollowingLimits,
        spindle: &Followed,
        effort: &SpindleEffort,
    ) -> Option<Alarm> {
        if spindle.is_saturated {
            self.unwinding = (UNWINDING_S / limits.period_s) as u32;
        }
        let calm = self.unwinding == 0;
        self.unwinding = self.unwinding.saturating_sub(1);
        let Some(reported_nm) = effort.reported_nm.filter(|_| spindle.is_trusted) else {
            (self.contradicted, self.nothing) = (0, 0);
            return None;
        };
        if !calm {
            (self.contradicted, self.nothing) = (0, 0);
            return None;
        }
        let nothing = self.gives_nothing(limits, spindle, effort, reported_nm);
        nothing.or_else(|| self.contradiction(limits, spindle, effort, reported_nm))
    }

    /// The drive is told to push, gives nothing, and its axis falls behind.
    fn gives_nothing(
        &mut self,
        limits: &FollowingLimits,
        spindle: &Followed,
        effort: &SpindleEffort,
        reported_nm: f64,
    ) -> Option<Alarm> {
        let rated_nm = limits.rated_nm();
        let [least_nm, most_nm] = effort.commanded_nm;
        let commanded_nm = if least_nm > 0.0 { least_nm } else { most_nm.min(0.0) };
        let pushes = commanded_nm.abs() > PUSH_SHARE * rated_nm;
        let falls_behind = commanded_nm * spindle.error < 0.0;
        let nothing = pushes && falls_behind && reported_nm.abs() < NOTHING_SHARE * rated_nm;
        self.nothing = if nothing { self.nothing.saturating_add(1) } else { 0 };
        (self.nothing >= NOTHING_PERIODS).then_some(Alarm::SpindleTorque { torque_nm: reported_nm, commanded_nm })
    }

    /// The drive does not push as it would, were its axis where the encoder says.
    fn contradiction(
        &mut self,
        limits: &FollowingLimits,
        spindle: &Followed,
        effort: &SpindleEffort,
        reported_nm: f64,
    ) -> Option<Alarm> {
        let FollowingLimits { motor, coulomb_nm, position_gain_per_s, velocity_gain_per_s, delay_s, .. } = limits;
        // A drive without a position loop does not push against where its axis is.
        if *position_gain_per_s == 0.0 {
            return None;
        }
        let side = if spindle.error < 0.0 { -1.0 } else { 1.0 };
        // An error in proportion to the speed is a delay that is not as told, and no drive sees it.
        let delay_rev = spindle.speed.abs() * *delay_s;
        let seen_rev = (spindle.error.abs() - delay_rev).max(0.0);
        let growing = (side * spindle.error_rate).max(0.0);
        let push_nm = motor.torque_for_nm(velocity_gain_per_s * (growing + position_gain_per_s * seen_rev));
        let shown_nm = effort.commanded_nm.map(|nm| side * (nm - reported_nm)).into_iter().fold(f64::MIN, f64::max);
        let least_nm = PUSH_SHARE * limits.rated_nm();
        if push_nm <= least_nm || shown_nm >= SHOWN_SHARE * push_nm {
            (self.contradicted, self.given_nm, self.disobeyed_nm) = (0, 0.0, 0.0);
            return None;
        }
        let friction_nm = if spindle.speed < 0.0 { -coulomb_nm } else { *coulomb_nm };
        self.contradicted = self.contradicted.saturating_add(1);
        self.given_nm += reported_nm.abs();
        self.disobeyed_nm += distance(reported_nm, effort.commanded_nm, friction_nm);
        if self.contradicted < CONTRADICTED_PERIODS {
            return None;
        }
        let limit = delay_rev + least_nm / motor.torque_for_nm(velocity_gain_per_s * position_gain_per_s);
        let disobeys = self.given_nm < self.disobeyed_nm || self.disobeyed_nm > least_nm * f64::from(self.contradicted);
        Some(if disobeys {
            Alarm::SpindleFollowing { error_rev: spindle.error, limit_rev: limit }
        } else {
            Alarm::TravelMismatch { axis: Axis::Spindle, deviation: spindle.error, limit }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::examples::{effort, good, limits};
    use super::{ContradictionMonitor, Followed, SpindleEffort};
    use crate::control::sync::supervision::alarm::{Alarm, Axis};

    fn first(effort: SpindleEffort, spindle: Followed, periods: u32) -> Option<(u32, Alarm)> {
        let (mut monitor, limits) = (ContradictionMonitor::default(), limits());
        (0..periods).find_map(|k| monitor.check(&limits, &spindle, &effort).map(|alarm| (k, alarm)))
    }

    /// 0.05 rev behind: 40 and 200 1/s make 400 rev/s², for which the motor takes 10 N·m.
    fn behind() -> Followed {
        Followed { error: -0.05, ..good() }
    }

    #[test]
    fn effort_tells_a_wrong_encoder_from_a_drive_that_does_not_obey() {
        let of = |commanded_nm, reported_nm| first(effort(commanded_nm, Some(reported_nm)), behind(), 1000);
        assert_eq!(of(1.0, 9.0), None, "it pushes as it should");
        assert_eq!(of(1.0, 3.6), None, "it pushes a quarter of that");
        let Some((4, Alarm::TravelMismatch { axis, deviation, .. })) = of(1.0, 1.1) else {
            panic!("the drive sees its axis where it is to be")
        };
        assert_eq!((axis, deviation), (Axis::Spindle, -0.05));
        // Half of what it is told, or nothing against friction alone.
        for (commanded_nm, reported_nm) in [(12.0, 6.0), (0.0, 0.0)] {
            let Some((4, Alarm::SpindleFollowing { error_rev, .. })) = of(commanded_nm, reported_nm) else {
                panic!("the drive does not give {commanded_nm} N·m")
            };
            assert_eq!(error_rev, -0.05);
        }
        // Nothing is known of a drive that tells nothing, or that gives all it has.
        assert_eq!(first(effort(1.0, None), behind(), 100), None);
        assert_eq!(first(effort(-1.0, Some(-1.0)), Followed { is_saturated: true, ..behind() }, 100), None);
    }

    /// It may have been given at any of the last periods: what lies between was commanded.
    #[test]
    fn torque_that_comes_late_is_obeyed() {
        let rising = SpindleEffort { reported_nm: Some(4.0), commanded_nm: [2.0, 5.0] };
        let ahead = Followed { error: 0.05, ..good() };
        let Some((4, Alarm::TravelMismatch { .. })) = first(rising, ahead, 10) else { panic!("it obeys") };
    }

    #[test]
    fn a_drive_that_gives_nothing_is_seen_at_once() {
        let off = |error: f64| Followed { error, ..good() };
        let alarm = Alarm::SpindleTorque { torque_nm: 0.1, commanded_nm: -5.0 };
        assert_eq!(first(effort(-5.0, Some(0.1)), off(0.001), 10), Some((2, alarm)));
        assert_eq!(first(effort(-5.0, Some(0.1)), off(-0.001), 1000), None, "the loops hold against it");
        assert_eq!(first(effort(-3.9, Some(0.1)), off(0.001), 1000), None, "it may be that friction brakes");
        assert_eq!(first(effort(5.0, Some(0.5)), off(-0.001), 1000), None, "it gives something");
        let reverses = SpindleEffort { reported_nm: Some(0.1), commanded_nm: [-1.0, 16.0] };
        assert_eq!(first(reverses, off(-0.001), 1000), None);
        // It was at its limit, and its integrator winds down.
        let mut monitor = ContradictionMonitor::default();
        let saturated = Followed { is_saturated: true, ..off(0.001) };
        assert_eq!(monitor.check(&limits(), &saturated, &effort(-5.0, Some(-20.0))), None);
        assert!((0..200).all(|_| monitor.check(&limits(), &off(0.001), &effort(-5.0, Some(0.1))).is_none()));
    }
}
