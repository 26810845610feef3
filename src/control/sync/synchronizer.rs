//! The synchronizer: one hole from rest at R back to rest at R.

use super::error::synchronisation_error_mm;
use crate::control::cycle::{CyclePlan, Interrupted, InterruptionError, Leg, LegState};
use crate::control::machine::{Machine, SpindleSpec};
use crate::control::math::{ceil, poly::State};
use crate::control::port::Feedback;
use crate::control::units::mm_from_um;

/// What Z follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// The command that the spindle has, too: FANUC, Siemens, Mitsubishi.
    #[default]
    Commanded,
    /// The measured spindle as it was measured: LinuxCNC.
    Following,
}

impl Mode {
    /// Every mode, in the order of documentation.
    pub const ALL: [Self; 2] = [Self::Commanded, Self::Following];

    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Commanded => "commanded",
            Self::Following => "following",
        }
    }
}

/// How Z is corrected by e(k).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Compensation {
    /// Not at all.
    #[default]
    None,
    /// The paper's section I.B: each period Z's increment is corrected by gain × e(k) × period, within a limit.
    Paper,
}

impl Compensation {
    /// Every compensation, in the order of documentation.
    pub const ALL: [Self; 2] = [Self::None, Self::Paper];

    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Paper => "paper",
        }
    }
}

/// Gain of [`Compensation::Paper`]. The paper gives none; fixed, so that the regression stands on it.
const PAPER_GAIN_PER_S: f64 = 50.0;
/// Most that [`Compensation::Paper`] corrects in one period; likewise.
const PAPER_LIMIT_UM: f64 = 5.0;

/// When spindle and Z count as at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    spindle_rev: f64,
    z_mm: f64,
    /// Both have to stay so near this long.
    hold_s: f64,
}

/// Before the zero is latched: what creeps afterwards is error of the hole, so the window is a few percent of a tolerance.
const START: Window = Window { spindle_rev: 0.001, z_mm: 0.002, hold_s: 0.01 };
/// Before Z is let go: the tap has left the thread, and the spindle must not turn on with it.
const END: Window = Window { spindle_rev: 0.01, z_mm: 0.05, hold_s: 0.0 };
/// No window is less than this: a resting axis may stand between two counts.
const WINDOW_COUNTS: f64 = 1.0;
/// After this long without, something is wrong with the machine.
const SETTLE_LIMIT_S: f64 = 3.0;

/// Share of a period that a sum of periods may be off by rounding.
const SLACK: f64 = 1e-6;

/// How a hole is synchronised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// What Z follows.
    pub mode: Mode,
    /// How Z is corrected.
    pub compensation: Compensation,
}

/// Where in the hole a period lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stage {
    /// Spindle and Z come to rest at R, before the first synchronous period or after the last.
    Settling,
    /// Synchronous, on this leg.
    Synchronous(LegState),
    /// The hole is done: Z is free, the spindle at rest.
    Done,
}

/// A fault at run time. The setpoint of the period before it stays valid: hold it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Alarm {
    /// Spindle or Z did not come to rest at the start or the end of a hole.
    NotInPosition {
        /// Seconds waited.
        waited_s: f64,
        /// The spindle's distance from where it should rest.
        spindle_rev: f64,
        /// Z's distance from R.
        z_mm: f64,
    },
}

/// What one period yields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Where in the hole the period lies.
    pub stage: Stage,
    /// The spindle's setpoint, machine coordinates in rev.
    pub spindle: State,
    /// Z's setpoint, machine coordinates in mm.
    pub z: State,
    /// e(k) of this period's feedback; 0 while settling.
    pub error_mm: f64,
    /// Correction in force on Z, positive into the hole.
    pub correction_mm: f64,
}

/// Travel since the hole's first synchronous period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Travel {
    z_mm: f64,
    spindle_rev: f64,
}

/// Where a hole's travels are counted from.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Zero {
    at_s: f64,
    spindle_counts: i64,
    z_counts: i64,
}

/// One hole's synchronizer. Planned outside the period, stepped inside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Synchronizer {
    plan: CyclePlan,
    /// The leg in force with its number: a leg is planned when it begins.
    leg: (usize, Leg),
    settings: Settings,
    period_s: f64,
    latency_periods: f64,
    /// From the first synchronous period to the last.
    last_synchronous_s: f64,
    counts_per_rev: f64,
    counts_per_mm: f64,
    spindle_rest_rev: f64,
    settling_since_s: Option<f64>,
    in_position_since_s: Option<f64>,
    zero: Option<Zero>,
    last: Travel,
    correction_mm: f64,
}

