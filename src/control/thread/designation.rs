//! Threads by their designation, as people write it.

use super::sizes::SIZES;
use super::standard::{Series, StandardThread, ThreadError};

/// Longest designation, with room for its blanks.
const LONGEST: usize = 24;

/// Taper threads, and what they are to be told from: NPSM and the like are parallel and not in the list.
const TAPERED: [&[u8]; 5] = [b"NPT", b"NPTF", b"BSPT", b"RC", b"PT"];

/// A designation in capitals: blanks and `-` between digits are one `-`, `*` is `X`, and `#` and the degree sign are gone.
struct Folded {
    bytes: [u8; LONGEST],
    length: usize,
}

impl Folded {
    fn of(written: &str) -> Option<Self> {
        let mut folded = Self { bytes: [0; LONGEST], length: 0 };
        let mut gap = false;
        for byte in written.trim().bytes() {
            match byte.to_ascii_uppercase() {
                b'#' => {}
                b' ' | b'-' | b'_' => gap = true,
                byte => {
                    let byte = if byte == b'*' { b'X' } else { byte };
                    let joins = folded.text().last().is_some_and(u8::is_ascii_digit) && byte.is_ascii_digit();
                    if core::mem::take(&mut gap) && joins {
                        folded.push(b'-')?;
                    }
                    folded.push(byte)?;
                }
            }
        }
        Some(folded)
    }

    fn push(&mut self, byte: u8) -> Option<()> {
        *self.bytes.get_mut(self.length)? = byte;
        self.length += 1;
        Some(())
    }

    fn text(&self) -> &[u8] {
        self.bytes.get(..self.length).unwrap_or_default()
    }
}

/// The thread of a designation.
pub(super) fn parse(written: &str) -> Result<StandardThread, ThreadError> {
    let folded = Folded::of(written).ok_or(ThreadError::Unknown)?;
    let text = folded.text();
    let has = |mark: &&[u8]| text.starts_with(mark) || text.ends_with(mark);
    if TAPERED.iter().any(has) || (text.starts_with(b"R") && text.get(1).is_some_and(u8::is_ascii_digit)) {
        return Err(ThreadError::Tapered);
    }
    metric(text).or_else(|| inch(text)).ok_or(ThreadError::Unknown)
}

/// `M10`, `M10X1.25`, `M10X1.50`.
fn metric(text: &[u8]) -> Option<StandardThread> {
    let rest = core::str::from_utf8(text.strip_prefix(b"M")?).ok()?;
    let (diameter, pitch) = rest.split_once('X').map_or((rest, None), |(diameter, pitch)| (diameter, Some(pitch)));
    if !rest.bytes().all(|byte| byte.is_ascii_digit() || b".X".contains(&byte)) {
        return None;
    }
    let major_mm: f64 = diameter.parse().ok()?;
    let pitch_mm: Option<f64> = match pitch {
        Some(pitch) => Some(pitch.parse().ok()?),
        None => None,
    };
    let fits = |series: Series, known_mm: f64| match (series, pitch_mm) {
        (Series::MetricCoarse, None) => true,
        (Series::MetricCoarse | Series::MetricFine, Some(pitch_mm)) => pitch_mm == known_mm,
        _ => false,
    };
    SIZES.iter().find(|size| size.major_mm == major_mm && fits(size.series, size.pitch_mm)).map(|size| size.thread())
}

/// `1/4-28`, `1/4-28UNF`, `10-32`, `1-1/8-7`, `G1/8`, `1/4-20BSW`; the series may stand first, or be left out of UNC, UNF and
/// UNEF. A BSW has one pitch for each size, which may be left out.
fn inch(text: &[u8]) -> Option<StandardThread> {
    SIZES
        .iter()
        .find(|size| {
            let Some(known) = Folded::of(size.name) else { return false };
            let (known, series) = (known.text(), size.series.mark().as_bytes());
            let bare = known.strip_suffix(series).unwrap_or(known);
            let parts = |first: &[u8], second: &[u8]| {
                text.len() == first.len() + second.len() && text.starts_with(first) && text.ends_with(second)
            };
            match size.series {
                Series::MetricCoarse | Series::MetricFine => false,
                Series::Pipe => text == known || parts(b"BSPP", bare.strip_prefix(b"G").unwrap_or(bare)),
                Series::Whitworth => {
                    let alone = bare.iter().rposition(|&byte| byte == b'-').and_then(|at| bare.get(..at));
                    let alone = alone.unwrap_or(bare);
                    text == known || parts(series, bare) || parts(series, alone) || parts(alone, series)
                }
                Series::Unc | Series::Unf | Series::Unef => text == known || text == bare || parts(series, bare),
            }
        })
        .map(|size| size.thread())
}
