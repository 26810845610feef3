//! Recordings: the trace that `simulate` writes, LinuxCNC's halsampler, any other CSV by a [`Map`].
//!
//! halsampler writes one line a servo period, its pins separated by blanks: the spindle's revolutions
//! (`spindle.0.revs`), then Z's position (`joint.2.pos-fb`), `cfg=ff`; with `-t` the sample's number stands before
//! them. Further pins may follow. It writes `overrun` where it lost samples. LinuxCNC resets the revolutions at the
//! spindle's index: from there they are counted on. Rows are one interpolation period of the machine apart.
//!
//! In all formats an empty line is nothing, and an empty or non-finite field is a reading that is missing. A time that
//! goes back begins a new recording, a time that stays is a repeated row.

use core::fmt;

use super::map::{Column, Map, Source};
use super::receiver::Fastest;
use super::sample::{Gap, Sample, Scale};
use crate::control::port::CountUnwrapper;

/// A step of time beyond so many usual ones is a gap.
const GAP_PERIODS: f64 = 1.5;
/// Headings of a trace.
const TRACE: [&str; 3] = ["time_s", "spindle_encoder_counts", "z_encoder_counts"];
/// What halsampler writes where it lost samples.
const OVERRUN: &str = "overrun";

/// What a file was read as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// The trace of `simulate`.
    Trace,
    /// LinuxCNC's halsampler.
    Halsampler,
    /// A CSV with a map.
    Mapped,
}

impl Format {
    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Trace => "trace",
            Self::Halsampler => "halsampler",
            Self::Mapped => "mapped",
        }
    }
}

/// A recording as samples, and what was odd about it.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What it was read as.
    pub format: Format,
    /// Its samples.
    pub samples: Vec<Sample>,
    /// What their counts are.
    pub scale: Scale,
    /// Usual step of time: the median.
    pub period_s: f64,
    /// Greatest deviation from it, gaps apart.
    pub jitter_s: f64,
    /// Places where readings are missing.
    pub gaps: u64,
    /// Readings missing there, by the usual step.
    pub missing: u64,
    /// Rows whose time is that of the row before; not used.
    pub repeated: u64,
    /// Times that time went back.
    pub restarts: u64,
    /// Times that the spindle's position was reset.
    pub resets: u64,
}

/// Why a file is no recording; with its place, from 1.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordingError {
    /// What is wrong.
    pub kind: RecordingErrorKind,
    /// Line.
    pub line: usize,
    /// Column in characters.
    pub column: usize,
}

/// What can be wrong with a recording.
#[derive(Clone, Debug, PartialEq, Eq)]
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
        }
    }
}

/// What a reader has to know beside the file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Context {
    /// Counts of the machine's encoders: a trace's, and what angles and lengths are turned into.
    pub scale: Scale,
    /// Step of time of a file without any.
    pub period_s: f64,
    /// A spindle that goes further in one step was reset.
    pub fastest: Fastest,
}

/// One line's fields with their places.
struct Row<'a> {
    number: usize,
    text: &'a str,
    separator: Separator,
}

#[derive(Clone, Copy, PartialEq)]
enum Separator {
    Blanks,
    Character(char),
}

impl<'a> Row<'a> {
    /// The field and its column in characters.
    fn field(&self, index: usize) -> Option<(&'a str, usize)> {
        let field = match self.separator {
            Separator::Blanks => self.text.split_whitespace().nth(index),
            Separator::Character(separator) => self.text.split(separator).nth(index),
        }?;
        let start = field.as_ptr() as usize - self.text.as_ptr() as usize;
        let before = self.text.get(..start).map_or(0, |before| before.chars().count());
        Some((field.trim().trim_matches('"'), before + 1))
    }

