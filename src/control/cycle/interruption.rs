//! An interrupted hole: what has taken the place of its strokes.

use core::fmt;

use super::error::CycleError;
use super::stroke::Stroke;

/// What an interrupted hole is doing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interrupted {
    /// Spindle and Z brake together.
    Braking,
    /// They rest in the thread.
    Holding,
    /// They come back to the R plane.
    Retracting,
    /// They go on to where the interrupted stroke ends.
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
pub(super) enum Purpose {
    Stop,
    Retract,
    Resume,
}

/// A stroke in place of the plan's own.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Interruption {
    pub(super) purpose: Purpose,
    /// From when on it stands for the plan.
    pub(super) since_s: f64,
    /// How many there have been: each is another stroke.
    pub(super) number: usize,
    /// The stroke of the plan that it interrupted.
    pub(super) interrupted: usize,
    pub(super) stroke: Stroke,
    /// The stop with its number, where it was still braking when it was left: it stands until `stroke` starts.
    pub(super) braking: Option<(usize, Stroke)>,
}

impl Interruption {
    pub(super) fn number_at(&self, t_s: f64) -> Option<usize> {
        if let Some((number, _)) = self.braking.as_ref().filter(|_| t_s >= self.since_s && t_s < self.stroke.start_s) {
            return Some(*number);
        }
        let resumed = self.purpose == Purpose::Resume && t_s >= self.stroke.end_s();
        (t_s >= self.since_s && !resumed).then_some(self.number)
    }

    /// The stroke of a number that [`Interruption::number_at`] has given.
    pub(super) fn stroke(&self, number: usize) -> &Stroke {
        match &self.braking {
            Some((of, braking)) if *of == number => braking,
            _ => &self.stroke,
        }
    }

    pub(super) fn end_of_hole_s(&self) -> Option<f64> {
        match self.purpose {
            Purpose::Stop => Some(f64::INFINITY),
            Purpose::Retract => Some(self.stroke.end_s()),
            Purpose::Resume => None,
        }
    }

    pub(super) fn state_at(&self, t_s: f64) -> Option<Interrupted> {
        self.number_at(t_s)?;
        Some(match self.purpose {
            Purpose::Stop if t_s < self.stroke.end_s() => Interrupted::Braking,
            _ if self.braking.is_some() && t_s < self.stroke.start_s => Interrupted::Braking,
            _ if t_s < self.stroke.start_s => Interrupted::Holding,
            Purpose::Stop => Interrupted::Holding,
            Purpose::Retract => Interrupted::Retracting,
            Purpose::Resume => Interrupted::Resuming,
        })
    }
}
