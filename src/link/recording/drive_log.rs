//! A recording that has the drives' efforts beside the encoders: the trace of `simulate`, or a real machine's.

use std::io::{Read, Seek};

use super::fault::{RecordingError, RecordingErrorKind};
use super::headings::DRIVE;
use super::row::Row;
use super::table::Table;
use crate::control::machine::Machine;
use crate::control::port::{AxisStatus, Feedback};

/// Rows may be this share of a period off.
const TIME_SHARE: f64 = 0.5;
/// Steps of time that the usual one is found among.
const MOST_STEPS: usize = 100_000;

/// What a machine reported, period by period, as far as it was recorded without a gap.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveLog {
    /// The longest unbroken stretch. What has no column, or nothing in its field, is `None`.
    pub feedback: Vec<Feedback>,
    /// Readings in the whole recording.
    pub readings: usize,
}

/// Where in a row everything stands.
struct Columns {
    time: usize,
    z: usize,
    force: usize,
    z_motor: Option<usize>,
    spindle: Option<usize>,
    torque: Option<usize>,
    saturated: Option<usize>,
}

impl Columns {
    fn of<R: Read + Seek>(table: &mut Table<R>) -> Result<Self, RecordingError> {
        let [time, z, force] = DRIVE;
        let others = ["z_motor_counts", "spindle_encoder_counts", "spindle_torque_nm", "torque_saturated"];
        let places = table.positions(&[&DRIVE[..], &others[..]].concat())?;
        let line = table.head_line();
        let at = |index: usize| places.get(index).copied().flatten();
        let needed = |index: usize, name: &'static str| {
            let kind = RecordingErrorKind::NoDriveHeading(name);
            at(index).ok_or(RecordingError { kind, line, column: 1 })
        };
        Ok(Self {
            time: needed(0, time)?,
            z: needed(1, z)?,
            force: needed(2, force)?,
            z_motor: at(3),
            spindle: at(4),
            torque: at(5),
            saturated: at(6),
        })
    }

    fn row(&self) -> Row {
        let optional = [self.z_motor, self.spindle, self.torque, self.saturated];
        Row::of([self.time, self.z, self.force].into_iter().chain(optional.into_iter().flatten()))
    }

    /// Time and feedback of a row; none where a reading is missing.
    fn read(&self, row: &Row) -> Result<Option<(f64, Feedback)>, RecordingError> {
        let number = |column: usize| row.number(column).map(|value| value.filter(|value| value.is_finite()));
        let optional = |column: Option<usize>| column.map_or(Ok(None), number);
        let (time_s, z) = (number(self.time)?, number(self.z)?);
        let force_n = number(self.force)?;
        let (z_motor, spindle) = (optional(self.z_motor)?, optional(self.spindle)?);
        let torque_nm = optional(self.torque)?;
        let saturated = optional(self.saturated)?.map(|flag| flag != 0.0);
        Ok(time_s.zip(z).map(|(time_s, z)| {
            let feedback = Feedback {
                spindle_counts: spindle.unwrap_or(0.0).round() as i64,
                z_counts: z.round() as i64,
                z_motor_counts: z_motor.map(|counts| counts.round() as i64),
                spindle_torque_nm: torque_nm,
                z_force_n: force_n,
                spindle: AxisStatus { saturated, ..AxisStatus::default() },
                z: AxisStatus::default(),
            };
            (time_s, feedback)
        }))
    }
}

impl DriveLog {
    /// Reads a recording whose rows are one interpolation period of the machine apart. A row that is missing, a field
    /// without a reading, and a time that goes back end an unbroken stretch.
    ///
    /// # Errors
    /// [`RecordingError`]: the first thing in the file that cannot be.
    ///
    /// ```
    /// use rigidtap::control::machine::Machine;
    /// use rigidtap::link::recording::DriveLog;
    /// let read = |text: &'static str| DriveLog::read(std::io::Cursor::new(text), &Machine::reference());
    /// let log = read("time_s,z_encoder_counts,z_force_n\n0,0,1\n0.001,5,9\n0.002,9,10\n0.004,20,11\n").unwrap();
    /// assert_eq!((log.readings, log.feedback.len(), log.feedback[1].z_force_n), (4, 3, Some(9.0)));
    /// let wrong = read("time_s,z_encoder_counts\n").unwrap_err();
    /// assert_eq!((wrong.line, wrong.column), (1, 1));
    /// ```
    pub fn read(source: impl Read + Seek, machine: &Machine) -> Result<Self, RecordingError> {
        let mut table = Table::new(source)?;
        let columns = Columns::of(&mut table)?;
        let expected_s = machine.spec().control.period_s;
        let (mut longest, mut stretch) = (Vec::new(), Vec::new());
        let mut before: Option<f64> = None;
        let (mut readings, mut steps, mut all_steps, mut period_steps) = (0, Vec::new(), 0usize, 0usize);
        let mut second_line = None;
        let mut row = columns.row();
        while table.next_row(&mut row)? {
            let read = columns.read(&row)?;
            let step_s = read.as_ref().zip(before).map(|((time_s, _), before)| time_s - before);
            before = read.as_ref().map(|(time_s, _)| *time_s);
            let goes_on = step_s.is_some_and(|step_s| (step_s / expected_s - 1.0).abs() < TIME_SHARE);
            if let Some(step_s) = step_s.filter(|step_s| *step_s > 0.0) {
                second_line.get_or_insert(row.number);
                if steps.len() < MOST_STEPS {
                    steps.push(step_s);
                }
                all_steps += 1;
                period_steps += usize::from(goes_on);
            }
            if !goes_on {
                longest = longer(longest, core::mem::take(&mut stretch));
            }
            if let Some((_, feedback)) = read {
                readings += 1;
                stretch.push(feedback);
            }
        }
        let longest = longer(longest, stretch);
        if let Some(line) = second_line.filter(|_| 2 * period_steps < all_steps) {
            let middle = (steps.len() - 1) / 2;
            let found_s = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
            return Err(RecordingError { kind: RecordingErrorKind::Period { found_s, expected_s }, line, column: 1 });
        }
        if longest.is_empty() {
            return Err(RecordingError { kind: RecordingErrorKind::Empty, line: 1, column: 1 });
        }
        Ok(Self { feedback: longest, readings })
    }
}

/// The later one of two that are alike: there the machine is warm.
fn longer(one: Vec<Feedback>, other: Vec<Feedback>) -> Vec<Feedback> {
    if other.len() >= one.len() { other } else { one }
}
