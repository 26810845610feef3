//! The controlled stop: at any moment of a hole the spindle brakes along the motor's torque curve and Z with it at pitch;
//! then it is held, and either comes back to R or goes on. A leg takes the place of the plan's own, so whoever follows
//! the plan follows the stop, too.

use core::fmt;

use super::{CycleError, CyclePlan, Leg, LegKind};
use crate::control::profile::{Profile, StrokeRequest, Turns};
use crate::control::units::rev_per_s_from_rpm;

/// What an interrupted hole is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interrupted {
    /// Spindle and Z brake together.
    Braking,
    /// They rest in the thread.
    Holding,
    /// They come back to the R plane.
    Retracting,
    /// They go on to where the interrupted leg ends.
    Resuming,
}

/// Why a hole cannot be retracted or resumed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InterruptionError {
    /// It has not been stopped.
    NotStopped,
    /// An alarm is latched: it is acknowledged first.
    AlarmLatched,
    /// An alarm ended the hole: it can be retracted, and not gone on with.
    HoleFailed,
    /// There is no stroke from where it rests.
    Stroke(CycleError),
}

impl fmt::Display for InterruptionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotStopped => f.write_str("the hole has not been stopped"),
            Self::AlarmLatched => f.write_str("an alarm is latched, which has to be acknowledged first"),
            Self::HoleFailed => f.write_str("an alarm ended the hole: it can only be retracted"),
            Self::Stroke(error) => write!(f, "no stroke from where the tap rests: {error}"),
        }
    }
}

impl core::error::Error for InterruptionError {}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Purpose {
    Stop,
    Retract,
    Resume,
}

/// A leg in place of the plan's own.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Interruption {
    purpose: Purpose,
    /// From when on it stands for the plan.
    since_s: f64,
    /// How many there have been: each is another leg.
    number: usize,
    /// The leg of the plan that it interrupted.
    interrupted: usize,
    leg: Leg,
    /// The stop with its number, where it was still braking when it was left: it stands until `leg` starts.
    braking: Option<(usize, Leg)>,
}

/// A way this short in rev is the rounding of the stroke that has already ended there.
const NO_WAY_REV: f64 = 1e-9;

impl Interruption {
    pub(super) fn number_at(&self, t_s: f64) -> Option<usize> {
        if let Some((number, _)) = self.braking.as_ref().filter(|_| t_s >= self.since_s && t_s < self.leg.start_s) {
            return Some(*number);
        }
        let resumed = self.purpose == Purpose::Resume && t_s >= self.leg.end_s();
        (t_s >= self.since_s && !resumed).then_some(self.number)
    }

    /// The leg of a number that [`Interruption::number_at`] has given.
    pub(super) fn leg(&self, number: usize) -> &Leg {
        match &self.braking {
            Some((of, braking)) if *of == number => braking,
            _ => &self.leg,
        }
    }

    pub(super) fn end_of_hole_s(&self) -> Option<f64> {
        match self.purpose {
            Purpose::Stop => Some(f64::INFINITY),
            Purpose::Retract => Some(self.leg.end_s()),
            Purpose::Resume => None,
        }
    }

    fn state_at(&self, t_s: f64) -> Option<Interrupted> {
        self.number_at(t_s)?;
        Some(match self.purpose {
            Purpose::Stop if t_s < self.leg.end_s() => Interrupted::Braking,
            _ if self.braking.is_some() && t_s < self.leg.start_s => Interrupted::Braking,
            _ if t_s < self.leg.start_s => Interrupted::Holding,
            Purpose::Stop => Interrupted::Holding,
            Purpose::Retract => Interrupted::Retracting,
            Purpose::Resume => Interrupted::Resuming,
        })
    }
}

impl CyclePlan {
    /// What the hole does at a time, where it is interrupted.
    #[must_use]
    pub fn interrupted_at(&self, t_s: f64) -> Option<Interrupted> {
        self.interruption.as_ref()?.state_at(t_s)
    }

    /// Brakes from the state at `now_s` in the shortest way that the motor's torque curve at its share, and Z's
    /// acceleration, allow; a leg that itself ends sooner is ended instead, so that nothing goes below the bottom or
    /// above R. From then on the hole rests there. Nothing where it has ended, or is braking or held already.
    ///
    /// ```
    /// use rigidtap::control::{cycle::{CyclePlan, Interrupted, TapCycle}, machine::{Law, Machine}};
    /// let machine = Machine::reference();
    /// let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 3000.0);
    /// let mut plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).unwrap();
    /// let before = plan.at(0.3).spindle;
    /// plan.stop(0.3);
    /// assert_eq!(plan.at(0.3).spindle.velocity, before.velocity);
    /// assert_eq!(plan.interrupted_at(0.3), Some(Interrupted::Braking));
    /// let rest = plan.at(1.0).spindle;
    /// assert!(rest.velocity == 0.0 && rest.position < 18.0);
    /// plan.retract(1.0).unwrap();
    /// assert!(plan.at(plan.duration_s()).spindle.position.abs() < 1e-9);
    /// ```
    pub fn stop(&mut self, now_s: f64) {
        if self.stay_stopped(now_s) {
            return;
        }
        if matches!(self.interrupted_at(now_s), Some(Interrupted::Braking | Interrupted::Holding))
            || now_s > self.duration_s()
        {
            return;
        }
        let Leg { kind, start_s, duration_s, start_rev, profile } = self.leg(self.leg_at(now_s));
        let moved = profile.at(now_s - start_s);
        let rest_rev = profile.distance() - moved.position;
        let braking = self
            .machine
            .torque_limit()
            .brake(moved.velocity, self.machine.spec().z.max_mm_per_s2 / self.cycle().pitch_mm)
            .ok()
            .filter(|braking| kind.is_stroke() && braking.distance() < rest_rev);
        let leg = match braking {
            Some(profile) => {
                let sign = if kind == LegKind::Out { -1.0 } else { 1.0 };
                let start_rev = start_rev + sign * moved.position;
                Leg { kind, start_s: now_s, duration_s: profile.duration_s(), start_rev, profile }
            }
            None if kind == LegKind::Dwell => Leg { kind, start_s, duration_s: now_s - start_s, start_rev, profile },
            None => Leg { kind, start_s, duration_s, start_rev, profile },
        };
        self.interrupt(Purpose::Stop, now_s, leg);
    }

