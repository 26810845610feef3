//! The synchronous legs of a hole: stroke in, dwell, stroke out. Feasible, or refused before anything moves.

use arrayvec::ArrayVec;

use super::TapCycle;
use crate::control::coupling::Thread;
use crate::control::machine::{Law, Machine};
use crate::control::math::poly::State;
use crate::control::profile::{Profile, ProfileError, StrokeRequest, Turns};
use crate::control::units::{rev_per_s_from_rpm, rpm_from_rev_per_s};

/// Why a hole cannot be tapped on this machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CycleError {
    /// The bottom is not below the R plane.
    NoStroke {
        /// R plane.
        r_plane_mm: f64,
        /// Bottom.
        bottom_mm: f64,
    },
    /// A number that has to be positive and finite is not: pitch, speed or dwell.
    Invalid {
        /// The number.
        value: f64,
    },
    /// Commanded speed beyond the spindle's.
    SpindleTooFast {
        /// Commanded speed.
        needed_rpm: f64,
        /// The spindle's greatest.
        limit_rpm: f64,
    },
    /// Pitch × speed beyond Z's speed.
    PitchTooFast {
        /// Speed that Z would need.
        needed_mm_per_s: f64,
        /// Z's greatest.
        limit_mm_per_s: f64,
    },
    /// Pitch × acceleration beyond Z's acceleration.
    PitchTooSharp {
        /// Acceleration that Z would need.
        needed_mm_per_s2: f64,
        /// Z's greatest.
        limit_mm_per_s2: f64,
    },
    /// The time law has no profile for a stroke.
    Law(ProfileError),
    /// Pecks are asked for; this version taps each hole in one stroke.
    PecksNotSupported,
}

/// Which part of a hole a leg is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LegKind {
    /// Stroke in, R plane to bottom.
    In,
    /// Pause at the bottom, still synchronous.
    Dwell,
    /// Stroke out, bottom to R plane.
    Out,
}

impl LegKind {
    /// Name in traces and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::In => "in",
            Self::Dwell => "dwell",
            Self::Out => "out",
        }
    }

    /// Whether the tap moves: it rests while dwelling.
    #[must_use]
    pub const fn is_stroke(self) -> bool {
        matches!(self, Self::In | Self::Out)
    }
}

/// One synchronous leg.
#[derive(Clone, Debug, PartialEq)]
pub struct Leg {
    /// Which part it is.
    pub kind: LegKind,
    /// When it starts, from the hole's first synchronous period.
    pub start_s: f64,
    /// How long it takes.
    pub duration_s: f64,
    /// Spindle angle at its start, positive into the hole.
    pub start_rev: f64,
    /// Its time law; none while dwelling.
    pub profile: Profile,
}

/// The spindle's planned state at one instant of a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegState {
    /// Which leg.
    pub kind: LegKind,
    /// Segment of the leg's profile, from 0.
    pub phase: usize,
    /// Spindle angle in rev from the hole's start, positive into the hole.
    pub spindle: State,
}

/// A hole that can be tapped: its legs, planned.
#[derive(Debug, PartialEq)]
pub struct CyclePlan {
    cycle: TapCycle,
    legs: ArrayVec<Leg, 3>,
    duration_s: f64,
}

impl Clone for CyclePlan {
    fn clone(&self) -> Self {
        // Not the list's own `clone`, see `math::list`.
        let mut legs = ArrayVec::new();
        for leg in &self.legs {
            let _ = legs.try_push(leg.clone());
        }
        Self { legs, ..*self }
    }
}

impl CyclePlan {
    /// Plans the hole's strokes under a law.
    ///
    /// # Errors
    /// [`CycleError`], and nothing has moved.
    ///
    /// ```
    /// use rigidtap::control::{cycle::{CyclePlan, TapCycle}, machine::{Law, Machine}};
    /// let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 3000.0);
    /// let plan = CyclePlan::new(hole, &Machine::reference(), Law::TorqueCurve).unwrap();
    /// let bottom = plan.at(plan.duration_s() / 2.0).spindle;
    /// assert!((bottom.position - 25.0).abs() < 1e-9);
    /// ```
    pub fn new(cycle: TapCycle, machine: &Machine, law: Law) -> Result<Self, CycleError> {
        check(&cycle, machine)?;
        let thread = Thread { pitch_mm: cycle.pitch_mm };
        let distance_rev = cycle.depth_mm() / cycle.pitch_mm;
        let strokes = [cycle.speed_rpm, cycle.out_speed_rpm]
            .map(|speed_rpm| StrokeRequest { distance: distance_rev, command: rev_per_s_from_rpm(speed_rpm) });
        let [request_in, request_out] = strokes;
        // Where the spindle need not stand at the bottom, it may keep its acceleration through the reversal.
        let pauses = cycle.dwell_s > 0.0;
        let turn = if pauses { 0.0 } else { machine.turn_acceleration(law, strokes).map_err(CycleError::Law)? };
        let stroke = |request, turns| {
            let profile = machine.turning_stroke(law, request, turns).map_err(CycleError::Law)?;
            let limit_mm_per_s2 = machine.spec().z.max_mm_per_s2;
            for segment in profile.segments() {
                for state in [segment.start, segment.end()] {
                    let needed_mm_per_s2 = thread.follow(&state).acceleration.abs();
                    if needed_mm_per_s2 > limit_mm_per_s2 {
                        return Err(CycleError::PitchTooSharp { needed_mm_per_s2, limit_mm_per_s2 });
                    }
                }
            }
            Ok(profile)
        };
        let mut plan = Self { cycle, legs: ArrayVec::new(), duration_s: 0.0 };
        plan.append(LegKind::In, 0.0, stroke(request_in, Turns { end: turn, ..Turns::default() })?, None);
        if pauses {
            plan.append(LegKind::Dwell, distance_rev, Profile::default(), Some(cycle.dwell_s));
        }
        plan.append(LegKind::Out, distance_rev, stroke(request_out, Turns { start: turn, ..Turns::default() })?, None);
        Ok(plan)
    }

