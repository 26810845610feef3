//! A part's file: one line of JSON, the machines' records, eight bytes of checksum.

use std::collections::BTreeMap;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};

use serde::{Deserialize, Serialize};
use serde_json::{Number, Value};

use super::fault::PartFault;
use super::identity::{CRC, Identity};
use super::shard::Shard;
use crate::sim::{Actual, ActualValue};
use crate::study::sweep::machine_run::draw;
use crate::study::sweep::record::record_bytes;
use crate::study::sweep::records::{ReadSeek, Records, Stretch};
use crate::study::sweep::settings::SweepSettings;
use crate::study::sweep::summary::{Counts, Extremes};
use crate::study::sweep::swept_machine::SweptMachine;

const FORMAT: &str = "rigidtap sweep part";
const FORMAT_VERSION: u32 = 1;
/// The head of a sound part is far shorter: a longer first line is no part's.
const LONGEST_HEAD: u64 = 1 << 20;
const CRC_BYTES: u64 = 8;

/// The first line.
#[derive(Debug, Deserialize, Serialize)]
pub(super) struct Head {
    format: String,
    format_version: u32,
    #[serde(flatten)]
    pub(super) identity: Identity,
    shard: u32,
    of: u32,
    pub(super) first_run: u32,
    pub(super) machines: u32,
    record_bytes: usize,
    counts: BTreeMap<String, u32>,
    /// Least and greatest of each number over the machines; null for what is no finite number.
    extremes: BTreeMap<String, [Option<f64>; 2]>,
    /// The worst machines whole, the worst first.
    worst: Vec<WholeMachine>,
}

/// A machine with all that was drawn of it.
#[derive(Debug, Deserialize, PartialEq, Serialize)]
struct WholeMachine {
    run: u32,
    seed: u64,
    worst_um: Option<f64>,
    actual: BTreeMap<String, Value>,
}

fn actual_values(actual: &Actual) -> BTreeMap<String, Value> {
    let value = |value| match value {
        ActualValue::Number(number) => number.and_then(Number::from_f64).map_or(Value::Null, Value::Number),
        ActualValue::Word(word) => Value::String(word.to_owned()),
        ActualValue::Switch(on) => Value::Bool(on),
    };
    actual.values().into_iter().map(|(key, found)| (key.to_owned(), value(found))).collect()
}

impl Head {
    pub(super) fn shard(&self) -> Option<Shard> {
        Shard::new(self.shard, self.of)
    }

    pub(super) fn last_run(&self) -> u32 {
        self.first_run.saturating_add(self.machines).saturating_sub(1)
    }
}

/// Writes a part.
pub(super) fn write(
    to: &mut dyn Write,
    identity: Identity,
    shard: Shard,
    settings: &SweepSettings,
    records: &mut Records,
    (counts, extremes, worst): (&Counts, &Extremes, &[SweptMachine]),
) -> io::Result<()> {
    let finite = |value: f64| Some(value).filter(|value| value.is_finite());
    let runs = shard.runs(settings.runs);
    let head = Head {
        format: FORMAT.to_owned(),
        format_version: FORMAT_VERSION,
        identity,
        shard: shard.number(),
        of: shard.of(),
        first_run: *runs.start(),
        machines: counts.machines,
        record_bytes: record_bytes(settings),
        counts: counts.named().map(|(name, count)| (name.to_owned(), count)).into(),
        extremes: extremes.named().map(|(name, ends)| (name.to_owned(), ends.map(finite))).into(),
        worst: worst
            .iter()
            .map(|machine| WholeMachine {
                run: machine.run,
                seed: machine.seed,
                worst_um: finite(machine.first.worst_um),
                actual: actual_values(&machine.actual),
            })
            .collect(),
    };
    let mut to = Summed { to, digest: CRC.digest() };
    serde_json::to_writer(&mut to, &head)?;
    to.write_all(b"\n")?;
    records.copy(&mut to)?;
    let Summed { to, digest } = to;
    to.write_all(&digest.finalize().to_le_bytes())
}

/// Counts what is written into the checksum.
struct Summed<'a> {
    to: &'a mut dyn Write,
    digest: crc::Digest<'static, u64>,
}

impl Write for Summed<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.to.write(bytes)?;
        self.digest.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.to.flush()
    }
}

/// Reads a part's head, checks that the file is whole and that this program draws the machines that the head keeps.
pub(super) fn read(
    mut from: Box<dyn ReadSeek>,
    expected: &Identity,
    settings: &SweepSettings,
    nominal: Actual,
) -> Result<(Head, Stretch), PartFault> {
    let unreadable = |error: io::Error| PartFault::Unreadable(error.to_string());
    let mut line = Vec::new();
    BufReader::new(&mut from).take(LONGEST_HEAD).read_until(b'\n', &mut line).map_err(unreadable)?;
    // Format first: what another version wrote may have another head.
    let any: Value = serde_json::from_slice(&line).map_err(|_| PartFault::NoPart)?;
    if any.get("format").and_then(Value::as_str) != Some(FORMAT) {
        return Err(PartFault::NoPart);
    }
    let version = any.get("format_version").and_then(Value::as_u64).unwrap_or(0);
    if version != u64::from(FORMAT_VERSION) {
        return Err(PartFault::Format { found: version, expected: FORMAT_VERSION });
    }
    let head: Head = serde_json::from_value(any).map_err(|_| PartFault::Damaged)?;
    if let Some((what, found, expected)) = expected.difference(&head.identity) {
        return Err(PartFault::Other { what, found, expected });
    }
    let at = line.len() as u64;
    let records = head.record_bytes as u64 * u64::from(head.machines);
    let length = from.seek(SeekFrom::End(0)).map_err(unreadable)?;
    let runs = head.shard().map(|shard| shard.runs(settings.runs));
    let sound = head.record_bytes == record_bytes(settings)
        && runs.is_some_and(|runs| (*runs.start(), *runs.end()) == (head.first_run, head.last_run()))
        && length == at + records + CRC_BYTES;
    if !sound || !is_whole(&mut from, length).map_err(unreadable)? {
        return Err(PartFault::Damaged);
    }
    for kept in &head.worst {
        let (actual, seed) = draw(settings, nominal, kept.run);
        if (seed, actual_values(&actual)) != (kept.seed, kept.actual.clone()) {
            return Err(PartFault::DrawnOtherwise { run: kept.run });
        }
    }
    let (first_run, machines) = (head.first_run, head.machines);
    Ok((head, Stretch { from, at, first_run, machines }))
}

/// Whether the checksum at the end is that of what stands before it.
fn is_whole(from: &mut dyn ReadSeek, length: u64) -> io::Result<bool> {
    from.seek(SeekFrom::Start(0))?;
    let mut digest = CRC.digest();
    let mut left = length.saturating_sub(CRC_BYTES);
    let mut bytes = vec![0; 1 << 16];
    while left > 0 {
        let block = bytes.get_mut(..left.min(1 << 16) as usize).unwrap_or_default();
        from.read_exact(block)?;
        digest.update(block);
        left -= block.len() as u64;
    }
    let mut sum = [0; CRC_BYTES as usize];
    from.read_exact(&mut sum)?;
    Ok(u64::from_le_bytes(sum) == digest.finalize())
}
