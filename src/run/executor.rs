//! The loop.

use std::collections::VecDeque;

use crate::control::cycle::{CyclePlan, StrokeKind};
use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::port::{Feedback, Port, Setpoint};
use crate::control::sync::{Alarm, Compensation, Identified, Scale, Settings, Stage, Step, synchronisation_error_mm};
use crate::control::tapping::Tapping;
use crate::control::units::um_from_mm;
use crate::gcode::program::{Action, Move, Overrides, straight};
use crate::gcode::{Options, SpindleCommand};

use super::fault::Fault;
use super::listener::Listener;
use super::monitor::{HoleOutcome, Monitor};
use super::power_cut::PowerCut;
use super::row::{Row, RowStage};
use super::spindle_motion::SpindleMotion;

/// A machine that has not come to rest so long after an alarm is given up.
const LONGEST_STOP_S: f64 = 20.0;
/// A hole takes at most so many times its plan, slowed down and in position at both ends, and so much longer: beyond it the
/// control's clock does not go on.
const MOST_OVER_PLAN: f64 = 10.0;
const MOST_WAIT_S: f64 = 10.0;

/// How a program is run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSettings {
    /// How each hole is synchronised.
    pub sync: Settings,
    /// Before the first hole its strokes are run in air, for `compensation = full` to identify the machine.
    pub dry_cycle: bool,
    /// Where the machine stands at first.
    pub start_mm: [f64; 3],
    /// When the power is lost, and of what.
    pub power_cut: Option<PowerCut>,
}

impl Default for RunSettings {
    /// Starts where programs are read from, too.
    fn default() -> Self {
        Self { sync: Settings::default(), dry_cycle: false, start_mm: Options::default().start_mm, power_cut: None }
    }
}

/// A hole in which the power was lost.
pub(super) struct CutHole {
    pub(super) plan: CyclePlan,
    /// Its number, from 1.
    pub(super) hole: u32,
    pub(super) monitor: Monitor,
}

/// Runs actions against a port, a listener beside it.
pub struct Executor<'a, P: Port> {
    pub(super) machine: &'a Machine,
    pub(super) port: &'a mut P,
    pub(super) settings: RunSettings,
    k: u64,
    saturated_periods: u64,
    holes: u32,
    pub(super) axes: [State; 3],
    spindle: SpindleMotion,
    /// Past setpoints, newest first: what is in force arrives late.
    sent: VecDeque<Setpoint>,
    /// What was measured and learned so far, and the hole under way.
    pub(super) tapping: Tapping,
    scale: Scale,
    /// True travels' zero of the hole being tapped.
    true_zero: Option<(f64, f64)>,
    /// The power was lost in this hole.
    cut: Option<Box<CutHole>>,
    /// The hole that a fault ended.
    unfinished: Option<HoleOutcome>,
}

impl<'a, P: Port> Executor<'a, P> {
    /// For a machine at rest at the settings' start.
    pub fn new(machine: &'a Machine, port: &'a mut P, settings: RunSettings) -> Self {
        let axes = settings.start_mm.map(|position| State { position, ..State::default() });
        let rest = setpoint(State::default(), axes);
        let kept = machine.spec().drive.latency_periods.ceil() as usize + 2;
        Self {
            machine,
            port,
            settings,
            k: 0,
            saturated_periods: 0,
            holes: 0,
            axes,
            spindle: SpindleMotion::at_rest(0.0),
            sent: std::iter::repeat_n(rest, kept).collect(),
            tapping: Tapping::new(machine),
            scale: Scale::of(machine),
            true_zero: None,
            cut: None,
            unfinished: None,
        }
    }

    /// What is known of the machine so far.
    #[must_use]
    pub fn identified(&self) -> Identified {
        self.tapping.identified()
    }

    /// The hole that a fault ended, judged as far as it came.
    pub fn take_unfinished(&mut self) -> Option<HoleOutcome> {
        self.unfinished.take()
    }

