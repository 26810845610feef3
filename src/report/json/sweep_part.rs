//! `sweep --shard`.

use schemars::JsonSchema;
use serde::Serialize;

use crate::study::{Counts, Shard, SweepSettings};

/// One part of a sweep, which lies in a file of its own until the parts are merged.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct SweepPartAnswer {
    file: String,
    /// File of the part.
    part: String,
    /// Number of the part, from 1.
    shard: u32,
    /// Number of parts.
    of: u32,
    /// Number of machines in all parts.
    runs: u32,
    /// Number of its first machine.
    first_run: u32,
    /// Number of its last machine.
    last_run: u32,
    /// Its machines with |e| over 1 mm, or with a growing oscillation.
    unstable: u32,
    /// Its machines whose spindle drive stood at its torque limit.
    saturated: u32,
    /// Its machines that an alarm stopped.
    alarms: u32,
    /// Share of its machines whose first hole fails.
    fail_ratio: f64,
    /// Share of those that are a warning.
    warning_ratio: f64,
}

impl SweepPartAnswer {
    /// Of a part that was run.
    #[must_use]
    pub fn new(file: &str, settings: &SweepSettings, shard: Shard, counts: &Counts, part: &str) -> Self {
        let runs = shard.runs(settings.runs);
        Self {
            file: file.to_owned(),
            part: part.to_owned(),
            shard: shard.number(),
            of: shard.of(),
            runs: settings.runs.get(),
            first_run: *runs.start(),
            last_run: *runs.end(),
            unstable: counts.unstable,
            saturated: counts.saturated,
            alarms: counts.alarms,
            fail_ratio: counts.fail_ratio(),
            warning_ratio: counts.warning_ratio(),
        }
    }
}
