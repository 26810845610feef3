//! An independent checker of profiles: it samples and integrates, and uses no formula of any planner.

use super::Profile;
use crate::control::math::{poly::State, quadrature::integrate};

/// What a profile has to keep. Magnitudes; infinite where there is no limit.
#[derive(Clone, Copy)]
pub struct Limits<'a> {
    /// Greatest speed.
    pub velocity: f64,
    /// Greatest acceleration at a state, from its speed and the direction of its acceleration.
    pub acceleration: &'a dyn Fn(&State) -> f64,
    /// Greatest jerk.
    pub jerk: f64,
    /// Acceleration has no steps, neither inside nor at the ends.
    pub continuous_acceleration: bool,
}

/// What a profile has to do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task {
    /// Distance to cover.
    pub distance: f64,
    /// Speed at the start.
    pub start_velocity: f64,
    /// Speed at the end.
    pub end_velocity: f64,
}

/// The first thing found wrong with a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Violation {
    /// A time, state or snap is not a finite number, or a segment takes no time.
    NotFinite {
        /// Segment, from 0.
        segment: usize,
    },
    /// A segment starts at another time than the one before it ended.
    Gap {
        /// Segment, from 0.
        segment: usize,
        /// Time between them.
        gap_s: f64,
    },
    /// Position, velocity or acceleration steps where a segment starts.
    Step {
        /// Segment, from 0; the number of segments for the end.
        segment: usize,
        /// Order of the derivative: 0 for position.
        derivative: u8,
        /// Height of the step.
        step: f64,
    },
    /// The integral of a derivative over a segment is not the change of what it derives.
    Integral {
        /// Segment, from 0.
        segment: usize,
        /// Order of the integrated derivative: 1 for velocity.
        derivative: u8,
        /// Difference.
        difference: f64,
    },
    /// A limit is passed.
    Limit {
        /// When.
        time_s: f64,
        /// Order of the derivative: 1 for velocity.
        derivative: u8,
        /// Value there.
        value: f64,
        /// Its limit.
        limit: f64,
    },
    /// The motion runs backwards.
    Backwards {
        /// When.
        time_s: f64,
        /// Velocity there.
        velocity: f64,
    },
    /// The profile starts or ends elsewhere than its task says.
    End {
        /// Order of the derivative: 0 for position.
        derivative: u8,
        /// Difference.
        difference: f64,
    },
}

/// The absolute part of every tolerance: position in units, velocity in units/s.
pub const TOLERANCE: f64 = 1e-9;
/// The relative part of the limits' tolerance.
pub const RELATIVE_TOLERANCE: f64 = 1e-9;
const SAMPLES: u32 = 16;

