//! Why a machine cannot carry out a command, in words.

use core::fmt;

use crate::control::cycle::CycleError;
use crate::control::profile::ProfileError;
use crate::control::units::S_PER_HOUR;
use crate::gcode::text::Decimal;

/// Why a command cannot be carried out on this machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PlanError {
    /// A hole.
    Cycle(CycleError),
    /// A straight line.
    Line(ProfileError),
    /// The pitch has no standard tolerance and the machine file gives none.
    NoTolerance {
        /// The pitch.
        pitch_mm: f64,
    },
    /// The pitch has no standard tap and the machine file gives none.
    NoTapSize {
        /// The pitch.
        pitch_mm: f64,
    },
    /// The hole's pitch is not that of the tap.
    PitchOfAnotherTap {
        /// The hole's.
        pitch_mm: f64,
        /// The tap's.
        tap_mm: f64,
    },
    /// The program takes longer than anyone would let it.
    TooLong {
        /// Planned time up to here.
        planned_s: f64,
        /// Longest time allowed.
        limit_s: f64,
    },
    /// Commanded speed beyond the spindle's.
    SpindleTooFast {
        /// Commanded speed.
        needed_rpm: f64,
        /// The spindle's greatest.
        limit_rpm: f64,
    },
}

impl fmt::Display for PlanError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Cycle(error) => error.fmt(formatter),
            Self::Line(error) => write!(formatter, "the move has no profile: {error}"),
            Self::NoTolerance { pitch_mm } => {
                write!(
                    formatter,
                    "pitch {} mm is outside the usual threads, 0.25 to 6.35 mm, so its tolerance is not known",
                    Decimal(pitch_mm)
                )
            }
            Self::NoTapSize { pitch_mm } => {
                write!(
                    formatter,
                    "pitch {} mm is outside the usual threads, 0.25 to 6.35 mm, so its tap is not known",
                    Decimal(pitch_mm)
                )
            }
            Self::PitchOfAnotherTap { pitch_mm, tap_mm } => {
                write!(formatter, "the hole's pitch is {pitch_mm:.4} mm, and the tap has {tap_mm:.4} mm")
            }
            Self::SpindleTooFast { needed_rpm, limit_rpm } => spindle_too_fast(formatter, needed_rpm, limit_rpm),
            Self::TooLong { planned_s, limit_s } => write!(
                formatter,
                "the program takes {:.0} hours up to here, more than {:.0}",
                planned_s / S_PER_HOUR,
                limit_s / S_PER_HOUR
            ),
        }
    }
}

fn spindle_too_fast(formatter: &mut fmt::Formatter<'_>, needed_rpm: f64, limit_rpm: f64) -> fmt::Result {
    write!(formatter, "S{needed_rpm} is beyond the spindle's {limit_rpm} rpm")
}

impl PlanError {
    /// Stable name in diagnostics.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::Cycle(CycleError::NoStroke { .. }) => "G601",
            Self::Cycle(CycleError::Invalid { .. }) | Self::Line(_) => "G602",
            Self::Cycle(CycleError::SpindleTooFast { .. }) | Self::SpindleTooFast { .. } => "G603",
            Self::Cycle(CycleError::PitchTooFast { .. }) => "G604",
            Self::Cycle(CycleError::PitchTooSharp { .. }) => "G605",
            Self::Cycle(CycleError::Law(_)) => "G606",
            Self::Cycle(CycleError::TooManyPecks { .. }) => "G607",
            Self::NoTolerance { .. } => "G608",
            Self::NoTapSize { .. } => "G609",
            Self::TooLong { .. } => "G610",
            Self::PitchOfAnotherTap { .. } => "G611",
        }
    }

    /// What to do about it.
    #[must_use]
    pub const fn hint(&self) -> &'static str {
        match self {
            Self::Cycle(CycleError::NoStroke { .. }) => "give Z a depth below R",
            Self::Cycle(CycleError::Invalid { .. }) | Self::Line(_) => "check F, S and the coordinates of this block",
            Self::Cycle(CycleError::SpindleTooFast { .. }) | Self::SpindleTooFast { .. } => {
                "lower S, or raise spindle.max_rpm and the torque curve if the machine really has it"
            }
            Self::Cycle(CycleError::PitchTooFast { .. }) => "lower S, and F with it so that the pitch F/S stays",
            Self::Cycle(CycleError::PitchTooSharp { .. }) => "lower the law's acceleration in the machine file",
            Self::Cycle(CycleError::Law(_)) => "check the law's start and end speed against the depth and S",
            Self::Cycle(CycleError::TooManyPecks { .. }) => "give Q a greater depth",
            Self::NoTolerance { .. } => {
                "give [tolerance] error_um in the machine file, or check that F/S is the pitch meant"
            }
            Self::PitchOfAnotherTap { .. } => {
                "check F and S, or name the tap that is in the spindle (--tap, [tap] pitch_mm)"
            }
            Self::TooLong { .. } => "check the coordinates, F, and the dwell of this block",
            Self::NoTapSize { .. } => {
                "give [tap] major_mm and hole_mm in the machine file, or --material none to cut air"
            }
        }
    }
}
