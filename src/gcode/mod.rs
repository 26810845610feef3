//! gcode
pub mod command;
pub mod program;
pub use command::*;
