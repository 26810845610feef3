//! The machine file: TOML → checked [`Machine`](crate::control::machine::Machine), the plant's
//! deviations from it, and how programs are read; and back.
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
mod data_sheet;
mod diagnostic;
mod drawn;
mod fault;
mod gcode_options;
mod hal;
mod implied;
mod keys;
mod machine_file;
mod measured;
mod new_machine;
mod number;
mod read;
mod slips;
mod suggest;
#[cfg(test)]
mod tests;
mod value;
mod wording;
mod write;

pub use data_sheet::DataSheet;
pub use diagnostic::ConfigDiagnostic;
pub use fault::{ConfigFault, Expected, Found};
pub use gcode_options::{GcodeOptions, Peck};
pub use machine_file::MachineFile;
pub use new_machine::{SheetInertia, SheetValues, new_machine_toml};
pub use slips::Slip;
pub use write::{MeasuredKey, bands_to_toml, measured_to_toml};
