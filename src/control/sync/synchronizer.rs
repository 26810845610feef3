//! The synchronizer: one hole from rest at R back to rest at R.

use crate::control::cycle::{CyclePlan, InterruptionError};
use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::port::Feedback;

use super::adaptation::Adaptation;
use super::cutting_torque::TooLittle;
use super::drives::Drives;
use super::error::synchronisation_error_mm;
use super::frame::{AxisCommands, Frame, HelixZero, Measured};
use super::in_position::{END, InPosition};
use super::step::{Stage, Step};
use super::strategy::{Command, Inputs, Settings, Strategy};
use super::supervision::{Alarm, Observation, StopKind, Supervision};
use super::trajectory::Trajectory;

/// One hole's synchronizer: planned outside the period, stepped inside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Synchronizer {
    frame: Frame,
    trajectory: Trajectory,
    strategy: Strategy,
    in_position: InPosition,
    supervision: Supervision,
    drives: Drives,
    settings: Settings,
    period_s: f64,
    r_plane_mm: f64,
    last_spindle_rev: f64,
    /// What e(k) had a period ago of the way between Z's motor and the load.
    unseen_mm: f64,
    /// An alarm ended the hole.
    failed: bool,
    /// It is gone on with from rest in it, after a loss of power, and has not begun.
    is_restored: bool,
    /// It was acknowledged, and the next period goes on from rest at an angle that is not the plan's.
    restarts_rev: Option<f64>,
}

impl Synchronizer {
    /// For one planned hole, where the spindle is commanded to rest at `spindle_rest_rev` and Z at the R plane.
    ///
    /// ```
    /// use rigidtap::control::cycle::{CyclePlan, TapCycle};
    /// use rigidtap::control::machine::{Law, Machine};
    /// use rigidtap::control::port::Feedback;
    /// use rigidtap::control::sync::{Adaptation, Compensation, Settings, Stage, Synchronizer};
    ///
    /// let machine = Machine::reference();
    /// let hole = TapCycle::right_hand(2.0, -10.0, 1.0, 3000.0);
    /// let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).unwrap();
    /// let settings = Settings { compensation: Compensation::Uncompensated, ..Settings::default() };
    /// let mut adaptation = Adaptation::new(&machine);
    /// let mut synchronizer = Synchronizer::new(plan, settings, 0.0);
    /// // A host that has no machine: its encoders read exactly what was commanded.
    /// let mut feedback = Feedback { z_counts: 20_000, ..Feedback::default() };
    /// let mut deepest_mm = f64::INFINITY;
    /// for period in 0.. {
    ///     let step = synchronizer.step(f64::from(period) * 0.001, &feedback, &mut adaptation);
    ///     if step.stage == Stage::Done {
    ///         break;
    ///     }
    ///     deepest_mm = step.z.position.min(deepest_mm);
    ///     feedback.spindle_counts = (step.spindle.position * 16_384.0).round() as i64;
    ///     feedback.z_counts = (step.z.position * 10_000.0).round() as i64;
    /// }
    /// assert!((deepest_mm + 10.0).abs() < 0.002);
    /// ```
    #[must_use]
    pub fn new(plan: CyclePlan, settings: Settings, spindle_rest_rev: f64) -> Self {
        let machine: &Machine = plan.machine();
        let strategy = Strategy::new(&plan, machine, settings);
        let period_s = machine.spec().control.period_s;
        Self {
            frame: Frame::new(machine, plan.cycle(), spindle_rest_rev),
            in_position: InPosition::new(machine),
            supervision: Supervision::new(&plan, settings, spindle_rest_rev),
            drives: Drives::new(machine, settings),
            settings,
            period_s,
            r_plane_mm: plan.cycle().r_plane_mm,
            last_spindle_rev: 0.0,
            unseen_mm: 0.0,
            failed: false,
            is_restored: false,
            restarts_rev: None,
            trajectory: Trajectory::new(plan, period_s, strategy.inner().tail_s()),
            strategy,
        }
    }

    /// For a hole that was broken off, by the zero of its helix: [`Standing::zero`](super::Standing). Spindle and Z rest in it, and are
    /// held where they stand until [`Synchronizer::retract`]; it is not resumed. What Z stands off the helix is led back to it slowly.
    #[must_use]
    pub fn restored(plan: CyclePlan, settings: Settings, zero: HelixZero) -> Self {
        let frame = Frame::of_helix(plan.machine(), plan.cycle(), zero);
        let new = Self::new(plan, settings, frame.spindle_rest_rev());
        Self { frame, failed: true, is_restored: true, ..new }
    }