    /// The spindle was brought to rest elsewhere than planned: from a time on the hole is held there, as if stopped.
    pub fn hold_at(&mut self, now_s: f64, rest_rev: f64) {
        let leg = self.leg(self.leg_at(now_s));
        let held = Leg { start_s: now_s, duration_s: 0.0, start_rev: rest_rev, profile: Profile::default(), ..leg };
        self.interrupt(Purpose::Stop, now_s, held);
    }

    /// A stop that was to be left once it rests, and still brakes, is not left. True where it was so.
    fn stay_stopped(&mut self, now_s: f64) -> bool {
        let Some(interruption) = &mut self.interruption else { return false };
        if now_s >= interruption.leg.start_s {
            return false;
        }
        let Some((_, leg)) = interruption.braking.take() else { return false };
        // Another number: the leg that will not come may be known by its own.
        (interruption.purpose, interruption.number, interruption.leg) = (Purpose::Stop, interruption.number + 1, leg);
        true
    }

    /// Brings a stopped hole back to the R plane, once it rests, at the speed of the stroke out.
    ///
    /// # Errors
    /// [`InterruptionError`], and the hole stays held.
    pub fn retract(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        self.leave(Purpose::Retract, now_s)
    }

    /// Lets a stopped hole go on from where it rests, as if it had never been stopped.
    ///
    /// # Errors
    /// As [`CyclePlan::retract`].
    pub fn resume(&mut self, now_s: f64) -> Result<(), InterruptionError> {
        self.leave(Purpose::Resume, now_s)
    }

    fn leave(&mut self, purpose: Purpose, now_s: f64) -> Result<(), InterruptionError> {
        let stopped = self.interruption.as_ref().filter(|interruption| interruption.purpose == Purpose::Stop);
        let Some(Interruption { since_s, number, interrupted, leg, .. }) = stopped else {
            return Err(InterruptionError::NotStopped);
        };
        let (since_s, interrupted) = (*since_s, *interrupted);
        let braking = (now_s < leg.end_s()).then(|| (*number, leg.clone()));
        let start_s = now_s.max(leg.end_s());
        let start_rev = leg.at(start_s).spindle.position;
        let (kind, to_rev) = match purpose {
            Purpose::Resume => {
                let span = self.pecks.leg(interrupted);
                (span.kind, span.to_mm / self.cycle().pitch_mm)
            }
            Purpose::Stop | Purpose::Retract => (LegKind::Out, 0.0),
        };
        let distance = (to_rev - start_rev).abs();
        let cycle = self.cycle();
        let speed_rpm = if kind == LegKind::Out { cycle.out_speed_rpm } else { cycle.speed_rpm };
        let request = StrokeRequest { distance, command: rev_per_s_from_rpm(speed_rpm) };
        let (start_rev, profile) = if distance < NO_WAY_REV {
            (to_rev, Profile::default())
        } else {
            (start_rev, self.stroke(request, Turns::default()).map_err(InterruptionError::Stroke)?)
        };
        let leg = Leg { kind, start_s, duration_s: profile.duration_s(), start_rev, profile };
        if purpose == Purpose::Resume {
            self.delay_after(interrupted, leg.end_s());
        }
        self.interrupt(purpose, since_s, leg);
        if let Some(interruption) = &mut self.interruption {
            interruption.braking = braking;
        }
        Ok(())
    }

    /// Lets the legs after one start later, the first of them at a time.
    fn delay_after(&mut self, interrupted: usize, end_s: f64) {
        let mut later = self.starts_s.iter_mut().skip(interrupted + 1);
        let Some(first) = later.next() else { return };
        let delay_s = end_s - *first;
        *first = end_s;
        later.for_each(|start_s| *start_s += delay_s);
    }

    fn interrupt(&mut self, purpose: Purpose, since_s: f64, leg: Leg) {
        let before = self.interruption.as_ref();
        let number = before.map_or(0, |interruption| interruption.number + 1);
        // A retract or a resumed leg that is stopped again still stands for the leg that was interrupted first.
        let interrupted = match before {
            Some(interruption) if interruption.number_at(since_s).is_some() => interruption.interrupted,
            _ => self.planned_leg_at(since_s),
        };
        self.interruption = Some(Interruption { purpose, since_s, number, interrupted, leg, braking: None });
    }
}
