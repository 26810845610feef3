//! A whole tapping block: to the hole, down to R, the hole, up to the return level; as often as it is repeated.

use super::block_request::{BlockRequest, feasible};
use super::hole::{Counters, Tapping, check_turning};
use super::power_loss::PowerLossRecord;
use super::start_error::StartError;
use crate::control::cycle::{CycleError, CyclePlan, InterruptionError, Positioning};
use crate::control::machine::{Law, Machine};
use crate::control::math::poly::State;
use crate::control::port::{Feedback, Setpoint};
use crate::control::sync::{Alarm, Identified, LearnedError, Settings, Stage};
use crate::control::units::{rev_per_s_from_rpm, rpm_from_rev_per_s};

/// Where in a block a period lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlockStage {
    /// X, Y and Z move, or stand where they were stopped; the spindle goes on as it was.
    Positioning,
    /// In a hole.
    Hole(Stage),
    /// Z is back on the return level of the last hole. Its [`ResidualFeedforward`](crate::control::sync::ResidualFeedforward)
    /// decays while the block is stepped on.
    Done,
}

/// What one period yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BlockStep {
    /// Where in the block the period lies.
    pub stage: BlockStage,
    /// Which hole, from 0.
    pub hole: u32,
    /// All axes.
    pub setpoint: Setpoint,
    /// e(k) of this period's feedback; 0 outside a hole.
    pub error_mm: f64,
    /// Correction in force on Z.
    pub correction_mm: f64,
    /// How fast the plan's time runs against the clock's, 1 outside a hole.
    pub path_rate: f64,
    /// The alarm that is latched.
    pub alarm: Option<Alarm>,
    /// What the last hole is warned of: the block stops after it, and [`Block::resume`] goes on.
    pub warning: Option<Alarm>,
}

/// The parts of a block's hole, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    /// X and Y, above the work piece.
    Over,
    /// Z to R.
    Down,
    Hole,
    /// Z to the return level.
    Up,
    Done,
}

/// A tapping block under way. Every move and stroke of it is known to be feasible before anything moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Block {
    request: BlockRequest,
    plan: CyclePlan,
    settings: Settings,
    part: Part,
    hole: u32,
    at_mm: [f64; 3],
    positioning: Option<(f64, Positioning)>,
    tapping: Tapping,
    spindle: State,
    spindle_since_s: Option<f64>,
    stopped: bool,
    warning: Option<Alarm>,
}

impl Block {
    /// Plans a block for a spindle that stands at an angle and turns at a signed speed; it goes on turning until the first
    /// hole, and rests from then on.
    ///
    /// # Errors
    /// [`CycleError`], and nothing has moved: for the hole, for a spindle that turns as [`Tapping::start`] refuses it, or as
    /// [`CycleError::Law`] for a move between holes.
    ///
    /// ```
    /// use rigidtap::control::cycle::TapCycle;
    /// use rigidtap::control::machine::{Law, Machine};
    /// use rigidtap::control::port::Feedback;
    /// use rigidtap::control::sync::Settings;
    /// use rigidtap::control::tapping::{Block, BlockRequest, BlockStage};
    ///
    /// let machine = Machine::reference();
    /// let hole = TapCycle { x_mm: 5.0, return_mm: 10.0, ..TapCycle::right_hand(2.0, -8.0, 1.0, 3000.0) };
    /// let request = BlockRequest { hole, start_mm: [0.0, 0.0, 10.0], holes: 3, step_mm: [7.0, 0.0] };
    /// let mut block = Block::plan(request, &machine, Law::TorqueCurve, Settings::default(), 0.0, 0.0).unwrap();
    /// let mut feedback = Feedback { z_counts: 100_000, ..Feedback::default() };
    /// let last = (0..).map(|period| {
    ///     let step = block.step(f64::from(period) * 0.001, &feedback);
    ///     feedback.spindle_counts = (step.setpoint.spindle.position * 16_384.0).round() as i64;
    ///     feedback.z_counts = (step.setpoint.z.position * 10_000.0).round() as i64;
    ///     step
    /// }).find(|step| step.stage == BlockStage::Done).unwrap();
    /// assert_eq!((last.hole, last.setpoint.x.position), (2, 19.0));
    /// assert!((last.setpoint.z.position - 10.0).abs() < 0.001);
    /// ```
    pub fn plan(
        request: BlockRequest,
        machine: &Machine,
        law: Law,
        settings: Settings,
        spindle_rev: f64,
        spindle_rpm: f64,
    ) -> Result<Self, CycleError> {
        let plan = feasible(&request, machine, law)?;
        check_turning(machine, spindle_rev, spindle_rpm)?;
        let velocity = rev_per_s_from_rpm(spindle_rpm);
        Ok(Self {
            request,
            plan,
            settings,
            part: Part::Over,
            hole: 0,
            at_mm: request.start_mm,
            positioning: None,
            tapping: Tapping::new(machine),
            spindle: State { position: spindle_rev, velocity, ..State::default() },
            spindle_since_s: None,
            stopped: false,
            warning: None,
        })
    }

