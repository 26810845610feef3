//! A [`Profile`] as its segments of constant snap, and how a law strings them together.

use arrayvec::ArrayVec;

use super::error::ProfileError;
use crate::control::math::{list::copied, poly::State};

/// Most lines of a ceiling: two for each piece of the longest torque curve.
pub(super) const MAX_LINES: usize = 30;
/// Most segments of a profile: two flanks under a ceiling, each between its two jerk ramps, and the cruise. Both flanks of
/// [`MAX_BANDS`](super::MAX_BANDS) bands are fewer.
pub const MAX_SEGMENTS: usize = 2 * (MAX_LINES + 2) + 1;

/// The relative part of the limits' tolerance.
pub const RELATIVE_TOLERANCE: f64 = 1e-9;

/// Motion under constant snap for a while.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Segment {
    /// When it starts, from the profile's start.
    pub start_s: f64,
    /// How long it lasts, positive.
    pub duration_s: f64,
    /// State at its start.
    pub start: State,
    /// Fourth derivative of position throughout.
    pub snap: f64,
}

impl Segment {
    /// When it ends.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// State at its end.
    #[must_use]
    pub fn end(&self) -> State {
        self.start.after(self.duration_s, self.snap)
    }
}

/// A time law of one coordinate, from 0 at time 0 to its distance at its end.
#[derive(Debug, PartialEq)]
pub struct Profile {
    pub(super) segments: ArrayVec<Segment, MAX_SEGMENTS>,
    pub(super) duration_s: f64,
    pub(super) end: State,
    peak_velocity: f64,
}

impl Clone for Profile {
    fn clone(&self) -> Self {
        Self { segments: copied(&self.segments), ..*self }
    }
}

impl Default for Profile {
    /// No motion at all: zero time at position zero.
    fn default() -> Self {
        Self { segments: ArrayVec::new(), duration_s: 0.0, end: State::default(), peak_velocity: 0.0 }
    }
}

impl Profile {
    /// The segments, in order, each starting where the one before it ended.
    #[must_use]
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Time from start to end.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// Distance covered.
    #[must_use]
    pub fn distance(&self) -> f64 {
        self.end.position
    }

    /// State at the end, kept for ever after: velocity and acceleration are those the law ends with. A stroke that turns
    /// back (see [`Turns`](super::Turns)) ends with its acceleration, so whoever stays there instead needs another stroke.
    #[must_use]
    pub fn end(&self) -> State {
        self.end
    }

    /// Greatest speed.
    #[must_use]
    pub fn peak_velocity(&self) -> f64 {
        self.peak_velocity
    }

    /// Greatest magnitude of the jerk; none where the acceleration steps from one segment to the next.
    #[must_use]
    pub fn peak_jerk(&self) -> Option<f64> {
        let mut pairs = self.segments.iter().zip(self.segments.iter().skip(1));
        let steps = pairs.any(|(before, after)| {
            let (end, start) = (before.end().acceleration, after.start.acceleration);
            (end - start).abs() > RELATIVE_TOLERANCE * (1.0 + end.abs())
        });
        let jerk = |segment: &Segment| segment.start.jerk.abs().max(segment.end().jerk.abs());
        (!steps).then(|| self.segments.iter().map(jerk).fold(0.0, f64::max))
    }

    /// Index of the segment that holds a time; the last one from the end on, 0 for an empty profile.
    #[must_use]
    pub fn segment_at(&self, t_s: f64) -> usize {
        self.segments.iter().skip(1).map(|segment| usize::from(segment.start_s <= t_s)).sum()
    }

