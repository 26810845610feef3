//! TOML → [`Draft`], with the place of everything that was read.

use core::ops::Range;
use std::collections::HashMap;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fault::ConfigFault;
use super::keys::{self, Draft, Key, Slot};

/// Longest file that is read: a machine file takes some kilobytes, and a parsed one many times its length.
const MAX_BYTES: usize = 1 << 20;

/// A file as far as it could be read.
pub(super) struct Reading {
    pub(super) draft: Draft,
    /// Places of the values that were stored, and of the tables, by path; `…[2]` is a list's element.
    pub(super) places: HashMap<String, Range<usize>>,
    pub(super) faults: Vec<(ConfigFault, Range<usize>)>,
}

/// Reads everything that can be read; `text` is what [`String::from_utf8_lossy`] makes of `bytes`.
pub(super) fn read(bytes: &[u8], text: &str) -> Reading {
    let mut reader =
        Reader { text, reading: Reading { draft: Draft::reference(), places: HashMap::new(), faults: Vec::new() } };
    if bytes.len() > MAX_BYTES {
        reader.fault(ConfigFault::TooLong { bytes: bytes.len(), limit: MAX_BYTES }, 0..0);
    } else if let Err(error) = core::str::from_utf8(bytes) {
        let at = error.valid_up_to();
        let byte = bytes.get(at).copied().unwrap_or_default();
        reader.fault(ConfigFault::NotUtf8 { byte }, at..at + char::REPLACEMENT_CHARACTER.len_utf8());
    } else {
        reader.document();
    }
    reader.reading
}

pub(super) struct Reader<'t> {
    pub(super) text: &'t str,
    pub(super) reading: Reading,
}

impl Reader<'_> {
    fn document(&mut self) {
        let (document, errors) = DeTable::parse_recoverable(self.text);
        // What recovers from a slip of syntax may be nonsense; a duplicate alone leaves the rest readable.
        let mut readable = true;
        for error in errors {
            let span = error.span().unwrap_or(0..0);
            let name = self.text.get(span.clone()).unwrap_or("").to_owned();
            let duplicate = error.message() == "duplicate key";
            readable &= duplicate;
            let syntax = || ConfigFault::Syntax { message: error.message().to_owned() };
            self.fault(if duplicate { ConfigFault::Duplicate { name } } else { syntax() }, span);
        }
        if readable {
            self.table("", document.get_ref());
        }
    }

    fn table(&mut self, path: &'static str, table: &DeTable<'_>) {
        for (name, value) in table {
            let full = if path.is_empty() { name.get_ref().to_string() } else { format!("{path}.{}", name.get_ref()) };
            // A name with a dot in quotes is one name, not a path.
            let plain = !name.get_ref().contains('.');
            if let Some(key) = keys::find(&full).filter(|_| plain) {
                self.value(key, value);
            } else if let Some(renamed) = keys::renamed(&full).filter(|_| plain) {
                self.fault(ConfigFault::Renamed { old: renamed.old, new: renamed.new }, name.span());
                // Where both stand, the new name is the one in force.
                let unless_given = |key: &&Key| !table.iter().any(|(other, _)| other.get_ref() == key.name());
                if let Some(key) = renamed.key().filter(unless_given) {
                    self.value(key, value);
                }
            } else if let Some(below) = keys::find_table(&full).filter(|_| plain) {
                match value.get_ref() {
                    DeValue::Table(inner) => {
                        self.place(full, value.span());
                        self.table(below.path, inner);
                    }
                    _ => self.wrong_type(full, super::fault::Expected::Table, value),
                }
            } else {
                self.fault(ConfigFault::UnknownKey { table: path, name: name.get_ref().to_string() }, name.span());
            }
        }
    }

    fn value(&mut self, key: &'static Key, value: &Spanned<DeValue<'_>>) {
        let stored = match &key.slot {
            Slot::Number(at) => self.number(key.path, value).map(|number| *at(&mut self.reading.draft) = number),
            Slot::Optional { at, .. } | Slot::Ruled { at, .. } => {
                self.number(key.path, value).map(|number| *at(&mut self.reading.draft) = Some(number))
            }
            Slot::Switch(at) => self.switch(key.path, value).map(|on| *at(&mut self.reading.draft) = on),
            Slot::Range(at) => self.drawn(key.path, value).map(|drawn| *at(&mut self.reading.draft) = drawn),
            Slot::OptionalRange { at, .. } => {
                self.drawn(key.path, value).map(|drawn| *at(&mut self.reading.draft) = Some(drawn))
            }
            Slot::Models(at) => self.models(key.path, value).map(|models| *at(&mut self.reading.draft) = models),
            Slot::Word { known, set, .. } => {
                self.word(key.path, known, value).map(|word| set(&mut self.reading.draft, word))
            }
            Slot::TorqueCurve => {
                self.points(key.path, value).map(|points| self.reading.draft.spec.spindle.torque_curve = points)
            }
            Slot::Bands => {
                self.bands(key.path, value).map(|bands| self.reading.draft.spec.law.torque_curve.bands = bands)
            }
        };
        if stored.is_some() {
            self.place(key.path.to_owned(), value.span());
        }
    }

    pub(super) fn place(&mut self, path: String, span: Range<usize>) {
        self.reading.places.insert(path, span);
    }

    pub(super) fn fault(&mut self, fault: ConfigFault, span: Range<usize>) {
        self.reading.faults.push((fault, span));
    }
}
