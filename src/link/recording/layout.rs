//! Which column of a file holds what.

use super::found::{Context, Format};
use super::headings::{OVERRUN, TRACE};
use super::row::{Position, RecordingError, RecordingErrorKind, Row, Separator};
use crate::link::map::{Column, Map, Source};
use crate::link::sample::Scale;

/// Where in a row everything stands.
pub(super) struct Layout {
    pub(super) format: Format,
    pub(super) headed: bool,
    pub(super) time: Option<(usize, f64)>,
    pub(super) spindle: Position,
    pub(super) z: Position,
    pub(super) scale: Scale,
}

impl Layout {
    pub(super) fn of(head: &Row<'_>, map: Option<&Map>, context: &Context) -> Result<Self, RecordingError> {
        let named = |name: &str| {
            let index = head.fields().position(|field| field == name);
            index.ok_or_else(|| head.fault(RecordingErrorKind::NoHeading(name.to_owned()), 1))
        };
        let scale = context.scale;
        if let Some(map) = map {
            let at = |source: &Source| match &source.column {
                Column::Named(name) => named(name),
                Column::At(index) => Ok(*index),
            };
            let scale = Scale {
                counts_per_rev: map.spindle.counts.unwrap_or(scale.counts_per_rev),
                counts_per_mm: map.z.counts.unwrap_or(scale.counts_per_mm),
                ..scale
            };
            let time = map.time.as_ref().map(|source| at(source).map(|column| (column, source.factor))).transpose()?;
            let (spindle, z) = (at(&map.spindle)?, at(&map.z)?);
            let headed = [time.map(|(column, _)| column), Some(spindle), Some(z)];
            return Ok(Self {
                format: Format::Mapped,
                // Numbered columns may have headings all the same.
                headed: headed.into_iter().flatten().any(|column| head.number(column).is_err()),
                time,
                spindle: Position::new(&map.spindle, spindle, scale.counts_per_rev),
                z: Position::new(&map.z, z, scale.counts_per_mm),
                scale,
            });
        }
        let plain = |column, factor| Position { column, factor, unwrapper: None };
        if let [Ok(time), Ok(spindle), Ok(z)] = TRACE.map(named) {
            return Ok(Self {
                format: Format::Trace,
                headed: true,
                time: Some((time, 1.0)),
                spindle: plain(spindle, 1.0),
                z: plain(z, 1.0),
                scale,
            });
        }
        let pins = head.fields().count();
        let numbers =
            head.text.trim() == OVERRUN || (pins >= 2 && head.fields().all(|field| field.parse::<f64>().is_ok()));
        if head.separator != Separator::Blanks || !numbers {
            return Err(head.fault(RecordingErrorKind::UnknownFormat, 1));
        }
        // With `-t` the number of the sample, a whole one, stands first.
        let tagged = pins >= 3 && head.fields().next().is_some_and(|field| field.parse::<u64>().is_ok());
        let first = usize::from(tagged);
        Ok(Self {
            format: Format::Halsampler,
            headed: false,
            time: tagged.then_some((0, context.period_s)),
            spindle: plain(first, scale.counts_per_rev),
            z: plain(first + 1, scale.counts_per_mm),
            scale,
        })
    }
}
