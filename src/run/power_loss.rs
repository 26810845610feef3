//! A power cut in a run: both axes come to rest, the control is gone, and after the restart the tap is led out of the hole, or not.

use crate::control::cycle::Interrupted;
use crate::control::port::{Feedback, Port, Setpoint};
use crate::control::sync::{Alarm, Stage, Standing};
use crate::control::tapping::{PowerLossRecord, RestoreError, RestoredHole, Tapping};

use super::executor::{CutHole, Executor};
use super::listener::Listener;
use super::monitor::HoleOutcome;
use super::power_cut::Lost;
use super::row::RowStage;

/// How a power cut ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PowerLossEnd {
    /// No hole had begun: nothing is left in one.
    NoHole,
    /// The tap was led out to R.
    Retracted,
    /// The tap stays where it is.
    Refused(RestoreError),
    /// An alarm held the tap on its way.
    Alarm(Alarm),
    /// The axes did not come to rest.
    Coasting,
}

/// A power cut, and what came of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLoss {
    /// When, from the program's start.
    pub time_s: f64,
    /// What lost its power.
    pub lost: Lost,
    /// Hole, from 1; none between holes.
    pub hole: Option<u32>,
    /// Where the tap stood when the power came back, by the record: none where there is none, or it cannot be read.
    pub standing: Option<Standing>,
    /// What came of it.
    pub end: PowerLossEnd,
}

impl PowerLoss {
    /// Whether the tap is left in a hole.
    #[must_use]
    pub const fn is_left(&self) -> bool {
        use PowerLossEnd::{NoHole, Refused, Retracted};
        !matches!(self.end, NoHole | Retracted | Refused(RestoreError::NotInHole { .. }))
    }
}

/// Both axes stand once their counts have been the same, but for one, for so many periods; on the DC link, held for as many.
const REST_PERIODS: u32 = 50;
/// An axis that coasts longer is given up, s.
const LONGEST_COAST_S: f64 = 30.0;
/// After the restart the tap is held so many periods before it is led out.
const RESTART_PERIODS: u32 = 50;

