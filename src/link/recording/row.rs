//! One line's fields, as far as anyone asks for them.

use super::fault::{RecordingError, RecordingErrorKind};
use super::headings::OVERRUN;
use crate::control::port::CountUnwrapper;
use crate::link::map::Source;

/// Characters of a field that a message shows.
const SHOWN: usize = 40;

/// What stands between fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Separator {
    /// Any number of blanks and tabs.
    Blanks,
    /// This byte, once.
    Byte(u8),
}

/// A field that is asked for.
#[derive(Clone, Debug, Default)]
pub(super) struct Cell {
    pub(super) index: usize,
    /// Place of its first character; none where the line ends before it.
    pub(super) column: Option<usize>,
    pub(super) text: String,
}

/// The fields of one line that are asked for, with their places.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// Line, from 1.
    pub(super) number: usize,
    separator: Separator,
    cells: Vec<Cell>,
    fields: usize,
    end_column: usize,
}

impl Row {
    /// A row of these columns, from 0, and of the first one.
    pub(super) fn of(columns: impl IntoIterator<Item = usize>) -> Self {
        let mut cells = vec![Cell::default()];
        for index in columns {
            if cells.iter().all(|cell| cell.index != index) {
                cells.push(Cell { index, ..Cell::default() });
            }
        }
        Self { number: 0, separator: Separator::Blanks, cells, fields: 0, end_column: 1 }
    }

    pub(super) fn clear(&mut self) {
        self.cells.iter_mut().for_each(|cell| cell.column = None);
    }

    pub(super) fn cell_mut(&mut self, index: usize) -> Option<&mut Cell> {
        self.cells.iter_mut().find(|cell| cell.index == index)
    }

    pub(super) fn end(&mut self, number: usize, separator: Separator, fields: usize, end_column: usize) {
        (self.number, self.separator, self.fields, self.end_column) = (number, separator, fields, end_column);
    }

    /// halsampler's word for samples that it lost.
    pub(super) fn is_overrun(&self) -> bool {
        self.fields == 1 && self.cells.first().is_some_and(|cell| cell.text == OVERRUN)
    }

    pub(super) fn fault(&self, kind: RecordingErrorKind, column: usize) -> RecordingError {
        RecordingError { kind, line: self.number, column }
    }

    /// The field as it stands, for a message: short, and without control characters.
    pub(super) fn shown(&self, index: usize) -> String {
        let cell = self.cells.iter().find(|cell| cell.index == index);
        cell.map_or_else(String::new, |cell| shown(&cell.text))
    }

    /// None where the reading is missing; infinite where it is beyond all numbers.
    pub(super) fn number(&self, index: usize) -> Result<Option<f64>, RecordingError> {
        let cell = self.cells.iter().find(|cell| cell.index == index && cell.column.is_some());
        let Some(Cell { column: Some(column), text, .. }) = cell else {
            return Err(self.fault(RecordingErrorKind::ShortRow(index + 1), self.end_column));
        };
        if text.is_empty() {
            return Ok(None);
        }
        // Where semicolons separate, a comma is a decimal one.
        let parsed = match self.separator {
            Separator::Byte(b';') => text.replace(',', ".").parse::<f64>(),
            _ => text.parse(),
        };
        parsed
            .map(|value| Some(value).filter(|value| !value.is_nan()))
            .map_err(|_| self.fault(RecordingErrorKind::NotANumber(shown(text)), *column))
    }
}

fn shown(text: &str) -> String {
    text.chars().take(SHOWN).filter(|c| !c.is_control()).collect()
}

/// A position in the scale's counts, unwrapped.
#[derive(Clone, Debug)]
pub(super) struct Position {
    pub(super) column: usize,
    /// What the column is called in messages.
    pub(super) name: String,
    factor: f64,
    unwrapper: Option<CountUnwrapper>,
    bits: Option<u32>,
}

impl Position {
    pub(super) fn new(source: &Source, column: usize, name: String, counts_per_unit: f64) -> Self {
        let unwrapper = source.bits.and_then(CountUnwrapper::new);
        Self { column, name, factor: source.factor * counts_per_unit, unwrapper, bits: source.bits }
    }

    pub(super) fn plain(column: usize, name: String, factor: f64) -> Self {
        Self { column, name, factor, unwrapper: None, bits: None }
    }

    /// Infinite where the field holds more than its counter can.
    pub(super) fn read(&mut self, row: &Row) -> Result<Option<f64>, RecordingError> {
        let value = row.number(self.column)?;
        Ok(value.map(|value| {
            let counts = match (&mut self.unwrapper, self.bits) {
                (Some(_), Some(bits)) if !holds(bits, value) => f64::INFINITY,
                // A signed or an unsigned counter: the low bits are the same.
                (Some(unwrapper), _) => unwrapper.unwrap_count((value as i64).cast_unsigned()) as f64,
                (None, _) => value,
            };
            counts * self.factor
        }))
    }
}

/// Whether a counter of so many bits, signed or unsigned, can show this.
fn holds(bits: u32, value: f64) -> bool {
    let range = f64::from(bits).exp2();
    value >= -range / 2.0 && value < range
}
