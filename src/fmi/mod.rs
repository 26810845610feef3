//! Other people's plants: co-simulation FMUs (FMI 2.0 and 3.0) in place of ours.
//!
//! 1. `error`: what an FMU does wrong ([`FmuError`])
//! 2. `variables`: the one set of variables, by name, causality, unit ([`INPUTS`], [`OUTPUTS`], [`PARAMETERS`])
//! 3. `description`, `unpack`: a model description of either version, and the archive that it lies in
//! 4. `binding`: the set found in a description, or every reason why it is not
//! 5. `calls`, `fmi2`, `fmi3`: the C functions of an FMU, the only unsafe code here
//! 6. `wire`, `host`: a process of its own for each FMU, so that one that crashes or hangs takes nothing with it
//! 7. `plant`: the plant as a port ([`FmuSource`])
//! 8. `export`: our machine and our synchronizer as FMUs ([`pack`])
#![allow(unsafe_code, reason = "an FMU is C code in a shared library")]

mod binding;
mod calls;
mod description;
mod error;
mod export;
mod fmi2;
mod fmi3;
mod host;
mod plant;
mod unpack;
mod variables;
mod wire;

pub use error::FmuError;
pub use export::*;
pub use host::serve;
pub use plant::FmuSource;
pub use variables::{INPUTS, Kind, OUTPUTS, PARAMETERS, Variable};