    /// Plans the next block of the same machine: what this one measured and learned goes on to it.
    ///
    /// # Errors
    /// [`StartError`], and this block stays as it was.
    pub fn plan_next(
        &mut self,
        request: BlockRequest,
        law: Law,
        settings: Settings,
        spindle_rev: f64,
        spindle_rpm: f64,
    ) -> Result<(), StartError> {
        if self.is_tapping() {
            return Err(StartError::UnderWay);
        }
        check_turning(self.plan.machine(), spindle_rev, spindle_rpm)?;
        self.plan = feasible(&request, self.plan.machine(), law)?;
        (self.request, self.settings, self.at_mm) = (request, settings, request.start_mm);
        (self.part, self.hole, self.stopped, self.warning) = (Part::Over, 0, false, None);
        (self.positioning, self.spindle_since_s) = (None, None);
        let velocity = rev_per_s_from_rpm(spindle_rpm);
        self.spindle = State { position: spindle_rev, velocity, ..State::default() };
        Ok(())
    }

    fn z_mm(&self) -> f64 {
        let [_, _, z_mm] = self.at_mm;
        z_mm
    }

    fn over_mm(&self, hole: u32, z_mm: f64) -> [f64; 3] {
        self.request.over_mm(hole, z_mm)
    }

    /// One period: what the encoders read at `now_s`, and the setpoint for that time. `now_s` never falls. There is always a
    /// setpoint; an alarm stands beside it.
    pub fn step(&mut self, now_s: f64, feedback: &Feedback) -> BlockStep {
        let was_tapping = self.is_tapping();
        let step = self.advance(now_s, feedback);
        // A hole observes its own periods, its last one included.
        if !was_tapping && !self.is_tapping() {
            self.tapping.observe(now_s, feedback);
            self.tapping.note_commanded(&step.setpoint);
        }
        step
    }

    /// Whether a hole is under way.
    #[must_use]
    pub fn is_tapping(&self) -> bool {
        self.tapping.plan().is_some()
    }

    fn advance(&mut self, now_s: f64, feedback: &Feedback) -> BlockStep {
        let since_s = *self.spindle_since_s.get_or_insert(now_s);
        // Each part ends in the period that the next begins, and a hole's four come round to positioning: a bounded loop.
        for _ in 0..Self::PARTS {
            let target_mm = match self.part {
                Part::Over => self.over_mm(self.hole, self.z_mm()),
                Part::Down => self.over_mm(self.hole, self.request.hole.r_plane_mm),
                Part::Up => self.over_mm(self.hole, self.request.hole.return_mm),
                Part::Hole => {
                    if let Some(step) = self.tap(now_s, since_s, feedback) {
                        return step;
                    }
                    self.part = Part::Up;
                    continue;
                }
                Part::Done => return self.positioned(BlockStage::Done, self.standing(), now_s - since_s),
            };
            if let Some(axes) = self.travel(now_s, target_mm) {
                return self.positioned(BlockStage::Positioning, axes, now_s - since_s);
            }
            if self.part == Part::Up && self.warning.is_some() && self.hole + 1 < self.request.holes {
                self.stopped = true;
                continue;
            }
            self.part = match self.part {
                Part::Over => Part::Down,
                Part::Down => Part::Hole,
                Part::Hole | Part::Up | Part::Done if self.hole + 1 < self.request.holes => {
                    self.hole += 1;
                    Part::Over
                }
                Part::Hole | Part::Up | Part::Done => Part::Done,
            };
        }
        self.positioned(BlockStage::Positioning, self.standing(), now_s - since_s)
    }

    const PARTS: usize = 6;

    fn standing(&self) -> [State; 3] {
        self.at_mm.map(|position| State { position, ..State::default() })
    }

    fn positioned(&self, stage: BlockStage, [x, y, z]: [State; 3], turned_s: f64) -> BlockStep {
        let setpoint = Setpoint { spindle: self.spindle.after(turned_s, 0.0), x, y, z, ..Setpoint::default() };
        let setpoint = self.tapping.residual().added_to(setpoint);
        BlockStep {
            stage,
            hole: self.hole,
            setpoint,
            error_mm: 0.0,
            correction_mm: 0.0,
            path_rate: 1.0,
            alarm: None,
            warning: self.warning,
        }
    }

