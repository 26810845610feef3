//! What every source yields: both encoders at one instant.

pub use crate::control::sync::Scale;

/// Both encoders at one instant. Positions in counts: whole ones from a board, broken ones from a file that holds
/// angles and lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Number of the reading; missing ones take a number, too.
    pub k: u64,
    /// Its instant.
    pub time_s: f64,
    /// Spindle, unwrapped, positive as M03 turns.
    pub spindle_counts: f64,
    /// Z, unwrapped, falling into the hole.
    pub z_counts: f64,
    /// What is missing between the sample before and this one.
    pub gap: Gap,
}

/// What is missing before a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gap {
    /// Nothing.
    #[default]
    None,
    /// Readings; the positions still count from where they did.
    Readings,
    /// The relation to all before: positions count anew.
    Origin,
}
