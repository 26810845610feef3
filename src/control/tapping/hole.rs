//! Hole after hole of a host that does the moves between them itself.

use super::power_loss::{PowerLossRecord, RestoredHole};
use super::start_error::StartError;
use crate::control::cycle::{CycleError, CyclePlan, InterruptionError};
use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::port::{Feedback, Setpoint};
use crate::control::profile::Profile;
use crate::control::sync::{
    Adaptation, Identified, LearnedError, ResidualFeedforward, Settings, Stage, Step, Synchronizer,
};
use crate::control::units::rev_per_s_from_rpm;

/// A spindle speed up to this is an encoder's noise: nothing has to be braked.
const STANDSTILL_RPM: f64 = 0.5;
/// A spindle at its greatest speed is measured up to so much above it: overshoot and the encoder's noise.
const OVERSPEED_SHARE: f64 = 1.05;

/// One hole under way: a spindle that still turns is braked first, and then turned to the hole's start angle.
#[derive(Clone, Debug, PartialEq)]
struct Hole {
    synchronizer: Synchronizer,
    start_s: f64,
    /// Where the spindle's motion before the hole begins, its direction ±1, and its travel: it is braked, then it turns to the
    /// start angle.
    spindle_start_rev: f64,
    spindle_sign: f64,
    approach: Profile,
    /// How long it was braked before that travel began.
    approach_since_s: f64,
    /// How long that has taken, by the host's clock as long as that is one; none once the spindle rests.
    approached_s: Option<f64>,
}

impl Hole {
    /// The spindle has ended a travel: it turns to the start angle, if it is not there. Not part of its caller: what planning takes
    /// of the stack is free again before the period goes on.
    #[inline(never)]
    fn turn(&mut self) {
        let rest_rev = self.spindle_start_rev + self.spindle_sign * self.approach.distance();
        // Between finite angles, as these are, there is always a way.
        if let Ok(Some(turn)) = self.synchronizer.plan().orientation(rest_rev) {
            self.approach_since_s += self.approach.duration_s();
            (self.spindle_start_rev, self.spindle_sign) = (turn.from_rev, turn.direction());
            self.approach = turn.profile;
        }
    }

    /// One period of braking or turning: the spindle's motion, none once it rests. The synchronizer is told the same clock, and
    /// tells of one that fails.
    fn approach(&mut self, now_s: f64) -> Option<State> {
        let plan = self.synchronizer.plan();
        let spec = plan.machine().spec();
        let (approached_s, told_s) = (self.approached_s?, now_s - self.start_s);
        let most_s = (spec.supervision.bridge_periods + 0.5) * spec.control.period_s;
        let is_clock = (0.0..=most_s).contains(&(told_s - approached_s));
        let approached_s = if is_clock { told_s } else { approached_s + spec.control.period_s };
        if approached_s >= self.approach_since_s + self.approach.duration_s() {
            self.turn();
        }
        let since_s = approached_s - self.approach_since_s;
        self.approached_s = (since_s < self.approach.duration_s()).then_some(approached_s);
        self.approached_s.map(|_| self.approach.at(since_s).scaled(self.spindle_sign).shifted(self.spindle_start_rev))
    }
}

/// A machine that is tapped with, hole after hole.
#[derive(Clone, Debug, PartialEq)]
pub struct Tapping {
    adaptation: Adaptation,
    hole: Option<Hole>,
    /// A period longer than this is a gap.
    gap_s: f64,
    last_s: Option<f64>,
    counters: Counters,
}

/// Periods of a gap: more than one, less than two.
const GAP_PERIODS: f64 = 1.5;

/// What was counted since the machine was first seen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counters {
    /// Periods, those between holes included.
    pub periods: u64,
    /// Periods in which a sample of spindle or Z was not valid.
    pub invalid_samples: u64,
    /// Periods longer than one and a half of the machine's.
    pub gaps: u64,
    /// Periods in which the spindle's drive stood at its torque limit.
    pub saturated_periods: u64,
}

impl Tapping {
    /// A machine of which nothing has been measured yet.
    #[must_use]
    pub fn new(machine: &Machine) -> Self {
        Self {
            adaptation: Adaptation::new(machine),
            hole: None,
            gap_s: GAP_PERIODS * machine.spec().control.period_s,
            last_s: None,
            counters: Counters::default(),
        }
    }

    /// One period between holes. Returns what the last hole left beside Z's setpoints, to be added to this period's; a host
    /// that cannot add it says so by [`Tapping::discard_residual`].
    pub fn observe(&mut self, now_s: f64, feedback: &Feedback) -> ResidualFeedforward {
        self.count(now_s, feedback);
        self.adaptation.observe(feedback)
    }

    /// [`Adaptation::note_commanded`].
    pub fn note_commanded(&mut self, setpoint: &Setpoint) {
        if self.hole.is_none() {
            self.adaptation.note_commanded(setpoint);
        }
    }

