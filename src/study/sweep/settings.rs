//! How a sweep is done.

use std::num::{NonZeroU32, NonZeroUsize};

use crate::sim::{HardSpread, Spread};

/// How a sweep is done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepSettings {
    /// Number of machines.
    pub runs: NonZeroU32,
    /// Seed of the draws; the same seed gives the same machines.
    pub seed: u64,
    /// How often each machine taps the hole.
    pub holes: NonZeroU32,
    /// What the machines are drawn from; none for machines as the base is, which differ in what is random alone.
    pub spread: Option<Spread>,
    /// What they have beside that; none for the standard plant.
    pub hard: Option<HardSpread>,
    /// Number of threads; none for one on each core. The results do not depend on it.
    pub jobs: Option<NonZeroUsize>,
}
