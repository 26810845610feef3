//! Which columns of a foreign file hold what: `time=t[ms],spindle=enc0[counts/16384],z=enc1[counts/10000]`.
//!
//! A column is named by its heading, or by its number from 1 after `#`, which needs no heading. Units:
//!
//! | of | units |
//! |---|---|
//! | time | `s`, `ms`, `us`, `ns`; without a time column rows are one interpolation period of the machine apart |
//! | spindle | `rev`, `deg`, `rad`, `counts/N` with N counts per revolution |
//! | z | `mm`, `um`, `in`, `counts/N` with N counts per mm |
//!
//! `counts16/N` is a counter that wraps at 16 bits; any width from 2 to 52 does. A minus before the unit turns the
//! direction: the spindle counts up as M03 turns, Z falls into the hole.

use core::fmt;
use core::ops::Range;

use crate::control::units::{DEG_PER_REV, MM_PER_INCH, RAD_PER_REV, UM_PER_MM};

/// Where a value stands in a row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Column {
    /// Under this heading.
    Named(String),
    /// In this column, from 0.
    At(usize),
}

/// A column and what its numbers mean.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Where.
    pub column: Column,
    /// Factor from its numbers to the base unit: s, rev, mm. For counts, ±1 over the counts of one unit.
    pub factor: f64,
    /// Counts per unit, where it holds counts.
    pub counts: Option<f64>,
    /// Width of the counter, where it wraps.
    pub bits: Option<u32>,
}

/// The columns of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Time; rows are one period apart without it.
    pub time: Option<Source>,
    /// Spindle.
    pub spindle: Source,
    /// Z.
    pub z: Source,
}

/// What is wrong with a map, at these bytes of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapError {
    /// What is wrong.
    pub kind: MapErrorKind,
    /// Where in the text.
    pub span: Range<usize>,
}

/// What can be wrong with a map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapErrorKind {
    /// Not of the form `what=column[unit]`.
    Form,
    /// Neither time nor spindle nor z.
    What,
    /// One of them twice.
    Twice,
    /// No such column number.
    Number,
    /// No unit of this quantity.
    Unit,
    /// Spindle or z is missing.
    Missing,
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.kind {
            MapErrorKind::Form => "expected what=column[unit], as in spindle=enc0[counts/16384]",
            MapErrorKind::What => "expected time, spindle or z",
            MapErrorKind::Twice => "mapped twice",
            MapErrorKind::Number => "expected a column number from 1",
            MapErrorKind::Unit => {
                "expected a unit: s, ms, us, ns of time; rev, deg, rad of the spindle; mm, um, in of z; \
                 counts/N or counts16/N of both"
            }
            MapErrorKind::Missing => "spindle and z both have to be mapped",
        };
        write!(f, "character {}: {what}", self.span.start + 1)
    }
}

impl core::error::Error for MapError {}

/// Quantities that a map names.
#[derive(Clone, Copy, PartialEq)]
enum Quantity {
    Time,
    Spindle,
    Z,
}

impl core::str::FromStr for Map {
    type Err = MapError;

    /// Reads a map.
    ///
    /// ```
    /// use rigidtap::link::map::{Column, Map};
    /// let map: Map = "time=t[ms],spindle=#2[counts16/4096],z=pos[-mm]".parse().unwrap();
    /// assert_eq!((map.spindle.column, map.spindle.bits), (Column::At(1), Some(16)));
    /// assert_eq!(map.z.factor, -1.0);
    /// assert!("spindle=a[rev]".parse::<Map>().is_err());
    /// ```
    fn from_str(text: &str) -> Result<Self, MapError> {
        let (mut time, mut spindle, mut z) = (None, None, None);
        let mut start = 0;
        for part in text.split(',') {
            let span = start..start + part.len();
            start = span.end + 1;
            let fault = |kind| MapError { kind, span: span.clone() };
            let (what, rest) = part.split_once('=').ok_or(fault(MapErrorKind::Form))?;
            let (column, unit) = rest
                .trim()
                .strip_suffix(']')
                .and_then(|rest| rest.rsplit_once('['))
                .filter(|(column, _)| !column.trim().is_empty())
                .ok_or(fault(MapErrorKind::Form))?;
            let (place, quantity) = match what.trim() {
                "time" => (&mut time, Quantity::Time),
                "spindle" => (&mut spindle, Quantity::Spindle),
                "z" => (&mut z, Quantity::Z),
                _ => return Err(fault(MapErrorKind::What)),
            };
            let column = match column.trim().strip_prefix('#') {
                None => Column::Named(column.trim().to_owned()),
                Some(number) => {
                    let number = number.parse().ok().and_then(|number: usize| number.checked_sub(1));
                    Column::At(number.ok_or(fault(MapErrorKind::Number))?)
                }
            };
            let source = source(column, unit.trim(), quantity).ok_or(fault(MapErrorKind::Unit))?;
            if place.replace(source).is_some() {
                return Err(fault(MapErrorKind::Twice));
            }
        }
        match (spindle, z) {
            (Some(spindle), Some(z)) => Ok(Self { time, spindle, z }),
            _ => Err(MapError { kind: MapErrorKind::Missing, span: 0..text.len() }),
        }
    }
}

fn source(column: Column, unit: &str, quantity: Quantity) -> Option<Source> {
    let (sign, unit) = unit.strip_prefix('-').map_or((1.0, unit), |unit| (-1.0, unit));
    if let Some(counts) = unit.strip_prefix("counts").filter(|_| quantity != Quantity::Time) {
        let (bits, per_unit) = counts.split_once('/')?;
        let bits = match bits {
            "" => None,
            bits => Some(bits.parse().ok().filter(|bits| (2..=52).contains(bits))?),
        };
        let per_unit: f64 = per_unit.parse().ok().filter(|counts: &f64| counts.is_normal() && *counts > 0.0)?;
        return Some(Source { column, factor: sign / per_unit, counts: Some(per_unit), bits });
    }
    let factor = match (quantity, unit) {
        (Quantity::Time, "s") | (Quantity::Spindle, "rev") | (Quantity::Z, "mm") => 1.0,
        (Quantity::Time, "ms") => 1e-3,
        (Quantity::Time, "us") => 1e-6,
        (Quantity::Time, "ns") => 1e-9,
        (Quantity::Spindle, "deg") => 1.0 / DEG_PER_REV,
        (Quantity::Spindle, "rad") => 1.0 / RAD_PER_REV,
        (Quantity::Z, "um") => 1.0 / UM_PER_MM,
        (Quantity::Z, "in") => MM_PER_INCH,
        _ => return None,
    };
    Some(Source { column, factor: sign * factor, counts: None, bits: None })
}
