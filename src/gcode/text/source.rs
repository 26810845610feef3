//! A program's text, line by line and from any place again, in memory that does not grow with it.

use std::fmt;
use std::io::{self, Read, Seek, SeekFrom};

use super::appended::{Appended, Subprograms, Wanted};
use super::span::{BYTE_ORDER_MARK, Cursor, Line, MAX_BLOCK_BYTES, line_length};

/// Bytes kept. A loop that fits is not read from its file again.
const KEPT_BYTES: usize = 4 * MAX_BLOCK_BYTES;

/// A program's text: a file, or bytes in memory. It is read as it is needed, and again where a program jumps back.
pub struct Text<R> {
    reader: R,
    kept: Box<[u8]>,
    /// Where in the text the kept bytes begin.
    start: usize,
    /// How many there are.
    length: usize,
    /// The text ends where they do.
    ended: bool,
    /// The reader stands where they end.
    in_place: bool,
    error: Option<io::Error>,
    /// Files behind it.
    appended: Appended,
}

impl<'a> Text<io::Cursor<&'a [u8]>> {
    /// A text in memory.
    #[must_use]
    pub fn of(source: &'a [u8]) -> Self {
        Self::new(io::Cursor::new(source))
    }
}

impl<R: Read + Seek> Text<R> {
    /// The text from the reader's first byte to its last, wherever it stands now.
    ///
    /// ```
    /// use rigidtap::gcode::Text;
    /// let mut numbers = Vec::new();
    /// Text::of(b"G0\r\nX1").for_each(|line| {
    ///     numbers.push((line.number, line.offset));
    ///     true
    /// });
    /// assert_eq!(numbers, [(1, 0), (2, 4)]);
    /// ```
    pub fn new(reader: R) -> Self {
        let kept = vec![0; KEPT_BYTES].into_boxed_slice();
        Self {
            reader,
            kept,
            start: 0,
            length: 0,
            ended: false,
            in_place: false,
            error: None,
            appended: Appended::default(),
        }
    }

    /// With a source of the subprograms that it calls and does not hold.
    #[must_use]
    pub fn with_subprograms(mut self, source: Box<dyn Subprograms>) -> Self {
        self.appended.source = Some(source);
        self
    }

    /// Name and bytes of the file of a subprogram that holds a place, and where it begins; none of the program's own text.
    #[must_use]
    pub fn subprogram(&self, offset: usize) -> Option<(&str, &[u8], usize)> {
        self.appended.part(offset).map(|(part, start)| (part.name.as_str(), part.bytes.as_slice(), start))
    }

    /// Whether a place is in the file of a subprogram.
    pub(crate) fn is_appended(&self, offset: usize) -> bool {
        !self.appended.parts.is_empty() && self.appended.part(offset).is_some()
    }

    /// Where the files of subprograms begin, and the numbers that they were asked for by.
    pub(crate) fn parts(&self) -> Vec<(Cursor, Option<u32>)> {
        self.appended.starts().collect()
    }

    /// Where the file begins that was taken in for a name.
    pub(crate) fn named_part(&self, name: &str) -> Option<Cursor> {
        self.appended.named(name)
    }

    /// Takes in the file of a program's number, or of a subprogram's name; where it begins.
    pub(crate) fn take_in(&mut self, wanted: Wanted<'_>) -> Option<Cursor> {
        let source = self.appended.source.as_mut()?;
        let file = match wanted {
            Wanted::Number(number) => source.numbered(number)?,
            Wanted::Name(name) => source.named(name)?,
        };
        let text_end = self.reader.seek(SeekFrom::End(0)).ok()?;
        self.in_place = false;
        Some(self.appended.add(file, wanted, usize::try_from(text_end).ok()?))
    }

