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
mod found;
mod headings;
mod layout;
mod reader;
mod row;

pub use drive_log::DriveLog;
pub use found::{Context, Format, Recording};
pub use row::{RecordingError, RecordingErrorKind};

use super::map::Map;

use layout::Layout;
use reader::Reader;
use row::rows;

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
