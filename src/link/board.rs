//! A stand-in for the board: samples as frames, in real time or as fast as the line takes them.

use std::io::{self, Write};
use std::time::{Duration, Instant};

use super::frame::{Count, Frame, MAX_ENCODED, Status};

/// What one reading is before it becomes a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reading {
    /// Spindle counts.
    pub spindle_counts: i64,
    /// Z counts.
    pub z_counts: i64,
}

/// Makes frames of readings, one period after another.
#[derive(Clone, Debug)]
pub struct Encoder {
    period_us: f64,
    bits: u8,
    sequence: u64,
}

impl Encoder {
    /// For readings this far apart, and counters of so many bits: 2 to 63, others are taken to the nearest.
    #[must_use]
    pub fn new(period_s: f64, bits: u8) -> Self {
        Self { period_us: period_s * 1e6, bits: bits.clamp(2, 63), sequence: 0 }
    }

    /// The next reading on the line; its length.
    pub fn encode(&mut self, reading: Reading, line: &mut [u8; MAX_ENCODED]) -> usize {
        let count = |counts: i64| Count::new(self.bits, counts);
        let (Some(spindle), Some(z)) = (count(reading.spindle_counts), count(reading.z_counts)) else { return 0 };
        let frame = Frame {
            status: if self.sequence == 0 { Status::START } else { Status::default() },
            // Both wrap, as a board's do.
            sequence: self.sequence as u32,
            time_us: (self.sequence as f64 * self.period_us).round() as u64 as u32,
            spindle,
            z,
        };
        self.sequence += 1;
        frame.encode(line)
    }
}

/// Sends readings in real time; what the line does not take is lost, as a board's is. Returns how many were.
///
/// # Errors
/// Where the line is gone.
pub fn stream(
    readings: impl Iterator<Item = Reading>,
    period: Duration,
    encoder: &mut Encoder,
    line: &mut impl Write,
) -> io::Result<u64> {
    let start = Instant::now();
    let mut lost = 0;
    for (number, reading) in (0u32..).zip(readings) {
        let due = period.saturating_mul(number);
        if let Some(wait) = due.checked_sub(start.elapsed()) {
            std::thread::sleep(wait);
        }
        let mut bytes = [0; MAX_ENCODED];
        let length = encoder.encode(reading, &mut bytes);
        match line.write_all(&bytes[..length]) {
            Ok(()) => {}
            Err(error) if matches!(error.kind(), io::ErrorKind::TimedOut | io::ErrorKind::WouldBlock) => lost += 1,
            Err(error) => return Err(error),
        }
    }
    Ok(lost)
}
