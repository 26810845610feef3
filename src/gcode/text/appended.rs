//! Subprograms of other files, which a program's text takes in where it calls them.

use std::fmt;

use super::span::{BYTE_ORDER_MARK, Cursor, Line, MAX_BLOCK_BYTES, line_length};

/// Finds the subprograms that a program calls and does not hold.
///
/// ```
/// use rigidtap::gcode::{Dialect, Options, Subprograms, Commands, Text};
/// #[derive(Debug)]
/// struct One;
/// impl Subprograms for One {
///     fn numbered(&mut self, number: u32) -> Option<(String, Vec<u8>)> {
///         (number == 7).then(|| ("O0007.nc".into(), b"O0007\nX5.\nM99\n".to_vec()))
///     }
///     fn named(&mut self, _: &str) -> Option<(String, Vec<u8>)> {
///         None
///     }
/// }
/// let program = b"G90 G95 M29\nG0 X0. Y0. Z10.\nG84 X0. Z-9. R2. F1. S900\nM98 P7\nG80\nM30\n";
/// let mut text = Text::of(program).with_subprograms(Box::new(One));
/// let commands = Commands::new(&mut text, &Dialect::FANUC, Options::default());
/// assert_eq!(commands.count(), 4);
/// ```
pub trait Subprograms: fmt::Debug + Send {
    /// The file of a program's number: its name, and its bytes.
    fn numbered(&mut self, number: u32) -> Option<(String, Vec<u8>)>;

    /// The file of a subprogram's name (LinuxCNC, SINUMERIK).
    fn named(&mut self, name: &str) -> Option<(String, Vec<u8>)>;
}

/// What a call looks for in other files.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Wanted<'a> {
    Number(u32),
    Name(&'a str),
}

/// One file behind the program's own text.
#[derive(Debug)]
pub(super) struct Part {
    pub(super) name: String,
    pub(super) bytes: Vec<u8>,
    /// The program's number that was asked for.
    number: Option<u32>,
    /// The subprogram's name that was asked for.
    asked: Option<String>,
    /// Where it begins, counted on from the program's own text.
    start: usize,
}

/// Files in the order in which they were called.
#[derive(Debug, Default)]
pub(super) struct Appended {
    pub(super) parts: Vec<Part>,
    pub(super) source: Option<Box<dyn Subprograms>>,
}

impl Appended {
    /// Takes a file in behind everything so far, and says where it begins.
    pub(super) fn add(&mut self, (name, mut bytes): (String, Vec<u8>), wanted: Wanted<'_>, text_end: usize) -> Cursor {
        if bytes.starts_with(BYTE_ORDER_MARK) {
            bytes.drain(..BYTE_ORDER_MARK.len());
        }
        let end = self.parts.last().map_or(text_end, |part| part.start + part.bytes.len());
        // One byte of nobody between: what begins here is no place of what stands before.
        let start = end + 1;
        let (number, asked) = match wanted {
            Wanted::Number(number) => (Some(number), None),
            Wanted::Name(name) => (None, Some(name.to_owned())),
        };
        self.parts.push(Part { name, bytes, number, asked, start });
        Cursor { offset: start, number: 1 }
    }

    /// The file that holds a place, and where it begins.
    pub(super) fn part(&self, offset: usize) -> Option<(&Part, usize)> {
        let part = self.parts.iter().rev().find(|part| part.start <= offset)?;
        Some((part, part.start))
    }

    /// Where the file begins that was taken in for a name.
    pub(super) fn named(&self, name: &str) -> Option<Cursor> {
        let is_it = |part: &&Part| part.asked.as_deref().is_some_and(|asked| asked.eq_ignore_ascii_case(name));
        self.parts.iter().find(is_it).map(|part| Cursor { offset: part.start, number: 1 })
    }

    pub(super) fn starts(&self) -> impl Iterator<Item = (Cursor, Option<u32>)> {
        self.parts.iter().map(|part| (Cursor { offset: part.start, number: 1 }, part.number))
    }

    /// The line of a file that starts at a place, and where its next one does.
    pub(super) fn line_at(&self, at: Cursor) -> Option<(Line<'_>, Cursor)> {
        let (part, start) = self.part(at.offset)?;
        let rest = part.bytes.get(at.offset - start..).filter(|rest| !rest.is_empty())?;
        let (length, end) = line_length(rest).unwrap_or((rest.len(), 0));
        let text = rest.get(..length.min(MAX_BLOCK_BYTES + 1))?;
        let next = Cursor { offset: at.offset + length + end, number: at.number.saturating_add(1) };
        Some((Line { number: at.number, offset: at.offset, text }, next))
    }
}
