//! The machine file: TOML → checked [`Machine`], the plant's deviations from it, and how programs are read; and back.
//!
//! Every key may be left out and then keeps the reference machine's value, so that an empty file is the reference
//! machine and a short one says only what differs. Everything wrong is reported at once, each fault with its place;
//! a key that nobody reads is wrong too.
//!
//! ```
//! use rigidtap::config::MachineFile;
//! let file = MachineFile::read(b"[spindle]\nencoder_counts_per_rev = 4096\n")?;
//! assert_eq!(file.machine.spec().spindle.encoder_counts_per_rev, 4096.0);
//! assert_eq!(file.machine.spec().spindle.max_rpm, 8000.0);
//! // What is written reads back the same.
//! assert_eq!(MachineFile::read(file.to_toml().as_bytes())?.machine, file.machine);
//! # Ok::<(), Vec<rigidtap::config::ConfigDiagnostic>>(())
//! ```

mod check;
mod diagnostic;
mod fault;
mod keys;
mod number;
mod read;
mod suggest;
#[cfg(test)]
mod tests;
mod value;
mod wording;
mod write;

pub use diagnostic::ConfigDiagnostic;
pub use fault::{ConfigFault, Expected, Found};
pub use write::bands_to_toml;

use crate::control::machine::Machine;
use crate::gcode::{DecimalPoint, Dialect, G81};
use crate::sim::Actual;

/// What a machine file says.
#[derive(Clone, Debug, PartialEq)]
pub struct MachineFile {
    /// The machine as the control knows it.
    pub machine: Machine,
    /// How the real one differs from it: for the plant alone.
    pub actual: Actual,
    /// How programs are read.
    pub gcode: GcodeOptions,
    /// What runs but is unwise, in the order of the text.
    pub warnings: Vec<ConfigDiagnostic>,
}

/// `[gcode]`: how programs are read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GcodeOptions {
    /// Name of one of [`Dialect::ALL`].
    pub dialect: String,
    /// The cycle that G81 calls.
    pub g81: G81,
    /// What a number without a decimal point means.
    pub decimal_point: DecimalPoint,
}

impl Default for GcodeOptions {
    /// As the torque-curve paper's programs are written.
    fn default() -> Self {
        let Dialect { name, g81, decimal_point, .. } = Dialect::PAPER;
        Self { dialect: name.to_owned(), g81, decimal_point }
    }
}

impl MachineFile {
    /// Reads a machine file.
    ///
    /// # Errors
    /// Every fault of the file in the order of its text, fifty at most; see [`ConfigFault`].
    pub fn read(bytes: &[u8]) -> Result<Self, Vec<ConfigDiagnostic>> {
        let text = String::from_utf8_lossy(bytes);
        check::check(read::read(bytes, &text), &text)
    }
}
