//! The governor: a motor weaker than its file takes the same path in more time.

use crate::control::math::sqrt;

use super::identify::Identified;

/// Share of the motor's torque left to the control itself.
const RESERVE_SHARE: f64 = 0.03;
/// Slowest pace that a path is taken at: below it something else is wrong.
const SLOWEST_PACE: f64 = 0.3;

/// What a plan asks of the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Load {
    /// Greatest share of the motor's torque that accelerates the file's inertia.
    pub(super) inertia_share: f64,
    /// The motor's torque at the plan's greatest speed.
    pub(super) top_nm: f64,
    /// The file's friction there.
    pub(super) friction_nm: f64,
}

/// How fast the plan's time runs against the clock's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Governor {
    /// Greatest fall of the pace per second.
    fall_per_s: f64,
    /// Share of the torque curve that a sagging supply takes away.
    sag_ratio: f64,
    load: Load,
    /// Seconds of the plan per second of the clock, at most 1.
    pace: f64,
    slope_per_s: f64,
}

impl Governor {
    /// At the plan's own pace.
    pub(super) fn new(fall_per_s: f64, sag_ratio: f64, load: Load) -> Self {
        Self { fall_per_s, sag_ratio, load, pace: 1.0, slope_per_s: 0.0 }
    }

    /// The pace at which the plan stays within the motor: accelerations grow with its square.
    fn wanted(&self, known: &Identified) -> f64 {
        let drag_share = (self.load.friction_nm + known.spindle_drag_nm).max(0.0) / self.load.top_nm;
        let left = (known.torque_limit_ratio * (1.0 - self.sag_ratio) - drag_share - RESERVE_SHARE).max(0.0);
        let asked = self.load.inertia_share * known.inertia_ratio;
        if asked <= left { 1.0 } else { sqrt(left / asked).max(SLOWEST_PACE) }
    }

    /// A hole begins at rest: any pace can be taken at once.
    pub(super) fn begin(&mut self, identified: &Identified) {
        (self.pace, self.slope_per_s) = (self.wanted(identified), 0.0);
    }

    /// One period on the way: never faster, since what a stroke has shown stays true in it.
    pub(super) fn step(&mut self, identified: &Identified, period_s: f64) {
        let wanted = self.wanted(identified).min(self.pace);
        self.slope_per_s = ((wanted - self.pace) / period_s).max(-self.fall_per_s);
        self.pace += self.slope_per_s * period_s;
    }

    /// Seconds of the plan per second of the clock.
    pub(super) fn pace(&self) -> f64 {
        self.pace
    }

    /// Change of pace per second.
    pub(super) fn slope_per_s(&self) -> f64 {
        self.slope_per_s
    }
}

#[cfg(test)]
mod tests {
    use super::{Governor, Load, SLOWEST_PACE};
    use crate::control::machine::Machine;
    use crate::control::sync::Identified;

    const PERIOD_S: f64 = 0.001;
    const FALL_PER_S: f64 = 1.0;
    /// Of the motor are left: all less a sag of 0.05, friction of 0.5 N·m of 10, and a reserve of 0.03.
    const LOAD: Load = Load { inertia_share: 0.8, top_nm: 10.0, friction_nm: 0.5 };
    const LEFT_SHARE: f64 = 0.87;

    fn governor() -> Governor {
        Governor::new(FALL_PER_S, 0.05, LOAD)
    }

    fn with(change: impl FnOnce(&mut Identified)) -> Identified {
        let mut identified = Identified::nominal(&Machine::reference());
        change(&mut identified);
        identified
    }

    fn pace_of(change: impl FnOnce(&mut Identified)) -> f64 {
        let mut governor = governor();
        governor.begin(&with(change));
        governor.pace()
    }

    #[test]
    fn accelerations_that_the_motor_can_give_keep_the_plans_pace() {
        assert_eq!(pace_of(|_| ()), 1.0);
        assert_eq!(pace_of(|known| known.inertia_ratio = 0.999 * LEFT_SHARE / 0.8), 1.0);
        assert!(pace_of(|known| known.inertia_ratio = 1.001 * LEFT_SHARE / 0.8) < 1.0);
    }

    #[test]
    fn pace_falls_with_the_root_of_what_is_left_over_what_is_asked() {
        let near = |pace: f64, square: f64| assert!((pace * pace - square).abs() < 1e-12, "{pace} {square}");
        near(pace_of(|known| known.inertia_ratio = 1.5), LEFT_SHARE / 1.2);
        // A fifth less torque takes a fifth of what the sag leaves, 1 N·m of drag a tenth of the motor.
        near(pace_of(|known| known.torque_limit_ratio = 0.8), (LEFT_SHARE - 0.19) / 0.8);
        near(pace_of(|known| known.spindle_drag_nm = 1.0), (LEFT_SHARE - 0.1) / 0.8);
        // Drag that helps more than friction brakes counts as none.
        near(pace_of(|known| (known.spindle_drag_nm, known.inertia_ratio) = (-3.0, 2.0)), (LEFT_SHARE + 0.05) / 1.6);
    }

    #[test]
    fn never_below_the_slowest() {
        assert_eq!(pace_of(|known| known.torque_limit_ratio = 0.05), SLOWEST_PACE);
    }

    #[test]
    fn slows_gradually_on_the_way_and_stays_there() {
        let (weak, mut governor) = (with(|known| known.inertia_ratio = 1.5), governor());
        governor.begin(&with(|_| ()));
        governor.step(&weak, PERIOD_S);
        assert!((governor.pace() - (1.0 - FALL_PER_S * PERIOD_S)).abs() < 1e-15);
        assert_eq!(governor.slope_per_s(), -FALL_PER_S);
        (0..500).for_each(|_| governor.step(&weak, PERIOD_S));
        assert!((governor.pace() - pace_of(|known| known.inertia_ratio = 1.5)).abs() < 1e-12);
        assert!(governor.slope_per_s().abs() < 1e-9);
    }

    #[test]
    fn faster_only_in_the_next_hole() {
        let mut governor = governor();
        governor.begin(&with(|known| known.inertia_ratio = 1.5));
        let slow = governor.pace();
        (0..500).for_each(|_| governor.step(&with(|_| ()), PERIOD_S));
        assert_eq!((governor.pace(), governor.slope_per_s()), (slow, 0.0));
        governor.begin(&with(|_| ()));
        assert_eq!(governor.pace(), 1.0);
    }
}