/// Checks a profile against its task and limits.
///
/// # Errors
/// The first [`Violation`] in time.
///
/// ```
/// use rigidtap::control::profile::{LinearLaw, StrokeRequest, verify::{Limits, Task, verify}};
/// let profile = LinearLaw { acceleration: 100.0 }.plan(StrokeRequest { distance: 2.0, command: 5.0 }).unwrap();
/// let limits = |a| Limits { velocity: 5.0, acceleration: a, jerk: f64::INFINITY, continuous_acceleration: false };
/// let task = Task { distance: 2.0, start_velocity: 0.0, end_velocity: 0.0 };
/// assert!(verify(&profile, &task, &limits(&|_| 100.0)).is_ok());
/// assert!(verify(&profile, &task, &limits(&|_| 99.0)).is_err());
/// ```
pub fn verify(profile: &Profile, task: &Task, limits: &Limits<'_>) -> Result<(), Violation> {
    let mut expected = State { velocity: task.start_velocity, ..State::default() };
    let mut time_s = 0.0;
    for (segment, piece) in profile.segments().iter().enumerate() {
        let start = piece.start;
        let numbers = [start.position, start.velocity, start.acceleration, start.jerk, piece.snap, piece.start_s];
        if numbers.iter().any(|number| !number.is_finite()) || !(piece.duration_s > 0.0 && piece.duration_s.is_finite())
        {
            return Err(Violation::NotFinite { segment });
        }
        if (piece.start_s - time_s).abs() > TOLERANCE {
            return Err(Violation::Gap { segment, gap_s: piece.start_s - time_s });
        }
        no_step(&expected, &start, segment, limits)?;
        let inner = |share: f64| piece.start_s + share * piece.duration_s;
        within(profile, piece.start_s, piece.duration_s, limits)?;
        // The two integrals use the profile's own evaluation, so that is checked too. Both nodes lie inside the segment.
        let span = piece.duration_s;
        let travelled = integrate(0.0, 1.0, 1, |share| profile.at(inner(share)).velocity) * span;
        let gained = integrate(0.0, 1.0, 1, |share| profile.at(inner(share)).acceleration) * span;
        let end = profile.segments().get(segment + 1).map_or(profile.end(), |next| next.start);
        agree(end.position - start.position, travelled, segment, 1)?;
        agree(end.velocity - start.velocity, gained, segment, 2)?;
        expected = State { acceleration: start.acceleration + span * (start.jerk + span * piece.snap / 2.0), ..end };
        time_s = piece.start_s + span;
    }
    no_step(&expected, &profile.end(), profile.segments().len(), limits)?;
    let end = profile.at(f64::MAX);
    for (derivative, difference) in [
        (0, end.position - task.distance),
        (1, end.velocity - task.end_velocity),
        (0, profile.at(0.0).position),
        (1, profile.at(0.0).velocity - task.start_velocity),
    ] {
        if !(difference.abs() <= TOLERANCE) {
            return Err(Violation::End { derivative, difference });
        }
    }
    if !((profile.duration_s() - time_s).abs() <= TOLERANCE) {
        let gap_s = profile.duration_s() - time_s;
        return Err(Violation::Gap { segment: profile.segments().len(), gap_s });
    }
    Ok(())
}

fn no_step(expected: &State, found: &State, segment: usize, limits: &Limits<'_>) -> Result<(), Violation> {
    let position = found.position - expected.position;
    let velocity = found.velocity - expected.velocity;
    let acceleration = found.acceleration - expected.acceleration;
    let allowed = RELATIVE_TOLERANCE * (limits.acceleration)(expected).max(1.0) * 10.0;
    for (derivative, step, tolerance) in [
        (0, position, TOLERANCE),
        (1, velocity, TOLERANCE),
        (2, acceleration, if limits.continuous_acceleration { allowed } else { f64::INFINITY }),
    ] {
        if !(step.abs() <= tolerance) {
            return Err(Violation::Step { segment, derivative, step });
        }
    }
    Ok(())
}

fn agree(change: f64, integral: f64, segment: usize, derivative: u8) -> Result<(), Violation> {
    let difference = change - integral;
    if difference.abs() <= TOLERANCE { Ok(()) } else { Err(Violation::Integral { segment, derivative, difference }) }
}

fn within(profile: &Profile, start_s: f64, duration_s: f64, limits: &Limits<'_>) -> Result<(), Violation> {
    for sample in 0..=SAMPLES {
        // The last sample stays inside: at the boundary the next segment answers.
        let share = (f64::from(sample) / f64::from(SAMPLES)).min(1.0 - 1e-12);
        let time_s = start_s + share * duration_s;
        let state = profile.at(time_s);
        if state.velocity < -TOLERANCE {
            return Err(Violation::Backwards { time_s, velocity: state.velocity });
        }
        for (derivative, value, limit) in [
            (1, state.velocity, limits.velocity),
            (2, state.acceleration, (limits.acceleration)(&state)),
            (3, state.jerk, limits.jerk),
        ] {
            if !(value.abs() <= limit * (1.0 + RELATIVE_TOLERANCE) + TOLERANCE) {
                return Err(Violation::Limit { time_s, derivative, value, limit });
            }
        }
    }
    Ok(())
}