    fn fields(&self) -> impl Iterator<Item = &'a str> {
        (0..).map_while(|index| self.field(index).map(|(field, _)| field))
    }

    fn fault(&self, kind: RecordingErrorKind, column: usize) -> RecordingError {
        RecordingError { kind, line: self.number, column }
    }

    /// None where the reading is missing.
    fn number(&self, index: usize) -> Result<Option<f64>, RecordingError> {
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
struct Position {
    column: usize,
    factor: f64,
    unwrapper: Option<CountUnwrapper>,
}

impl Position {
    fn new(source: &Source, column: usize, counts_per_unit: f64) -> Self {
        Self { column, factor: source.factor * counts_per_unit, unwrapper: source.bits.and_then(CountUnwrapper::new) }
    }

    fn read(&mut self, row: &Row<'_>) -> Result<Option<f64>, RecordingError> {
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

impl Recording {
    /// Reads a recording.
    ///
    /// # Errors
    /// [`RecordingError`]: the first thing in the file that cannot be.
    ///
    /// ```
    /// use rigidtap::control::machine::Machine;
    /// use rigidtap::link::{receiver::Fastest, recording::{Context, Recording}, sample::Scale};
    /// let machine = Machine::reference();
    /// let context = Context { scale: Scale::of(&machine), period_s: 0.001, fastest: Fastest::of(&machine) };
    /// let map = "time=t[ms],spindle=a[deg],z=b[mm]".parse().unwrap();
    /// let found = Recording::read(b"t,a,b\n0,0,5\n1,36,4.9\n3,72,4.8\n", Some(&map), &context).unwrap();
    /// assert_eq!((found.samples.len(), found.gaps, found.missing), (3, 1, 1));
    /// let wrong = Recording::read(b"t,a,b\n0,x,5\n", Some(&map), &context).unwrap_err();
    /// assert_eq!((wrong.line, wrong.column), (2, 3));
    /// ```
    pub fn read(bytes: &[u8], map: Option<&Map>, context: &Context) -> Result<Self, RecordingError> {
        let text = String::from_utf8_lossy(bytes);
        let text = text.strip_prefix('\u{FEFF}').unwrap_or(&text);
        let mut rows = (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty()).peekable();
        let nothing = RecordingError { kind: RecordingErrorKind::Empty, line: 1, column: 1 };
        let &(first_line, first) = rows.peek().ok_or(nothing.clone())?;
        let separator = match [';', '\t', ','].into_iter().find(|separator| first.contains(*separator)) {
            Some(separator) => Separator::Character(separator),
            None => Separator::Blanks,
        };
        let row = |(number, text)| Row { number, text, separator };
        let head = row((first_line, first));
        let layout = Layout::of(&head, map, context)?;
        if layout.headed {
            rows.next();
        }
        let mut reader = Reader::new(layout, context);
        for line in rows {
            reader.read(&row(line))?;
        }
        if reader.samples.is_empty() { Err(nothing) } else { Ok(reader.finish()) }
    }
}

/// Where in a row everything stands.
struct Layout {
    format: Format,
    headed: bool,
    time: Option<(usize, f64)>,
    spindle: Position,
    z: Position,
    scale: Scale,
}

impl Layout {
    fn of(head: &Row<'_>, map: Option<&Map>, context: &Context) -> Result<Self, RecordingError> {
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

/// Reads rows into samples.
struct Reader<'a> {
    layout: Layout,
    context: &'a Context,
    samples: Vec<Sample>,
    gap: Gap,
    rows: u64,
    repeated: u64,
    restarts: u64,
    resets: u64,
    /// What was taken from the spindle's position at resets.
    reset_counts: f64,
    last_step_counts: f64,
}

impl<'a> Reader<'a> {
    fn new(layout: Layout, context: &'a Context) -> Self {
        Self {
            layout,
            context,
            samples: Vec::new(),
            gap: Gap::None,
            rows: 0,
            repeated: 0,
            restarts: 0,
            resets: 0,
            reset_counts: 0.0,
            last_step_counts: 0.0,
        }
    }

    fn read(&mut self, row: &Row<'_>) -> Result<(), RecordingError> {
        if row.text.trim() == OVERRUN {
            self.gap = self.gap.max(Gap::Readings);
            return Ok(());
        }
        let number = self.rows;
        self.rows += 1;
        let layout = &mut self.layout;
        let time_s = match layout.time {
            Some((column, factor)) => row.number(column)?.map(|time| time * factor),
            None => Some(number as f64 * self.context.period_s),
        };
        let (spindle, z) = (layout.spindle.read(row)?, layout.z.read(row)?);
        let (Some(time_s), Some(mut spindle_counts), Some(z_counts)) = (time_s, spindle, z) else {
            self.gap = self.gap.max(Gap::Readings);
            return Ok(());
        };
        spindle_counts += self.reset_counts;
        if let Some(last) = self.samples.last() {
            if time_s == last.time_s {
                self.repeated += 1;
                return Ok(());
            }
            if time_s < last.time_s {
                self.restarts += 1;
                self.gap = Gap::Origin;
            } else if layout.format == Format::Halsampler {
                let step = spindle_counts - last.spindle_counts;
                let reach = self.context.fastest.spindle_counts_per_s * (time_s - last.time_s);
                // A jump, or a running spindle that falls back to its index.
                let back = step * self.last_step_counts < 0.0 && step.abs() > 4.0 * self.last_step_counts.abs();
                if step.abs() > reach
                    || (back && self.last_step_counts.abs() > self.layout.scale.counts_per_rev / 200.0)
                {
                    self.resets += 1;
                    let carried = last.spindle_counts + self.last_step_counts - spindle_counts;
                    self.reset_counts += carried;
                    spindle_counts += carried;
                } else {
                    self.last_step_counts = step;
                }
            }
        }
        let k = self.samples.len() as u64;
        self.samples.push(Sample { k, time_s, spindle_counts, z_counts, gap: core::mem::take(&mut self.gap) });
        Ok(())
    }

    /// Finds the usual step of time, and with it the gaps and the jitter.
    fn finish(mut self) -> Recording {
        let mut steps: Vec<f64> =
            self.samples.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).filter(|step| *step > 0.0).collect();
        let middle = steps.len() / 2;
        let period_s = if steps.is_empty() {
            self.context.period_s
        } else {
            *steps.select_nth_unstable_by(middle, f64::total_cmp).1
        };
        let (mut gaps, mut missing, mut jitter_s, mut k, mut before) = (0, 0, 0f64, 0, None::<f64>);
        for sample in &mut self.samples {
            let step_s = before.map_or(period_s, |before| sample.time_s - before);
            before = Some(sample.time_s);
            let steps = (step_s / period_s).round().max(1.0);
            if step_s > GAP_PERIODS * period_s {
                sample.gap = sample.gap.max(Gap::Readings);
                missing += steps as u64 - 1;
            } else if step_s > 0.0 {
                jitter_s = jitter_s.max((step_s - period_s).abs());
            }
            gaps += u64::from(sample.gap == Gap::Readings);
            k += steps as u64;
            sample.k = k - 1;
        }
        Recording {
            format: self.layout.format,
            samples: self.samples,
            scale: self.layout.scale,
            period_s,
            jitter_s,
            gaps,
            missing,
            repeated: self.repeated,
            restarts: self.restarts,
            resets: self.resets,
        }
    }
}