    fn append(&mut self, kind: LegKind, start_rev: f64, profile: Profile, dwell_s: Option<f64>) {
        let duration_s = dwell_s.unwrap_or_else(|| profile.duration_s());
        let leg = Leg { kind, start_s: self.duration_s, duration_s, start_rev, profile };
        self.duration_s += duration_s;
        // Three legs at most, as many as the list holds.
        let _ = self.legs.try_push(leg);
    }

    /// The hole this is the plan of.
    #[must_use]
    pub fn cycle(&self) -> &TapCycle {
        &self.cycle
    }

    /// Spindle and Z's coupling.
    #[must_use]
    pub fn thread(&self) -> Thread {
        Thread { pitch_mm: self.cycle.pitch_mm }
    }

    /// The legs in order.
    #[must_use]
    pub fn legs(&self) -> &[Leg] {
        &self.legs
    }

    /// Time from the first to the last synchronous period.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Where the spindle is to be at a time; from the end on it rests where it started.
    #[must_use]
    pub fn at(&self, t_s: f64) -> LegState {
        if t_s >= self.duration_s {
            let phase = self.legs.last().map_or(0, |leg| leg.profile.segment_at(leg.duration_s));
            return LegState { kind: LegKind::Out, phase, spindle: State::default() };
        }
        let leg = self.legs.iter().rev().find(|leg| leg.start_s <= t_s).or(self.legs.first());
        let Some(leg) = leg else {
            return LegState { kind: LegKind::Out, phase: 0, spindle: State::default() };
        };
        let leg_s = t_s - leg.start_s;
        let moved = leg.profile.at(leg_s);
        let direction = match leg.kind {
            LegKind::In => 1.0,
            LegKind::Dwell => 0.0,
            LegKind::Out => -1.0,
        };
        let spindle = moved.scaled(direction).shifted(leg.start_rev);
        LegState { kind: leg.kind, phase: leg.profile.segment_at(leg_s), spindle }
    }
}

fn check(cycle: &TapCycle, machine: &Machine) -> Result<(), CycleError> {
    let spec = machine.spec();
    for value in [cycle.pitch_mm, cycle.speed_rpm, cycle.out_speed_rpm] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(CycleError::Invalid { value });
        }
    }
    if !(cycle.dwell_s >= 0.0 && cycle.dwell_s.is_finite()) {
        return Err(CycleError::Invalid { value: cycle.dwell_s });
    }
    if !(cycle.depth_mm() > 0.0 && cycle.depth_mm().is_finite()) {
        return Err(CycleError::NoStroke { r_plane_mm: cycle.r_plane_mm, bottom_mm: cycle.bottom_mm });
    }
    if cycle.peck_mm.is_some() {
        return Err(CycleError::PecksNotSupported);
    }
    let needed_rpm = cycle.speed_rpm.max(cycle.out_speed_rpm);
    let limit_rpm = spec.spindle.max_rpm;
    if needed_rpm > limit_rpm {
        return Err(CycleError::SpindleTooFast { needed_rpm, limit_rpm });
    }
    let needed_mm_per_s = cycle.pitch_mm * rev_per_s_from_rpm(needed_rpm);
    let limit_mm_per_s = spec.z.max_mm_per_s;
    if needed_mm_per_s > limit_mm_per_s {
        return Err(CycleError::PitchTooFast { needed_mm_per_s, limit_mm_per_s });
    }
    Ok(())
}

impl Leg {
    /// Greatest spindle speed of the leg.
    #[must_use]
    pub fn peak_rpm(&self) -> f64 {
        rpm_from_rev_per_s(self.profile.peak_velocity())
    }
}
