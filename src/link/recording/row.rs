//! One line of a file, and what is wrong with it.

use core::fmt;

use super::headings::{DRIVE, TRACE};
use crate::control::port::CountUnwrapper;
use crate::link::map::Source;

/// Why a file is no recording; with its place, from 1.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordingError {
    /// What is wrong.
    pub kind: RecordingErrorKind,
    /// Line.
    pub line: usize,
    /// Column in characters.
    pub column: usize,
}

/// What can be wrong with a recording.
#[derive(Clone, Debug, PartialEq)]
pub enum RecordingErrorKind {
    /// It has no rows.
    Empty,
    /// Its first line is none of the known formats'.
    UnknownFormat,
    /// No column has this heading.
    NoHeading(String),
    /// The row ends before the column that is needed, from 1.
    ShortRow(usize),
    /// Something else than a number.
    NotANumber(String),
    /// A recording of the drives, too, lacks this column.
    NoDriveHeading(&'static str),
    /// Rows are this far apart instead of the interpolation period.
    Period {
        /// Usual step of time.
        found_s: f64,
        /// The machine's period.
        expected_s: f64,
    },
}

impl fmt::Display for RecordingErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "no readings here: expected rows of numbers"),
            Self::UnknownFormat => write!(
                f,
                "neither a trace with the headings {}, nor halsampler's numbers: name the columns with --map",
                TRACE.join(", ")
            ),
            Self::NoHeading(name) => write!(f, "no column is headed `{name}`; a file without headings needs #1, #2 …"),
            Self::ShortRow(column) => write!(f, "the row ends here: expected a number in column {column}"),
            Self::NotANumber(found) => write!(f, "found `{found}`: expected a number"),
            Self::NoDriveHeading(name) => write!(
                f,
                "no column is headed `{name}`: expected a trace as simulate writes it, with at least {}",
                DRIVE.join(", ")
            ),
            Self::Period { found_s, expected_s } => write!(
                f,
                "rows are {found_s:.6} s apart: expected the machine's control.period_s = {expected_s:.6} s, each period one row"
            ),
        }
    }
}

/// One line's fields with their places.
#[derive(Clone, Copy)]
pub(super) struct Row<'a> {
    pub(super) number: usize,
    pub(super) text: &'a str,
    pub(super) separator: Separator,
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Separator {
    Blanks,
    Character(char),
}

impl<'a> Row<'a> {
    /// The field and its column in characters.
    pub(super) fn field(&self, index: usize) -> Option<(&'a str, usize)> {
        let field = match self.separator {
            Separator::Blanks => self.text.split_whitespace().nth(index),
            Separator::Character(separator) => self.text.split(separator).nth(index),
        }?;
        let start = field.as_ptr() as usize - self.text.as_ptr() as usize;
        let before = self.text.get(..start).map_or(0, |before| before.chars().count());
        Some((field.trim().trim_matches('"'), before + 1))
    }

    pub(super) fn fields(&self) -> impl Iterator<Item = &'a str> {
        (0..).map_while(|index| self.field(index).map(|(field, _)| field))
    }

    pub(super) fn fault(&self, kind: RecordingErrorKind, column: usize) -> RecordingError {
        RecordingError { kind, line: self.number, column }
    }

    /// None where the reading is missing.
    pub(super) fn number(&self, index: usize) -> Result<Option<f64>, RecordingError> {
        let Some((field, column)) = self.field(index) else {
            let end = self.text.chars().count() + 1;
            return Err(self.fault(RecordingErrorKind::ShortRow(index + 1), end));
        };
        if field.is_empty() {
            return Ok(None);
        }
        // Where semicolons separate, a comma is a decimal one.
        let parsed = match self.separator {
            Separator::Character(';') => field.replace(',', ".").parse::<f64>(),
            _ => field.parse(),
        };
        parsed.map(|value| Some(value).filter(|value| value.is_finite())).map_err(|_| {
            let shown = field.chars().take(40).filter(|c| !c.is_control()).collect();
            self.fault(RecordingErrorKind::NotANumber(shown), column)
        })
    }
}

/// A position in the scale's counts, unwrapped.
pub(super) struct Position {
    pub(super) column: usize,
    pub(super) factor: f64,
    pub(super) unwrapper: Option<CountUnwrapper>,
}

impl Position {
    pub(super) fn new(source: &Source, column: usize, counts_per_unit: f64) -> Self {
        Self { column, factor: source.factor * counts_per_unit, unwrapper: source.bits.and_then(CountUnwrapper::new) }
    }

    pub(super) fn read(&mut self, row: &Row<'_>) -> Result<Option<f64>, RecordingError> {
        let value = row.number(self.column)?;
        Ok(value.map(|value| {
            let counts = match &mut self.unwrapper {
                // A signed or an unsigned counter: the low bits are the same.
                Some(unwrapper) => unwrapper.unwrap_count((value as i64).cast_unsigned()) as f64,
                None => value,
            };
            counts * self.factor
        }))
    }
}

/// The rows that are not empty, at the strongest separator that the first one has.
pub(super) fn rows(text: &str) -> impl Iterator<Item = Row<'_>> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let lines = || (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let separator = lines().next().and_then(|(_, first)| [';', '\t', ','].into_iter().find(|c| first.contains(*c)));
    let separator = separator.map_or(Separator::Blanks, Separator::Character);
    lines().map(move |(number, text)| Row { number, text, separator })
}
