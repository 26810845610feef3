//! What a sweep that cannot be is told by.

use crate::cli::outcome::{Stop, report};
use crate::study::SweepError;

/// The message, and how the command ends.
pub(super) fn refused(name: &str, error: SweepError) -> Stop {
    match error {
        SweepError::NoHole => {
            report(&format!("error: {name}: there is no hole to sweep: expected a tapping cycle"));
            Stop::Reported
        }
        // Every command was planned before, under the same law and overrides.
        SweepError::Plan(error) => Stop::Usage(format!("{name}: {error}")),
        SweepError::Io(error) => Stop::Output { name: "what the machines came to".into(), error },
        SweepError::Merge(faults) => {
            faults.iter().for_each(|fault| report(&format!("error: {fault}")));
            Stop::Reported
        }
    }
}
