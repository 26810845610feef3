//! A hole from a spindle that may still turn: it is brought to rest first, then spindle and Z are synchronised.

use super::{Adaptation, Alarm, Settings, Stage, Step, Synchronizer};
use crate::control::cycle::{CycleError, CyclePlan, Interrupted, InterruptionError};
use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::port::Feedback;
use crate::control::profile::Profile;
use crate::control::units::rev_per_s_from_rpm;

/// A spindle speed this small is an encoder's noise: nothing has to be braked.
const STANDSTILL_RPM: f64 = 0.5;

/// One hole of a host that leaves the spindle as M03 or M05 left it.
#[derive(Clone, Debug, PartialEq)]
pub struct Tapping {
    synchronizer: Synchronizer,
    start_s: f64,
    spindle_start_rev: f64,
    /// Direction in which the spindle turned at the start, ±1.
    spindle_sign: f64,
    braking: Profile,
    r_plane_mm: f64,
}

impl Tapping {
    /// Starts at `now_s`, Z at rest on the R plane, with the spindle at an angle and a signed speed. The spindle brakes as
    /// fast as the motor's torque curve at its share allows, and the hole starts where it comes to rest.
    ///
    /// # Errors
    /// [`CycleError::Law`] for a speed that is no number.
    ///
    /// ```
    /// use rigidtap::control::cycle::{CyclePlan, TapCycle};
    /// use rigidtap::control::machine::{Law, Machine};
    /// use rigidtap::control::port::Feedback;
    /// use rigidtap::control::sync::{Settings, Stage, Tapping};
    ///
    /// let machine = Machine::reference();
    /// let hole = TapCycle::right_hand(0.0, -10.0, 1.0, 3000.0);
    /// let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).unwrap();
    /// let mut tapping = Tapping::start(plan, &machine, Settings::default(), 0.0, 0.25, 3000.0).unwrap();
    /// let mut feedback = Feedback { spindle_counts: 4096, ..Feedback::default() };
    /// let mut periods = 0..;
    /// let rest_rev = loop {
    ///     let step = tapping.step(f64::from(periods.next().unwrap()) * 0.001, &feedback).unwrap();
    ///     feedback.spindle_counts = (step.spindle.position * 16_384.0).round() as i64;
    ///     if step.spindle.velocity == 0.0 {
    ///         break step.spindle.position;
    ///     }
    /// };
    /// // 50 rev/s at 637 rev/s², and what friction helps.
    /// assert!((1.5..2.3).contains(&rest_rev));
    /// ```
    pub fn start(
        plan: CyclePlan,
        machine: &Machine,
        settings: Settings,
        now_s: f64,
        spindle_rev: f64,
        spindle_rpm: f64,
    ) -> Result<Self, CycleError> {
        let braking = if spindle_rpm.abs() <= STANDSTILL_RPM {
            Profile::default()
        } else {
            let speed = rev_per_s_from_rpm(spindle_rpm.abs());
            machine.torque_limit().brake(speed, f64::INFINITY).map_err(CycleError::Law)?
        };
        let spindle_sign = if spindle_rpm < 0.0 { -1.0 } else { 1.0 };
        let rest_rev = spindle_rev + spindle_sign * braking.distance();
        let r_plane_mm = plan.cycle().r_plane_mm;
        Ok(Self {
            synchronizer: Synchronizer::new(plan, machine, settings, rest_rev),
            start_s: now_s,
            spindle_start_rev: spindle_rev,
            spindle_sign,
            braking,
            r_plane_mm,
        })
    }

    /// One period: [`Synchronizer::step`], after the spindle has been braked.
    ///
    /// # Errors
    /// [`Alarm`]; hold the setpoint of the period before.
    pub fn step(&mut self, now_s: f64, feedback: &Feedback) -> Result<Step, Alarm> {
        let braked_s = now_s - self.start_s;
        if braked_s >= self.braking.duration_s() {
            return self.synchronizer.step(now_s, feedback);
        }
        let spindle = self.braking.at(braked_s).scaled(self.spindle_sign).shifted(self.spindle_start_rev);
        let z = State { position: self.r_plane_mm, ..State::default() };
        let step = Step { stage: Stage::Settling, spindle, z, ..Step::default() };
        let step = step.with(&self.synchronizer.lingering());
        self.synchronizer.observe(feedback);
        Ok(step)
    }

    /// The hole's plan.
    #[must_use]
    pub fn plan(&self) -> &CyclePlan {
        self.synchronizer.plan()
    }

    /// [`Synchronizer::stop`]; a spindle that is being braked goes on braking, and the hole does not start.
    pub fn stop(&mut self, now_s: f64) {
        self.synchronizer.stop(now_s);
    }

    /// [`Synchronizer::retract`].
    ///
    /// # Errors
    /// [`InterruptionError`], and the tap stays held.
    pub fn retract(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        self.synchronizer.retract(now_s)
    }

    /// [`Synchronizer::resume`].
    ///
    /// # Errors
    /// [`InterruptionError`], and the tap stays held.
    pub fn resume(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        self.synchronizer.resume(now_s)
    }

    /// [`Synchronizer::interrupted_at`].
    #[must_use]
    pub fn interrupted_at(&self, now_s: f64) -> Option<Interrupted> {
        self.synchronizer.interrupted_at(now_s)
    }

    /// [`Synchronizer::adapted`].
    #[must_use]
    pub fn adapted(mut self, adaptation: Adaptation) -> Self {
        self.synchronizer = self.synchronizer.adapted(adaptation);
        self
    }

    /// [`Synchronizer::into_adaptation`].
    #[must_use]
    pub fn into_adaptation(self) -> Adaptation {
        self.synchronizer.into_adaptation()
    }
}
