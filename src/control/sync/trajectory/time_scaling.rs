//! Path time scaling: a motor weaker than its file takes the same path in more time.
//!
//! On-line time scaling after Dahl and Nielsson, Torque-limited path following by on-line trajectory time scaling, IEEE
//! Transactions on Robotics and Automation 6(5), 1990: a path taken at a rate σ asks for σ² of its accelerations.

use crate::control::cycle::CyclePlan;
use crate::control::machine::Machine;
use crate::control::math::{poly::State, sqrt};
use crate::control::sync::plant_model::IdentifiedSpindle;
use crate::control::units::rpm_from_rev_per_s;

/// Share of the motor's torque that stays with the drive's own loops.
const RESERVE_SHARE: f64 = 0.03;
/// Least path rate: a machine that needs a lower one has another fault.
const LEAST_RATE: f64 = 0.3;
/// Instants of a stroke at which its torque is looked at.
const TORQUE_STEPS: u32 = 200;

/// What a plan asks of the motor that the file describes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync) struct TorqueDemand {
    /// Greatest share of the motor's torque that accelerates the file's inertia.
    inertia_share: f64,
    /// The motor's torque at the plan's greatest speed.
    top_nm: f64,
    /// The file's friction there.
    friction_nm: f64,
}

impl TorqueDemand {
    pub(in crate::control::sync) fn of(plan: &CyclePlan, machine: &Machine) -> Self {
        let (motor, spindle) = (machine.motor(), &machine.spec().spindle);
        let (mut inertia_share, mut top_rpm) = (0.0_f64, 0.0_f64);
        for stroke in plan.strokes() {
            for instant in 0..=TORQUE_STEPS {
                let state = stroke.profile.at(stroke.duration_s * f64::from(instant) / f64::from(TORQUE_STEPS));
                let rpm = rpm_from_rev_per_s(state.velocity.abs());
                let share = motor.torque_for_nm(state.acceleration.abs()) / motor.curve.torque_nm(rpm);
                (inertia_share, top_rpm) = (inertia_share.max(share), top_rpm.max(rpm));
            }
        }
        let friction_nm = spindle.coulomb_nm + spindle.viscous_nm_per_rpm * top_rpm;
        Self { inertia_share, top_nm: motor.curve.torque_nm(top_rpm), friction_nm }
    }
}

/// How fast the plan's time runs against the clock's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync) struct TimeScaling {
    /// Greatest fall of the rate per second.
    fall_per_s: f64,
    /// Share of the torque curve that a sagging supply takes away.
    sag_ratio: f64,
    demand: TorqueDemand,
    /// Path rate: seconds of the plan per second of the clock, at most 1.
    rate: f64,
    slope_per_s: f64,
}

impl TimeScaling {
    /// A hole begins at rest, where any rate can be taken at once.
    pub(in crate::control::sync) fn new(
        fall_per_s: f64,
        sag_ratio: f64,
        demand: TorqueDemand,
        spindle: &IdentifiedSpindle,
    ) -> Self {
        let unscaled = Self { fall_per_s, sag_ratio, demand, rate: 1.0, slope_per_s: 0.0 };
        Self { rate: unscaled.feasible_rate(spindle), ..unscaled }
    }

    /// The greatest rate at which the plan stays within the motor.
    fn feasible_rate(&self, spindle: &IdentifiedSpindle) -> f64 {
        let drag_share = (self.demand.friction_nm + spindle.drag_nm).max(0.0) / self.demand.top_nm;
        let left = (spindle.torque_limit_ratio * (1.0 - self.sag_ratio) - drag_share - RESERVE_SHARE).max(0.0);
        let asked = self.demand.inertia_share * spindle.inertia_ratio;
        if asked <= left { 1.0 } else { sqrt(left / asked).max(LEAST_RATE) }
    }

    /// One period. The rate never rises within a hole: what its strokes have shown of the motor stays true in it.
    pub(in crate::control::sync) fn step(&mut self, spindle: &IdentifiedSpindle, period_s: f64) {
        let feasible = self.feasible_rate(spindle).min(self.rate);
        self.slope_per_s = ((feasible - self.rate) / period_s).max(-self.fall_per_s);
        self.rate += self.slope_per_s * period_s;
    }

    /// Path rate.
    pub(in crate::control::sync) fn rate(&self) -> f64 {
        self.rate
    }

