//! A file as rows of fields. A line is read field by field and never kept whole: its length costs time, and no memory.

use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};

use super::fault::{RecordingError, RecordingErrorKind};
use super::row::{Cell, Row, Separator};

/// Bytes of a field that are kept: a number is far shorter, and so is a heading that anyone can name.
const LONGEST_FIELD: usize = 1024;
const BYTE_ORDER_MARK: &[u8] = b"\xEF\xBB\xBF";

/// A field as it is scanned.
#[derive(Clone, Copy)]
pub(super) struct Field<'a> {
    /// From 0.
    pub(super) index: usize,
    bytes: &'a [u8],
    /// Place of its first character in the line, from 1.
    pub(super) column: usize,
}

impl Field<'_> {
    /// Without blanks and quotation marks around it; broken bytes replaced, and cut where it is very long.
    pub(super) fn text(&self) -> String {
        String::from_utf8_lossy(self.bytes).trim().trim_matches('"').to_owned()
    }
}

/// A line that was scanned.
#[derive(Clone, Copy, Debug, Default)]
struct Line {
    fields: usize,
    /// It has nothing but blanks.
    blank: bool,
    /// The column after its last character.
    end_column: usize,
}

/// The rows of a file that are not empty, at the strongest separator that the first one has.
pub(super) struct Table<R> {
    source: BufReader<R>,
    pub(super) separator: Separator,
    /// Where the first row begins.
    head: (u64, usize),
    /// Line last read, from 1.
    line: usize,
    field: Vec<u8>,
}

impl<R: Read + Seek> Table<R> {
    /// Finds the first row.
    pub(super) fn new(source: R) -> Result<Self, RecordingError> {
        let source = BufReader::with_capacity(1 << 16, source);
        let mut table = Self { source, separator: Separator::Blanks, head: (0, 0), line: 0, field: Vec::new() };
        table.find_head().map_err(|error| table.unreadable(&error))?;
        if table.head.1 == 0 {
            return Err(RecordingError { kind: RecordingErrorKind::Empty, line: 1, column: 1 });
        }
        table.rewind()?;
        Ok(table)
    }

    fn find_head(&mut self) -> io::Result<()> {
        self.source.seek(SeekFrom::Start(0))?;
        let mut offset = 0;
        if self.source.fill_buf()?.starts_with(BYTE_ORDER_MARK) {
            offset = BYTE_ORDER_MARK.len();
            self.source.consume(offset);
        }
        let (mut begin, mut number, mut blank) = (offset as u64, 1, true);
        let (mut found, mut position) = ([false; 3], offset as u64);
        loop {
            let chunk = self.source.fill_buf()?;
            if chunk.is_empty() {
                break;
            }
            let mut ended = false;
            let mut used = chunk.len();
            for (index, byte) in chunk.iter().enumerate() {
                if *byte == b'\n' {
                    used = index + 1;
                    ended = true;
                    break;
                }
                blank &= byte.is_ascii_whitespace();
                for (found, separator) in found.iter_mut().zip(b";\t,") {
                    *found |= byte == separator;
                }
            }
            self.source.consume(used);
            position += used as u64;
            if ended && !blank {
                break;
            }
            if ended {
                (begin, number, found) = (position, number + 1, [false; 3]);
            }
        }
        if !blank {
            self.head = (begin, number);
            let separator = found.into_iter().zip(b";\t,").find(|(found, _)| *found);
            self.separator = separator.map_or(Separator::Blanks, |(_, byte)| Separator::Byte(*byte));
        }
        Ok(())
    }

    /// The next row is the first again.
    pub(super) fn rewind(&mut self) -> Result<(), RecordingError> {
        let (offset, number) = self.head;
        self.line = number - 1;
        self.source.seek(SeekFrom::Start(offset)).map(drop).map_err(|error| self.unreadable(&error))
    }

    /// The first row's line.
    pub(super) fn head_line(&self) -> usize {
        self.head.1
    }

