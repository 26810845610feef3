//! Each variable's number (value reference).

use crate::fmi::variables::{INPUTS, Kind, OUTPUTS, PARAMETERS, Variable};

/// What the control tells beside its setpoints.
pub(super) const TOLD: [Variable; 4] = [
    Variable {
        name: "error_um",
        unit: Some("um"),
        kind: Kind::Real,
        required: false,
        meaning: "e(k), 0 outside a hole",
    },
    Variable {
        name: "synchronous",
        unit: None,
        kind: Kind::Switch,
        required: false,
        meaning: "e(k) counts in this period",
    },
    Variable { name: "done", unit: None, kind: Kind::Switch, required: false, meaning: "the program has ended" },
    Variable {
        name: "alarm",
        unit: None,
        kind: Kind::Whole,
        required: false,
        meaning: "code of the alarm that ended it, 0 for none",
    },
];

/// Numbers of the lists: each begins at one of these.
pub(super) const FIRST: [u32; 4] = [0, 100, 200, 300];

/// Place of a number: list and index.
pub(super) fn place(number: u32) -> Option<(usize, usize)> {
    let list = (number / 100) as usize;
    let index = (number % 100) as usize;
    let length = [INPUTS.len(), OUTPUTS.len(), PARAMETERS.len(), TOLD.len()].get(list).copied()?;
    (index < length).then_some((list, index))
}
