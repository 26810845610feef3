//! Every diagnostic of the front end: its code, its severity and its words.

mod code;
mod explain;
mod kind;
mod letter;
mod of_blocks;
mod of_cycles;
mod of_modes;
mod of_programs;
mod of_text;
mod unsupported;
mod words;

pub use explain::{codes, explain};
pub(crate) use kind::Fault;
pub use kind::{DiagnosticKind, FeedUse, Found, Severity};
