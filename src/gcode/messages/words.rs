//! Message and hint of every diagnostic, side by side.

use std::fmt;

use super::kind::{DiagnosticKind, DiagnosticKind as K};
use super::letter::Letter;
use crate::control::cycle::CycleError;
use crate::control::units::S_PER_MIN;
use crate::gcode::planning_error::PlanError;
use crate::gcode::text::Decimal;
use crate::gcode::warning::Warning;

impl DiagnosticKind {
    /// The code or word that changes nothing, as the program writes it; none of any other finding.
    #[must_use]
    pub fn idle(&self) -> Option<String> {
        match *self {
            Self::IdleCode { name } => Some(name.to_string()),
            Self::IdleWord { letter } => Some(Letter(letter).to_string()),
            _ => None,
        }
    }

    /// What is wrong.
    #[must_use]
    pub fn message(&self) -> String {
        self.words().0
    }

    /// What to do about it.
    #[must_use]
    pub fn hint(&self) -> String {
        self.words().1
    }

    /// Message and hint side by side, so that they fit each other.
    fn words(&self) -> (String, String) {
        of_planning(self)
            .or_else(|| super::of_text::words(self))
            .or_else(|| super::of_blocks::words(self))
            .or_else(|| super::of_modes::words(self))
            .or_else(|| super::of_cycles::words(self))
            .or_else(|| super::of_programs::words(self))
            .unwrap_or_default()
    }
}

/// Message and hint of what planning finds; none of any other finding.
fn of_planning(kind: &K) -> Option<(String, String)> {
    let (message, hint): (String, &str) = match *kind {
        K::Warning(Warning::SpeedNotReached { out, command_rpm, peak_rpm }) => {
            let stroke = if out { "out" } else { "in" };
            return Some((
                format!("S{command_rpm:.0} is not reached on the stroke {stroke}: its peak is {peak_rpm:.0} rpm"),
                "a lower S takes the same time: the stroke is too short for more".into(),
            ));
        }
        K::Warning(Warning::CuttingTooFast { speed_m_per_min, limit_m_per_min }) => (
            format!("{speed_m_per_min:.0} m/min cutting speed; the material bears about {limit_m_per_min:.0}"),
            "lower S, and F with it so that the pitch stays",
        ),
        K::Warning(Warning::LawSlowed { law, factor, limit_mm_per_s2 }) => {
            return Some((
                format!(
                    "{} is slowed to {:.0} % here: at this pitch its acceleration is more than Z's {limit_mm_per_s2:.0} mm/s²",
                    law.name(),
                    100.0 * factor
                ),
                "nothing to do; lower the law's acceleration in the machine file to have every hole alike".into(),
            ));
        }
        K::Planning {
            error: error @ PlanError::Cycle(CycleError::PitchTooFast { limit_mm_per_s, .. }),
            pitch_mm: Some(pitch_mm),
        } => {
            // Down to a whole number, so that it holds as written.
            let fits_rpm = (S_PER_MIN * limit_mm_per_s / pitch_mm).floor();
            let feed = Decimal(fits_rpm * pitch_mm);
            return Some((
                error.to_string(),
                format!("S{fits_rpm:.0} fits: F{feed} with it under G94; under G95 F stays"),
            ));
        }
        K::Planning { error, .. } => (error.to_string(), error.hint()),
        _ => return None,
    };
    Some((message, hint.into()))
}

impl fmt::Display for DiagnosticKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message())
    }
}
