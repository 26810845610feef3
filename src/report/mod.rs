//! What people and programs read: one file per format.

pub mod advice;
mod alarm;
pub mod diagnostics;
pub mod identification;
pub mod json;
pub mod monitor;
pub mod page;
pub mod picture;
pub mod plot;
mod printable;
pub mod sweep_csv;
pub mod table;
mod unit;
mod words;

pub use printable::{printable, printable_json, printable_text};
