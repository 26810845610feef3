//! The loop.

use std::collections::VecDeque;

use crate::control::cycle::{CyclePlan, LegKind};
use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::port::{Feedback, Port, Setpoint};
use crate::control::sync::{Alarm, Settings, Stage, Step, Synchronizer, synchronisation_error_mm};
use crate::control::units::um_from_mm;
use crate::gcode::SpindleCommand;
use crate::gcode::program::{Action, Move};

use super::monitor::{HoleOutcome, Monitor};
use super::program::Observer;
use super::row::{Row, RowStage};
use super::spindle_motion::SpindleMotion;

/// How a program is run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RunSettings {
    /// How each hole is synchronised.
    pub sync: Settings,
    /// Where the machine stands at first.
    pub start_mm: [f64; 3],
}

/// A fault that ended a run, with its period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fault {
    /// Period, from 0 at the program's start.
    pub k: u64,
    /// Its time.
    pub time_s: f64,
    /// Hole, from 1.
    pub hole: u32,
    /// What happened.
    pub alarm: Alarm,
}

/// Runs actions against a port, an observer beside it.
pub struct Executor<'a, P: Port> {
    machine: &'a Machine,
    port: &'a mut P,
    settings: RunSettings,
    k: u64,
    holes: u32,
    axes: [State; 3],
    spindle: SpindleMotion,
    /// Past setpoints, newest first: what is in force arrives late.
    sent: VecDeque<Setpoint>,
    /// True travels' zero of the hole being tapped.
    true_zero: Option<(f64, f64)>,
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
            holes: 0,
            axes,
            spindle: SpindleMotion::at_rest(0.0),
            sent: std::iter::repeat_n(rest, kept).collect(),
            true_zero: None,
        }
    }

    /// Time since the program's start.
    #[must_use]
    pub fn now_s(&self) -> f64 {
        self.k as f64 * self.machine.spec().control.period_s
    }

    /// Carries out one action; a hole yields its outcome.
    ///
    /// # Errors
    /// [`Fault`]: the run cannot go on.
    pub fn run(&mut self, action: &Action, observer: &mut dyn Observer) -> Result<Option<HoleOutcome>, Fault> {
        match action {
            Action::Spindle(command) => {
                self.spindle.command(self.now_s(), *command, self.machine);
                Ok(None)
            }
            Action::Dwell(dwell_s) => {
                let end_s = self.now_s() + dwell_s;
                while self.now_s() < end_s {
                    self.free_period(RowStage::Rapid, 0, observer);
                }
                Ok(None)
            }
            Action::Move(line) => {
                self.travel(line, observer);
                Ok(None)
            }
            Action::Tap(plan) => self.tap(plan, observer).map(Some),
        }
    }

    /// Waits for the spindle to reach its last commanded speed: a program is over when it has stopped.
    pub fn finish(&mut self, observer: &mut dyn Observer) {
        while !self.spindle.at_speed(self.now_s()) {
            self.free_period(RowStage::Orient, 0, observer);
        }
    }

    fn travel(&mut self, line: &Move, observer: &mut dyn Observer) {
        if !line.rapid {
            while !self.spindle.at_speed(self.now_s()) {
                self.free_period(RowStage::Orient, 0, observer);
            }
        }
        let start_s = self.now_s();
        // After a hole with corrections Z stands a little off where the line starts: that fades with the path.
        let nominal = line.path.follow(&State::default());
        let offset: [f64; 3] = std::array::from_fn(|axis| self.axes[axis].position - nominal[axis].position);
        loop {
            let path_s = self.now_s() - start_s;
            let path = line.profile.at(path_s);
            let left = 1.0 - path.position / line.path.length_mm();
            self.axes = line.path.follow(&path);
            for (axis, offset) in self.axes.iter_mut().zip(offset) {
                axis.position += left * offset;
                axis.velocity -= path.velocity / line.path.length_mm() * offset;
            }
            if path_s >= line.profile.duration_s() {
                return;
            }
            self.free_period(RowStage::Rapid, line.profile.segment_at(path_s), observer);
        }
    }

    /// One period outside a hole's synchronous legs.
    fn free_period(&mut self, stage: RowStage, phase: usize, observer: &mut dyn Observer) {
        let now_s = self.now_s();
        let feedback = self.port.read(now_s);
        let row = self.row(stage, phase, setpoint(self.spindle.at(now_s), self.axes), feedback);
        self.exchange(row, 0.0, observer);
    }

    fn tap(&mut self, plan: &CyclePlan, observer: &mut dyn Observer) -> Result<HoleOutcome, Fault> {
        self.holes += 1;
        self.port.begin_hole(plan.cycle());
        self.spindle.command(self.now_s(), SpindleCommand::Off, self.machine);
        while !self.spindle.at_speed(self.now_s()) {
            self.free_period(RowStage::Orient, 0, observer);
        }
        let rest_rev = self.spindle.at(self.now_s()).position;
        let mut synchronizer = Synchronizer::new(plan.clone(), self.machine, self.settings.sync, rest_rev);
        let mut monitor = Monitor::new(self.holes, plan, self.machine);
        self.true_zero = None;
        loop {
            let now_s = self.now_s();
            let feedback = self.port.read(now_s);
            let step = synchronizer.step(now_s, &feedback).map_err(|alarm| Fault {
                k: self.k,
                time_s: now_s,
                hole: self.holes,
                alarm,
            })?;
            let [x, y, _] = self.axes;
            let row = match step.stage {
                Stage::Done => break,
                Stage::Settling => self.row(RowStage::Orient, 0, setpoint(step.spindle, [x, y, step.z]), feedback),
                Stage::Synchronous(leg) => {
                    let row =
                        self.row(RowStage::Leg(leg.kind), leg.phase, setpoint(step.spindle, [x, y, step.z]), feedback);
                    self.synchronous(row, &step, plan)
                }
            };
            monitor.observe(&row);
            self.axes[2] = step.z;
            self.exchange(row, plan.cycle().pitch_mm, observer);
        }
        self.axes[2] = State { position: self.axes[2].position, ..State::default() };
        self.spindle = SpindleMotion::at_rest(rest_rev);
        Ok(monitor.finish())
    }

    /// Adds to a row what only a synchronous period has.
    fn synchronous(&mut self, row: Row, step: &Step, plan: &CyclePlan) -> Row {
        let true_error_um = row.truth.map(|truth| {
            let (spindle_zero, z_zero) = *self.true_zero.get_or_insert((truth.spindle_rev, truth.z_mm));
            let spindle_rev = plan.cycle().hand.sign() * (truth.spindle_rev - spindle_zero);
            um_from_mm(synchronisation_error_mm(z_zero - truth.z_mm, plan.thread().pitch_mm, spindle_rev))
        });
        Row {
            error_um: Some(um_from_mm(step.error_mm)),
            correction_um: um_from_mm(step.correction_mm),
            true_error_um,
            ..row
        }
    }

    fn row(&self, stage: RowStage, phase: usize, setpoint: Setpoint, feedback: Feedback) -> Row {
        let spec = self.machine.spec();
        let (spindle_rev, z_mm) = self.in_force(&setpoint);
        let hole = if matches!(stage, RowStage::Rapid) { 0 } else { self.holes };
        Row {
            k: self.k,
            time_s: self.now_s(),
            hole,
            stage,
            phase,
            setpoint,
            feedback,
            truth: self.port.truth(),
            spindle_following_error_rev: spindle_rev
                - feedback.spindle_counts as f64 / spec.spindle.encoder_counts_per_rev,
            z_following_error_um: um_from_mm(z_mm - feedback.z_counts as f64 / spec.z_axis.encoder_counts_per_mm),
            correction_um: 0.0,
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

    fn exchange(&mut self, row: Row, pitch_mm: f64, observer: &mut dyn Observer) {
        observer.row(pitch_mm, &row);
        self.port.write(row.time_s, &row.setpoint);
        self.sent.pop_back();
        self.sent.push_front(row.setpoint);
        self.k += 1;
    }
}

fn setpoint(spindle: State, [x, y, z]: [State; 3]) -> Setpoint {
    Setpoint { spindle, x, y, z }
}

/// Whether a leg moves the tap: dwell does not.
pub(super) const fn is_stroke(kind: LegKind) -> bool {
    matches!(kind, LegKind::In | LegKind::Out)
}
