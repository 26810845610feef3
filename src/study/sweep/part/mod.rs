//! Sweeps in parts: on several computers, or one after the other. Machine i is the same whatever the split.
//!
//! shard → identity, fault → tiling, file

mod fault;
mod file;
mod identity;
mod shard;
mod tiling;

use std::io::Write;

pub use fault::{MergeFault, PartFault};
pub use identity::PartLabels;
pub use shard::Shard;

use super::records::{ReadSeek, Records};
use super::settings::SweepSettings;
use super::summary::{Counts, counts_and_worst, extremes};
use crate::gcode::Command;
use crate::sim::Actual;
use crate::study::simulation::Simulation;
use identity::Identity;
use tiling::Tile;

/// Writes a part; how many of its machines are what.
pub(super) fn write(
    to: &mut dyn Write,
    labels: &PartLabels,
    commands: &[Command],
    base: &Simulation,
    settings: &SweepSettings,
    shard: Shard,
    records: &mut Records,
) -> std::io::Result<Counts> {
    let (counts, worst) = counts_and_worst(records)?;
    let extremes = extremes(records)?;
    let identity = Identity::new(labels, commands, base, settings);
    file::write(to, identity, shard, settings, records, (&counts, &extremes, &worst))?;
    Ok(counts)
}

/// A part's file with its name.
pub struct PartFile {
    name: String,
    from: Box<dyn ReadSeek>,
}

impl PartFile {
    /// A file that [`sweep_part`](super::sweep_part) wrote, with the name that faults call it by.
    pub fn new(name: impl Into<String>, from: impl std::io::Read + std::io::Seek + 'static) -> Self {
        Self { name: name.into(), from: Box::new(from) }
    }
}

/// The machines of all parts, each of which must be of this very sweep.
pub(super) fn join(
    parts: Vec<PartFile>,
    labels: &PartLabels,
    commands: &[Command],
    base: &Simulation,
    settings: &SweepSettings,
) -> Result<Records, Vec<MergeFault>> {
    let nominal: Actual = base.actual;
    let identity = Identity::new(labels, commands, base, settings);
    let (mut faults, mut tiles, mut stretches) = (Vec::new(), Vec::new(), Vec::new());
    for PartFile { name, from } in parts {
        match file::read(from, &identity, settings, nominal) {
            Ok((head, stretch)) => {
                let of = head.shard().map_or(0, Shard::of);
                tiles.push(Tile { name, first_run: head.first_run, last_run: head.last_run(), of });
                stretches.push(stretch);
            }
            Err(fault) => faults.push(MergeFault::Part { name, fault }),
        }
    }
    // What a refused part may have had is not called missing.
    if faults.is_empty() {
        faults = tiling::faults(&tiles, settings.runs);
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    stretches.sort_by_key(|stretch| stretch.first_run);
    Ok(Records::new(stretches, settings, nominal))
}
