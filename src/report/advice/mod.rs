//! The advice in words and numbers that table, JSON and page share.

mod control;
mod sentences;
mod trials;

pub use control::{Control, ControlParameter, ControlSheet, control_sheet};
pub use sentences::{Asked, answer_sentences, kind_name, limit_sentence, yield_bound};
pub(super) use trials::{trial_cells, trials};
