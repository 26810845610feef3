//! One synchronous stroke of a hole, in or out, or the dwell between them.

use crate::control::math::poly::State;
use crate::control::profile::Profile;
use crate::control::units::rpm_from_rev_per_s;

/// Which part of a hole a stroke is. The dwell counts as one, in which the tap rests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StrokeKind {
    /// Stroke in, R plane to bottom.
    In,
    /// Pause at the bottom, still synchronous.
    Dwell,
    /// Stroke out, bottom to R plane.
    Out,
}

impl StrokeKind {
    /// Every part, in the order of a hole.
    pub const ALL: [Self; 3] = [Self::In, Self::Dwell, Self::Out];

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
    pub const fn moves(self) -> bool {
        matches!(self, Self::In | Self::Out)
    }
}

/// One synchronous stroke.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Which part it is.
    pub kind: StrokeKind,
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
pub struct StrokeState {
    /// Which stroke.
    pub kind: StrokeKind,
    /// Segment of the stroke's profile, from 0.
    pub phase: usize,
    /// Spindle angle in rev from the hole's start, positive into the hole.
    pub spindle: State,
}

impl Stroke {
    /// When it ends.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// Where the spindle is to be at a time of the hole.
    #[must_use]
    pub fn at(&self, t_s: f64) -> StrokeState {
        let stroke_s = t_s - self.start_s;
        let direction = match self.kind {
            StrokeKind::In => 1.0,
            StrokeKind::Dwell => 0.0,
            StrokeKind::Out => -1.0,
        };
        // Past the last stroke the spindle rests, whatever speed its law ends with.
        let moved = if stroke_s < self.duration_s {
            self.profile.at(stroke_s)
        } else {
            State { position: self.profile.distance(), ..State::default() }
        };
        let spindle = moved.scaled(direction).shifted(self.start_rev);
        StrokeState { kind: self.kind, phase: self.profile.segment_at(stroke_s), spindle }
    }

    /// Greatest spindle speed of the stroke.
    #[must_use]
    pub fn peak_rpm(&self) -> f64 {
        rpm_from_rev_per_s(self.profile.peak_velocity())
    }
}
