//! The trace of real encoders: the columns of a simulated one, those that no encoder knows left empty.

use std::io;
use std::path::Path;

use super::analysis::MeasuredRow;
use super::atomic_file::AtomicFile;
use super::trace::COLUMNS;
use crate::control::sync::spindle_rev_from_error_um;
use crate::link::sample::Scale;

/// Writes rows to a file, which appears whole or not at all.
pub struct MeasuredTrace {
    csv: csv::Writer<AtomicFile>,
    pitch_mm: f64,
    scale: Scale,
    /// The first error; nothing is written after it.
    failed: Option<io::Error>,
}

impl MeasuredTrace {
    /// Opens the file.
    ///
    /// # Errors
    /// Where it cannot be created.
    pub fn create(path: &Path, pitch_mm: f64, scale: Scale) -> io::Result<Self> {
        let mut csv = csv::Writer::from_writer(AtomicFile::create(path)?);
        csv.write_record(COLUMNS)?;
        Ok(Self { csv, pitch_mm, scale, failed: None })
    }

    /// Takes one row.
    pub fn push(&mut self, row: &MeasuredRow) {
        if self.failed.is_none() {
            self.failed = self.csv.write_record(self.fields(row)).err().map(io::Error::from);
        }
    }

    fn fields(&self, row: &MeasuredRow) -> [String; COLUMNS.len()] {
        let counts_per_rev = self.scale.counts_per_rev;
        COLUMNS.map(|column| match column {
            "program" => "1".into(),
            "k" => row.sample.k.to_string(),
            "time_s" => format!("{:.6}", row.sample.time_s),
            "hole" => row.hole.to_string(),
            "stroke" => row.kind.map_or("rapid", |kind| kind.name()).into(),
            "spindle_encoder_counts" => row.sample.spindle_counts.to_string(),
            "z_encoder_counts" => row.sample.z_counts.to_string(),
            "error_pulses" => row.error_um.map_or_else(String::new, |error_um| {
                format!("{:.3}", spindle_rev_from_error_um(error_um, self.pitch_mm) * counts_per_rev)
            }),
            "error_um" => row.error_um.map_or_else(String::new, |error_um| format!("{error_um:.3}")),
            _ => String::new(),
        })
    }

    /// The written file; it still has to be kept.
    ///
    /// # Errors
    /// The first error in writing.
    pub fn finish(self) -> io::Result<AtomicFile> {
        if let Some(error) = self.failed {
            return Err(error);
        }
        self.csv.into_inner().map_err(|error| io::Error::other(error.to_string()))
    }
}
