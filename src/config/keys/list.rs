//! All keys, and how they are found.

use super::bands::{BAND_KEYS, BANDS};
use super::key::{Key, leaf, parent};
use super::tables::TABLES;
use super::{actual, axes, drive, hard, law, program, spindle, sync};

/// A value itself, and the factor on the file's own that it stands in place of.
pub(in crate::config) const EITHER: [(&str, &str); 4] = [
    ("actual.backlash_um", "actual.backlash"),
    ("actual.encoder_latency_s", "actual.encoder_latency"),
    ("spread.backlash_um", "spread.backlash"),
    ("spread.encoder_latency_s", "spread.encoder_latency"),
];

/// Every key, table by table in the order of [`TABLES`].
pub(in crate::config) fn all() -> impl Iterator<Item = &'static Key> {
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
pub(in crate::config) fn of_table(table: &str) -> impl Iterator<Item = &'static Key> {
    all().filter(move |key| key.table() == table)
}

pub(in crate::config) fn find(path: &str) -> Option<&'static Key> {
    all().find(|key| key.path == path)
}

/// Unit of a key's value, those inside a band too.
pub(in crate::config) fn unit(path: &str) -> &'static str {
    if parent(path) == BANDS {
        return BAND_KEYS.iter().find(|(name, _)| *name == leaf(path)).map_or("", |(_, unit)| *unit);
    }
    find(path).map_or("", |key| key.unit)
}

/// What may stand in a table: its keys and its sub-tables; the tables themselves at the top, whose path is empty.
pub(in crate::config) fn names_in(table: &str) -> Vec<&'static str> {
    if table == BANDS {
        return BAND_KEYS.iter().map(|(name, _)| *name).collect();
    }
    if find(table).is_some() {
        return vec!["any", "ratio", "one_of"];
    }
    let below = TABLES.iter().map(|table| table.path).filter(|path| parent(path) == table).map(leaf);
    of_table(table).map(Key::name).chain(below).collect()
}
