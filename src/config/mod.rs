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

mod actual_ranges;
mod check;
mod diagnostic;
mod drawn;
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
pub use write::{MeasuredKey, bands_to_toml, measured_to_toml};

use crate::control::cycle::Retract;
use crate::control::machine::Machine;
use crate::gcode::{CycleWords, DecimalPoint, Dialect, G81, PECK_BACK_MM};
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
    /// What runs but is unwise, in the order of the text.
    pub warnings: Vec<ConfigDiagnostic>,
}

/// `[gcode]`: how programs are read; what is none stays as the dialect has it.
#[derive(Clone, Debug, PartialEq)]
pub struct GcodeOptions {
    /// Name of one of [`Dialect::ALL`].
    pub dialect: String,
    /// The cycle that G81 calls.
    pub g81: Option<G81>,
    /// What a number without a decimal point means.
    pub decimal_point: Option<DecimalPoint>,
    /// Lengths are in inches until G20 or G21.
    pub power_on_inch: bool,
    /// What a peck does at its end.
    pub peck: Peck,
    /// How far a chip-breaking peck turns back.
    pub peck_back_mm: f64,
}

/// What Q makes of a tapping cycle: on a Fanuc parameter 5200 bit 5 says so.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Peck {
    /// Turns back a little.
    #[default]
    ChipBreak,
    /// Comes back to R.
    Full,
}

impl Default for GcodeOptions {
    /// As the torque-curve paper's programs are written.
    fn default() -> Self {
        Self {
            dialect: Dialect::PAPER.name.to_owned(),
            g81: None,
            decimal_point: None,
            power_on_inch: false,
            peck: Peck::default(),
            peck_back_mm: PECK_BACK_MM,
        }
    }
}

impl GcodeOptions {
    /// A dialect with these options.
    ///
    /// ```
    /// use rigidtap::config::GcodeOptions;
    /// use rigidtap::gcode::{DecimalPoint, Dialect};
    /// let options = GcodeOptions { decimal_point: Some(DecimalPoint::Calculator), ..GcodeOptions::default() };
    /// assert_eq!(Dialect::FANUC.decimal_point, DecimalPoint::Fanuc);
    /// assert_eq!(options.apply(Dialect::FANUC).decimal_point, DecimalPoint::Calculator);
    /// ```
    #[must_use]
    pub fn apply(&self, dialect: Dialect) -> Dialect {
        let retract = match self.peck {
            Peck::ChipBreak => Retract::ChipBreak { back_mm: self.peck_back_mm },
            Peck::Full => Retract::Full,
        };
        Dialect {
            g81: self.g81.unwrap_or(dialect.g81),
            decimal_point: self.decimal_point.unwrap_or(dialect.decimal_point),
            power_on_inch: self.power_on_inch,
            cycle: CycleWords { peck: dialect.cycle.peck.map(|_| retract), ..dialect.cycle },
            ..dialect
        }
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
