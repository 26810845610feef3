//! A machine file with measured values in place of its own.

use super::keys::{self, Slot};
use super::machine_file::MachineFile;
use super::number::rounded;
use super::write::MeasuredKey;
use crate::control::machine::{Machine, MachineError};

impl MachineFile {
    /// The file with these values, four digits each, in place of its own.
    ///
    /// # Errors
    /// [`MachineError`] where a value is none that a machine can have.
    ///
    /// ```
    /// use rigidtap::config::{MachineFile, MeasuredKey};
    /// let found = MeasuredKey { path: "z.backlash_um", value: 3.141_59, how: "both ways compared".into() };
    /// let file = MachineFile::reference().with_measured(&[found]).unwrap();
    /// assert_eq!(file.machine.spec().z_axis.backlash_um, 3.142);
    /// ```
    pub fn with_measured(&self, measured: &[MeasuredKey]) -> Result<Self, MachineError> {
        let mut draft = self.draft();
        for found in measured {
            if let Some(Slot::Number(at)) = keys::find(found.path).map(|key| &key.slot) {
                *at(&mut draft) = rounded(found.value).parse().unwrap_or(found.value);
            }
        }
        Ok(Self { machine: Machine::check(draft.spec)?, ..self.clone() })
    }
}
