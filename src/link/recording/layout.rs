//! Which column of a file holds what.

use std::io::{Read, Seek};

use super::fault::{RecordingError, RecordingErrorKind};
use super::found::{Context, Format};
use super::headings::{OVERRUN, TRACE};
use super::row::{Position, Row, Separator};
use super::table::Table;
use crate::link::map::{Column, Map, Source};
use crate::link::sample::Scale;

/// A column of times.
#[derive(Clone, Debug)]
pub(super) struct Time {
    pub(super) column: usize,
    pub(super) name: String,
    pub(super) factor: f64,
}

/// Where in a row everything stands.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) format: Format,
    pub(super) headed: bool,
    pub(super) time: Option<Time>,
    pub(super) spindle: Position,
    pub(super) z: Position,
    pub(super) scale: Scale,
}

impl Layout {
    pub(super) fn of<R: Read + Seek>(
        table: &mut Table<R>,
        map: Option<&Map>,
        context: &Context,
    ) -> Result<Self, RecordingError> {
        if let Some(map) = map {
            return Self::mapped(table, map, context);
        }
        if let [Some(time), Some(spindle), Some(z)] = *table.positions(&TRACE)? {
            let [time_name, spindle_name, z_name] = TRACE.map(str::to_owned);
            return Ok(Self {
                format: Format::Trace,
                headed: true,
                time: Some(Time { column: time, name: time_name, factor: 1.0 }),
                spindle: Position::plain(spindle, spindle_name, 1.0),
                z: Position::plain(z, z_name, 1.0),
                scale: context.scale,
            });
        }
        Self::halsampler(table, context)
    }

    /// The row that this layout reads.
    pub(super) fn row(&self) -> Row {
        Row::of(self.time.iter().map(|time| time.column).chain([self.spindle.column, self.z.column]))
    }

    fn mapped<R: Read + Seek>(table: &mut Table<R>, map: &Map, context: &Context) -> Result<Self, RecordingError> {
        let sources = [map.time.as_ref(), Some(&map.spindle), Some(&map.z)];
        let names = sources.map(|source| match source.map(|source| &source.column) {
            Some(Column::Named(name)) => name.as_str(),
            _ => "",
        });
        let places = table.positions(&names)?;
        table.rewind()?;
        let line = table.head_line();
        let at = |quantity: usize, source: &Source| match &source.column {
            Column::Named(name) => places.get(quantity).copied().flatten().ok_or_else(|| {
                let kind = RecordingErrorKind::NoHeading(name.clone());
                RecordingError { kind, line, column: 1 }
            }),
            Column::At(index) => Ok(*index),
        };
        let called = |source: &Source, index: usize| match &source.column {
            Column::Named(name) => name.clone(),
            Column::At(_) => format!("#{}", index + 1),
        };
        let scale = Scale {
            counts_per_rev: map.spindle.counts.unwrap_or(context.scale.counts_per_rev),
            counts_per_mm: map.z.counts.unwrap_or(context.scale.counts_per_mm),
            ..context.scale
        };
        let time = map.time.as_ref().map(|source| {
            at(0, source).map(|column| Time { column, name: called(source, column), factor: source.factor })
        });
        let (time, spindle, z) = (time.transpose()?, at(1, &map.spindle)?, at(2, &map.z)?);
        let mut layout = Self {
            format: Format::Mapped,
            headed: false,
            time,
            spindle: Position::new(&map.spindle, spindle, called(&map.spindle, spindle), scale.counts_per_rev),
            z: Position::new(&map.z, z, called(&map.z, z), scale.counts_per_mm),
            scale,
        };
        // Numbered columns may have headings all the same.
        let mut head = layout.row();
        if table.next_row(&mut head)? {
            let time = layout.time.as_ref().map(|time| time.column);
            let columns = [time, Some(spindle), Some(z)].into_iter().flatten();
            layout.headed = columns.into_iter().any(|column| head.number(column).is_err());
        }
        Ok(layout)
    }

    fn halsampler<R: Read + Seek>(table: &mut Table<R>, context: &Context) -> Result<Self, RecordingError> {
        let (mut pins, mut numbers, mut tagged, mut overrun) = (0usize, true, false, false);
        table.scan_head(&mut |field| {
            let text = field.text();
            pins += 1;
            if field.index == 0 {
                overrun = text == OVERRUN;
                tagged = text.parse::<u64>().is_ok();
            }
            numbers = numbers && text.parse::<f64>().is_ok();
        })?;
        let known = (pins == 1 && overrun) || (pins >= 2 && numbers);
        if table.separator != Separator::Blanks || !known {
            return Err(RecordingError { kind: RecordingErrorKind::UnknownFormat, line: table.head_line(), column: 1 });
        }
        // With `-t` the number of the sample, a whole one, stands first.
        let first = usize::from(tagged && pins >= 3);
        let scale = context.scale;
        let name = |column: usize| format!("#{}", column + 1);
        Ok(Self {
            format: Format::Halsampler,
            headed: false,
            time: (first == 1).then(|| Time { column: 0, name: name(0), factor: context.period_s }),
            spindle: Position::plain(first, name(first), scale.counts_per_rev),
            z: Position::plain(first + 1, name(first + 1), scale.counts_per_mm),
            scale,
        })
    }
}
