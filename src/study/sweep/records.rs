//! The machines of a sweep one after the other, from memory while they are few and from files where they are many.

use std::io::{self, BufReader, Read, Seek, SeekFrom, Write};
use std::path::Path;

use tempfile::SpooledTempFile;

use super::machine_run::draw;
use super::record::{decode, encode, record_bytes};
use super::settings::SweepSettings;
use super::swept_machine::SweptMachine;
use crate::sim::Actual;

/// Records up to so many bytes stay in memory.
const IN_MEMORY: usize = 64 << 20;

/// Where records can be read again.
pub(super) trait ReadSeek: Read + Seek {}

impl<T: Read + Seek> ReadSeek for T {}

/// Records of machines with consecutive numbers.
pub(super) struct Stretch {
    pub(super) from: Box<dyn ReadSeek>,
    /// Where the first record begins.
    pub(super) at: u64,
    /// Number of the first machine, from 1.
    pub(super) first_run: u32,
    pub(super) machines: u32,
}

/// Records that are being written.
pub(super) struct RecordWriter {
    spool: SpooledTempFile,
    bytes: Vec<u8>,
    settings: SweepSettings,
    machines: u32,
}

impl RecordWriter {
    /// Where memory does not do, the records lie in a nameless file of this folder.
    pub(super) fn new(settings: &SweepSettings, folder: &Path) -> Self {
        let spool = tempfile::spooled_tempfile_in(IN_MEMORY, folder);
        Self { spool, bytes: Vec::new(), settings: *settings, machines: 0 }
    }

    pub(super) fn add(&mut self, machine: &SweptMachine) -> io::Result<()> {
        self.bytes.clear();
        encode(machine, &self.settings, &mut self.bytes);
        self.machines += 1;
        self.spool.write_all(&self.bytes)
    }

    pub(super) fn finish(mut self, first_run: u32) -> io::Result<Stretch> {
        self.spool.flush()?;
        Ok(Stretch { from: Box::new(self.spool), at: 0, first_run, machines: self.machines })
    }
}

/// All machines of a sweep, or of a part of one.
pub(super) struct Records {
    stretches: Vec<Stretch>,
    settings: SweepSettings,
    nominal: Actual,
}

impl Records {
    pub(super) fn new(stretches: Vec<Stretch>, settings: &SweepSettings, nominal: Actual) -> Self {
        Self { stretches, settings: *settings, nominal }
    }

    pub(super) fn machines(&self) -> u64 {
        self.stretches.iter().map(|stretch| u64::from(stretch.machines)).sum()
    }

    /// Each machine in the order of their numbers.
    pub(super) fn each(&mut self, see: &mut dyn FnMut(&SweptMachine)) -> io::Result<()> {
        let (settings, nominal) = (self.settings, self.nominal);
        self.each_outcome(&mut |outcome| {
            let (actual, seed) = draw(&settings, nominal, outcome.run);
            see(&SweptMachine { actual, seed, ..*outcome });
        })
    }

    /// The same without what was drawn, and quicker: seed and deviations are those of no machine.
    pub(super) fn each_outcome(&mut self, see: &mut dyn FnMut(&SweptMachine)) -> io::Result<()> {
        let mut record = vec![0; record_bytes(&self.settings)];
        for stretch in &mut self.stretches {
            stretch.from.seek(SeekFrom::Start(stretch.at))?;
            let mut from = BufReader::with_capacity(1 << 16, &mut stretch.from);
            for run in (stretch.first_run..).take(stretch.machines as usize) {
                from.read_exact(&mut record)?;
                let machine = decode(&record, &self.settings, run, 0, self.nominal);
                see(&machine.ok_or_else(|| io::Error::new(io::ErrorKind::InvalidData, "damaged record"))?);
            }
        }
        Ok(())
    }

    /// What was drawn of each machine, with its outcome, for machines of which `of` says yes.
    pub(super) fn each_of(
        &mut self,
        of: &mut dyn FnMut(&SweptMachine) -> bool,
        see: &mut dyn FnMut(&SweptMachine),
    ) -> io::Result<()> {
        let (settings, nominal) = (self.settings, self.nominal);
        self.each_outcome(&mut |outcome| {
            if of(outcome) {
                let (actual, seed) = draw(&settings, nominal, outcome.run);
                see(&SweptMachine { actual, seed, ..*outcome });
            }
        })
    }

    /// Writes the records as they are.
    pub(super) fn copy(&mut self, to: &mut dyn Write) -> io::Result<()> {
        let size = record_bytes(&self.settings) as u64;
        for stretch in &mut self.stretches {
            stretch.from.seek(SeekFrom::Start(stretch.at))?;
            io::copy(&mut (&mut stretch.from).take(size * u64::from(stretch.machines)), to)?;
        }
        Ok(())
    }
}
