//! What a machine file says, once it is checked.

use super::data_sheet::DataSheet;
use super::diagnostic::ConfigDiagnostic;
use super::gcode_options::GcodeOptions;
use crate::control::machine::Machine;
use crate::sim::{Actual, HardSpread, Spread};

/// What a machine file says.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFile {
    /// The machine as the control knows it.
    pub machine: Machine,
    /// How the real one differs from it: for the plant alone.
    pub actual: Actual,
    /// How machines of its kind differ: what a sweep draws from.
    pub spread: Spread,
    /// What they have beside that in a hard sweep.
    pub hard: HardSpread,
    /// How programs are read.
    pub gcode: GcodeOptions,
    /// What other keys are checked against.
    pub data_sheet: DataSheet,
    /// What runs but is unwise, in the order of the text.
    pub warnings: Vec<ConfigDiagnostic>,
}

impl MachineFile {
    /// The reference machine, as its file says.
    #[must_use]
    pub fn reference() -> Self {
        Self {
            machine: Machine::reference(),
            actual: Actual::default(),
            spread: Spread::default(),
            hard: HardSpread::default(),
            gcode: GcodeOptions::default(),
            data_sheet: DataSheet::default(),
            warnings: Vec::new(),
        }
    }
}
