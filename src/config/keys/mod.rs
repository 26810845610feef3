//! The one list of the machine file's keys: what each is called, means, why its default stands, and where it is stored.
//!
//! Reading, writing, suggestions and hints all walk this list, so that they cannot drift apart.

mod actual;
mod axes;
mod drive;
mod hard;
mod law;
mod program;
mod renamed;
mod spindle;
mod sync;

pub(super) use renamed::renamed;

use super::GcodeOptions;
use crate::control::machine::MachineSpec;
use crate::sim::{Actual, Drawn, FrictionModels, HardSpread, Spread};

/// Everything a machine file says, before it is checked.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Draft {
    pub(super) spec: MachineSpec,
    pub(super) actual: Actual,
    pub(super) spread: Spread,
    pub(super) hard: HardSpread,
    pub(super) gcode: GcodeOptions,
}

impl Draft {
    /// What a file without any key says.
    pub(super) fn reference() -> Self {
        Self {
            spec: MachineSpec::reference(),
            actual: Actual::default(),
            spread: Spread::default(),
            hard: HardSpread::default(),
            gcode: GcodeOptions::default(),
        }
    }
}

/// One key of the file.
#[derive(Debug)]
pub(super) struct Key {
    /// Table and name, `spindle.max_rpm`, as [`MachineError`](crate::control::machine::MachineError) spells it.
    pub(super) path: &'static str,
    /// Unit of the value; empty for ratios, counts of things and words.
    pub(super) unit: &'static str,
    /// What it is.
    pub(super) meaning: &'static str,
    /// Source or reason of the reference machine's value.
    pub(super) reason: &'static str,
    pub(super) slot: Slot,
}

/// The kind of a key's value, and where it is stored.
#[derive(Debug)]
pub(super) enum Slot {
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
    const fn number(
        path: &'static str,
        unit: &'static str,
        meaning: &'static str,
        reason: &'static str,
        at: fn(&mut Draft) -> &mut f64,
    ) -> Self {
        Self { path, unit, meaning, reason, slot: Slot::Number(at) }
    }

    const fn range(
        path: &'static str,
        unit: &'static str,
        meaning: &'static str,
        reason: &'static str,
        at: fn(&mut Draft) -> &mut Drawn,
    ) -> Self {
        Self { path, unit, meaning, reason, slot: Slot::Range(at) }
    }

    /// The table that holds the key, `law.torque_curve`.
    pub(super) fn table(&self) -> &'static str {
        parent(self.path)
    }

    /// The key without its table.
    pub(super) fn name(&self) -> &'static str {
        leaf(self.path)
    }
}

/// One table of the file.
#[derive(Debug)]
pub(super) struct Table {
    /// The header without its brackets.
    pub(super) path: &'static str,
    /// What it holds.
    pub(super) about: &'static str,
}

const fn table(path: &'static str, about: &'static str) -> Table {
    Table { path, about }
}