    /// The zero of the hole's helix, from its first synchronous period on.
    #[must_use]
    pub fn helix_zero(&self) -> Option<HelixZero> {
        self.trajectory.has_begun().then(|| self.frame.zero())
    }

    /// Brakes spindle and Z together from the period of `now_s` on, and holds them: [`CyclePlan::stop`]. Before the first
    /// synchronous period nothing will move; after the last there is nothing to stop.
    pub fn stop(&mut self, now_s: f64) {
        if self.supervision.stop().is_none() {
            self.trajectory.stop(self.supervision.of_order(now_s));
        }
    }

    /// Brings a stopped tap back to the R plane, spindle and Z in synchronism: [`CyclePlan::retract`].
    ///
    /// # Errors
    /// [`InterruptionError`], and the tap stays held.
    pub fn retract(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        if self.supervision.alarm().is_some() {
            return Err(InterruptionError::AlarmLatched);
        }
        self.trajectory.retract(self.supervision.of_order(now_s))
    }

    /// Lets a stopped tap go on: [`CyclePlan::resume`].
    ///
    /// # Errors
    /// As [`Synchronizer::retract`], and [`InterruptionError::HoleFailed`] once an alarm ended the hole.
    pub fn resume(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        if self.supervision.alarm().is_some() {
            return Err(InterruptionError::AlarmLatched);
        }
        if self.failed {
            return Err(InterruptionError::HoleFailed);
        }
        self.trajectory.resume(self.supervision.of_order(now_s))
    }

    /// Forgets the latched alarm, if both axes rest: [`Stage::Held`]. A hole that an alarm ended can then be retracted; a wait
    /// that raised it begins anew. False where they still move, and it stays latched.
    pub fn acknowledge(&mut self) -> bool {
        let at_rest = self.supervision.is_at_rest();
        if at_rest {
            self.restarts_rev = self.supervision.acknowledge();
        }
        at_rest
    }

    /// Where the spindle is commanded to rest before the hole and after it, rev.
    #[must_use]
    pub fn spindle_rest_rev(&self) -> f64 {
        self.frame.spindle_rest_rev()
    }

    /// The hole's plan.
    #[must_use]
    pub fn plan(&self) -> &CyclePlan {
        self.trajectory.plan()
    }

    /// Samples for which the model stood in so far.
    #[must_use]
    pub fn bridged_samples(&self) -> u64 {
        self.supervision.bridged_samples()
    }

    /// One period: what the encoders read at `now_s`, and the setpoint for that time. There is always a setpoint, finite and
    /// within the machine's limits; an alarm stands beside it.
    pub fn step(&mut self, now_s: f64, feedback: &Feedback, adaptation: &mut Adaptation) -> Step {
        let tick = self.supervision.tick(now_s);
        // Periods that the host left out are made up by the model: at most as many as are bridged.
        for missed in (1..tick.periods).rev() {
            self.period(tick.now_s - f64::from(missed) * self.period_s, None, None, adaptation);
        }
        self.period(tick.now_s, Some(feedback), tick.alarm, adaptation)
    }

    fn period(
        &mut self,
        now_s: f64,
        told: Option<&Feedback>,
        of_clock: Option<Alarm>,
        adaptation: &mut Adaptation,
    ) -> Step {
        let (feedback, of_samples) = self.supervision.check(now_s, told);
        let measured = self.frame.measure(&feedback);
        let wanted = if self.trajectory.has_begun() {
            self.synchronous(now_s, &feedback, &measured, of_clock.or(of_samples), adaptation)
        } else {
            self.before(now_s, &feedback, &measured, of_clock.or(of_samples), adaptation)
        };
        let [spindle, z] = self.supervision.bound(&wanted.spindle, &wanted.z, wanted.spindle_torque_nm);
        let bridged = !(feedback.spindle.sample_valid && feedback.z.sample_valid);
        let step = self.drives.sent(&Step { spindle, z, alarm: self.supervision.alarm(), bridged, ..wanted });
        if step.stage == Stage::Done {
            let off_mm = step.z.position - self.r_plane_mm;
            let interrupted = self.trajectory.was_interrupted();
            self.strategy.inner().finish(adaptation, interrupted, off_mm, step.z_force_n);
        }
        step
    }