    /// On the move to a target; none once there. A block that is stopped ends the move it is on, and stands.
    fn travel(&mut self, now_s: f64, target_mm: [f64; 3]) -> Option<[State; 3]> {
        if self.positioning.is_none() && self.stopped {
            return Some(self.standing());
        }
        if self.positioning.is_none() {
            // Planned once already and found feasible; a correction left of a hole may be too short a move to plan.
            let positioning = Positioning::plan(self.plan.machine(), self.at_mm, target_mm, |top| top).ok().flatten();
            self.positioning = positioning.map(|positioning| (now_s, positioning));
        }
        let moving =
            self.positioning.as_ref().filter(|(start_s, moving)| now_s - start_s < moving.profile.duration_s());
        if let Some((start_s, moving)) = moving {
            return Some(moving.at(now_s - start_s));
        }
        self.positioning = None;
        self.at_mm = target_mm;
        None
    }

    /// In the hole; none once it is done.
    fn tap(&mut self, now_s: f64, since_s: f64, feedback: &Feedback) -> Option<BlockStep> {
        if !self.is_tapping() {
            if self.stopped {
                return Some(self.positioned(BlockStage::Positioning, self.standing(), now_s - since_s));
            }
            let turned = self.spindle.after(now_s - since_s, 0.0);
            let (rev, rpm) = (turned.position, rpm_from_rev_per_s(turned.velocity));
            // The speed is a number: the moves here have shown it.
            let _ = self.tapping.start(self.plan.clone(), self.settings, now_s, rev, rpm);
        }
        let step = self.tapping.step(now_s, feedback)?;
        let [x, y, _] = self.standing();
        if step.stage == Stage::Done {
            self.warning = step.warning;
            let [x_mm, y_mm, _] = self.at_mm;
            self.spindle = State { position: step.spindle.position, ..State::default() };
            self.at_mm = [x_mm, y_mm, step.z.position - self.tapping.residual().z.position];
            return None;
        }
        Some(BlockStep {
            stage: BlockStage::Hole(step.stage),
            hole: self.hole,
            setpoint: step.setpoint(x, y),
            error_mm: step.error_mm,
            correction_mm: step.correction_mm,
            path_rate: step.path_rate,
            alarm: step.alarm,
            warning: None,
        })
    }

    /// In a hole [`Tapping::stop`]; between holes the axes end their move and stand.
    pub fn stop(&mut self, now_s: f64) {
        if self.is_tapping() {
            self.tapping.stop(now_s);
        } else {
            self.stopped = true;
        }
    }

    /// Brings a stopped tap back to R, and ends the block on the return level.
    ///
    /// # Errors
    /// [`InterruptionError`], and the tap stays held.
    pub fn retract(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        if self.is_tapping() {
            self.tapping.retract(now_s)?;
        } else if self.stopped && self.positioning.is_none() {
            self.part = Part::Up;
        } else {
            return Err(InterruptionError::NotStopped);
        }
        self.stopped = false;
        self.request.holes = self.hole + 1;
        Ok(())
    }

    /// Lets a stopped block go on.
    ///
    /// # Errors
    /// [`InterruptionError`], and it stays stopped.
    pub fn resume(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        if self.is_tapping() {
            self.tapping.resume(now_s)?;
        } else if !self.stopped {
            return Err(InterruptionError::NotStopped);
        }
        (self.stopped, self.warning) = (false, None);
        Ok(())
    }

    /// [`Tapping::acknowledge`].
    pub fn acknowledge(&mut self) -> bool {
        self.tapping.acknowledge()
    }

    /// What is known of the machine by now.
    #[must_use]
    pub fn identified(&self) -> Identified {
        self.tapping.identified()
    }

    /// [`Tapping::save_learned`].
    ///
    /// # Errors
    /// As there.
    pub fn save_learned(&self, bytes: &mut [u8]) -> Result<usize, LearnedError> {
        self.tapping.save_learned(bytes)
    }

    /// [`Tapping::load_learned`].
    ///
    /// # Errors
    /// As there.
    pub fn load_learned(&mut self, bytes: &[u8]) -> Result<(), LearnedError> {
        self.tapping.load_learned(bytes)
    }

    /// Gives up the block: its axes are the host's from now on, at rest or not. What was measured stays for the next one.
    pub fn release(&mut self) {
        self.tapping.release();
        (self.part, self.positioning) = (Part::Done, None);
    }

    /// [`Tapping::power_loss_record`].
    #[must_use]
    pub fn power_loss_record(&self) -> Option<PowerLossRecord> {
        self.tapping.power_loss_record()
    }

    /// [`Tapping::counters`].
    #[must_use]
    pub fn counters(&self) -> Counters {
        self.tapping.counters()
    }

    /// The machine that it is planned for.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        self.plan.machine()
    }
}
