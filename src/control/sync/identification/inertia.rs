//! The spindle's inertia, drag and torque limit, from its drive's torque and its encoder.
//!
//! Least squares of torque = κ·J·acceleration + drag·direction over windows, the file's values as prior.

use crate::control::machine::Machine;
use crate::control::math::sign;
use crate::control::motor::Motor;
use crate::control::sync::plant_model::IdentifiedSpindle;
use crate::control::units::{RAD_PER_REV, rpm_from_rev_per_s};

/// Below this the spindle's direction is not certain.
pub(super) const TURNING_REV_PER_S: f64 = 2.0;
/// Prior weight of the file's inertia in equivalent windows, and their torque as a share of the motor's. A slow tap shows its
/// inertia in a few windows, of which the acceleration fills a part.
const PRIOR_WINDOWS: f64 = 1.0;
const PRIOR_SHARE: f64 = 0.4;
/// Torque of an acceleration, as a share of the motor's, from which on it counts, and below which it is taken for none.
/// Between the two, and above all in the many windows at constant speed, an acceleration is mostly the encoder's noise, and
/// a fit that took it for one would find next to no inertia.
const ACCELERATING_SHARE: f64 = 0.1;
const STEADY_SHARE: f64 = 0.02;
/// Least and greatest ratio to the file's value: no machine is further from it.
const RATIO: (f64, f64) = (0.5, 2.0);
/// Greatest drag, as a share of the motor's torque.
const DRAG_SHARE: f64 = 0.3;
/// Periods at the limit after which the torque is taken for the limit.
const LIMIT_PERIODS: u32 = 3;
/// Share that each further one counts for.
const LIMIT_SHARE: f64 = 0.2;

/// Sums over windows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct InertiaFit {
    motor: Motor,
    coulomb_nm: f64,
    viscous_nm_per_rpm: f64,
    /// Σ a², Σ a·s, Σ s², Σ a·y, Σ s·y of torque y = κ·a + c·s, where a is the acceleration's torque by the file's inertia
    /// and s the direction.
    normal: [f64; 5],
    saturated_periods: u32,
    limit_ratio: f64,
    reports_torque: bool,
    tracked_ratio: f64,
}

impl InertiaFit {
    pub(super) fn new(machine: &Machine) -> Self {
        let spindle = &machine.spec().spindle;
        Self {
            motor: machine.motor().clone(),
            coulomb_nm: spindle.coulomb_nm,
            viscous_nm_per_rpm: spindle.viscous_nm_per_rpm,
            normal: [0.0; 5],
            saturated_periods: 0,
            limit_ratio: 1.0,
            reports_torque: false,
            tracked_ratio: 1.0,
        }
    }

    /// The file's friction at a speed.
    pub(super) fn friction_nm(&self, speed_rev_per_s: f64) -> f64 {
        let rpm = rpm_from_rev_per_s(speed_rev_per_s);
        self.coulomb_nm * sign(rpm) + self.viscous_nm_per_rpm * rpm
    }