    /// Before the hole: the wait for rest at R, and its end.
    fn before(
        &mut self,
        now_s: f64,
        feedback: &Feedback,
        measured: &Measured,
        fault: Option<Alarm>,
        adaptation: &mut Adaptation,
    ) -> Step {
        if let Some(alarm) = fault {
            self.supervision.raise(alarm);
        }
        if self.is_restored {
            self.restore(now_s, measured, adaptation);
            return self.synchronous(now_s, feedback, measured, None, adaptation);
        }
        if let Some(settling) = self.settle(now_s, measured, adaptation) {
            return settling;
        }
        self.frame.latch_zero(measured);
        self.trajectory.begin(now_s);
        let known = adaptation.known(self.settings.identify).drives;
        self.drives.begin(adaptation.residual().z.position, &known);
        self.strategy.inner_mut().begin(0.0, &mut self.trajectory, measured, adaptation);
        self.synchronous(now_s, feedback, measured, None, adaptation)
    }

    fn synchronous(
        &mut self,
        now_s: f64,
        feedback: &Feedback,
        measured: &Measured,
        fault: Option<Alarm>,
        adaptation: &mut Adaptation,
    ) -> Step {
        if let Some(rest_rev) = self.restarts_rev.take() {
            self.restart(now_s, rest_rev, measured, adaptation);
        }
        let travel = self.frame.travel(measured);
        let error_mm = synchronisation_error_mm(travel.z_mm, self.plan().thread().pitch_mm, travel.spindle_rev);
        let seen = Observation { spindle_rev: travel.spindle_rev, error_mm: error_mm - self.unseen_mm, feedback };
        if let Some(alarm) = fault.or(self.supervision.judge(&seen)) {
            self.fail(now_s, alarm);
        }
        let spindle_rev_per_s = (travel.spindle_rev - self.last_spindle_rev) / self.period_s;
        self.last_spindle_rev = travel.spindle_rev;
        self.in_position.decay_offset();
        if let Some(axes) = self.supervision.followed() {
            adaptation.observe_measured(measured);
            return self.answer_followed(now_s, axes, error_mm);
        }
        let inputs = Inputs { now_s, travel, spindle_rev_per_s, error_mm, measured };
        let command = self.strategy.inner_mut().step(&mut self.trajectory, &inputs, adaptation);
        self.unseen_mm = command.unseen_mm;
        let torque_nm = measured.spindle_torque_nm.map(|torque_nm| self.plan().cycle().hand.sign() * torque_nm);
        adaptation.cutting_torque.observe(command.planned.kind, torque_nm);
        let deeper_mm = self.in_position.start_offset_mm() + command.z_offset_mm;
        self.supervision.note_commands(&command.axes, deeper_mm);
        let stage = Stage::Synchronous(command.planned, self.trajectory.interruption(command.plan_s));
        let step = self.answer(self.stopping().unwrap_or(stage), &command, deeper_mm, error_mm);
        if self.trajectory.is_synchronous(command.plan_s) {
            return step;
        }
        // Z is released only from a spindle that rests: one that lost its command is still turning in the thread.
        let done = self.check(now_s, measured, step.z.position, false);
        if done && self.supervision.alarm().is_none() {
            let judged = !self.trajectory.was_interrupted() && self.supervision.watches();
            let cut = if judged { adaptation.cutting_torque.finish() } else { None };
            let warning = cut.map(|TooLittle { torque_nm, limit_nm }| Alarm::TapBroken { torque_nm, limit_nm });
            return Step { stage: Stage::Done, warning, ..step };
        }
        Step { stage: self.waiting(), ..step }
    }

    /// An alarm in the hole.
    fn fail(&mut self, now_s: f64, alarm: Alarm) {
        self.failed = true;
        if self.supervision.react(alarm) {
            self.trajectory.stop(now_s);
        }
    }