    /// State at a time, in closed form. Before the start the first state, from the end on exactly the end.
    ///
    /// ```
    /// use rigidtap::control::profile::{LinearLaw, StrokeRequest};
    /// let law = LinearLaw { acceleration: 100.0 };
    /// let profile = law.plan(StrokeRequest { distance: 1.0, command: 50.0 }).unwrap();
    /// assert!((profile.at(profile.duration_s() / 2.0).position - 0.5).abs() < 1e-12);
    /// assert_eq!(profile.at(99.0).position, 1.0);
    /// ```
    #[must_use]
    #[inline]
    pub fn at(&self, t_s: f64) -> State {
        if t_s >= self.duration_s {
            return self.end;
        }
        match self.segments.get(self.segment_at(t_s)) {
            Some(segment) => segment.start.after((t_s - segment.start_s).max(0.0), segment.snap),
            None => self.end,
        }
    }
}

impl Profile {
    /// A profile that starts with a velocity and is filled segment by segment.
    #[inline]
    pub(crate) fn built(
        velocity: f64,
        fill: impl FnOnce(&mut Builder<'_>) -> Result<(), ProfileError>,
    ) -> Result<Self, ProfileError> {
        let mut profile = Self::default();
        profile.rebuild(velocity, fill)?;
        Ok(profile)
    }

    /// The same in place of what was there; on an error the profile holds what was filled so far.
    #[inline]
    pub(crate) fn rebuild(
        &mut self,
        velocity: f64,
        fill: impl FnOnce(&mut Builder<'_>) -> Result<(), ProfileError>,
    ) -> Result<(), ProfileError> {
        self.segments.clear();
        self.peak_velocity = velocity;
        fill(&mut Builder { profile: self, state: State { velocity, ..State::default() }, time_s: 0.0 })
    }
}

/// Strings segments together; each starts from the position and velocity where the one before it ended.
pub(crate) struct Builder<'a> {
    profile: &'a mut Profile,
    pub(super) state: State,
    pub(super) time_s: f64,
}

impl Builder<'_> {
    /// Appends a segment of constant snap that starts with this acceleration and jerk; one without duration is left out.
    #[inline]
    pub(crate) fn push(
        &mut self,
        duration_s: f64,
        acceleration: f64,
        jerk: f64,
        snap: f64,
    ) -> Result<&mut Self, ProfileError> {
        if duration_s > 0.0 {
            let start = State { acceleration, jerk, ..self.state };
            let segment = Segment { start_s: self.time_s, duration_s, start, snap };
            self.profile.segments.try_push(segment).map_err(|_| ProfileError::TooManySegments)?;
            self.state = segment.end();
            self.time_s += duration_s;
            self.profile.peak_velocity = self.profile.peak_velocity.max(self.state.velocity);
        }
        Ok(self)
    }

    /// Appends the rest of a stroke of `distance` at a constant speed. A rest below the rounding of the distances is none.
    pub(crate) fn cruise(&mut self, rest: f64, speed: f64, distance: f64) -> Result<&mut Self, ProfileError> {
        let cruises = rest > f64::EPSILON * 8.0 * distance;
        self.push(if cruises { rest / speed } else { 0.0 }, 0.0, 0.0, 0.0)
    }

    /// Ends the profile at its distance and end speed to the last bit; what rounding left of them is not carried on.
    #[inline]
    pub(crate) fn finish(&mut self, distance: f64, end_velocity: f64) -> Result<(), ProfileError> {
        self.finish_at(State { position: distance, velocity: end_velocity, ..State::default() })
    }

    /// Ends the profile wherever it has come to, at this speed: a change of speed has no distance of its own.
    pub(crate) fn finish_here(&mut self, end_velocity: f64) -> Result<(), ProfileError> {
        self.finish(self.state.position, end_velocity)
    }

    /// As [`Builder::finish`], at rest but about to turn back with an acceleration of this magnitude.
    pub(crate) fn finish_turning(&mut self, distance: f64, acceleration: f64) -> Result<(), ProfileError> {
        // No negative zero: most strokes end without.
        self.finish_at(State { position: distance, acceleration: 0.0 - acceleration, ..State::default() })
    }

    #[inline]
    fn finish_at(&mut self, end: State) -> Result<(), ProfileError> {
        self.profile.duration_s = self.time_s;
        self.profile.end = end;
        Ok(())
    }
}
