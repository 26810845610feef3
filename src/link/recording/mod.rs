//! Recordings: the trace that `simulate` writes, LinuxCNC's halsampler, any other CSV by a [`Map`].
//!
//! halsampler writes one line a servo period, its pins separated by blanks: the spindle's revolutions
//! (`spindle.0.revs`), then Z's position (`joint.2.pos-fb`), `cfg=ff`; with `-t` the sample's number stands before
//! them. Further pins may follow. It writes `overrun` where it lost samples. LinuxCNC resets the revolutions at the
//! spindle's index: from there they are counted on. Rows are one interpolation period of the machine apart.
//!
//! A [`DriveLog`] is a trace with the drives' efforts, from which a machine is identified.
//!
//! In all formats an empty line is nothing, and an empty or non-finite field is a reading that is missing. A time that
//! goes back begins a new recording, a time that stays is a repeated row.

mod drive_log;
mod layout;
mod reader;
mod row;

pub use drive_log::DriveLog;
pub use row::{RecordingError, RecordingErrorKind};

use super::map::Map;
use super::receiver::Fastest;
use super::sample::{Sample, Scale};

use layout::Layout;
use reader::Reader;
use row::{Row, Separator};

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
        let mut rows = rows(&text).peekable();
        let nothing = RecordingError { kind: RecordingErrorKind::Empty, line: 1, column: 1 };
        let head = *rows.peek().ok_or(nothing.clone())?;
        let layout = Layout::of(&head, map, context)?;
        if layout.headed {
            rows.next();
        }
        let mut reader = Reader::new(layout, context);
        for row in rows {
            reader.read(&row)?;
        }
        if reader.samples.is_empty() { Err(nothing) } else { Ok(reader.finish()) }
    }
}

/// The rows that are not empty, at the strongest separator that the first one has.
fn rows(text: &str) -> impl Iterator<Item = Row<'_>> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let lines = || (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty());
    let separator = lines().next().and_then(|(_, first)| [';', '\t', ','].into_iter().find(|c| first.contains(*c)));
    let separator = separator.map_or(Separator::Blanks, Separator::Character);
    lines().map(move |(number, text)| Row { number, text, separator })
}
