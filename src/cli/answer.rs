//! What every answer has: JSON its head, a table its room.

use std::io::{self, IsTerminal};

use crate::report::json::Answer;
use crate::report::table::{Layout, USUAL_WIDTH};

use super::args::Common;
use super::input;

/// An answer in JSON, with its head.
pub(super) fn answer<T>(common: &Common, seed: Option<u64>, body: T) -> Answer<T> {
    let machine = common.machine.as_deref().map_or_else(|| "built-in".to_owned(), input::name);
    Answer::new(&machine, seed, body)
}

/// The room for tables: the terminal's on standard output, or that of a usual one.
pub(super) fn layout(common: &Common) -> Layout {
    let stdout = io::stdout();
    let terminal = if stdout.is_terminal() { terminal_size::terminal_size_of(&stdout) } else { None };
    let width = terminal.map_or(USUAL_WIDTH, |(terminal_size::Width(width), _)| usize::from(width));
    Layout::new(width, common.wide)
}
