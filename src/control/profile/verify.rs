//! An independent checker of profiles: it samples and integrates, and uses no formula of any planner.

use super::segments::Profile;
pub use super::segments::RELATIVE_TOLERANCE;
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
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Task {
    /// Distance to cover.
    pub distance: f64,
    /// Speed at the start.
    pub start_velocity: f64,
    /// Speed at the end.
    pub end_velocity: f64,
    /// Acceleration at the start, checked where it has to be continuous.
    pub start_acceleration: f64,
    /// Acceleration at the end; likewise.
    pub end_acceleration: f64,
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
    /// A segment starts with a position, velocity or acceleration other than that which the motion integrates to.
    Step {
        /// Segment, from 0; the number of segments for the end.
        segment: usize,
        /// Order of the derivative: 0 for position.
        derivative: u8,
        /// Height of the step.
        step: f64,
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
/// let task = Task { distance: 2.0, ..Task::default() };
/// assert!(verify(&profile, &task, &limits(&|_| 100.0)).is_ok());
/// assert!(verify(&profile, &task, &limits(&|_| 99.0)).is_err());
/// ```
pub fn verify(profile: &Profile, task: &Task, limits: &Limits<'_>) -> Result<(), Violation> {
    let mut expected =
        State { velocity: task.start_velocity, acceleration: task.start_acceleration, ..State::default() };
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
        within(profile, piece.start_s, piece.duration_s, limits)?;
        // The integrals use the profile's own evaluation, so that is checked too; their nodes lie inside the segment.
        let span = piece.duration_s;
        let integral = |of: fn(&State) -> f64| {
            span * integrate(0.0, 1.0, 1, |share| of(&profile.at(piece.start_s + share * span)))
        };
        expected = State {
            position: start.position + integral(|state| state.velocity),
            velocity: start.velocity + integral(|state| state.acceleration),
            // By the segment alone: jerk × a time's last bit may be more than the tolerance of a step.
            acceleration: start.acceleration + span * (start.jerk + span * piece.snap / 2.0),
            jerk: 0.0,
        };
        time_s = piece.start_s + span;
    }
    no_step(&expected, &profile.end(), profile.segments().len(), limits)?;
    let end = profile.at(f64::MAX);
    let asked = State { acceleration: task.end_acceleration, ..end };
    no_step(&asked, &end, profile.segments().len(), limits)?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::profile::{Profile, SCurveLaw, Segment, StrokeRequest};

    const DISTANCE: f64 = 10.0;
    const TASK: Task = Task {
        distance: DISTANCE,
        start_velocity: 0.0,
        end_velocity: 0.0,
        start_acceleration: 0.0,
        end_acceleration: 0.0,
    };

    /// Seven segments: V = 5, A = 10 and J = 100 all reached.
    fn profile() -> Profile {
        let law = SCurveLaw { acceleration: 10.0, jerk: 100.0 };
        let profile = law.plan(StrokeRequest { distance: DISTANCE, command: 5.0 }).unwrap();
        assert_eq!(profile.segments().len(), 7);
        profile
    }

    fn verified(profile: &Profile) -> Result<(), Violation> {
        let limits = Limits { velocity: 5.0, acceleration: &|_| 10.0, jerk: 100.0, continuous_acceleration: true };
        verify(profile, &TASK, &limits)
    }

    /// What is found after a change to one segment.
    fn after(segment: usize, change: impl FnOnce(&mut Segment)) -> Result<(), Violation> {
        let mut profile = profile();
        change(&mut profile.segments[segment]);
        verified(&profile)
    }

    #[test]
    fn an_intact_profile_passes() {
        assert_eq!(verified(&profile()), Ok(()));
        assert_eq!(after(3, |piece| piece.start.position += 0.5 * TOLERANCE), Ok(()));
    }

    #[test]
    fn what_is_no_number_is_found() {
        let not_finite = |segment| Err(Violation::NotFinite { segment });
        assert_eq!(after(2, |piece| piece.snap = f64::NAN), not_finite(2));
        assert_eq!(after(0, |piece| piece.start.position = f64::INFINITY), not_finite(0));
        assert_eq!(after(6, |piece| piece.duration_s = 0.0), not_finite(6));
        assert_eq!(after(4, |piece| piece.duration_s = -0.1), not_finite(4));
    }

    #[test]
    fn a_gap_in_time_is_found() {
        let found = after(3, |piece| piece.start_s += 1e-6);
        assert!(matches!(found, Err(Violation::Gap { segment: 3, .. })), "{found:?}");
        let mut profile = profile();
        profile.duration_s += 1e-6;
        let found = verified(&profile);
        assert!(matches!(found, Err(Violation::Gap { segment: 7, .. })), "{found:?}");
    }

    #[test]
    fn steps_are_found_at_the_segment_that_makes_them() {
        type Change = fn(&mut State);
        let moved: [(u8, Change); 3] = [
            (0, |start| start.position += 3e-9),
            (1, |start| start.velocity -= 3e-9),
            (2, |start| start.acceleration -= 3e-7),
        ];
        for (order, change) in moved {
            for at in 0..7 {
                let found = after(at, |piece| change(&mut piece.start));
                let Err(Violation::Step { segment, derivative, .. }) = found else { panic!("{at}: {found:?}") };
                assert_eq!((segment, derivative), (at, order), "{found:?}");
            }
        }
    }

    #[test]
    fn a_wrong_piece_is_found_where_it_meets_the_next() {
        for wrong in [
            after(0, |piece| piece.start.jerk *= 1.0 - 1e-6),
            after(0, |piece| piece.snap = -1e-3),
            after(6, |piece| piece.duration_s *= 1.0 - 1e-6),
        ] {
            assert!(matches!(wrong, Err(Violation::Step { .. } | Violation::Gap { .. })), "{wrong:?}");
        }
    }

    #[test]
    fn passed_limits_are_found() {
        let under = |velocity: f64, acceleration: f64, jerk: f64| {
            let acceleration = &|_: &State| acceleration;
            let limits = Limits { velocity, acceleration, jerk, continuous_acceleration: true };
            verify(&profile(), &TASK, &limits)
        };
        let less = 1.0 - 1e-6;
        for (order, found) in [
            (1, under(5.0 * less, 10.0, 100.0)),
            (2, under(5.0, 10.0 * less, 100.0)),
            (3, under(5.0, 10.0, 100.0 * less)),
        ] {
            assert!(matches!(found, Err(Violation::Limit { derivative, .. }) if derivative == order), "{found:?}");
        }
    }

    #[test]
    fn running_backwards_is_found() {
        let mut profile = profile();
        for piece in &mut profile.segments {
            piece.start.velocity -= 1.0;
            piece.start.position -= piece.start_s;
        }
        let distance = DISTANCE - profile.duration_s;
        profile.end = State { position: distance, velocity: -1.0, ..State::default() };
        let task = Task { distance, start_velocity: -1.0, end_velocity: -1.0, ..TASK };
        let limits = Limits { velocity: 5.0, acceleration: &|_| 10.0, jerk: 100.0, continuous_acceleration: true };
        let found = verify(&profile, &task, &limits);
        assert!(matches!(found, Err(Violation::Backwards { .. })), "{found:?}");
    }

    #[test]
    fn a_wrong_end_is_found() {
        let against = |task: Task| {
            let limits = Limits { velocity: 5.0, acceleration: &|_| 10.0, jerk: 100.0, continuous_acceleration: true };
            verify(&profile(), &task, &limits)
        };
        let far = against(Task { distance: DISTANCE + 3e-9, ..TASK });
        assert!(matches!(far, Err(Violation::End { derivative: 0, .. })), "{far:?}");
        let fast = against(Task { end_velocity: 3e-9, ..TASK });
        assert!(matches!(fast, Err(Violation::End { derivative: 1, .. })), "{fast:?}");
        let started = against(Task { start_velocity: 3e-9, ..TASK });
        assert!(matches!(started, Err(Violation::Step { segment: 0, derivative: 1, .. })), "{started:?}");
        let empty = verify(
            &Profile::default(),
            &TASK,
            &Limits { velocity: 5.0, acceleration: &|_| 10.0, jerk: 100.0, continuous_acceleration: true },
        );
        assert!(matches!(empty, Err(Violation::Step { .. } | Violation::End { .. })), "{empty:?}");
    }

    #[test]
    fn an_acceleration_at_an_end_other_than_asked_is_found() {
        let profile = profile();
        let limits = Limits { velocity: 5.0, acceleration: &|_| 10.0, jerk: 100.0, continuous_acceleration: true };
        let start = verify(&profile, &Task { start_acceleration: 1e-3, ..TASK }, &limits);
        assert!(matches!(start, Err(Violation::Step { segment: 0, derivative: 2, .. })), "{start:?}");
        let end = verify(&profile, &Task { end_acceleration: -1e-3, ..TASK }, &limits);
        assert!(matches!(end, Err(Violation::Step { segment: 7, derivative: 2, .. })), "{end:?}");
        // Where it may step, nothing is asked of it.
        let stepping = Limits { continuous_acceleration: false, ..limits };
        assert_eq!(verify(&profile, &Task { end_acceleration: -1e-3, ..TASK }, &stepping), Ok(()));
    }

    /// The profile's own evaluation is checked, too: it must follow the segment it stands in.
    #[test]
    fn an_end_that_the_motion_does_not_reach_is_found() {
        let mut profile = profile();
        profile.end.position += 3e-9;
        let task = Task { distance: profile.end.position, ..TASK };
        let limits = Limits { velocity: 5.0, acceleration: &|_| 10.0, jerk: 100.0, continuous_acceleration: true };
        let found = verify(&profile, &task, &limits);
        assert!(matches!(found, Err(Violation::Step { segment: 7, derivative: 0, .. })), "{found:?}");
    }
}