impl<P: Port> Executor<'_, P> {
    /// The power is lost in a hole. Returns what came of it, and the hole as it was judged to the end.
    pub(super) fn lose_power(
        &mut self,
        lost: Lost,
        cut: CutHole,
        listener: &mut dyn Listener,
    ) -> (PowerLoss, HoleOutcome) {
        let (mut cut, time_s) = (cut, self.now_s());
        // What the host has kept of it.
        let record = self.tapping.power_loss_record().map(|record| record.to_bytes());
        let (standing, end) = match self.come_to_rest(lost, &mut cut, listener) {
            Some(end) => (None, end),
            None => self.restart(record, &mut cut, listener),
        };
        let hole = Some(cut.hole).filter(|_| end != PowerLossEnd::NoHole);
        (PowerLoss { time_s, lost, hole, standing, end }, cut.monitor.finish(None))
    }

    /// Both axes come to rest and lose their power; an end where they do not.
    fn come_to_rest(&mut self, lost: Lost, cut: &mut CutHole, listener: &mut dyn Listener) -> Option<PowerLossEnd> {
        if lost == Lost::Mains {
            let clock_s = self.read_clock().1;
            self.tapping.stop(clock_s);
            let mut held = 0;
            // A hole that has not begun waits at R, and never moves.
            while held < REST_PERIODS {
                let Some(stage) = self.hole_period(cut, 0, listener) else { break };
                match stage {
                    Err(alarm) => return Some(PowerLossEnd::Alarm(alarm)),
                    Ok(Stage::Synchronous(_, Some(Interrupted::Holding)) | Stage::Settling) => held += 1,
                    Ok(_) => held = 0,
                }
            }
            self.port.set_power(false);
            return None;
        }
        self.port.set_power(false);
        let (mut before, mut rests) = (self.port.read(self.now_s()), 0);
        let end_s = self.now_s() + LONGEST_COAST_S;
        while rests < REST_PERIODS {
            if self.now_s() > end_s {
                return Some(PowerLossEnd::Coasting);
            }
            let read = self.coast(cut, listener);
            let moved = [read.spindle_counts - before.spindle_counts, read.z_counts - before.z_counts];
            rests = if moved.iter().all(|counts| counts.abs() <= 1) { rests + 1 } else { 0 };
            before = read;
        }
        None
    }

    /// The control made anew, and the tap led out.
    fn restart(
        &mut self,
        record: Option<[u8; PowerLossRecord::BYTES]>,
        cut: &mut CutHole,
        listener: &mut dyn Listener,
    ) -> (Option<Standing>, PowerLossEnd) {
        self.port.set_power(true);
        self.tapping = Tapping::new(self.machine);
        let Some(record) = record else { return (None, PowerLossEnd::NoHole) };
        let read = self.port.read(self.now_s());
        // A single-turn encoder counts from the turn that it is in.
        let counts_per_rev = self.machine.spec().spindle.encoder_counts_per_rev;
        let turns = (read.spindle_counts as f64 / counts_per_rev).floor();
        let told = told(&read, turns, counts_per_rev);
        let plan = PowerLossRecord::from_bytes(&record).map(|record| {
            let standing = record.zero.standing(self.machine, record.hand, record.pitch_mm, &told);
            (standing, RestoredHole::plan(&record, self.machine, cut.plan.law(), None, &told))
        });
        let (standing, hole) = match plan {
            Ok((standing, Ok(hole))) => (standing, hole),
            Ok((standing, Err(error))) => return (Some(standing), PowerLossEnd::Refused(error)),
            Err(error) => return (None, PowerLossEnd::Refused(error)),
        };
        let clock_s = self.read_clock().1;
        // No hole is under way, and the clock is a number: this cannot fail.
        let _ = self.tapping.restore(hole, self.settings.sync, clock_s);
        let mut periods = 0;
        while let Some(stage) = self.hole_period(cut, turns as i64, listener) {
            if let Err(alarm) = stage {
                return (Some(standing), PowerLossEnd::Alarm(alarm));
            }
            periods += 1;
            if periods == RESTART_PERIODS {
                let clock_s = self.read_clock().1;
                // Held, and planned once already.
                let _ = self.tapping.retract(clock_s);
            }
        }
        (Some(standing), PowerLossEnd::Retracted)
    }

    /// One period of a control whose spindle count lacks some turns; none once the hole is done.
    fn hole_period(
        &mut self,
        cut: &mut CutHole,
        turns: i64,
        listener: &mut dyn Listener,
    ) -> Option<Result<Stage, Alarm>> {
        let (now_s, clock_s) = self.read_clock();
        let feedback = self.port.read(now_s);
        let turns = turns as f64;
        let told = told(&feedback, turns, self.machine.spec().spindle.encoder_counts_per_rev);
        let step = self.tapping.step(clock_s, &told)?;
        if let Some(alarm) = step.alarm {
            return Some(Err(alarm));
        }
        if step.stage == Stage::Done {
            return None;
        }
        let [x, y, _] = self.axes;
        let setpoint = step.setpoint(x, y);
        let setpoint = Setpoint { spindle: setpoint.spindle.shifted(turns), ..setpoint };
        self.axes[2] = step.z;
        let row = match step.stage {
            Stage::Synchronous(stroke, _) => {
                let row = self.row(RowStage::Stroke(stroke.kind), stroke.phase, cut.hole, setpoint, feedback);
                self.synchronous(row, &step, &cut.plan)
            }
            _ => self.row(RowStage::Orient, 0, cut.hole, setpoint, feedback),
        };
        cut.monitor.observe(&row);
        self.exchange(row, cut.plan.cycle().pitch_mm, listener);
        Some(Ok(step.stage))
    }

    /// One period without power: nobody commands, and nobody but the simulation sees.
    fn coast(&mut self, cut: &CutHole, listener: &mut dyn Listener) -> Feedback {
        let now_s = self.now_s();
        let feedback = self.port.read(now_s);
        let row = self.row(RowStage::Orient, 0, cut.hole, self.last_sent(), feedback);
        self.exchange(row, cut.plan.cycle().pitch_mm, listener);
        feedback
    }
}

/// What a host is told whose spindle count lacks some turns.
fn told(read: &Feedback, turns: f64, counts_per_rev: f64) -> Feedback {
    Feedback { spindle_counts: read.spindle_counts - (turns * counts_per_rev).round() as i64, ..*read }
}
