//! The controlled stop: at any moment of a hole the spindle brakes along the motor's torque curve and Z with it at pitch;
//! then it is held, and either comes back to R or goes on. A stroke takes the place of the plan's own, so whoever follows
//! the plan follows the stop, too.

use super::interruption::{Interrupted, Interruption, InterruptionError, Purpose};
use super::plan::CyclePlan;
use super::stroke::{Stroke, StrokeKind};
use crate::control::profile::{Profile, StrokeRequest, Turns};
use crate::control::units::rev_per_s_from_rpm;

/// A travel this short in rev is the rounding of the stroke that has already ended there.
const NO_TRAVEL_REV: f64 = 1e-9;

impl CyclePlan {
    /// What the hole does at a time, where it is interrupted.
    #[must_use]
    pub fn interrupted_at(&self, t_s: f64) -> Option<Interrupted> {
        self.interruption.as_ref()?.state_at(t_s)
    }

    /// Brakes from the state at `now_s` in the shortest way that the motor's torque curve at its share, and Z's
    /// acceleration, allow; a stroke that itself ends sooner is ended instead, so that nothing goes below the bottom or
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
        let Stroke { kind, start_s, duration_s, start_rev, profile } = self.stroke(self.stroke_at(now_s));
        let moved = profile.at(now_s - start_s);
        let rest_rev = profile.distance() - moved.position;
        let braking = self
            .machine
            .torque_limit()
            .brake(moved.velocity, self.machine.spec().z.max_mm_per_s2 / self.cycle().pitch_mm)
            .ok()
            .filter(|braking| kind.moves() && braking.distance() < rest_rev);
        let stroke = match braking {
            Some(profile) => {
                let sign = if kind == StrokeKind::Out { -1.0 } else { 1.0 };
                let start_rev = start_rev + sign * moved.position;
                Stroke { kind, start_s: now_s, duration_s: profile.duration_s(), start_rev, profile }
            }
            None if kind == StrokeKind::Dwell => {
                Stroke { kind, start_s, duration_s: now_s - start_s, start_rev, profile }
            }
            None => Stroke { kind, start_s, duration_s, start_rev, profile },
        };
        self.interrupt(Purpose::Stop, now_s, stroke);
    }

    /// The spindle was brought to rest elsewhere than planned: from a time on the hole is held there, as if stopped.
    pub fn hold_at(&mut self, now_s: f64, rest_rev: f64) {
        let stroke = self.stroke(self.stroke_at(now_s));
        let held =
            Stroke { start_s: now_s, duration_s: 0.0, start_rev: rest_rev, profile: Profile::default(), ..stroke };
        self.interrupt(Purpose::Stop, now_s, held);
    }

    /// A stop that was to be left once it rests, and still brakes, is not left. True where it was so.
    fn stay_stopped(&mut self, now_s: f64) -> bool {
        let Some(interruption) = &mut self.interruption else { return false };
        if now_s >= interruption.stroke.start_s {
            return false;
        }
        let Some((_, stroke)) = interruption.braking.take() else { return false };
        // Another number: the stroke that will not come may be known by its own.
        (interruption.purpose, interruption.number, interruption.stroke) =
            (Purpose::Stop, interruption.number + 1, stroke);
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
        let Some(Interruption { since_s, number, interrupted, stroke, .. }) = stopped else {
            return Err(InterruptionError::NotStopped);
        };
        let (since_s, interrupted) = (*since_s, *interrupted);
        let braking = (now_s < stroke.end_s()).then(|| (*number, stroke.clone()));
        let start_s = now_s.max(stroke.end_s());
        let start_rev = stroke.at(start_s).spindle.position;
        let (kind, to_rev) = match purpose {
            Purpose::Resume => {
                let span = self.pecks.stroke(interrupted);
                (span.kind, span.to_mm / self.cycle().pitch_mm)
            }
            Purpose::Stop | Purpose::Retract => (StrokeKind::Out, 0.0),
        };
        let distance = (to_rev - start_rev).abs();
        let cycle = self.cycle();
        let speed_rpm = if kind == StrokeKind::Out { cycle.out_speed_rpm } else { cycle.speed_rpm };
        let request = StrokeRequest { distance, command: rev_per_s_from_rpm(speed_rpm) };
        let (start_rev, profile) = if distance < NO_TRAVEL_REV {
            (to_rev, Profile::default())
        } else {
            (start_rev, self.law_profile(request, Turns::default()).map_err(InterruptionError::Stroke)?)
        };
        let stroke = Stroke { kind, start_s, duration_s: profile.duration_s(), start_rev, profile };
        if purpose == Purpose::Resume {
            self.delay_after(interrupted, stroke.end_s());
        }
        self.interrupt(purpose, since_s, stroke);
        if let Some(interruption) = &mut self.interruption {
            interruption.braking = braking;
        }
        Ok(())
    }

    /// Lets the strokes after one start later, the first of them at a time.
    fn delay_after(&mut self, interrupted: usize, end_s: f64) {
        let mut later = self.starts_s.iter_mut().skip(interrupted + 1);
        let Some(first) = later.next() else { return };
        let delay_s = end_s - *first;
        *first = end_s;
        later.for_each(|start_s| *start_s += delay_s);
    }

    fn interrupt(&mut self, purpose: Purpose, since_s: f64, stroke: Stroke) {
        let before = self.interruption.as_ref();
        let number = before.map_or(0, |interruption| interruption.number + 1);
        // A retract or a resumed stroke that is stopped again still stands for the stroke that was interrupted first.
        let interrupted = match before {
            Some(interruption) if interruption.number_at(since_s).is_some() => interruption.interrupted,
            _ => self.planned_stroke_at(since_s),
        };
        self.interruption = Some(Interruption { purpose, since_s, number, interrupted, stroke, braking: None });
    }
}