impl Synchronizer {
    /// For one planned hole, where the spindle is commanded to rest at `spindle_rest_rev` and Z at the R plane.
    ///
    /// ```
    /// use rigidtap::control::cycle::{CyclePlan, TapCycle};
    /// use rigidtap::control::machine::{Law, Machine};
    /// use rigidtap::control::port::Feedback;
    /// use rigidtap::control::sync::{Settings, Stage, Synchronizer};
    ///
    /// let machine = Machine::reference();
    /// let hole = TapCycle::right_hand(2.0, -10.0, 1.0, 3000.0);
    /// let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).unwrap();
    /// let mut synchronizer = Synchronizer::new(plan, &machine, Settings::default(), 0.0);
    /// // A host that has no machine: its encoders read exactly what was commanded.
    /// let mut feedback = Feedback { z_counts: 20_000, ..Feedback::default() };
    /// let mut deepest_mm = f64::INFINITY;
    /// for period in 0.. {
    ///     let step = synchronizer.step(f64::from(period) * 0.001, &feedback).unwrap();
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
    pub fn new(plan: CyclePlan, machine: &Machine, settings: Settings, spindle_rest_rev: f64) -> Self {
        let spec = machine.spec();
        let SpindleSpec { encoder_counts_per_rev, .. } = spec.spindle;
        let period_s = spec.control.period_s;
        let leg = (0, plan.leg(0));
        let mut synchronizer = Self {
            plan,
            leg,
            settings,
            period_s,
            latency_periods: ceil(spec.drive.latency_periods),
            last_synchronous_s: 0.0,
            counts_per_rev: encoder_counts_per_rev,
            counts_per_mm: spec.z_axis.encoder_counts_per_mm,
            spindle_rest_rev,
            settling_since_s: None,
            in_position_since_s: None,
            zero: None,
            last: Travel::default(),
            correction_mm: 0.0,
        };
        synchronizer.set_end();
        synchronizer
    }

    /// The setpoint of the plan's end acts this many periods after the first, and then as late as any other.
    fn set_end(&mut self) {
        let whole_periods = ceil(self.plan.duration_s() / self.period_s - SLACK);
        self.last_synchronous_s = (whole_periods + self.latency_periods + SLACK) * self.period_s;
    }

    /// Brakes spindle and Z together from the period of `now_s` on, and holds them: [`CyclePlan::stop`]. Before the first
    /// synchronous period nothing will move; after the last there is nothing to stop.
    pub fn stop(&mut self, now_s: f64) {
        self.plan.stop(self.elapsed_s(now_s));
        self.set_end();
    }

    /// Brings a stopped tap back to the R plane, spindle and Z in synchronism: [`CyclePlan::retract`].
    ///
    /// # Errors
    /// [`InterruptionError`], and the tap stays held.
    pub fn retract(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        self.plan.retract(self.elapsed_s(now_s))?;
        self.set_end();
        Ok(())
    }

    /// Lets a stopped tap go on: [`CyclePlan::resume`].
    ///
    /// # Errors
    /// As [`Synchronizer::retract`].
    pub fn resume(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        self.plan.resume(self.elapsed_s(now_s))?;
        self.set_end();
        Ok(())
    }

    /// What a stopped hole does.
    #[must_use]
    pub fn interrupted_at(&self, now_s: f64) -> Option<Interrupted> {
        self.plan.interrupted_at(self.elapsed_s(now_s))
    }

    /// Time since the hole's first synchronous period; 0 before it.
    fn elapsed_s(&self, now_s: f64) -> f64 {
        self.zero.map_or(0.0, |zero| now_s - zero.at_s)
    }

    /// The hole's plan.
    #[must_use]
    pub fn plan(&self) -> &CyclePlan {
        &self.plan
    }