    /// Each line in its order until one is answered with false. Of a line that is too long for a block, the first bytes.
    /// Where reading fails the text ends, see [`Text::error`].
    pub fn for_each(&mut self, look: impl FnMut(Line<'_>) -> bool) {
        let first = self.first();
        self.for_each_from(first, look);
    }

    /// The same from a line on.
    pub(crate) fn for_each_from(&mut self, mut next: Cursor, mut look: impl FnMut(Line<'_>) -> bool) {
        while let Some((line, behind)) = self.line_at(next) {
            if !look(line) {
                return;
            }
            next = behind;
        }
    }

    /// Why reading failed, if it did; returned once.
    pub fn error(&mut self) -> Option<io::Error> {
        self.error.take()
    }

    /// Where the first line starts: behind a byte order mark.
    pub(crate) fn first(&mut self) -> Cursor {
        self.keep(0, BYTE_ORDER_MARK.len());
        let marked = self.kept_from(0).starts_with(BYTE_ORDER_MARK);
        Cursor { offset: if marked { BYTE_ORDER_MARK.len() } else { 0 }, number: 1 }
    }

    /// The line that starts at a place, and where the next one does; none at the text's end.
    pub(crate) fn line_at(&mut self, at: Cursor) -> Option<(Line<'_>, Cursor)> {
        if self.is_appended(at.offset) {
            return self.appended.line_at(at);
        }
        let mut wanted = 1;
        let (length, behind) = loop {
            self.keep(at.offset, wanted);
            let rest = self.kept_from(at.offset);
            match line_length(rest) {
                // A CR at the very end may have its LF still to come.
                Some((length, end)) if length + end < rest.len() || self.ended => break (length, length + end),
                None if self.ended => break (rest.len(), rest.len()),
                found if found.map_or(rest.len(), |(length, _)| length) > MAX_BLOCK_BYTES => {
                    let behind = self.behind_long_line(at.offset + MAX_BLOCK_BYTES);
                    self.keep(at.offset, MAX_BLOCK_BYTES + 1);
                    break (MAX_BLOCK_BYTES + 1, behind - at.offset);
                }
                _ => wanted = rest.len() + 1,
            }
        };
        let text = self.kept_from(at.offset).get(..length.min(MAX_BLOCK_BYTES + 1))?;
        let next = Cursor { offset: at.offset + behind, number: at.number.saturating_add(1) };
        (behind > 0).then_some((Line { number: at.number, offset: at.offset, text }, next))
    }

    /// Where the line after this one starts, read piece by piece.
    fn behind_long_line(&mut self, mut from: usize) -> usize {
        loop {
            // CR, LF, and one more byte, which shows that the line's end is whole.
            self.keep(from, 3);
            let rest = self.kept_from(from);
            match line_length(rest) {
                Some((length, end)) if length + end < rest.len() || self.ended => return from + length + end,
                Some((length, _)) => from += length,
                None if self.ended => return from + rest.len(),
                None => from += rest.len(),
            }
        }
    }

    /// What is kept from a place on.
    fn kept_from(&self, offset: usize) -> &[u8] {
        let kept = self.kept.get(..self.length).unwrap_or_default();
        offset.checked_sub(self.start).and_then(|skip| kept.get(skip..)).unwrap_or_default()
    }

    /// Keeps at least `wanted` bytes from a place on, or all that there are.
    #[inline(always)]
    fn keep(&mut self, offset: usize, wanted: usize) {
        let inside = (self.start..=self.start + self.length).contains(&offset);
        if !inside || !(self.ended || self.start + self.length >= offset + wanted) {
            self.move_to(offset, wanted, inside);
        }
    }

    /// Reads on, or from another place.
    fn move_to(&mut self, offset: usize, wanted: usize, inside: bool) {
        let known = if inside { self.start + self.length - offset } else { 0 };
        self.kept.copy_within(self.length - known..self.length, 0);
        (self.start, self.length) = (offset, known);
        if !inside {
            (self.ended, self.in_place) = (false, false);
        }
        if let Err(error) = self.fill(wanted) {
            // What cannot be read is the end.
            (self.error, self.ended) = (Some(error), true);
        }
    }

    fn fill(&mut self, wanted: usize) -> io::Result<()> {
        if !self.in_place {
            self.reader.seek(SeekFrom::Start((self.start + self.length) as u64))?;
            self.in_place = true;
        }
        while self.length < wanted && !self.ended {
            let Some(free) = self.kept.get_mut(self.length..) else { break };
            match self.reader.read(free) {
                Ok(0) => self.ended = true,
                Ok(count) => self.length += count,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

impl<R> fmt::Debug for Text<R> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Text").field("start", &self.start).field("length", &self.length).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gcode::text::lines;

    /// Hands out few bytes at a time, as pipes and disks may.
    struct Slowly<'a>(io::Cursor<&'a [u8]>, usize);

    impl Read for Slowly<'_> {
        fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
            let length = into.len().min(self.1);
            self.0.read(&mut into[..length])
        }
    }

    impl Seek for Slowly<'_> {
        fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
            self.0.seek(to)
        }
    }

