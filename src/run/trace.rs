//! The trace: one CSV row per period. The loop hands rows to a ring buffer, a thread of its own writes them.

use std::io;
use std::path::Path;
use std::thread::JoinHandle;
use std::time::Duration;

use ringbuf::HeapRb;
use ringbuf::traits::{Consumer, Observer, Producer, Split};

use super::atomic_file::AtomicFile;
use super::row::Row;
use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::sync::spindle_rev_from_error_um;

/// Rows that the buffer holds: some seconds of a machine's time.
const CAPACITY: usize = 4096;
/// How long either side waits where the other one is behind.
const WAIT: Duration = Duration::from_micros(200);

/// The columns, in order.
pub const COLUMNS: [&str; 25] = [
    "program",
    "k",
    "time_s",
    "hole",
    "stroke",
    "phase",
    "x_command_mm",
    "y_command_mm",
    "spindle_command_rev",
    "spindle_rev",
    "spindle_rpm",
    "spindle_torque_nm",
    "torque_saturated",
    "spindle_encoder_counts",
    "z_command_mm",
    "z_mm",
    "z_encoder_counts",
    "z_motor_counts",
    "z_force_n",
    "spindle_following_error_rev",
    "z_following_error_um",
    "correction_um",
    "error_pulses",
    "error_um",
    "true_error_um",
];

/// A row with the number of its program, from 1, and its pitch, 0 outside holes.
#[derive(Clone, Copy, Debug)]
struct Entry {
    program: u32,
    pitch_mm: f64,
    row: Row,
}

/// Writes rows to a file, which appears whole or not at all.
pub struct TraceWriter {
    producer: ringbuf::HeapProd<Entry>,
    writer: JoinHandle<io::Result<AtomicFile>>,
}

impl TraceWriter {
    /// Opens the file and starts the writing thread.
    ///
    /// # Errors
    /// Where the file cannot be created.
    pub fn create(path: &Path, machine: &Machine) -> io::Result<Self> {
        let file = AtomicFile::create(path)?;
        let counts_per_rev = machine.spec().spindle.encoder_counts_per_rev;
        let (producer, consumer) = HeapRb::new(CAPACITY).split();
        let writer = std::thread::Builder::new()
            .name("trace".into())
            .spawn(move || write_all(consumer, file, counts_per_rev))?;
        Ok(Self { producer, writer })
    }

    /// Takes in one row of a program (from 1). Waits where the writer is behind: a simulation loses no row.
    pub fn push(&mut self, program: u32, pitch_mm: f64, row: &Row) {
        let mut entry = Entry { program, pitch_mm, row: *row };
        while let Err(back) = self.producer.try_push(entry) {
            if !self.producer.read_is_held() {
                // The writer failed; `finish` tells why.
                return;
            }
            entry = back;
            std::thread::sleep(WAIT);
        }
    }

    /// Waits for the last row to be written; the file still has to be kept.
    ///
    /// # Errors
    /// The first error in writing.
    pub fn finish(self) -> io::Result<AtomicFile> {
        drop(self.producer);
        match self.writer.join() {
            Ok(file) => file,
            Err(panic) => std::panic::resume_unwind(panic),
        }
    }
}

fn write_all(mut rows: ringbuf::HeapCons<Entry>, file: AtomicFile, counts_per_rev: f64) -> io::Result<AtomicFile> {
    let mut csv = csv::Writer::from_writer(file);
    csv.write_record(COLUMNS)?;
    loop {
        // Asked before looking: what was pushed before the end is then surely seen.
        let more = rows.write_is_held();
        let mut idle = true;
        while let Some(entry) = rows.try_pop() {
            csv.write_record(fields(&entry, counts_per_rev))?;
            idle = false;
        }
        if !more {
            break;
        }
        if idle {
            std::thread::sleep(WAIT);
        }
    }
    csv.into_inner().map_err(|error| io::Error::other(error.to_string()))
}

fn fields(entry: &Entry, counts_per_rev: f64) -> [String; COLUMNS.len()] {
    let Entry { program, pitch_mm, row } = entry;
    let Row { setpoint, feedback, truth, .. } = row;
    let place = |state: &State| format!("{:.6}", state.position);
    let known = |value: Option<f64>, digits: usize| value.map_or_else(String::new, |value| format!("{value:.digits$}"));
    let pulses = row.error_um.map(|error_um| spindle_rev_from_error_um(error_um, *pitch_mm) * counts_per_rev);
    [
        program.to_string(),
        row.k.to_string(),
        format!("{:.6}", row.time_s),
        row.hole.to_string(),
        row.stage.name().into(),
        row.phase.to_string(),
        place(&setpoint.x),
        place(&setpoint.y),
        format!("{:.9}", setpoint.spindle.position),
        known(truth.map(|truth| truth.spindle_rev), 9),
        known(truth.map(|truth| truth.spindle_rpm), 3),
        known(feedback.spindle_torque_nm, 4),
        feedback.spindle.saturated.map_or_else(String::new, |saturated| u8::from(saturated).to_string()),
        feedback.spindle_counts.to_string(),
        place(&setpoint.z),
        known(truth.map(|truth| truth.z_mm), 6),
        feedback.z_counts.to_string(),
        feedback.z_motor_counts.map_or_else(String::new, |counts| counts.to_string()),
        known(feedback.z_force_n, 2),
        format!("{:.9}", row.spindle_following_error_rev),
        format!("{:.3}", row.z_following_error_um),
        format!("{:.3}", row.correction_um),
        known(pulses, 3),
        known(row.error_um, 3),
        known(row.true_error_um, 3),
    ]
}