    /// A host that was away for periods is measured anew.
    fn count(&mut self, now_s: f64, feedback: &Feedback) {
        let gap = self.last_s.replace(now_s).is_some_and(|last_s| now_s - last_s > self.gap_s);
        if gap {
            self.adaptation.note_gap();
        }
        let Counters { periods, invalid_samples, gaps, saturated_periods } = &mut self.counters;
        *periods += 1;
        *invalid_samples += u64::from(!(feedback.spindle.sample_valid && feedback.z.sample_valid));
        *gaps += u64::from(gap);
        *saturated_periods += u64::from(feedback.torque_saturated());
    }

    /// Starts a hole at `now_s`, Z at rest on the R plane, with the spindle at an angle and a signed speed. The spindle brakes as
    /// fast as the motor's torque curve at its utilisation allows, and the hole starts where it comes to rest; at the hole's start
    /// angle where it has one, to which the spindle is turned from rest by the shortest way.
    ///
    /// # Errors
    /// [`StartError::UnderWay`] in a hole; as [`StartError::Cycle`], [`CycleError::Invalid`] for a time, angle or speed that is no
    /// finite number, and [`CycleError::SpindleTooFast`] for a speed more than 5 % beyond the machine's; nothing has started.
    ///
    /// ```
    /// use rigidtap::control::cycle::{CyclePlan, TapCycle};
    /// use rigidtap::control::machine::{Law, Machine};
    /// use rigidtap::control::port::Feedback;
    /// use rigidtap::control::sync::Settings;
    /// use rigidtap::control::tapping::Tapping;
    ///
    /// let machine = Machine::reference();
    /// let mut tapping = Tapping::new(&machine);
    /// let hole = TapCycle::right_hand(0.0, -10.0, 1.0, 3000.0);
    /// let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).unwrap();
    /// tapping.start(plan, Settings::default(), 0.0, 0.25, 3000.0).unwrap();
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
        &mut self,
        plan: CyclePlan,
        settings: Settings,
        now_s: f64,
        spindle_rev: f64,
        spindle_rpm: f64,
    ) -> Result<(), StartError> {
        if self.hole.is_some() {
            return Err(StartError::UnderWay);
        }
        check_turning(plan.machine(), spindle_rev, spindle_rpm)?;
        if !now_s.is_finite() {
            return Err(CycleError::Invalid { value: now_s }.into());
        }
        let (approach, spindle_sign, rest_rev) = approach(&plan, spindle_rev, spindle_rpm)?;
        if !settings.compensation.leaves_residual() {
            self.adaptation.discard_residual();
        }
        self.hole = Some(Hole {
            synchronizer: Synchronizer::new(plan, settings, rest_rev),
            start_s: now_s,
            spindle_start_rev: spindle_rev,
            spindle_sign,
            approach,
            approach_since_s: 0.0,
            approached_s: Some(0.0),
        });
        Ok(())
    }

    /// Holds the tap in a hole in which it stood when the power came back, from the period of `now_s` on, until
    /// [`Tapping::retract`]. Nothing of it is measured against the plan of before: that is gone.
    ///
    /// # Errors
    /// [`StartError::UnderWay`] in a hole; [`CycleError::Invalid`] for a time that is no finite number.
    pub fn restore(&mut self, hole: RestoredHole, settings: Settings, now_s: f64) -> Result<(), StartError> {
        if self.hole.is_some() {
            return Err(StartError::UnderWay);
        }
        if !now_s.is_finite() {
            return Err(CycleError::Invalid { value: now_s }.into());
        }
        self.adaptation.discard_residual();
        let zero = hole.standing().zero;
        self.hole = Some(Hole {
            synchronizer: Synchronizer::restored(hole.plan, settings, zero),
            start_s: now_s,
            spindle_start_rev: 0.0,
            spindle_sign: 1.0,
            approach: Profile::default(),
            approach_since_s: 0.0,
            approached_s: None,
        });
        Ok(())
    }

    /// What leads the tap out of the hole under way if the power fails: from its first synchronous period to its end. The host
    /// keeps its bytes where they outlive the power, and forgets them where there is none.
    #[must_use]
    pub fn power_loss_record(&self) -> Option<PowerLossRecord> {
        let synchronizer = &self.hole.as_ref()?.synchronizer;
        Some(PowerLossRecord::of(synchronizer.plan(), synchronizer.helix_zero()?))
    }

    /// One period of a hole; none where none is under way. With [`Stage::Done`] it has ended, and the next period is one between
    /// holes.
    pub fn step(&mut self, now_s: f64, feedback: &Feedback) -> Option<Step> {
        if self.hole.is_some() {
            self.count(now_s, feedback);
        }
        let Self { adaptation, hole, .. } = self;
        let under_way = hole.as_mut()?;
        if let Some(spindle) = under_way.approach(now_s) {
            let r_plane_mm = under_way.synchronizer.plan().cycle().r_plane_mm;
            let z = State { position: r_plane_mm, ..State::default() };
            let braking = Step { spindle, z, ..Step::default() };
            let rest = State::default();
            let setpoint = adaptation.observe(feedback).added_to(braking.setpoint(rest, rest));
            adaptation.note_commanded(&setpoint);
            return Some(Step { z: setpoint.z, z_force_n: setpoint.z_force_n, ..braking });
        }
        let step = under_way.synchronizer.step(now_s, feedback, adaptation);
        if step.stage == Stage::Done {
            *hole = None;
        }
        Some(step)
    }

    /// Where the spindle is commanded to rest before the hole under way and after it, rev.
    #[must_use]
    pub fn spindle_rest_rev(&self) -> Option<f64> {
        self.hole.as_ref().map(|hole| hole.synchronizer.spindle_rest_rev())
    }

    /// The plan of the hole under way.
    #[must_use]
    pub fn plan(&self) -> Option<&CyclePlan> {
        self.hole.as_ref().map(|hole| hole.synchronizer.plan())
    }

    /// [`Synchronizer::stop`]; a spindle that is being braked goes on braking, and the hole does not start.
    pub fn stop(&mut self, now_s: f64) {
        if let Some(hole) = &mut self.hole {
            hole.synchronizer.stop(now_s);
        }
    }

    /// [`Synchronizer::retract`].
    ///
    /// # Errors
    /// [`InterruptionError`], and the tap stays held.
    pub fn retract(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        self.hole.as_mut().ok_or(InterruptionError::NotStopped)?.synchronizer.retract(now_s)
    }

    /// [`Synchronizer::resume`].
    ///
    /// # Errors
    /// [`InterruptionError`], and the tap stays held.
    pub fn resume(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        self.hole.as_mut().ok_or(InterruptionError::NotStopped)?.synchronizer.resume(now_s)
    }

    /// [`Synchronizer::acknowledge`].
    pub fn acknowledge(&mut self) -> bool {
        self.hole.as_mut().is_none_or(|hole| hole.synchronizer.acknowledge())
    }

    /// Gives up the hole under way: its axes are the host's from now on, at rest or not. What was measured stays.
    pub fn release(&mut self) {
        self.hole = None;
        self.adaptation.discard_residual();
    }

    /// [`Adaptation::residual`].
    #[must_use]
    pub fn residual(&self) -> ResidualFeedforward {
        self.adaptation.residual()
    }

    /// [`Adaptation::discard_residual`].
    pub fn discard_residual(&mut self) {
        self.adaptation.discard_residual();
    }

    /// What was counted so far.
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.counters
    }

    /// [`Adaptation::save_learned`].
    ///
    /// # Errors
    /// [`LearnedError::TooShort`], and [`LearnedError::UnderWay`] in a hole.
    pub fn save_learned(&self, bytes: &mut [u8]) -> Result<usize, LearnedError> {
        if self.hole.is_some() { Err(LearnedError::UnderWay) } else { self.adaptation.save_learned(bytes) }
    }

    /// [`Adaptation::load_learned`].
    ///
    /// # Errors
    /// [`LearnedError`], [`LearnedError::UnderWay`] in a hole; nothing has changed.
    pub fn load_learned(&mut self, bytes: &[u8]) -> Result<(), LearnedError> {
        if self.hole.is_some() { Err(LearnedError::UnderWay) } else { self.adaptation.load_learned(bytes) }
    }

    /// [`Adaptation::identified`].
    #[must_use]
    pub fn identified(&self) -> Identified {
        self.adaptation.identified()
    }
}

