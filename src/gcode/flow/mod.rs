//! Which line comes next: loops, jumps and subprograms over a text that can be read again.

mod commands;
mod fanuc;
mod index;
mod interpreter;
mod ngc;
mod run_state;
mod runner;

pub use commands::{Commands, Interpretation, interpret};
pub use interpreter::{Interpreter, Options};