    /// What is done about an alarm, as long as both axes move.
    fn stopping(&self) -> Option<Stage> {
        let stop = self.supervision.stop()?;
        if self.supervision.is_at_rest() {
            return Some(Stage::Held);
        }
        Some(match stop {
            StopKind::Synchronous => Stage::SynchronousStop,
            StopKind::Model => Stage::ModelStop,
            StopKind::ZLost => Stage::ZLost,
        })
    }

    /// A period of a stop that does not brake on the plan.
    fn answer_followed(&mut self, now_s: f64, axes: AxisCommands, error_mm: f64) -> Step {
        let plan_s = self.trajectory.plan_s(now_s);
        let planned = self.trajectory.at(plan_s);
        let command =
            Command { axes, z_offset_mm: 0.0, correction_mm: 0.0, unseen_mm: 0.0, plan_s, planned, path_rate: 1.0 };
        self.answer(self.stopping().unwrap_or(Stage::Held), &command, 0.0, error_mm)
    }

    /// The first period of a hole that is gone on with: both axes rest where they are measured.
    #[inline(never)]
    fn restore(&mut self, now_s: f64, measured: &Measured, adaptation: &mut Adaptation) {
        let travel = self.frame.travel(measured);
        let pitch_mm = self.plan().thread().pitch_mm;
        self.in_position.stand(synchronisation_error_mm(travel.z_mm, pitch_mm, travel.spindle_rev));
        self.supervision.rest_at(travel.spindle_rev, travel.z_mm);
        self.last_spindle_rev = travel.spindle_rev;
        self.trajectory.begin(now_s);
        self.restart(now_s, travel.spindle_rev, measured, adaptation);
    }

    /// Goes on from where a fault left both axes at rest. Not part of its caller, whose every period would take its stack.
    #[inline(never)]
    fn restart(&mut self, now_s: f64, rest_rev: f64, measured: &Measured, adaptation: &mut Adaptation) {
        adaptation.resume_hole();
        self.trajectory.hold_at(now_s, rest_rev);
        let plan_s = self.trajectory.plan_s(now_s);
        self.strategy.inner_mut().begin(plan_s, &mut self.trajectory, measured, adaptation);
    }

    /// Waits for rest at R; none once spindle and Z are in position.
    fn settle(&mut self, now_s: f64, measured: &Measured, adaptation: &mut Adaptation) -> Option<Step> {
        if self.check(now_s, measured, self.r_plane_mm, true) && self.supervision.alarm().is_none() {
            return None;
        }
        let (_, with_offset) = self.strategy.inner().start();
        let z_deep_mm = self.frame.position_error(measured, self.r_plane_mm).z_deep_mm;
        let velocity = if with_offset { self.in_position.follow_z(z_deep_mm) } else { 0.0 };
        let axes = AxisCommands { z: State { velocity, ..State::default() }, ..AxisCommands::default() };
        let residual = adaptation.observe_measured(measured);
        let machine = self.frame.machine(&axes, self.in_position.start_offset_mm());
        let rest = Step { spindle: machine.spindle, z: machine.z, ..Step::default() };
        let setpoint = residual.added_to(rest.setpoint(State::default(), State::default()));
        Some(Step { stage: self.waiting(), z: setpoint.z, z_force_n: setpoint.z_force_n, ..rest })
    }

    /// Whether spindle and Z are in position, Z at a height; an alarm where they do not get there.
    fn check(&mut self, now_s: f64, measured: &Measured, z_target_mm: f64, starts: bool) -> bool {
        let error = self.frame.position_error(measured, z_target_mm);
        let window = if starts { self.strategy.inner().start().0 } else { END };
        self.in_position.check(now_s, error, &window).unwrap_or_else(|alarm| {
            self.supervision.raise(alarm);
            false
        })
    }

    fn waiting(&self) -> Stage {
        if self.supervision.alarm().is_some() { Stage::Held } else { Stage::Settling }
    }

    /// A command in machine coordinates.
    fn answer(&self, stage: Stage, command: &Command, deeper_mm: f64, error_mm: f64) -> Step {
        let machine = self.frame.machine(&command.axes, deeper_mm);
        Step {
            stage,
            spindle: machine.spindle,
            z: machine.z,
            spindle_torque_nm: machine.spindle_torque_nm,
            z_force_n: machine.z_force_n,
            error_mm: error_mm - command.unseen_mm,
            correction_mm: command.correction_mm,
            path_rate: command.path_rate,
            ..Step::default()
        }
    }
}
