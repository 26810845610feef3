//! The synchronizer: one hole from rest at R back to rest at R.

use super::adaptation::{Adaptation, Lingering};
use super::compensator::Compensator;
use super::error::synchronisation_error_mm;
use super::path::Path;
use super::settings::{Compensation, Mode, Settings};
use super::settling::{Alarm, END, Off, START, START_AS_IT_STANDS, Settling};
use super::step::{Pair, Stage, Step};
use super::tracker::Tracker;
use crate::control::cycle::{CyclePlan, Interrupted, InterruptionError, TapCycle};
use crate::control::machine::{Machine, SpindleSpec};
use crate::control::math::{ceil, poly::State};
use crate::control::port::Feedback;
use crate::control::units::mm_from_um;

/// Gain of [`Compensation::Paper`]. The paper gives none; fixed, so that the regression stands on it.
const PAPER_GAIN_PER_S: f64 = 50.0;
/// Most that [`Compensation::Paper`] corrects in one period; likewise.
const PAPER_LIMIT_UM: f64 = 5.0;

/// Share of a period that a sum of periods may be off by rounding.
const SLACK: f64 = 1e-6;

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
    path: Path,
    compensator: Compensator,
    /// Of the spindle's travel, for [`Mode::FollowingPredicted`] alone.
    tracker: Tracker,
    /// From a reading of the spindle to the instant that Z's setpoint for it acts.
    horizon_s: f64,
    settings: Settings,
    period_s: f64,
    /// By so much the axes' motion ends after the plan.
    tail_periods: f64,
    /// From the first synchronous period to the last.
    last_synchronous_s: f64,
    counts_per_rev: f64,
    counts_per_mm: f64,
    spindle_rest_rev: f64,
    settling: Settling,
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
    /// use rigidtap::control::sync::{Compensation, Settings, Stage, Synchronizer};
    ///
    /// let machine = Machine::reference();
    /// let hole = TapCycle::right_hand(2.0, -10.0, 1.0, 3000.0);
    /// let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).unwrap();
    /// let settings = Settings { compensation: Compensation::None, ..Settings::default() };
    /// let mut synchronizer = Synchronizer::new(plan, &machine, settings, 0.0);
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
        let compensator = Compensator::new(&plan, machine, settings);
        let tail_s = match settings.compensation {
            Compensation::Full => compensator.tail_s(),
            Compensation::None | Compensation::Paper => spec.drive.latency_periods * period_s,
        };
        let mut synchronizer = Self {
            path: Path::new(plan),
            compensator,
            tracker: Tracker::of_angle(period_s, spec.sync.deviation_rad_per_s),
            horizon_s: spec.drive.latency_periods * period_s + spec.drive.encoder_latency_s,
            settings,
            period_s,
            tail_periods: ceil(tail_s / period_s - SLACK),
            last_synchronous_s: 0.0,
            counts_per_rev: encoder_counts_per_rev,
            counts_per_mm: spec.z_axis.encoder_counts_per_mm,
            spindle_rest_rev,
            settling: Settling::new(period_s, encoder_counts_per_rev, spec.z_axis.encoder_counts_per_mm),
            zero: None,
            last: Travel::default(),
            correction_mm: 0.0,
        };
        synchronizer.set_end();
        synchronizer
    }

    /// The setpoint of the plan's end acts this many periods after the first, and then as late as any other.
    fn set_end(&mut self) {
        let whole_periods = ceil(self.path.plan().duration_s() / self.period_s - SLACK);
        self.last_synchronous_s = (whole_periods + self.tail_periods + SLACK) * self.period_s;
    }

    /// Brakes spindle and Z together from the period of `now_s` on, and holds them: [`CyclePlan::stop`]. Before the first
    /// synchronous period nothing will move; after the last there is nothing to stop.
    pub fn stop(&mut self, now_s: f64) {
        let plan_s = self.plan_s(now_s);
        self.path.stop(plan_s);
        self.set_end();
    }

    /// Brings a stopped tap back to the R plane, spindle and Z in synchronism: [`CyclePlan::retract`].
    ///
    /// # Errors
    /// [`InterruptionError`], and the tap stays held.
    pub fn retract(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        let plan_s = self.plan_s(now_s);
        self.path.plan_mut().retract(plan_s)?;
        self.set_end();
        Ok(())
    }

    /// Lets a stopped tap go on: [`CyclePlan::resume`].
    ///
    /// # Errors
    /// As [`Synchronizer::retract`].
    pub fn resume(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        let plan_s = self.plan_s(now_s);
        self.path.plan_mut().resume(plan_s)?;
        self.set_end();
        Ok(())
    }

    /// What a stopped hole does.
    #[must_use]
    pub fn interrupted_at(&self, now_s: f64) -> Option<Interrupted> {
        self.path.plan().interrupted_at(self.plan_s(now_s))
    }

    /// The plan's time at the period of `now_s`; 0 before the hole's first.
    fn plan_s(&self, now_s: f64) -> f64 {
        let Some(zero) = self.zero else { return 0.0 };
        match self.settings.compensation {
            Compensation::Full => self.compensator.next_plan_s(),
            Compensation::None | Compensation::Paper => now_s - zero.at_s,
        }
    }

    /// The hole's plan.
    #[must_use]
    pub fn plan(&self) -> &CyclePlan {
        self.path.plan()
    }

    /// One period: what the encoders read at `now_s`, and the setpoint for that time. `now_s` never falls.
    ///
    /// # Errors
    /// [`Alarm`]; hold the setpoint of the period before.
    pub fn step(&mut self, now_s: f64, feedback: &Feedback) -> Result<Step, Alarm> {
        let Some(zero) = self.zero else { return self.settle(now_s, feedback) };
        let travel = self.travel(&zero, feedback);
        let error_mm = synchronisation_error_mm(travel.z_mm, self.path.plan().thread().pitch_mm, travel.spindle_rev);
        self.correct(error_mm);
        let elapsed_s = now_s - zero.at_s;
        let measured = State {
            position: travel.spindle_rev,
            velocity: (travel.spindle_rev - self.last.spindle_rev) / self.period_s,
            ..State::default()
        };
        self.last = travel;
        let (plan_s, pair) = if self.settings.compensation == Compensation::Full {
            self.settling.fade();
            self.compensator.step(&mut self.path, &measured, error_mm, feedback)
        } else {
            let spindle = self.path.at(elapsed_s).spindle;
            (elapsed_s, Pair { spindle, z: self.z_travel(&spindle, &measured), ..Pair::default() })
        };
        let leg = self.path.at(plan_s);
        if plan_s <= self.last_synchronous_s {
            return Ok(self.answer(Stage::Synchronous(leg), &pair, error_mm));
        }
        // Z is let go only from a spindle that rests: one that lost its command is still turning in the thread.
        let target_mm = self.answer(Stage::Done, &pair, error_mm).z.position;
        let rested = self.settling.rested(now_s, self.off(feedback, target_mm), &END)?;
        let stage = if rested { Stage::Done } else { Stage::Settling };
        let step = self.answer(stage, &pair, error_mm);
        if rested && self.settings.compensation == Compensation::Full {
            let off_mm = step.z.position - self.path.plan().cycle().r_plane_mm;
            self.compensator.finish(self.path.interrupted(), off_mm, step.z_force_n);
        }
        Ok(step)
    }

    /// Waits for rest at R, then latches the zero of both travels and starts.
    fn settle(&mut self, now_s: f64, feedback: &Feedback) -> Result<Step, Alarm> {
        let off = self.off(feedback, self.path.plan().cycle().r_plane_mm);
        let full = self.settings.compensation == Compensation::Full;
        if self.settling.rested(now_s, off, if full { &START_AS_IT_STANDS } else { &START })? {
            let zero = Zero { at_s: now_s, spindle_counts: feedback.spindle_counts, z_counts: feedback.z_counts };
            self.zero = Some(zero);
            self.compensator.begin(self.path.plan(), feedback);
            return self.step(now_s, feedback);
        }
        let velocity = if full { self.settling.take_as_it_stands(off.z_deep_mm) } else { 0.0 };
        let z = State { velocity, ..State::default() };
        let step = self.answer(Stage::Settling, &Pair { z, ..Pair::default() }, 0.0);
        let step = step.with(&self.lingering());
        self.observe(feedback);
        Ok(step)
    }

    /// How far spindle and Z are from rest, Z's being at `z_target_mm`.
    fn off(&self, feedback: &Feedback, z_target_mm: f64) -> Off {
        Off {
            spindle_rev: feedback.spindle_counts as f64 / self.counts_per_rev - self.spindle_rest_rev,
            z_deep_mm: z_target_mm - feedback.z_counts as f64 / self.counts_per_mm,
        }
    }

    fn travel(&self, zero: &Zero, feedback: &Feedback) -> Travel {
        let counts = |now: i64, then: i64| now.wrapping_sub(then) as f64;
        Travel {
            z_mm: -counts(feedback.z_counts, zero.z_counts) / self.counts_per_mm,
            spindle_rev: self.path.plan().cycle().hand.sign() * counts(feedback.spindle_counts, zero.spindle_counts)
                / self.counts_per_rev,
        }
    }

    fn correct(&mut self, error_mm: f64) {
        match self.settings.compensation {
            Compensation::None | Compensation::Full => {}
            Compensation::Paper => {
                let limit_mm = mm_from_um(PAPER_LIMIT_UM);
                self.correction_mm -= (PAPER_GAIN_PER_S * error_mm * self.period_s).clamp(-limit_mm, limit_mm);
            }
        }
    }

    /// Z's uncorrected travel into the hole.
    fn z_travel(&mut self, commanded: &State, measured: &State) -> State {
        let master = match self.settings.mode {
            Mode::Commanded => *commanded,
            // Measured twice over, an acceleration would be mostly count noise: Z gets none.
            Mode::Following => *measured,
            Mode::FollowingPredicted => {
                self.tracker.update(measured.position, false);
                self.tracker.predict(self.horizon_s)
            }
        };
        self.path.plan().thread().follow(&master)
    }

    /// From travels into the hole to machine coordinates.
    fn answer(&self, stage: Stage, pair: &Pair, error_mm: f64) -> Step {
        let TapCycle { hand, r_plane_mm, .. } = *self.path.plan().cycle();
        let hand = hand.sign();
        Step {
            stage,
            spindle: pair.spindle.scaled(hand).shifted(self.spindle_rest_rev),
            z: pair.z.scaled(-1.0).shifted(r_plane_mm - self.settling.standing_mm() - self.correction_mm),
            spindle_torque_nm: hand * pair.spindle_nm,
            z_force_n: -pair.z_n,
            error_mm,
            correction_mm: self.correction_mm + pair.correction_mm,
            slowed: pair.slowed,
        }
    }

    /// The same hole, with what earlier ones left.
    #[must_use]
    pub fn adapted(mut self, adaptation: Adaptation) -> Self {
        self.compensator.adapt(adaptation);
        self
    }

    /// What lingers of the hole before, until this one begins.
    pub(super) fn lingering(&self) -> Lingering {
        self.compensator.lingering()
    }

    /// One period in which spindle or Z is still on its way to rest.
    pub(super) fn observe(&mut self, feedback: &Feedback) {
        self.compensator.observe(feedback);
    }

    /// What the next hole may use.
    #[must_use]
    pub fn into_adaptation(self) -> Adaptation {
        self.compensator.into_adaptation()
    }
}
