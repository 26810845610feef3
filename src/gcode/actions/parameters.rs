//! Parameters of a call, between commas.

use super::output::Output;
use crate::gcode::blocks::{Reader, parts};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::State;
use crate::gcode::text::{Place, number};

/// Most parameters of a call.
const MAX_PARAMETERS: usize = 24;

/// What was written for each parameter.
#[derive(Clone, Copy, Debug)]
enum Parameter {
    Missing,
    Number(f64),
    Text,
}

/// Parameters by their numbers, from 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parameters {
    values: [Parameter; MAX_PARAMETERS],
    count: usize,
}

impl Parameters {
    /// How many there are.
    pub(super) const fn count(&self) -> usize {
        self.count
    }

    fn get(&self, number: usize) -> Parameter {
        number.checked_sub(1).and_then(|index| self.values.get(index)).copied().unwrap_or(Parameter::Missing)
    }

    /// A number; none where it is left out, or is a text.
    pub(super) fn number(&self, number: usize) -> Option<f64> {
        match self.get(number) {
            Parameter::Number(value) => Some(value),
            Parameter::Missing | Parameter::Text => None,
        }
    }

    /// Whether it is a text.
    pub(super) fn is_text(&self, number: usize) -> bool {
        matches!(self.get(number), Parameter::Text)
    }
}

/// The parameters at a place; none after a mistake.
pub(super) fn read_parameters(state: &State, place: Place, output: &mut Output<'_, '_>) -> Option<Parameters> {
    let mut read = Parameters { values: [Parameter::Missing; MAX_PARAMETERS], count: 0 };
    for (index, part) in parts(place.text(output.line.text)).into_iter().enumerate() {
        let part = part.trim_ascii();
        let parsed = match part {
            [] => Some(Parameter::Missing),
            [b'"', .., b'"'] => Some(Parameter::Text),
            _ => {
                let mut reader = Reader::new(part, 0, &state.variables);
                let value = reader.sum().ok().flatten().filter(|_| reader.at == part.len());
                value.filter(|value| value.abs() <= number::LARGEST).map(Parameter::Number)
            }
        };
        match (read.values.get_mut(index), parsed) {
            (Some(slot), Some(value)) => *slot = value,
            _ => {
                output.report(DiagnosticKind::CallParameterUnread { number: index + 1 }, place);
                return None;
            }
        }
        read.count = index + 1;
    }
    Some(read)
}