    /// Where it stands, for an alarm that ended a hole or is a warning of one.
    pub(super) fn fault(&self, alarm: Alarm) -> Fault {
        let (k, saturated_periods, hole) = (self.k, self.saturated_periods, self.holes);
        Fault { k, time_s: self.now_s(), hole, saturated_periods, alarm }
    }

    /// Time since the program's start.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.k as f64 * self.machine.spec().control.period_s
    }

    /// The power cut, once it has come.
    pub(super) fn power_lost(&self) -> Option<PowerCut> {
        self.settings.power_cut.filter(|cut| self.now_s() >= cut.at_s)
    }

    /// The hole in which the power was lost, once.
    pub(super) fn take_cut(&mut self) -> Option<Box<CutHole>> {
        self.cut.take()
    }

    /// The setpoint that was sent last.
    pub(super) fn last_sent(&self) -> Setpoint {
        self.sent.front().copied().unwrap_or_default()
    }

    /// The time by the count of periods, and what the host's clock shows for it.
    pub(super) fn read_clock(&mut self) -> (f64, f64) {
        let now_s = self.now_s();
        (now_s, self.port.clock_s(now_s))
    }

    /// Carries out one action; a hole yields its outcome, but not one in which the power is lost.
    ///
    /// # Errors
    /// [`Fault`]: the run cannot go on.
    pub fn run(&mut self, action: &Action, listener: &mut dyn Listener) -> Result<Option<HoleOutcome>, Fault> {
        match action {
            Action::Spindle(command) => {
                self.spindle.command(self.now_s(), *command, self.machine);
                Ok(None)
            }
            Action::Dwell(dwell_s) => {
                let end_s = self.now_s() + dwell_s;
                while self.now_s() < end_s {
                    self.free_period(RowStage::Rapid, 0, 0, listener);
                }
                Ok(None)
            }
            Action::Move(line) => {
                self.travel(line, listener);
                Ok(None)
            }
            Action::Tap(plan) => self.tap(plan, listener),
        }
    }

    /// Waits for the spindle to reach its last commanded speed, and for the last setpoint to act.
    pub fn finish(&mut self, listener: &mut dyn Listener) {
        self.wait_for_spindle(0, listener);
        for _ in 0..self.sent.len() {
            self.free_period(RowStage::Rapid, 0, 0, listener);
        }
    }

    fn wait_for_spindle(&mut self, hole: u32, listener: &mut dyn Listener) {
        while !self.spindle.at_speed(self.now_s()) {
            self.free_period(RowStage::Orient, 0, hole, listener);
        }
    }

    fn travel(&mut self, line: &Move, listener: &mut dyn Listener) {
        if !line.rapid {
            self.wait_for_spindle(0, listener);
        }
        self.go_to(line.path.follow(&State::default()).map(|axis| axis.position), listener);
        self.follow(line, listener);
    }

    /// After a hole that leaves no residual, Z stands a little off: from there to where the next action starts, at rapid speed.
    fn go_to(&mut self, target_mm: [f64; 3], listener: &mut dyn Listener) {
        let from_mm = self.axes.map(|axis| axis.position);
        // A way too short to plan is left to the next setpoint.
        if let Ok(Some(line)) = straight(self.machine, from_mm, target_mm, None, Overrides::default()) {
            self.follow(&line, listener);
        }
    }

    fn follow(&mut self, line: &Move, listener: &mut dyn Listener) {
        let start_s = self.now_s();
        loop {
            let path_s = self.now_s() - start_s;
            self.axes = line.path.follow(&line.profile.at(path_s));
            if path_s >= line.profile.duration_s() {
                return;
            }
            self.free_period(RowStage::Rapid, line.profile.segment_at(path_s), 0, listener);
        }
    }

    /// One period outside a hole's synchronous strokes.
    fn free_period(&mut self, stage: RowStage, phase: usize, hole: u32, listener: &mut dyn Listener) {
        let (now_s, clock_s) = self.read_clock();
        let feedback = self.port.read(now_s);
        let residual = self.tapping.observe(clock_s, &feedback);
        let setpoint = residual.added_to(setpoint(self.spindle.at(now_s), self.axes));
        let row = self.row(stage, phase, hole, setpoint, feedback);
        self.tapping.note_commanded(&setpoint);
        self.exchange(row, 0.0, listener);
    }

    fn tap(&mut self, plan: &CyclePlan, listener: &mut dyn Listener) -> Result<Option<HoleOutcome>, Fault> {
        let adapts = self.settings.sync.compensation == Compensation::ModelBased;
        if self.settings.dry_cycle && adapts && self.holes == 0 {
            self.dry_cycle(plan, listener)?;
        }
        self.holes += 1;
        self.port.begin_hole(plan.cycle());
        let mut monitor = Monitor::new(self.holes, plan, self.machine);
        let done = self.cycle(plan, self.holes, &mut |row| monitor.observe(row), listener);
        if done.is_ok() && self.power_lost().is_some() && self.tapping.plan().is_some() {
            self.cut = Some(Box::new(CutHole { plan: plan.clone(), hole: self.holes, monitor }));
            return Ok(None);
        }
        match done {
            Ok(warning) => Ok(Some(monitor.finish(warning))),
            Err(fault) => {
                let outcome = monitor.finish(Some(fault.alarm));
                listener.unfinished(&outcome);
                self.unfinished = Some(outcome);
                Err(fault)
            }
        }
    }

    /// The hole's strokes in air, above where Z stands, so that the machine shows itself: rows of hole 0.
    fn dry_cycle(&mut self, plan: &CyclePlan, listener: &mut dyn Listener) -> Result<(), Fault> {
        let [x_mm, y_mm, z_mm] = self.axes.map(|axis| axis.position);
        let raised = plan.with_r_plane(z_mm + plan.cycle().depth_mm());
        // What air leaves of e(k) is not what a hole will.
        let learn = std::mem::take(&mut self.settings.sync.learn);
        let done = self.cycle(&raised, 0, &mut |_| (), listener);
        self.settings.sync.learn = learn;
        done?;
        self.go_to([x_mm, y_mm, z_mm], listener);
        Ok(())
    }

    fn cycle(
        &mut self,
        plan: &CyclePlan,
        hole: u32,
        judge: &mut dyn FnMut(&Row),
        listener: &mut dyn Listener,
    ) -> Result<Option<Alarm>, Fault> {
        let cycle = plan.cycle();
        self.go_to([cycle.x_mm, cycle.y_mm, cycle.r_plane_mm], listener);
        self.spindle.command(self.now_s(), SpindleCommand::Off, self.machine);
        self.wait_for_spindle(hole, listener);
        let rest_rev = self.spindle.at(self.now_s()).position;
        // At rest at a finite angle: nothing has to be braked, and any turn to a start angle has its plan. This cannot fail.
        let (begun_s, begun_clock_s) = self.read_clock();
        let most_s = MOST_OVER_PLAN * plan.duration_s() + MOST_WAIT_S;
        let _ = self.tapping.start(plan.clone(), self.settings.sync, begun_clock_s, rest_rev, 0.0);
        let rest_rev = self.tapping.spindle_rest_rev().unwrap_or(rest_rev);
        self.true_zero = None;
        let (mut fault, mut kind, mut warning) = (None, StrokeKind::In, None);
        tracing::debug!(hole, identified = ?self.identified(), "at rest over the hole");
        loop {
            if hole > 0 && self.power_lost().is_some() {
                return Ok(None);
            }
            let (now_s, clock_s) = self.read_clock();
            let feedback = self.port.read(now_s);
            let Some(step) = self.tapping.step(clock_s, &feedback) else { break };
            let endless = || {
                let alarm = Alarm::Clock { elapsed_s: clock_s - begun_clock_s, limit_s: most_s };
                (now_s - begun_s > most_s).then_some(alarm)
            };
            if let Some(alarm) = step.alarm.or_else(endless) {
                let (k, saturated_periods) = (self.k, self.saturated_periods);
                let fault = *fault.get_or_insert(Fault { k, time_s: now_s, hole, saturated_periods, alarm });
                // What the fault leaves of the thread is seen until both axes rest, or will not.
                let given_up = now_s > fault.time_s + LONGEST_STOP_S || step.alarm.is_none();
                if step.stage == Stage::Held || given_up {
                    return Err(fault);
                }
            }
            let [x, y, _] = self.axes;
            let setpoint = step.setpoint(x, y);
            self.axes[2] = step.z;
            let row = match step.stage {
                Stage::Done => {
                    warning = step.warning;
                    break;
                }
                Stage::Synchronous(stroke, _) if hole > 0 => {
                    kind = stroke.kind;
                    let row = self.row(RowStage::Stroke(kind), stroke.phase, hole, setpoint, feedback);
                    self.synchronous(row, &step, plan)
                }
                Stage::SynchronousStop | Stage::ModelStop | Stage::ZLost if hole > 0 => {
                    let row = self.row(RowStage::Stroke(kind), 0, hole, setpoint, feedback);
                    self.synchronous(row, &step, plan)
                }
                _ => self.row(RowStage::Orient, 0, hole, setpoint, feedback),
            };
            judge(&row);
            self.exchange(row, plan.cycle().pitch_mm, listener);
        }
        let base_mm = self.axes[2].position - self.tapping.residual().z.position;
        self.axes[2] = State { position: base_mm, ..State::default() };
        self.spindle = SpindleMotion::at_rest(rest_rev);
        Ok(warning)
    }

    /// Adds to a row what only a synchronous period has.
    pub(super) fn synchronous(&mut self, row: Row, step: &Step, plan: &CyclePlan) -> Row {
        let true_error_um = row.truth.map(|truth| {
            let (spindle_zero, z_zero) = *self.true_zero.get_or_insert((truth.spindle_rev, truth.z_mm));
            let spindle_rev = plan.cycle().hand.sign() * (truth.spindle_rev - spindle_zero);
            um_from_mm(synchronisation_error_mm(z_zero - truth.z_mm, plan.thread().pitch_mm, spindle_rev))
        });
        Row {
            bridged: step.bridged,
            error_um: Some(um_from_mm(step.error_mm)),
            correction_um: um_from_mm(step.correction_mm),
            slowed: 1.0 - step.path_rate,
            true_error_um,
            ..row
        }
    }

    pub(super) fn row(&self, stage: RowStage, phase: usize, hole: u32, setpoint: Setpoint, feedback: Feedback) -> Row {
        let (spindle_rev, z_mm) = self.in_force(&setpoint);
        Row {
            k: self.k,
            time_s: self.now_s(),
            hole,
            stage,
            phase,
            setpoint,
            feedback,
            bridged: false,
            truth: self.port.truth(),
            spindle_following_error_rev: spindle_rev - self.scale.spindle_rev(feedback.spindle_counts),
            z_following_error_um: um_from_mm(z_mm - self.scale.z_mm(feedback.z_counts)),
            correction_um: 0.0,
            slowed: 0.0,
            error_um: None,
            true_error_um: None,
        }
    }

    /// Spindle and Z command that the drives hold at this instant: that of `latency_periods` ago.
    fn in_force(&self, newest: &Setpoint) -> (f64, f64) {
        let late = self.machine.spec().drive.latency_periods;
        let at = |periods: usize| match periods.checked_sub(1) {
            None => newest,
            Some(ago) => self.sent.get(ago).unwrap_or(newest),
        };
        let (whole, part) = (late.floor(), late.fract());
        let (new, old) = (at(whole as usize), at(whole as usize + 1));
        let between = |new: f64, old: f64| new + part * (old - new);
        (between(new.spindle.position, old.spindle.position), between(new.z.position, old.z.position))
    }

    pub(super) fn exchange(&mut self, row: Row, pitch_mm: f64, listener: &mut dyn Listener) {
        listener.row(pitch_mm, &row);
        self.port.write(row.time_s, &row.setpoint);
        self.saturated_periods += u64::from(row.feedback.torque_saturated());
        self.sent.pop_back();
        self.sent.push_front(row.setpoint);
        self.k += 1;
    }
}

fn setpoint(spindle: State, [x, y, z]: [State; 3]) -> Setpoint {
    Setpoint { spindle, x, y, z, ..Setpoint::default() }
}
