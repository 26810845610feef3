//! The set of variables found in a description.

use super::description::{Description, Found, Type};
use super::error::FmuError;
use super::variables::{INPUTS, Kind, OUTPUTS, PARAMETERS, Variable, same_unit};

/// Where a variable of the set is in the FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bound {
    pub(super) reference: u32,
    pub(super) value_type: Type,
}

/// The set in an FMU; none where it lacks an optional variable.
#[derive(Clone, Debug)]
pub(super) struct Binding {
    pub(super) inputs: Vec<Option<Bound>>,
    pub(super) outputs: Vec<Option<Bound>>,
    pub(super) parameters: Vec<(String, Bound)>,
}

impl Binding {
    /// Every variable of the set, or every reason why one is not as it has to be. `further` are names of parameters that may
    /// be there, whatever their unit.
    pub(super) fn new(description: &Description, further: &[&str]) -> Result<Self, FmuError> {
        let mut faults = Vec::new();
        let mut all = |set: &[Variable], causality: &str| -> Vec<Option<Bound>> {
            set.iter().map(|variable| bind(description, variable, causality, &mut faults)).collect()
        };
        let (inputs, outputs) = (all(&INPUTS, "input"), all(&OUTPUTS, "output"));
        let mut parameters = Vec::new();
        for (variable, bound) in PARAMETERS.iter().zip(all(&PARAMETERS, "parameter")) {
            parameters.extend(bound.map(|bound| (variable.name.to_owned(), bound)));
        }
        for name in further {
            let found = description.variables.get(*name).filter(|found| found.causality == "parameter");
            parameters.extend(found.map(|found| ((*name).to_owned(), bound(found))));
        }
        for (name, found) in &description.variables {
            let known = INPUTS.iter().any(|variable| variable.name == name);
            if found.causality == "input" && !known {
                faults.push(suggest(name));
            }
        }
        faults.sort();
        if faults.is_empty() { Ok(Self { inputs, outputs, parameters }) } else { Err(FmuError::Variables(faults)) }
    }
}

fn bound(found: &Found) -> Bound {
    Bound { reference: found.reference, value_type: found.value_type }
}

/// An input that nobody would set.
fn suggest(name: &str) -> String {
    let near = INPUTS
        .iter()
        .map(|variable| (strsim::damerau_levenshtein(variable.name, name), variable.name))
        .min()
        .filter(|(distance, _)| *distance <= 4);
    let hint = near.map_or_else(String::new, |(_, near)| format!("; is {near} meant?"));
    format!("input {name} is none of a plant, and nobody would set it{hint}")
}

fn bind(description: &Description, variable: &Variable, causality: &str, faults: &mut Vec<String>) -> Option<Bound> {
    let Variable { name, unit, kind, required, meaning } = *variable;
    let Some(found) = description.variables.get(name) else {
        if required {
            let of = unit.map_or_else(String::new, |unit| format!(" in {unit}"));
            faults.push(format!("{causality} {name} is missing: expected {meaning}{of}"));
        }
        return None;
    };
    if found.causality != causality {
        faults.push(format!("{name} is of causality {}, expected {causality}", found.causality));
    }
    if let Some(unit) = unit
        && !found.unit.as_deref().is_some_and(|found| same_unit(unit, found))
    {
        let has = found.unit.as_ref().map_or_else(|| "no unit".to_owned(), |found| format!("unit {found}"));
        faults.push(format!("{name} has {has}, expected {unit}"));
    }
    let fits = match kind {
        Kind::Real => matches!(found.value_type, Type::Real | Type::Float32),
        Kind::Whole => !matches!(found.value_type, Type::Boolean | Type::Other | Type::Float32),
        Kind::Switch => found.value_type == Type::Boolean,
    };
    if !fits || found.is_array {
        let expected = match kind {
            Kind::Real => "one real number",
            Kind::Whole => "one whole number: an integer type, or Real",
            Kind::Switch => "one Boolean",
        };
        let is = if found.is_array { "an array".to_owned() } else { format!("of type {:?}", found.value_type) };
        faults.push(format!("{name} is {is}, expected {expected}"));
    }
    Some(bound(found))
}