    /// Shows every field of the first row; the next row is the second.
    pub(super) fn scan_head(&mut self, visit: &mut dyn FnMut(Field<'_>)) -> Result<(), RecordingError> {
        self.rewind()?;
        self.scan(visit).map(drop)
    }

    /// Where these headings stand in the first row.
    pub(super) fn positions(&mut self, names: &[&str]) -> Result<Vec<Option<usize>>, RecordingError> {
        let mut places = vec![None; names.len()];
        self.scan_head(&mut |field| {
            let text = field.text();
            for (place, name) in places.iter_mut().zip(names) {
                if place.is_none() && text == *name {
                    *place = Some(field.index);
                }
            }
        })?;
        Ok(places)
    }

    /// The next row that is not empty, of which the row's own columns are kept; false at the end.
    pub(super) fn next_row(&mut self, row: &mut Row) -> Result<bool, RecordingError> {
        loop {
            row.clear();
            let scanned = self.scan(&mut |field| row.take(&field))?;
            let Some(line) = scanned else { return Ok(false) };
            if !line.blank {
                row.end(self.line, self.separator, line.fields, line.end_column);
                return Ok(true);
            }
        }
    }

    /// Reads one line, empty or not; none at the end of the file.
    fn scan(&mut self, visit: &mut dyn FnMut(Field<'_>)) -> Result<Option<Line>, RecordingError> {
        self.line += 1;
        let mut scan = Scan { separator: self.separator, field: &mut self.field, line: Line::default(), start: None };
        scan.line = Line { fields: 0, blank: true, end_column: 1 };
        scan.field.clear();
        if self.separator != Separator::Blanks {
            scan.start = Some(1);
        }
        let mut any = false;
        loop {
            let chunk = match self.source.fill_buf() {
                Ok(chunk) => chunk,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(self.unreadable(&error)),
            };
            if chunk.is_empty() {
                break;
            }
            any = true;
            let end = memchr::memchr(b'\n', chunk);
            let bytes = chunk.get(..end.unwrap_or(chunk.len())).unwrap_or_default();
            scan.bytes(bytes, visit);
            let used = bytes.len() + usize::from(end.is_some());
            self.source.consume(used);
            if end.is_some() {
                break;
            }
        }
        scan.end_field(visit);
        let line = scan.line;
        Ok(any.then_some(line))
    }

    fn unreadable(&self, error: &io::Error) -> RecordingError {
        let kind = RecordingErrorKind::Unreadable(error.to_string());
        RecordingError { kind, line: self.line.max(1), column: 1 }
    }
}

/// One line under way.
struct Scan<'a> {
    separator: Separator,
    field: &'a mut Vec<u8>,
    line: Line,
    /// Column of the field under way.
    start: Option<usize>,
}

impl Scan<'_> {
    fn bytes(&mut self, bytes: &[u8], visit: &mut dyn FnMut(Field<'_>)) {
        for byte in bytes {
            let separates = match self.separator {
                Separator::Blanks => byte.is_ascii_whitespace(),
                Separator::Byte(separator) => *byte == separator,
            };
            if separates {
                self.end_field(visit);
            }
            let begins = byte & 0xC0 != 0x80;
            if !separates {
                self.start.get_or_insert(self.line.end_column);
                if self.field.len() < LONGEST_FIELD {
                    self.field.push(*byte);
                }
            }
            self.line.blank &= byte.is_ascii_whitespace();
            self.line.end_column += usize::from(begins);
            if separates && self.separator != Separator::Blanks {
                self.start = Some(self.line.end_column);
            }
        }
    }

    fn end_field(&mut self, visit: &mut dyn FnMut(Field<'_>)) {
        if let Some(column) = self.start.take() {
            visit(Field { index: self.line.fields, bytes: self.field, column });
            self.line.fields += 1;
        }
        self.field.clear();
    }
}

impl Row {
    fn take(&mut self, field: &Field<'_>) {
        if let Some(cell) = self.cell_mut(field.index) {
            *cell = Cell { index: field.index, column: Some(field.column), text: field.text() };
        }
    }
}