/// The tables in the order in which they are written.
pub(super) static TABLES: &[Table] = &[
    table("control", "The interpolation that commands both axes."),
    table("spindle", "The spindle: motor, shaft, tool and encoder."),
    table("x", "Limits of X."),
    table("y", "Limits of Y."),
    table("z", "Limits, mechanics, friction and encoders of Z."),
    table("drive", "The drives' loops, and what the encoders deliver to them."),
    table(
        "sync",
        "The synchronizer's gains under compensation = full, by the rules of `rigidtap tune --gains`. A file without them\n\
         keeps those of the reference machine.",
    ),
    table(
        "actual",
        "How the real machine differs from this file. Only the simulated plant reads it: never the planner, the\n\
         synchronizer or tune, which may measure it.",
    ),
    table(
        "spread",
        "How machines of this kind differ: for each key of [actual] the least and the greatest value, [low, high]. A\n\
         sweep draws each evenly between them, independent of the others; [1, 1] keeps a factor as this file says.\n\
         What some machines have is { any = [low, high], ratio = 0.05 }, a choice { one_of = [10, 16] }.",
    ),
    table(
        "spread.hard",
        "The same for what real machines have beside that and [actual] leaves out unless told: `sweep --hard` draws\n\
         these, too.",
    ),
    table("law", "Time laws of the synchronous stroke."),
    table("law.torque_curve", "The segmented approximation of the motor's torque curve."),
    table("law.s_curve", "The conventional S-curve, one acceleration at all speeds."),
    table("law.linear", "The papers' baseline: one acceleration, no jerk limit."),
    table("law.torque_curve_smooth", "The motor's torque curve at motor_share, with bounded jerk."),
    table("law.trapezoid_jerk", "Fifteen phases: jerk, too, rises and falls steadily."),
    table(
        "law.improved_s_curve",
        "Ten phases: no constant acceleration, the cusp rounded; the jerk follows from the change of speed.",
    ),
    table("gcode", "How programs are read."),
    table("tap", "Tap and work piece: the torque that cutting takes."),
    table("tolerance", "What the verdict is judged by."),
];

/// Path of the list of bands, and the keys of one band with their units.
pub(super) const BANDS: &str = "law.torque_curve.bands";
pub(super) const BAND_KEYS: [(&str, &str); 5] =
    [("to_rpm", "rpm"), ("accel_s", "s"), ("decel_s", "s"), ("accel_rpm_per_s", "rpm/s"), ("decel_rpm_per_s", "rpm/s")];

/// A value itself, and the factor on the file's own that it stands in place of.
pub(super) const EITHER: [(&str, &str); 4] = [
    ("actual.backlash_um", "actual.backlash"),
    ("actual.encoder_latency_s", "actual.encoder_latency"),
    ("spread.backlash_um", "spread.backlash"),
    ("spread.encoder_latency_s", "spread.encoder_latency"),
];

/// Every key, table by table in the order of [`TABLES`].
pub(super) fn all() -> impl Iterator<Item = &'static Key> {
    let lists = [
        drive::CONTROL,
        spindle::KEYS,
        axes::KEYS,
        drive::KEYS,
        sync::KEYS,
        actual::ACTUAL,
        actual::SPREAD,
        hard::KEYS,
        law::KEYS,
        program::KEYS,
    ];
    lists.into_iter().flatten()
}

/// The keys of one table.
pub(super) fn of_table(table: &str) -> impl Iterator<Item = &'static Key> {
    all().filter(move |key| key.table() == table)
}

pub(super) fn find(path: &str) -> Option<&'static Key> {
    all().find(|key| key.path == path)
}

pub(super) fn find_table(path: &str) -> Option<&'static Table> {
    TABLES.iter().find(|table| table.path == path)
}

/// Unit of a key's value, those inside a band too.
pub(super) fn unit(path: &str) -> &'static str {
    if parent(path) == BANDS {
        return BAND_KEYS.iter().find(|(name, _)| *name == leaf(path)).map_or("", |(_, unit)| *unit);
    }
    find(path).map_or("", |key| key.unit)
}

/// What may stand in a table: its keys and its sub-tables; the tables themselves at the top, whose path is empty.
pub(super) fn names_in(table: &str) -> Vec<&'static str> {
    if table == BANDS {
        return BAND_KEYS.iter().map(|(name, _)| *name).collect();
    }
    if find(table).is_some() {
        return vec!["any", "ratio", "one_of"];
    }
    let below = TABLES.iter().map(|table| table.path).filter(|path| parent(path) == table).map(leaf);
    of_table(table).map(Key::name).chain(below).collect()
}

/// Everything before the last dot.
pub(super) fn parent(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(parent, _)| parent)
}

/// A path's key without its table.
pub(super) fn name(path: &str) -> &str {
    leaf(path)
}

fn leaf(path: &str) -> &str {
    path.rsplit_once('.').map_or(path, |(_, leaf)| leaf)
}
