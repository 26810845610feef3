//! One key: what it is called, means and is stored in; and what a path names.

use super::draft::Draft;
use crate::sim::{Drawn, FrictionModels};

/// One key of the file.
#[derive(Debug)]
pub(in crate::config) struct Key {
    /// Table and name, `spindle.max_rpm`, as [`MachineError`](crate::control::machine::MachineError) spells it.
    pub(in crate::config) path: &'static str,
    /// Unit of the value; empty for ratios, counts of things and words.
    pub(in crate::config) unit: &'static str,
    /// What it is.
    pub(in crate::config) meaning: &'static str,
    /// Source or reason of the reference machine's value.
    pub(in crate::config) reason: &'static str,
    pub(in crate::config) slot: Slot,
}

/// The kind of a key's value, and where it is stored.
#[derive(Debug)]
pub(in crate::config) enum Slot {
    Number(fn(&mut Draft) -> &mut f64),
    /// A number that may be absent; `example` is what a commented-out line shows.
    Optional {
        at: fn(&mut Draft) -> &mut Option<f64>,
        example: f64,
    },
    Word {
        known: &'static [&'static str],
        get: fn(&Draft) -> &str,
        /// Stores one of `known`.
        set: fn(&mut Draft, &'static str),
    },
    Switch(fn(&mut Draft) -> &mut bool),
    /// `[low, high]`, `{ any = [low, high], ratio = x }` or `{ one_of = [a, b] }`
    Range(fn(&mut Draft) -> &mut Drawn),
    /// A range that may be absent; `example` is what a commented-out line shows.
    OptionalRange {
        at: fn(&mut Draft) -> &mut Option<Drawn>,
        example: [f64; 2],
    },
    /// `{ one_of = ["stribeck", "lugre"] }`
    Models(fn(&mut Draft) -> &mut FrictionModels),
    TorqueCurve,
    Bands,
}

impl Key {
    pub(super) const fn number(
        path: &'static str,
        unit: &'static str,
        meaning: &'static str,
        reason: &'static str,
        at: fn(&mut Draft) -> &mut f64,
    ) -> Self {
        Self { path, unit, meaning, reason, slot: Slot::Number(at) }
    }

    pub(super) const fn range(
        path: &'static str,
        unit: &'static str,
        meaning: &'static str,
        reason: &'static str,
        at: fn(&mut Draft) -> &mut Drawn,
    ) -> Self {
        Self { path, unit, meaning, reason, slot: Slot::Range(at) }
    }

    /// The table that holds the key, `law.torque_curve`.
    pub(in crate::config) fn table(&self) -> &'static str {
        parent(self.path)
    }

    /// The key without its table.
    pub(in crate::config) fn name(&self) -> &'static str {
        leaf(self.path)
    }
}

/// Everything before the last dot.
pub(in crate::config) fn parent(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(parent, _)| parent)
}

/// A path's key without its table.
pub(in crate::config) fn name(path: &str) -> &str {
    leaf(path)
}

pub(super) fn leaf(path: &str) -> &str {
    path.rsplit_once('.').map_or(path, |(_, leaf)| leaf)
}
