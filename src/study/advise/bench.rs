//! What every trial has in common.

use std::num::NonZeroUsize;

use crate::sim::Spread;
use crate::study::simulation::Simulation;

/// The machines that settings are tried on, and what is asked of them.
pub(super) struct Bench<'a> {
    pub(super) base: &'a Simulation,
    pub(super) spread: Option<Spread>,
    pub(super) seed: u64,
    pub(super) threads: NonZeroUsize,
    /// Greatest share of tolerance and clearance.
    pub(super) margin: f64,
    /// Asked after each machine; no gives up.
    pub(super) go_on: &'a (dyn Fn() -> bool + Sync),
}
