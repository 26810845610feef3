//! The synchronous strokes of a hole: in and out, peck by peck, and the dwell. Feasible, or refused before anything moves.
//!
//! A profile is too large to keep one for each of a hundred strokes, and planning one takes about a microsecond: a plan
//! keeps when each stroke starts, and plans the stroke it is asked for.

use arrayvec::ArrayVec;

use super::error::CycleError;
use super::hole::TapCycle;
use super::interruption::Interruption;
use super::pecks::{MAX_PECKS, MAX_STROKES, Pecks};
use super::stroke::{Stroke, StrokeKind, StrokeState};
use crate::control::coupling::Thread;
use crate::control::machine::{Law, Machine};
use crate::control::math::list::copied;
use crate::control::profile::{Profile, StrokeRequest, Turns};
use crate::control::units::rev_per_s_from_rpm;

/// A hole that can be tapped: every stroke of it is known to be feasible.
#[derive(Debug, PartialEq)]
pub struct CyclePlan {
    cycle: TapCycle,
    law: Law,
    pub(super) machine: Machine,
    pub(super) pecks: Pecks,
    /// When each stroke starts, and the end of the last.
    pub(super) starts_s: ArrayVec<f64, { MAX_STROKES + 1 }>,
    /// What has taken the place of the strokes.
    pub(super) interruption: Option<Interruption>,
}

impl Clone for CyclePlan {
    fn clone(&self) -> Self {
        let interruption = self.interruption.clone();
        Self { machine: self.machine.clone(), starts_s: copied(&self.starts_s), interruption, ..*self }
    }
}

impl CyclePlan {
    /// Plans the hole's strokes under a law.
    ///
    /// # Errors
    /// [`CycleError`], and nothing has moved.
    ///
    /// ```
    /// use rigidtap::control::{cycle::{CyclePlan, StrokeKind, Retract, TapCycle}, machine::{Law, Machine}};
    /// let machine = Machine::reference();
    /// let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 3000.0);
    /// let plan = CyclePlan::new(hole, &machine, Law::TorqueCurve).unwrap();
    /// let bottom = plan.at(plan.duration_s() / 2.0).spindle;
    /// assert!((bottom.position - 25.0).abs() < 1e-9);
    ///
    /// let pecked = TapCycle { peck_mm: Some(10.0), retract: Some(Retract::Full), ..hole };
    /// let plan = CyclePlan::new(pecked, &machine, Law::TorqueCurve).unwrap();
    /// assert_eq!(plan.strokes().filter(|stroke| stroke.kind == StrokeKind::In).count(), 3);
    /// ```
    pub fn new(cycle: TapCycle, machine: &Machine, law: Law) -> Result<Self, CycleError> {
        cycle.check(machine)?;
        let pecks = Pecks::of(&cycle).map_err(|needed| CycleError::TooManyPecks { needed, limit: MAX_PECKS })?;
        let mut plan =
            Self { cycle, law, machine: machine.clone(), pecks, starts_s: ArrayVec::new(), interruption: None };
        let mut now_s = 0.0;
        // One more place than there are strokes at most: the pushes cannot fail.
        let _ = plan.starts_s.try_push(now_s);
        for index in 0..plan.pecks.strokes() {
            let profile = plan.profile(index)?;
            plan.check_acceleration(&profile)?;
            now_s += plan.stroke_duration_s(index, &profile);
            let _ = plan.starts_s.try_push(now_s);
        }
        Ok(plan)
    }

    /// The time law of a stroke.
    fn profile(&self, index: usize) -> Result<Profile, CycleError> {
        let Some(request) = self.request(index) else { return Ok(Profile::default()) };
        let turns = self.turns(index)?;
        self.law_profile(request, turns)
    }

    pub(super) fn law_profile(&self, request: StrokeRequest, turns: Turns) -> Result<Profile, CycleError> {
        self.machine.turning_stroke(self.law, request, turns).map_err(CycleError::Law)
    }

    /// What a stroke asks of the law; nothing while dwelling.
    fn request(&self, index: usize) -> Option<StrokeRequest> {
        let span = self.pecks.stroke(index);
        let speed_rpm = match span.kind {
            StrokeKind::In => self.cycle.speed_rpm,
            StrokeKind::Dwell => return None,
            StrokeKind::Out => self.cycle.out_speed_rpm,
        };
        let distance = (span.to_mm - span.from_mm).abs() / self.cycle.pitch_mm;
        Some(StrokeRequest { distance, command: rev_per_s_from_rpm(speed_rpm) })
    }

