//! Our machine and our synchronizer as FMUs (FMI 2.0, co-simulation), for other people's simulators.
//!
//! 1. `stored`: what an FMU carries beside its library: machine file, program, how it is run
//! 2. `numbers`: each variable's number
//! 3. `model`: what every model can; `plant_model`, `control_model`: the two
//! 4. `description`, `pack`: the archive
//! 5. `functions`: the standard's C functions over a model

mod control_model;
mod description;
mod functions;
mod model;
mod numbers;
mod pack;
mod plant_model;
mod stored;

pub use functions::*;
pub use pack::{PackError, pack};
pub use stored::{Stored, StoredProgram};
