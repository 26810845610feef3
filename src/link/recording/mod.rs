//! Recordings: the trace that `simulate` writes, LinuxCNC's halsampler, any other CSV by a [`Map`].
//!
//! halsampler writes one line a servo period, its pins separated by blanks: the spindle's revolutions
//! (`spindle.0.revs`), then Z's position (`joint.2.pos-fb`), `cfg=ff`; with `-t` the sample's number stands before
//! them. Further pins may follow. It writes `overrun` where it lost samples. LinuxCNC resets the revolutions at the
//! spindle's index: from there they are counted on. Rows are one interpolation period of the machine apart.
//!
//! A [`DriveLog`] is a trace with the drives' efforts, from which a machine is identified.
//!
//! In all formats an empty line is nothing, and a field that is empty or not a number (`nan`) is a reading that is
//! missing. A time that goes back begins a new recording, a time that stays is a repeated row. A reading that no
//! machine with these [limits](super::plausibility) can show is [`Corrupt`]: it is no sample, and no hole of its
//! recording is passed.
//!
//! A file is read row by row and field by field: neither its length nor its width takes memory.

mod drive_log;
mod fault;
mod found;
mod headings;
mod layout;
mod reader;
mod row;
mod table;

use std::io::{Read, Seek};

pub use drive_log::DriveLog;
pub use fault::{RecordingError, RecordingErrorKind};
pub use found::{Context, Corrupt, Corruption, Format, Recording};

use super::map::Map;
use super::sample::{Sample, Scale};

use layout::Layout;
use reader::Reader;
use table::Table;

/// Steps of time that are looked at for the usual one.
const STEPS: usize = 100_000;

/// A recording that can be read, any number of times.
pub struct RecordingFile<'a, R> {
    table: Table<R>,
    layout: Layout,
    period_s: f64,
    context: &'a Context,
}

impl<'a, R: Read + Seek> RecordingFile<'a, R> {
    /// Finds out which format it has, and the usual step of its time.
    ///
    /// # Errors
    /// [`RecordingError`]: the first thing in the beginning of the file that cannot be.
    ///
    /// ```
    /// use rigidtap::control::machine::Machine;
    /// use rigidtap::link::{plausibility::Limits, recording::{Context, RecordingFile}, sample::Scale};
    /// let machine = Machine::reference();
    /// let context = Context { scale: Scale::of(&machine), period_s: 0.001, limits: Limits::of(&machine) };
    /// let map = "time=t[ms],spindle=a[deg],z=b[mm]".parse().unwrap();
    /// let text = std::io::Cursor::new(b"t,a,b\n0,0,5\n1,36,4.9\n3,72,4.8\n");
    /// let mut file = RecordingFile::new(text, Some(&map), &context).unwrap();
    /// let mut samples = Vec::new();
    /// let found = file.read(&mut |sample| samples.push(sample)).unwrap();
    /// assert_eq!((samples.len(), found.gaps, found.missing, found.corrupt), (3, 1, 1, 0));
    /// let wrong = std::io::Cursor::new(b"t,a,b\n0,x,5\n");
    /// let wrong = RecordingFile::new(wrong, Some(&map), &context).err().unwrap();
    /// assert_eq!((wrong.line, wrong.column), (2, 3));
    /// ```
    pub fn new(source: R, map: Option<&Map>, context: &'a Context) -> Result<Self, RecordingError> {
        let mut table = Table::new(source)?;
        let layout = Layout::of(&mut table, map, context)?;
        let mut file = Self { table, layout, period_s: context.period_s, context };
        let (mut before, mut steps) = (None::<f64>, Vec::new());
        file.pass(STEPS, &mut |sample| {
            steps.extend(before.map(|before| sample.time_s - before).filter(|step_s| *step_s > 0.0));
            before = Some(sample.time_s);
        })?;
        if !steps.is_empty() {
            let middle = (steps.len() - 1) / 2;
            file.period_s = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        }
        Ok(file)
    }

    /// What the samples' counts are.
    pub fn scale(&self) -> Scale {
        self.layout.scale
    }

    /// Reads it from its beginning.
    ///
    /// # Errors
    /// [`RecordingError`]: the first thing in the file that cannot be.
    pub fn read(&mut self, sink: &mut dyn FnMut(Sample)) -> Result<Recording, RecordingError> {
        let found = self.pass(usize::MAX, sink)?;
        if found.readings == 0 && found.corrupt == 0 {
            return Err(RecordingError { kind: RecordingErrorKind::Empty, line: 1, column: 1 });
        }
        Ok(found)
    }

    fn pass(&mut self, most_rows: usize, sink: &mut dyn FnMut(Sample)) -> Result<Recording, RecordingError> {
        let Self { table, layout, period_s, context } = self;
        table.rewind()?;
        let mut row = layout.row();
        if layout.headed {
            table.next_row(&mut row)?;
        }
        let mut reader = Reader::new(layout.clone(), *period_s, context);
        let mut rows = 0;
        while rows < most_rows && table.next_row(&mut row)? {
            rows += 1;
            reader.read(&row)?.into_iter().for_each(&mut *sink);
        }
        Ok(reader.finish())
    }
}
