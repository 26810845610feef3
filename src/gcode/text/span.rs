//! Where something stands in a program's text.

use std::ops::Range;

/// Longest block in bytes. No control takes a hundredth of it; what is longer is no program.
pub const MAX_BLOCK_BYTES: usize = 64 * 1024;

/// Byte range in the source, counted from the start of the file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Span {
    /// First byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// The same as a standard range.
    #[must_use]
    pub const fn range(self) -> Range<usize> {
        self.start..self.end
    }
}

/// Byte range inside one block. Blocks are short, so that half the space does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) start: u32,
    pub(crate) end: u32,
}

impl Place {
    pub(crate) const fn new(start: usize, end: usize) -> Self {
        Self { start: start as u32, end: end as u32 }
    }

    /// Its bytes of the block.
    pub(crate) fn text(self, block: &[u8]) -> &[u8] {
        block.get(self.start as usize..self.end as usize).unwrap_or_default()
    }

    /// The place in the file of a block that starts at `block_offset`.
    pub(crate) const fn span(self, block_offset: usize) -> Span {
        Span { start: block_offset + self.start as usize, end: block_offset + self.end as usize }
    }

    /// Column from 1 of the place in a block, in characters as an editor shows them; each byte that is no UTF-8 is one.
    pub(crate) fn column(self, block: &[u8]) -> u32 {
        if self.start == 0 {
            return 1;
        }
        let before = block.get(..self.start as usize).unwrap_or(block);
        let width = |chunk: std::str::Utf8Chunk<'_>| chunk.valid().chars().count() + chunk.invalid().len();
        1 + before.utf8_chunks().map(width).sum::<usize>() as u32
    }
}

/// One line of a program without its line end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Line<'a> {
    /// Counted from 1.
    pub number: u32,
    /// Byte offset of its start in the source.
    pub offset: usize,
    /// Its bytes.
    pub text: &'a [u8],
}

impl Line<'_> {
    pub(crate) const fn start(&self) -> Cursor {
        Cursor { offset: self.offset, number: self.number }
    }
}

/// A line's start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Cursor {
    pub(crate) offset: usize,
    /// Number of that line.
    pub(crate) number: u32,
}

/// Splits a source at LF, CR LF or CR; a byte order mark at the start is left out.
///
/// ```
/// let lines: Vec<_> = rigidtap::gcode::lines(b"G0\r\nX1").map(|l| (l.number, l.offset, l.text)).collect();
/// assert_eq!(lines, [(1, 0, &b"G0"[..]), (2, 4, b"X1")]);
/// ```
pub fn lines(source: &[u8]) -> impl Iterator<Item = Line<'_>> {
    let start = if source.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
    let mut next = Cursor { offset: start, number: 1 };
    std::iter::from_fn(move || {
        let Cursor { offset, number } = next;
        let rest = source.get(offset..).filter(|rest| !rest.is_empty())?;
        let (length, end) = line_length(rest).unwrap_or((rest.len(), 0));
        next = Cursor { offset: offset + length + end, number: number.saturating_add(1) };
        Some(Line { number, offset, text: rest.get(..length).unwrap_or_default() })
    })
}

/// Lengths of the first line and of its end; none where the bytes hold no end of a line.
pub(crate) fn line_length(bytes: &[u8]) -> Option<(usize, usize)> {
    let length = memchr::memchr2(b'\n', b'\r', bytes)?;
    let end = if bytes.get(length..).unwrap_or_default().starts_with(b"\r\n") { 2 } else { 1 };
    Some((length, end))
}

/// UTF-8's mark at the start of a file, which some editors write.
pub(crate) const BYTE_ORDER_MARK: &[u8] = &[0xEF, 0xBB, 0xBF];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_end() {
        let source = b"\xEF\xBB\xBFa\nb\r\n\rc";
        let found: Vec<_> = lines(source).map(|l| (l.number, l.offset, l.text)).collect();
        assert_eq!(found, [(1, 3, &b"a"[..]), (2, 5, b"b"), (3, 8, b""), (4, 9, b"c")]);
        assert_eq!(lines(b"").count(), 0);
    }
}