    /// Where one stroke in is followed at once by one stroke out, the spindle may keep its acceleration through the
    /// reversal. Pecks stand at each: their strokes can be too short to turn at both ends.
    fn turns(&self, index: usize) -> Result<Turns, CycleError> {
        let (Some(before), Some(after), 2) = (self.request(0), self.request(1), self.pecks.strokes()) else {
            return Ok(Turns::default());
        };
        let turn = self.machine.turn_acceleration(self.law, [before, after]).map_err(CycleError::Law)?;
        Ok(if index == 0 { Turns { end: turn, ..Turns::default() } } else { Turns { start: turn, ..Turns::default() } })
    }

    fn stroke_duration_s(&self, index: usize, profile: &Profile) -> f64 {
        if self.pecks.stroke(index).kind == StrokeKind::Dwell { self.cycle.dwell_s } else { profile.duration_s() }
    }

    fn check_acceleration(&self, profile: &Profile) -> Result<(), CycleError> {
        let limit_mm_per_s2 = self.machine.spec().z.max_mm_per_s2;
        for segment in profile.segments() {
            for state in [segment.start, segment.end()] {
                let needed_mm_per_s2 = self.thread().follow(&state).acceleration.abs();
                if needed_mm_per_s2 > limit_mm_per_s2 {
                    return Err(CycleError::PitchTooSharp { needed_mm_per_s2, limit_mm_per_s2 });
                }
            }
        }
        Ok(())
    }

    /// The hole this is the plan of.
    #[must_use]
    pub fn cycle(&self) -> &TapCycle {
        &self.cycle
    }

    /// The time law of its strokes.
    #[must_use]
    pub fn law(&self) -> Law {
        self.law
    }

    /// The machine that it is planned for.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The same hole with its R plane elsewhere: its strokes do not depend on the height.
    #[must_use]
    pub fn with_r_plane(&self, r_plane_mm: f64) -> Self {
        let rise_mm = r_plane_mm - self.cycle.r_plane_mm;
        let (bottom_mm, return_mm) = (self.cycle.bottom_mm + rise_mm, self.cycle.return_mm + rise_mm);
        Self { cycle: TapCycle { r_plane_mm, bottom_mm, return_mm, ..self.cycle }, ..self.clone() }
    }

    /// Spindle and Z's coupling.
    #[must_use]
    pub fn thread(&self) -> Thread {
        Thread { pitch_mm: self.cycle.pitch_mm }
    }

    /// How many strokes the hole has.
    #[must_use]
    pub fn stroke_count(&self) -> usize {
        self.pecks.strokes()
    }

    /// The stroke in force at a time, from 0; from [`CyclePlan::stroke_count`] on what an interruption put in its place.
    #[must_use]
    pub fn stroke_at(&self, t_s: f64) -> usize {
        if let Some(number) = self.interruption.as_ref().and_then(|interruption| interruption.number_at(t_s)) {
            return self.stroke_count() + number;
        }
        self.planned_stroke_at(t_s)
    }

    pub(super) fn planned_stroke_at(&self, t_s: f64) -> usize {
        let started = self.starts_s.iter().take(self.pecks.strokes()).take_while(|start_s| **start_s <= t_s).count();
        started.saturating_sub(1)
    }

    /// Plans one stroke, the last where there is none of that number; see the module for why it is not kept.
    #[must_use]
    pub fn stroke(&self, index: usize) -> Stroke {
        if let Some(interruption) = self.interruption.as_ref().filter(|_| index >= self.stroke_count()) {
            return interruption.stroke(index - self.stroke_count()).clone();
        }
        let index = index.min(self.pecks.strokes() - 1);
        // Planned once already, and found feasible.
        let profile = self.profile(index).unwrap_or_default();
        Stroke {
            kind: self.pecks.stroke(index).kind,
            start_s: self.starts_s.get(index).copied().unwrap_or_default(),
            duration_s: self.stroke_duration_s(index, &profile),
            start_rev: self.pecks.stroke(index).from_mm / self.cycle.pitch_mm,
            profile,
        }
    }

    /// The strokes in order, each planned as it comes.
    pub fn strokes(&self) -> impl Iterator<Item = Stroke> {
        (0..self.pecks.strokes()).map(|index| self.stroke(index))
    }

    /// Time from the first to the last synchronous period; infinite while a stopped spindle is held.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        if let Some(end_s) = self.interruption.as_ref().and_then(Interruption::end_of_hole_s) {
            return end_s;
        }
        self.starts_s.last().copied().unwrap_or_default()
    }

    /// Where the spindle is to be at a time; from the end on it rests where it started. Who asks period by period
    /// keeps the [`Stroke`] and asks that.
    #[must_use]
    pub fn at(&self, t_s: f64) -> StrokeState {
        self.stroke(self.stroke_at(t_s)).at(t_s)
    }
}
