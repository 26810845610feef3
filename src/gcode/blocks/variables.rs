//! Variables of a program: `#1`, `#<name>`.

use std::collections::BTreeMap;

use crate::gcode::dialect::Macros;
use crate::gcode::messages::DiagnosticKind;

/// Most variables of one kind: it bounds what a loop can ask for.
const MAX_VARIABLES: usize = 10_000;

/// What is read or written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Variable {
    Number(u32),
    /// Lower case, without blanks.
    Name(Vec<u8>),
}

/// One level of calls has its own local variables.
#[derive(Clone, Debug, Default)]
struct Level {
    numbers: BTreeMap<u32, f64>,
    names: BTreeMap<Vec<u8>, f64>,
}

/// Every variable of a program.
#[derive(Clone, Debug)]
pub(crate) struct Variables {
    pub(crate) macros: Macros,
    common: Level,
    levels: Vec<Level>,
    /// Where the tool stands, in the unit in force: in the work coordinates, and from the machine's zero.
    places: [[f64; 3]; 2],
}

impl Variables {
    pub(crate) fn new(macros: Macros) -> Self {
        Self { macros, common: Level::default(), levels: vec![Level::default()], places: [[0.0; 3]; 2] }
    }

    /// A variable's value. Vacant is what was never written, on a Fanuc; RS274 reads it as 0, and knows no such name.
    pub(crate) fn read(&self, variable: &Variable) -> Result<Option<f64>, DiagnosticKind> {
        match variable {
            Variable::Number(0) if self.macros == Macros::Fanuc => Ok(None),
            Variable::Number(number) if self.place(*number).is_some() => Ok(self.place(*number)),
            Variable::Number(number) => {
                let level = self.level_of(*number)?;
                let value = level.numbers.get(number).copied();
                Ok(if matches!(self.macros, Macros::Ngc | Macros::Siemens) { value.or(Some(0.0)) } else { value })
            }
            Variable::Name(name) => {
                let value = self.names(name).and_then(|level| level.names.get(name).copied());
                value.map(Some).ok_or(DiagnosticKind::UnknownName)
            }
        }
    }

    /// Where the tool stands before the next block, for the system variables that say so.
    pub(crate) const fn set_places(&mut self, work: [f64; 3], machine: [f64; 3]) {
        self.places = [work, machine];
    }

    /// System variables of the position: of a FANUC and a Haas #5001 (end of the block before), #5021 (machine
    /// coordinates) and #5041 (work coordinates), each for X with Y and Z behind it; of LinuxCNC #5420.
    fn place(&self, number: u32) -> Option<f64> {
        let [work, machine] = &self.places;
        let (place, axis) = match (self.macros, number) {
            (Macros::Fanuc, 5001..=5003) => (work, number - 5001),
            (Macros::Fanuc, 5021..=5023) => (machine, number - 5021),
            (Macros::Fanuc, 5041..=5043) => (work, number - 5041),
            (Macros::Ngc, 5420..=5422) => (work, number - 5420),
            _ => return None,
        };
        place.get(axis as usize).copied()
    }

    /// Whether the variable was written.
    pub(crate) fn exists(&self, variable: &Variable) -> bool {
        match variable {
            Variable::Number(number) => self.level_of(*number).is_ok_and(|level| level.numbers.contains_key(number)),
            Variable::Name(name) => self.names(name).is_some_and(|level| level.names.contains_key(name)),
        }
    }

    /// Writes a variable; none makes it vacant.
    pub(crate) fn write(&mut self, variable: Variable, value: Option<f64>) -> Result<(), DiagnosticKind> {
        match variable {
            Variable::Number(number) if self.place(number).is_some() => {
                return Err(DiagnosticKind::UnknownVariable { number });
            }
            Variable::Number(number) => {
                self.level_of(number)?;
                let local = self.is_local(number);
                let level = if local { self.levels.last_mut() } else { Some(&mut self.common) };
                let Some(level) = level else { return Ok(()) };
                match value {
                    Some(value) if level.numbers.len() < MAX_VARIABLES => drop(level.numbers.insert(number, value)),
                    _ => drop(level.numbers.remove(&number)),
                }
            }
            Variable::Name(name) => {
                let common = name.starts_with(b"_");
                let level = if common { Some(&mut self.common) } else { self.levels.last_mut() };
                if let Some(level) = level.filter(|level| level.names.len() < MAX_VARIABLES) {
                    level.names.insert(name, value.unwrap_or(0.0));
                }
            }
        }
        Ok(())
    }

    /// A call begins, with its arguments in #1, #2, …
    pub(crate) fn enter(&mut self, arguments: &[f64]) {
        let numbers = (1..).zip(arguments.iter().copied()).collect();
        self.levels.push(Level { numbers, names: BTreeMap::new() });
    }

    /// A call begins, with these variables of its own.
    pub(crate) fn enter_with(&mut self, arguments: &[(u32, f64)]) {
        self.levels.push(Level { numbers: arguments.iter().copied().collect(), names: BTreeMap::new() });
    }

    /// A call ends.
    pub(crate) fn leave(&mut self) {
        if self.levels.len() > 1 {
            self.levels.pop();
        }
    }

    /// #1 to #33 of a Fanuc, #1 to #30 of RS274.
    fn is_local(&self, number: u32) -> bool {
        match self.macros {
            Macros::Fanuc => number <= 33,
            Macros::Ngc => number <= 30,
            Macros::Siemens | Macros::None => false,
        }
    }

    fn level_of(&self, number: u32) -> Result<&Level, DiagnosticKind> {
        let known = match self.macros {
            Macros::Fanuc => matches!(number, 1..=33 | 100..=199 | 500..=999),
            Macros::Ngc => matches!(number, 1..=5000),
            Macros::Siemens => number < 1000,
            Macros::None => false,
        };
        let level = if self.is_local(number) { self.levels.last() } else { Some(&self.common) };
        level.filter(|_| known).ok_or(DiagnosticKind::UnknownVariable { number })
    }

    fn names(&self, name: &[u8]) -> Option<&Level> {
        if name.starts_with(b"_") { Some(&self.common) } else { self.levels.last() }
    }
}
