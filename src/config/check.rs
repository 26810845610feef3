//! [`Reading`] → [`MachineFile`]: the machine's own checks, each fault at the place in the file that caused it.

use core::ops::Range;

use super::actual_ranges;
use super::diagnostic::{ConfigDiagnostic, Lines};
use super::fault::{ConfigFault, involved, warned_of};
use super::implied;
use super::keys::{self, BANDS};
use super::machine_file::MachineFile;
use super::read::{Reading, read};
use super::slips;
use crate::control::machine::{Machine, MachineError, MachineFault};

/// More than this nobody reads; a file of another kind would give thousands.
const MAX_DIAGNOSTICS: usize = 50;

impl MachineFile {
    /// Reads a machine file.
    ///
    /// # Errors
    /// Every fault of the file in the order of its text, fifty at most; see [`ConfigFault`].
    pub fn read(bytes: &[u8]) -> Result<Self, Vec<ConfigDiagnostic>> {
        let text = String::from_utf8_lossy(bytes);
        check(read(bytes, &text), &text)
    }
}

/// The file of a reading without faults, or all its faults in the order of the text.
fn check(reading: Reading, text: &str) -> Result<MachineFile, Vec<ConfigDiagnostic>> {
    let lines = Lines::of(text);
    let Reading { mut draft, places, faults } = reading;
    let (mut warnings, mut faults): (Vec<_>, Vec<_>) = faults.into_iter().partition(|(fault, _)| fault.is_warning());
    let places = Places(places);
    implied::fill(&mut draft, &|key| places.0.contains_key(key));
    let mut values = Vec::new();
    draft.spec.faults(&mut |error| values.push(error));
    actual_ranges::faults(&draft, &mut |error| values.push(error));
    for (key, other) in keys::EITHER {
        if let Some(place) = places.0.get(key).filter(|_| places.0.contains_key(other)) {
            faults.push((ConfigFault::Both { key, other }, place.clone()));
        }
    }
    let reported = |error: &MachineError| !follows_from_another(error, &values, &places, !faults.is_empty());
    let mut reported: Vec<_> = values
        .iter()
        .filter(|error| reported(error))
        .map(|error| (ConfigFault::Value(*error), places.find(error.key, error.index, &involved(error))))
        .collect();
    faults.append(&mut reported);
    if !faults.is_empty() {
        return Err(sorted(faults, &lines));
    }
    let mut slipped = Vec::new();
    slips::find(&draft, &|key| places.0.contains_key(key), &mut |slip| {
        slipped.push(slip.key);
        let span = places.find(slip.key, slip.index, &[]);
        warnings.push((ConfigFault::Slip(slip), span));
    });
    let machine = Machine::check(draft.spec)
        .map_err(|error| vec![lines.place(ConfigFault::Value(error), places.find(error.key, error.index, &[]))])?;
    machine.warnings(&mut |warning| {
        let involved = warned_of(&warning);
        // What follows from a slip is not told as well.
        if involved.iter().any(|key| slipped.contains(key)) {
            return;
        }
        let span = places.find(warning.key, warning.index, &involved);
        warnings.push((ConfigFault::Unwise(warning), span));
    });
    Ok(MachineFile {
        machine,
        actual: draft.actual,
        spread: draft.spread,
        hard: draft.hard,
        gcode: draft.gcode,
        data_sheet: draft.data_sheet,
        warnings: sorted(warnings, &lines),
    })
}

/// One mistake, one message: a contradiction with a value that is reported itself is left out, and, where some key
/// could not be read, a contradiction with a key's default, which the unread key may have been meant to replace.
fn follows_from_another(error: &MachineError, all: &[MachineError], places: &Places, unread: bool) -> bool {
    if matches!(error.fault, MachineFault::OutOfRange { .. }) {
        return false;
    }
    let involved = involved(error);
    let out_of_range = |key: &str| {
        all.iter().any(|other| {
            let same =
                other.key == key || (key == BANDS && keys::parent(other.key) == BANDS && other.key.ends_with("to_rpm"));
            same && matches!(other.fault, MachineFault::OutOfRange { .. })
        })
    };
    involved.iter().any(|key| out_of_range(key) || (unread && !places.0.contains_key(*key)))
}

fn sorted(mut faults: Vec<(ConfigFault, Range<usize>)>, lines: &Lines<'_>) -> Vec<ConfigDiagnostic> {
    faults.sort_by_key(|(_, span)| span.start);
    let more = faults.len().saturating_sub(MAX_DIAGNOSTICS);
    faults.truncate(MAX_DIAGNOSTICS);
    if more > 0 {
        let end = faults.last().map_or(0..0, |(_, span)| span.clone());
        faults.push((ConfigFault::More { count: more }, end));
    }
    faults.into_iter().map(|(fault, span)| lines.place(fault, span)).collect()
}

/// Places by path, see [`Reading`].
struct Places(std::collections::HashMap<String, Range<usize>>);

impl Places {
    /// What a fault should point to: the value itself, else the first of the others involved that the file gives, since
    /// the default that they contradict has no place; else the table; else the file's start.
    fn find(&self, key: &str, index: Option<usize>, involved: &[&str]) -> Range<usize> {
        let element = index.map(|index| match (key, keys::parent(key)) {
            (BANDS, _) => [format!("{BANDS}[{index}].to_rpm"), format!("{BANDS}[{index}]")],
            (_, BANDS) => [key.replacen(BANDS, &format!("{BANDS}[{index}]"), 1), format!("{BANDS}[{index}]")],
            _ => [format!("{key}[{index}]"), key.to_owned()],
        });
        let exact = element.iter().flatten().find_map(|path| self.0.get(path));
        let keys = || core::iter::once(key).chain(involved.iter().copied());
        let place = exact
            .or_else(|| keys().find_map(|key| self.0.get(key)))
            .or_else(|| keys().find_map(|key| self.0.get(keys::parent(key))));
        place.cloned().unwrap_or(0..0)
    }
}