    fn all<R: Read + Seek>(mut text: Text<R>) -> Vec<(u32, usize, Vec<u8>)> {
        let mut found = Vec::new();
        text.for_each(|line| {
            found.push((line.number, line.offset, line.text.to_vec()));
            true
        });
        assert!(text.error().is_none());
        found
    }

    proptest::proptest! {
        #[test]
        fn the_same_lines_as_in_memory(source in "[a\r\n]{0,40}", bytes in 1_usize..5, marked: bool) {
            let source = if marked { ["\u{feff}", &source].concat() } else { source };
            let expected: Vec<_> = lines(source.as_bytes()).map(|l| (l.number, l.offset, l.text.to_vec())).collect();
            proptest::prop_assert_eq!(&all(Text::of(source.as_bytes())), &expected);
            let slowly = Slowly(io::Cursor::new(source.as_bytes()), bytes);
            proptest::prop_assert_eq!(&all(Text::new(slowly)), &expected);
        }
    }

    #[test]
    fn lines_beyond_what_is_kept() {
        let mut source = Vec::new();
        for length in [10, MAX_BLOCK_BYTES, 3, MAX_BLOCK_BYTES + 1, 5 * KEPT_BYTES, 7, KEPT_BYTES, KEPT_BYTES - 1] {
            source.extend(std::iter::repeat_n(b'x', length));
            source.extend(b"\r\n");
        }
        let expected: Vec<_> = lines(&source)
            .map(|l| (l.number, l.offset, l.text[..l.text.len().min(MAX_BLOCK_BYTES + 1)].to_vec()))
            .collect();
        assert!(all(Text::of(&source)) == expected);
        assert!(all(Text::new(Slowly(io::Cursor::new(&source), 1000))) == expected);
    }

    #[test]
    fn any_line_again() {
        let source = b"G0 X12.5 Y-3\n".repeat(100_000);
        let mut text = Text::of(&source);
        for number in [1, 99_999, 50_000, 50_001, 2, 100_000] {
            let (line, _) = text.line_at(Cursor { offset: 13 * (number - 1), number: number as u32 }).unwrap();
            assert_eq!((line.number as usize, line.text), (number, &b"G0 X12.5 Y-3"[..]));
        }
        assert_eq!(text.line_at(Cursor { offset: source.len(), number: 100_001 }), None);
    }

    #[test]
    fn a_failing_reader_is_told() {
        struct Broken;
        impl Read for Broken {
            fn read(&mut self, _: &mut [u8]) -> io::Result<usize> {
                Err(io::Error::other("gone"))
            }
        }
        impl Seek for Broken {
            fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
                Ok(0)
            }
        }
        let mut text = Text::new(Broken);
        text.for_each(|_| panic!("a line"));
        assert_eq!(text.error().unwrap().to_string(), "gone");
    }
}
