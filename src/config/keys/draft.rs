//! What a machine file says before it is checked: where the keys are stored.

use crate::config::data_sheet::DataSheet;
use crate::config::gcode_options::GcodeOptions;
use crate::control::machine::MachineSpec;
use crate::sim::{Actual, HardSpread, Spread};

/// Everything a machine file says, before it is checked.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::config) struct Draft {
    pub(in crate::config) spec: MachineSpec,
    pub(in crate::config) actual: Actual,
    pub(in crate::config) spread: Spread,
    pub(in crate::config) hard: HardSpread,
    pub(in crate::config) gcode: GcodeOptions,
    pub(in crate::config) data_sheet: DataSheet,
}

impl Draft {
    /// What a file without any key says.
    pub(in crate::config) fn reference() -> Self {
        Self {
            spec: MachineSpec::reference(),
            actual: Actual::default(),
            spread: Spread::default(),
            hard: HardSpread::default(),
            gcode: GcodeOptions::default(),
            data_sheet: DataSheet::default(),
        }
    }
}