    /// A state of the plan on the clock, with derivatives by the clock's time.
    pub(in crate::control::sync) fn on_the_clock(&self, state: &State) -> State {
        let rate = self.rate;
        State {
            position: state.position,
            velocity: rate * state.velocity,
            acceleration: rate * rate * state.acceleration + self.slope_per_s * state.velocity,
            jerk: rate * rate * rate * state.jerk,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{LEAST_RATE, TimeScaling, TorqueDemand};
    use crate::control::cycle::{CyclePlan, TapCycle};
    use crate::control::machine::{Law, Machine};
    use crate::control::math::poly::State;
    use crate::control::sync::plant_model::IdentifiedSpindle;

    const PERIOD_S: f64 = 0.001;
    const FALL_PER_S: f64 = 1.0;
    /// Of the motor are left: all less a sag of 0.05, friction of 0.5 N·m of 10, and a reserve of 0.03.
    const DEMAND: TorqueDemand = TorqueDemand { inertia_share: 0.8, top_nm: 10.0, friction_nm: 0.5 };
    const LEFT_SHARE: f64 = 0.87;
    const NOMINAL: IdentifiedSpindle = IdentifiedSpindle::NOMINAL;

    fn scaling(spindle: IdentifiedSpindle) -> TimeScaling {
        TimeScaling::new(FALL_PER_S, 0.05, DEMAND, &spindle)
    }

    fn heavier(inertia_ratio: f64) -> IdentifiedSpindle {
        IdentifiedSpindle { inertia_ratio, ..NOMINAL }
    }

    #[test]
    fn accelerations_that_the_motor_can_give_keep_the_plans_time() {
        assert_eq!(scaling(NOMINAL).rate(), 1.0);
        assert_eq!(scaling(heavier(0.999 * LEFT_SHARE / 0.8)).rate(), 1.0);
        assert!(scaling(heavier(1.001 * LEFT_SHARE / 0.8)).rate() < 1.0);
    }

    #[test]
    fn rate_falls_with_the_root_of_what_is_left_over_what_is_asked() {
        let near = |spindle, square: f64| {
            let rate = scaling(spindle).rate();
            assert!((rate * rate - square).abs() < 1e-12, "{rate} {square}");
        };
        near(heavier(1.5), LEFT_SHARE / 1.2);
        // A fifth less torque takes a fifth of what the sag leaves, 1 N·m of drag a tenth of the motor.
        near(IdentifiedSpindle { torque_limit_ratio: 0.8, ..NOMINAL }, (LEFT_SHARE - 0.19) / 0.8);
        near(IdentifiedSpindle { drag_nm: 1.0, ..NOMINAL }, (LEFT_SHARE - 0.1) / 0.8);
        // Drag that helps more than friction brakes counts as none.
        near(IdentifiedSpindle { drag_nm: -3.0, ..heavier(2.0) }, (LEFT_SHARE + 0.05) / 1.6);
    }

    #[test]
    fn never_below_the_least_rate() {
        assert_eq!(scaling(IdentifiedSpindle { torque_limit_ratio: 0.05, ..NOMINAL }).rate(), LEAST_RATE);
    }

    #[test]
    fn slows_gradually_on_the_way_and_stays_there() {
        let mut slowing = scaling(NOMINAL);
        slowing.step(&heavier(1.5), PERIOD_S);
        assert!((slowing.rate() - (1.0 - FALL_PER_S * PERIOD_S)).abs() < 1e-15);
        assert_eq!(slowing.slope_per_s, -FALL_PER_S);
        (0..500).for_each(|_| slowing.step(&heavier(1.5), PERIOD_S));
        assert!((slowing.rate() - scaling(heavier(1.5)).rate()).abs() < 1e-12);
        assert!(slowing.slope_per_s.abs() < 1e-9);
        let slow = slowing.rate();
        (0..500).for_each(|_| slowing.step(&NOMINAL, PERIOD_S));
        assert_eq!((slowing.rate(), slowing.slope_per_s), (slow, 0.0));
    }

    /// Speed and acceleration of the scaled path are those of its position by finite differences.
    #[test]
    fn derivatives_are_by_the_clock() {
        let plan =
            |t_s: f64| State { position: 100.0 * t_s * t_s, velocity: 200.0 * t_s, acceleration: 200.0, jerk: 0.0 };
        let (slope, rate_at) = (-1.0, |t_s: f64| 0.9 - t_s);
        let path_s = |t_s: f64| 0.3 + 0.9 * t_s - 0.5 * t_s * t_s;
        let scaling = TimeScaling { rate: rate_at(0.0), slope_per_s: slope, ..scaling(NOMINAL) };
        let found = scaling.on_the_clock(&plan(path_s(0.0)));
        let h = 1e-4;
        let [before, here, after] = [-h, 0.0, h].map(|t_s| plan(path_s(t_s)).position);
        assert!((found.velocity - (after - before) / (2.0 * h)).abs() < 1e-4);
        assert!((found.acceleration - (after - 2.0 * here + before) / (h * h)).abs() < 1e-3);
    }

    /// The linear law asks for 38 197 rpm/s everywhere: 16 N·m of 0.004 kg·m², below 3000 rpm of 20 N·m.
    #[test]
    fn demand_is_the_share_of_the_motor_that_the_plan_takes() {
        let machine = Machine::reference();
        let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 3000.0);
        let demand = TorqueDemand::of(&CyclePlan::new(hole, &machine, Law::Linear).unwrap(), &machine);
        assert!((demand.inertia_share - 0.8).abs() < 1e-4, "{demand:?}");
        assert!((demand.top_nm - 20.0).abs() < 1e-9, "{demand:?}");
        assert!((demand.friction_nm - (0.3 + 0.3 * 3.0 / 8.0)).abs() < 1e-9, "{demand:?}");
    }
}