    /// One period: what the encoders read at `now_s`, and the setpoint for that time. `now_s` never falls.
    ///
    /// # Errors
    /// [`Alarm`]; hold the setpoint of the period before.
    pub fn step(&mut self, now_s: f64, feedback: &Feedback) -> Result<Step, Alarm> {
        let Some(zero) = self.zero else { return self.settle(now_s, feedback) };
        let travel = self.travel(&zero, feedback);
        let error_mm = synchronisation_error_mm(travel.z_mm, self.plan.thread().pitch_mm, travel.spindle_rev);
        self.correct(error_mm);
        let elapsed_s = now_s - zero.at_s;
        let number = self.plan.leg_at(elapsed_s);
        if number != self.leg.0 {
            self.leg = (number, self.plan.leg(number));
        }
        let leg = self.leg.1.at(elapsed_s);
        let z_into_hole = self.z_travel(&leg, &travel);
        self.last = travel;
        if elapsed_s <= self.last_synchronous_s {
            return Ok(self.answer(Stage::Synchronous(leg), &leg.spindle, &z_into_hole, error_mm));
        }
        // Z is let go only from a spindle that rests: one that lost its command is still turning in the thread.
        let target_mm = self.answer(Stage::Done, &leg.spindle, &z_into_hole, error_mm).z.position;
        let rested = self.rested(now_s, feedback, target_mm, END)?;
        let stage = if rested { Stage::Done } else { Stage::Settling };
        Ok(self.answer(stage, &leg.spindle, &z_into_hole, error_mm))
    }

    /// Waits for rest at R, then latches the zero of both travels and starts.
    fn settle(&mut self, now_s: f64, feedback: &Feedback) -> Result<Step, Alarm> {
        if self.rested(now_s, feedback, self.plan.cycle().r_plane_mm, START)? {
            let zero = Zero { at_s: now_s, spindle_counts: feedback.spindle_counts, z_counts: feedback.z_counts };
            self.zero = Some(zero);
            (self.settling_since_s, self.in_position_since_s) = (None, None);
            return self.step(now_s, feedback);
        }
        Ok(self.answer(Stage::Settling, &State::default(), &State::default(), 0.0))
    }

    /// Whether spindle and Z have stayed where they are to rest for long enough.
    fn rested(&mut self, now_s: f64, feedback: &Feedback, z_target_mm: f64, window: Window) -> Result<bool, Alarm> {
        let since_s = *self.settling_since_s.get_or_insert(now_s);
        let spindle_rev = feedback.spindle_counts as f64 / self.counts_per_rev - self.spindle_rest_rev;
        let z_mm = feedback.z_counts as f64 / self.counts_per_mm - z_target_mm;
        let spindle_window_rev = window.spindle_rev.max(WINDOW_COUNTS / self.counts_per_rev);
        let z_window_mm = window.z_mm.max(WINDOW_COUNTS / self.counts_per_mm);
        if spindle_rev.abs() <= spindle_window_rev && z_mm.abs() <= z_window_mm {
            return Ok(now_s - *self.in_position_since_s.get_or_insert(now_s) >= window.hold_s);
        }
        self.in_position_since_s = None;
        let waited_s = now_s - since_s;
        if waited_s > SETTLE_LIMIT_S {
            return Err(Alarm::NotInPosition { waited_s, spindle_rev, z_mm });
        }
        Ok(false)
    }

    fn travel(&self, zero: &Zero, feedback: &Feedback) -> Travel {
        let counts = |now: i64, then: i64| now.wrapping_sub(then) as f64;
        Travel {
            z_mm: -counts(feedback.z_counts, zero.z_counts) / self.counts_per_mm,
            spindle_rev: self.plan.cycle().hand.sign() * counts(feedback.spindle_counts, zero.spindle_counts)
                / self.counts_per_rev,
        }
    }

    fn correct(&mut self, error_mm: f64) {
        match self.settings.compensation {
            Compensation::None => {}
            Compensation::Paper => {
                let limit_mm = mm_from_um(PAPER_LIMIT_UM);
                self.correction_mm -= (PAPER_GAIN_PER_S * error_mm * self.period_s).clamp(-limit_mm, limit_mm);
            }
        }
    }

    /// Z's uncorrected travel into the hole.
    fn z_travel(&self, leg: &LegState, travel: &Travel) -> State {
        let master = match self.settings.mode {
            Mode::Commanded => leg.spindle,
            // Measured twice over, an acceleration would be mostly count noise: Z gets none.
            Mode::Following => State {
                position: travel.spindle_rev,
                velocity: (travel.spindle_rev - self.last.spindle_rev) / self.period_s,
                ..State::default()
            },
        };
        self.plan.thread().follow(&master)
    }

    /// From travels into the hole to machine coordinates.
    fn answer(&self, stage: Stage, spindle: &State, z: &State, error_mm: f64) -> Step {
        let hand = self.plan.cycle().hand.sign();
        Step {
            stage,
            spindle: spindle.scaled(hand).shifted(self.spindle_rest_rev),
            z: z.scaled(-1.0).shifted(self.plan.cycle().r_plane_mm - self.correction_mm),
            error_mm,
            correction_mm: self.correction_mm,
        }
    }
}