    /// A window of a length between two speeds, with its mean torque less the file's friction.
    pub(super) fn add(&mut self, from_rev_per_s: f64, to_rev_per_s: f64, length_s: f64, mean_nm: f64) {
        let turning = |speed: f64| speed.abs() > TURNING_REV_PER_S;
        if !(turning(from_rev_per_s) && turning(to_rev_per_s) && from_rev_per_s * to_rev_per_s > 0.0) {
            return;
        }
        let direction = sign(to_rev_per_s);
        let acceleration = (to_rev_per_s - from_rev_per_s) / length_s;
        let torque_nm = self.motor.inertia_kg_m2 * RAD_PER_REV * acceleration;
        let motor_nm = self.motor.curve.torque_nm(0.0);
        let a = if torque_nm.abs() < STEADY_SHARE * motor_nm { 0.0 } else { torque_nm };
        if a == 0.0 || a.abs() > ACCELERATING_SHARE * motor_nm {
            let terms = [a * a, a * direction, 1.0, a * mean_nm, direction * mean_nm];
            self.normal.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
    }

    /// The torque of a drive that reports none but that it stands at its limit, between two speeds: the curve's, in the
    /// direction in which the speed changes. A limit below the curve's counts as inertia then, which it is to a planner.
    pub(super) fn torque_at_limit_nm(&self, from_rev_per_s: f64, to_rev_per_s: f64) -> f64 {
        let rpm = rpm_from_rev_per_s(0.5 * (from_rev_per_s + to_rev_per_s));
        self.motor.curve.torque_nm(rpm.abs()) * sign(to_rev_per_s - from_rev_per_s)
    }

    /// One period: a drive at its limit shows what the limit is.
    pub(super) fn observe_limit(&mut self, torque_nm: Option<f64>, saturated: bool, speed_rev_per_s: f64) {
        self.reports_torque |= torque_nm.is_some();
        let Some(torque_nm) = torque_nm.filter(|_| saturated) else {
            self.saturated_periods = 0;
            return;
        };
        self.saturated_periods = self.saturated_periods.saturating_add(1);
        if self.saturated_periods >= LIMIT_PERIODS {
            let curve_nm = self.motor.curve.torque_nm(rpm_from_rev_per_s(speed_rev_per_s.abs()));
            let ratio = (torque_nm.abs() / curve_nm).max(RATIO.0).min(1.0);
            self.limit_ratio += LIMIT_SHARE * (ratio - self.limit_ratio);
        }
    }

    /// What outlives a restart.
    pub(super) fn kept(&mut self) -> impl Iterator<Item = &mut f64> {
        self.normal.iter_mut().chain([&mut self.limit_ratio])
    }

    pub(super) fn decay(&mut self, kept: f64) {
        self.normal.iter_mut().for_each(|sum| *sum *= kept);
    }

    /// Of a drive that reports no torque: inertia by how it follows.
    pub(super) fn note_tracked(&mut self, inertia_ratio: f64) {
        self.tracked_ratio = inertia_ratio;
    }

    /// What fits best by now.
    pub(super) fn identified(&self) -> IdentifiedSpindle {
        self.identified_as(self.tracked_ratio)
    }

    /// The same, where the way that the spindle follows says an inertia.
    pub(super) fn identified_as(&self, tracked_ratio: f64) -> IdentifiedSpindle {
        let [aa, a_s, ss, ay, sy] = self.normal;
        // The prior is so many windows of κ = 1 at a torque, and of no drag.
        let prior_nm = PRIOR_SHARE * self.motor.curve.torque_nm(0.0);
        let prior = PRIOR_WINDOWS * prior_nm * prior_nm;
        let prior_ratio = if self.reports_torque { 1.0 } else { tracked_ratio.max(RATIO.0).min(RATIO.1) };
        let determinant = (aa + prior) * (ss + PRIOR_WINDOWS) - a_s * a_s;
        let ratio = ((ay + prior * prior_ratio) * (ss + PRIOR_WINDOWS) - sy * a_s) / determinant;
        let drag_nm = (sy * (aa + prior) - (ay + prior * prior_ratio) * a_s) / determinant;
        let greatest_nm = DRAG_SHARE * self.motor.curve.torque_nm(0.0);
        IdentifiedSpindle {
            inertia_ratio: ratio.max(RATIO.0).min(RATIO.1),
            torque_limit_ratio: self.limit_ratio,
            drag_nm: drag_nm.max(-greatest_nm).min(greatest_nm),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::InertiaFit;
    use crate::control::machine::Machine;
    use crate::control::sync::plant_model::IdentifiedSpindle;

    const LENGTH_S: f64 = 0.016;

    fn fit() -> InertiaFit {
        InertiaFit::new(&Machine::reference())
    }

    /// Newton's law with 1.2 times 0.004 kg·m² and 0.5 N·m beyond the file's friction, up and down.
    #[test]
    fn inertia_and_drag_that_made_the_torque_are_found() {
        let mut fit = fit();
        for round in 0..40 {
            for (sign, rate) in [(1.0, 500.0), (1.0, -500.0), (-1.0, 500.0), (-1.0, 0.0)] {
                let from = sign * (30.0 + f64::from(round % 5));
                let torque_nm = 1.2 * 0.004 * core::f64::consts::TAU * rate + 0.5 * sign;
                fit.add(from, from + rate * LENGTH_S, LENGTH_S, torque_nm);
            }
        }
        let found = fit.identified();
        assert!((found.inertia_ratio - 1.2).abs() < 0.01 && (found.drag_nm - 0.5).abs() < 0.02, "{found:?}");
    }

    #[test]
    fn without_motion_the_file_stands() {
        let mut fit = fit();
        fit.add(0.0, 0.5, LENGTH_S, 3.0);
        fit.add(30.0, -30.0, LENGTH_S, 3.0);
        assert_eq!(fit.identified(), IdentifiedSpindle::NOMINAL);
    }

    #[test]
    fn a_limit_shows_after_three_periods_at_it() {
        let mut fit = fit();
        (0..2).for_each(|_| fit.observe_limit(Some(-15.0), true, 20.0));
        fit.observe_limit(Some(-15.0), false, 20.0);
        (0..2).for_each(|_| fit.observe_limit(None, true, 20.0));
        assert_eq!(fit.identified().torque_limit_ratio, 1.0);
        (0..60).for_each(|_| fit.observe_limit(Some(-15.0), true, 20.0));
        assert!((fit.identified().torque_limit_ratio - 0.75).abs() < 1e-4);
    }
}
