//! Blocks → commands: functions over the state, in the order that the words of a block act.

mod called_cycle;
mod calls;
mod cycle;
mod cycle84;
mod cycle_words;
mod execute;
mod modes;
mod motion;
mod offsets;
mod output;
mod parameters;
mod plane;
mod spindle;
mod strokes;
mod words;

pub(crate) use execute::{end, execute};
pub(crate) use output::Output;
