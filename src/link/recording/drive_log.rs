//! A recording that has the drives' efforts beside the encoders: the trace of `simulate`, or a real machine's.

use super::headings::DRIVE;
use super::row::{RecordingError, RecordingErrorKind, Row, rows};
use crate::control::machine::Machine;
use crate::control::port::{AxisStatus, Feedback};

/// Rows may be this share of a period off.
const TIME_SHARE: f64 = 0.5;

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
    fn of(head: &Row<'_>) -> Result<Self, RecordingError> {
        let at = |name: &str| head.fields().position(|field| field == name);
        let needed =
            |name: &'static str| at(name).ok_or_else(|| head.fault(RecordingErrorKind::NoDriveHeading(name), 1));
        let [time, z, force] = DRIVE;
        Ok(Self {
            time: needed(time)?,
            z: needed(z)?,
            force: needed(force)?,
            z_motor: at("z_motor_counts"),
            spindle: at("spindle_encoder_counts"),
            torque: at("spindle_torque_nm"),
            saturated: at("torque_saturated"),
        })
    }

    /// Time and feedback of a row; none where a reading is missing.
    fn read(&self, row: &Row<'_>) -> Result<Option<(f64, Feedback)>, RecordingError> {
        let optional = |column: Option<usize>| column.map_or(Ok(None), |column| row.number(column));
        let (time_s, z) = (row.number(self.time)?, row.number(self.z)?);
        let force_n = row.number(self.force)?;
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
    /// let text = b"time_s,z_encoder_counts,z_force_n\n0,0,1\n0.001,5,9\n0.002,9,10\n0.004,20,11\n";
    /// let log = DriveLog::read(text, &Machine::reference()).unwrap();
    /// assert_eq!((log.readings, log.feedback.len(), log.feedback[1].z_force_n), (4, 3, Some(9.0)));
    /// let wrong = DriveLog::read(b"time_s,z_encoder_counts\n", &Machine::reference()).unwrap_err();
    /// assert_eq!((wrong.line, wrong.column), (1, 1));
    /// ```
    pub fn read(bytes: &[u8], machine: &Machine) -> Result<Self, RecordingError> {
        let text = String::from_utf8_lossy(bytes);
        let mut rows = rows(&text);
        let nothing = RecordingError { kind: RecordingErrorKind::Empty, line: 1, column: 1 };
        let head = rows.next().ok_or(nothing.clone())?;
        let columns = Columns::of(&head)?;
        let expected_s = machine.spec().control.period_s;
        let mut stretches = vec![Vec::new()];
        let mut before: Option<f64> = None;
        let (mut readings, mut steps, mut period_steps) = (0, Vec::new(), 0);
        let mut second_line = None;
        for row in rows {
            let read = columns.read(&row)?;
            let step_s = read.as_ref().zip(before).map(|((time_s, _), before)| time_s - before);
            before = read.as_ref().map(|(time_s, _)| *time_s);
            let goes_on = step_s.is_some_and(|step_s| (step_s / expected_s - 1.0).abs() < TIME_SHARE);
            if let Some(step_s) = step_s.filter(|step_s| *step_s > 0.0) {
                second_line.get_or_insert(row.number);
                steps.push(step_s);
                period_steps += usize::from(goes_on);
            }
            if !goes_on {
                stretches.push(Vec::new());
            }
            if let (Some((_, feedback)), Some(stretch)) = (read, stretches.last_mut()) {
                readings += 1;
                stretch.push(feedback);
            }
        }
        if let Some(line) = second_line.filter(|_| 2 * period_steps < steps.len()) {
            let middle = (steps.len() - 1) / 2;
            let found_s = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
            return Err(RecordingError { kind: RecordingErrorKind::Period { found_s, expected_s }, line, column: 1 });
        }
        let longest = stretches.into_iter().max_by_key(Vec::len).filter(|stretch| !stretch.is_empty());
        Ok(Self { feedback: longest.ok_or(nothing)?, readings })
    }
}
