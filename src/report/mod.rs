//! What people and programs read: one file per format.

mod alarm;
pub mod json;
pub mod table;
mod unit;
