//! What happens after an alarm, by what can still be trusted.

use super::alarm::{Alarm, Axis};

/// How a hole is ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::control::sync) enum StopKind {
    /// Synchronous stop: the spindle brakes with what torque there is, and Z goes with the measured spindle.
    Synchronous,
    /// Stop on the model: what the encoders say is not to be trusted, and both axes brake on the plan.
    Model,
    /// Z is lost: the spindle brakes as hard as it can.
    ZLost,
}

/// What an alarm asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Severity {
    /// Nothing: the hole is over.
    Noted,
    /// Brake on the plan, by the model alone.
    Model,
    /// Brake on the plan, Z with the measured spindle.
    Synchronous,
    /// Brake as the spindle does, which does not follow the plan.
    Followed,
    /// Brake the spindle alone.
    ZLost,
}

impl Severity {
    pub(super) fn stop(self) -> StopKind {
        match self {
            Self::Noted | Self::Model => StopKind::Model,
            Self::Synchronous | Self::Followed => StopKind::Synchronous,
            Self::ZLost => StopKind::ZLost,
        }
    }

    pub(super) fn of(alarm: &Alarm) -> Self {
        match alarm {
            Alarm::SampleLost { .. }
            | Alarm::CountJump { .. }
            | Alarm::EncoderFrozen { .. }
            | Alarm::TravelMismatch { .. }
            | Alarm::Clock { .. } => Self::Model,
            Alarm::SynchronisationError { .. } | Alarm::EffortImplausible { .. } => Self::Synchronous,
            Alarm::SpindleFollowing { .. }
            | Alarm::SpindleTorque { .. }
            | Alarm::Jam { .. }
            | Alarm::DriveNotReady { axis: Axis::Spindle, .. } => Self::Followed,
            Alarm::ZFollowing { .. } | Alarm::DriveNotReady { axis: Axis::Z, .. } => Self::ZLost,
            Alarm::TapBroken { .. } | Alarm::NotInPosition { .. } => Self::Noted,
        }
    }
}