/// How a spindle at an angle and a signed speed is braked, in which direction it turns, ±1, and where it rests when the hole
/// begins. Not part of its caller: what planning takes of the stack is free again before the hole is made there.
#[inline(never)]
fn approach(plan: &CyclePlan, spindle_rev: f64, spindle_rpm: f64) -> Result<(Profile, f64, f64), CycleError> {
    let braking = if spindle_rpm.abs() <= STANDSTILL_RPM {
        Profile::default()
    } else {
        let speed = rev_per_s_from_rpm(spindle_rpm.abs());
        plan.machine().torque_limit().brake(speed, f64::INFINITY).map_err(CycleError::Law)?
    };
    let sign = if spindle_rpm < 0.0 { -1.0 } else { 1.0 };
    let rest_rev = plan.cycle().rest_rev(spindle_rev + sign * braking.distance());
    Ok((braking, sign, rest_rev))
}

/// Whether a spindle can stand at an angle and turn at a signed speed.
pub(super) fn check_turning(machine: &Machine, spindle_rev: f64, spindle_rpm: f64) -> Result<(), CycleError> {
    for value in [spindle_rev, spindle_rpm] {
        if !value.is_finite() {
            return Err(CycleError::Invalid { value });
        }
    }
    let (needed_rpm, limit_rpm) = (spindle_rpm.abs(), machine.spec().spindle.max_rpm);
    if needed_rpm > OVERSPEED_SHARE * limit_rpm {
        return Err(CycleError::SpindleTooFast { needed_rpm, limit_rpm });
    }
    Ok(())
}
