//! Typed commands
use crate::control::cycle::{Hand, TapCycle};
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Command {
    pub kind: CommandKind,
    pub line: u32,
}
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CommandKind {
    Rapid { to_mm: [f64; 3] },
    Feed { to_mm: [f64; 3], feed_mm_per_s: f64 },
    Spindle(SpindleCommand),
    Tap(TapCycle),
    End,
}
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SpindleCommand {
    Off,
    On { hand: Hand, speed_rpm: f64 },
}
