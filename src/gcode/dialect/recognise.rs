//! Which control a program was written for, by what no other of them writes.

use super::definition::Dialect;
use crate::gcode::text::Text;
use std::io::{Read, Seek};

/// The name that asks for [`recognise`] in place of a dialect's.
pub const AUTO: &str = "auto";

/// The one that is known and not read.
const HEIDENHAIN: &str = "heidenhain";

/// What stands in a line, in upper case and without blanks, and the dialect that reads it. FANUC's marks come last: its
/// kin has some of them, too.
const MARKS: &[(&[u8], &str)] = &[
    (b"BEGINPGM", HEIDENHAIN),
    (b"CYCLDEF", HEIDENHAIN),
    (b"TOOLCALL", HEIDENHAIN),
    (b"MCALL", "siemens"),
    (b"CYCLE", "siemens"),
    (b"SUPA", "siemens"),
    (b"=IC(", "siemens"),
    (b"=AC(", "siemens"),
    (b"G331", "siemens"),
    (b"G332", "siemens"),
    (b"G500", "siemens"),
    (b"SPOS", "siemens"),
    (b"HOLES1(", "siemens"),
    (b"HOLES2(", "siemens"),
    (b"WORKPIECE(", "siemens"),
    (b"MSG(", "siemens"),
    (b"_MPF", "siemens"),
    (b"G33.1", "linuxcnc"),
    (b"#<", "linuxcnc"),
    (b"O<", "linuxcnc"),
    (b"ENDSUB", "linuxcnc"),
    (b"G59.3", "linuxcnc"),
    (b",R1", "mitsubishi"),
    (b"G77", "brother"),
    (b"G187", "haas"),
    (b"G154", "haas"),
    (b"M97", "haas"),
    (b"G184", "haas"),
    (b"//", "paper"),
    (b"M29", "fanuc"),
    (b"G54.1", "fanuc"),
    (b"G84.2", "fanuc"),
    (b"G05.1", "fanuc"),
    (b"M198", "fanuc"),
];

/// The dialect that a line looks like, and what shows it.
///
/// ```
/// use rigidtap::gcode::looks_like;
/// assert_eq!(looks_like(b"MCALL CYCLE84(20,0,2,-15)"), Some(("siemens", "MCALL")));
/// assert_eq!(looks_like(b"G84 X1. Z-10. R2. (as CYCLE84)"), None);
/// ```
#[must_use]
pub fn looks_like(line: &[u8]) -> Option<(&'static str, &'static str)> {
    let text = without_comments(line);
    MARKS
        .iter()
        .find(|(mark, _)| holds(&text, mark))
        .map(|&(mark, name)| (name, std::str::from_utf8(mark).unwrap_or_default()))
}

/// The line in upper case, without blanks and without what stands in comments. A parenthesis behind a letter or `=` holds
/// parameters.
fn without_comments(line: &[u8]) -> Vec<u8> {
    const MOST: usize = 200;
    let mut text: Vec<u8> = Vec::new();
    let mut in_comment = false;
    for &byte in line.iter().take(MOST).filter(|byte| !byte.is_ascii_whitespace()) {
        match byte {
            b';' => break,
            b'(' if !text.last().is_some_and(|last| last.is_ascii_alphabetic() || b"=12347".contains(last)) => {
                in_comment = true
            }
            b')' if in_comment => in_comment = false,
            _ if in_comment => {}
            byte => text.push(byte.to_ascii_uppercase()),
        }
    }
    text
}

/// Whether a mark stands in a text, not as the beginning of a longer number.
fn holds(text: &[u8], mark: &[u8]) -> bool {
    let digit_last = mark.last().is_some_and(u8::is_ascii_digit);
    text.windows(mark.len()).enumerate().any(|(at, window)| {
        let next = text.get(at + mark.len());
        window == mark && !(digit_last && next.is_some_and(|next| next.is_ascii_digit() || *next == b'.'))
    })
}

/// What a program was taken for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recognised {
    /// Name of the dialect, or of a control that is not read.
    pub name: &'static str,
    /// What shows it, and in which line; none where nothing is of one control alone.
    pub mark: Option<(&'static str, u32)>,
    /// Another dialect, with a mark and its line, that the program has, too.
    pub against: Option<(&'static str, &'static str, u32)>,
}

impl Recognised {
    /// Why, in words.
    #[must_use]
    pub fn reason(&self) -> String {
        let name = self.name;
        match (self.mark, self.against) {
            (None, _) => format!("read as {name}: nothing in it is of one control alone"),
            (Some((mark, line)), None) => format!("read as {name}: {mark} in line {line}"),
            (Some((mark, line)), Some((other, its_mark, its_line))) => format!(
                "read as {name}: {mark} in line {line}; but {its_mark} in line {its_line} is of {other}: name the dialect if \
                 that is meant"
            ),
        }
    }
}

/// What a FANUC and its kin do not read, and LinuxCNC does: a text behind `;`, and codes in lower case.
fn written_as_ngc(line: &[u8]) -> Option<&'static str> {
    let (code, comment) = match line.iter().position(|&byte| byte == b';') {
        Some(at) => (line.get(..at).unwrap_or_default(), line.get(at + 1..).unwrap_or_default()),
        None => (line, &[][..]),
    };
    if comment.iter().any(u8::is_ascii_alphabetic) {
        return Some("a text behind ';'");
    }
    let code = code.trim_ascii_start();
    let lower = matches!(code.first(), Some(b'g' | b'm' | b'x' | b's')) && code.get(1).is_some_and(u8::is_ascii_digit);
    lower.then_some("a code in lower case")
}

/// The dialect that a whole program was written for: that with most lines of its own. Without any mark it is `linuxcnc` where it is
/// written as no FANUC reads it, and else `fanuc`, whose
/// words most controls share.
///
/// ```
/// use rigidtap::gcode::{Text, recognise};
/// let found = recognise(&mut Text::of(b"G90 G54\nMCALL CYCLE84(20,0,2,-15)\nX10\nMCALL\nM30\n"));
/// assert_eq!(found.reason(), "read as siemens: MCALL in line 2");
/// assert_eq!(recognise(&mut Text::of(b"G84 Z-10. R2. F1.\n")).name, "fanuc");
/// ```
pub fn recognise<R: Read + Seek>(text: &mut Text<R>) -> Recognised {
    /// A mark beyond so many lines of one dialect changes nothing.
    const ENOUGH: usize = 50;
    let mut votes: Vec<(&'static str, usize, &'static str, u32)> = Vec::new();
    let mut style: Option<(&'static str, u32)> = None;
    text.for_each(|line| {
        if let Some((name, mark)) = looks_like(line.text) {
            match votes.iter_mut().find(|vote| vote.0 == name) {
                Some(vote) => vote.1 += 1,
                None => votes.push((name, 1, mark, line.number)),
            }
        }
        style = style.or_else(|| written_as_ngc(line.text).map(|mark| (mark, line.number)));
        votes.iter().all(|vote| vote.1 < ENOUGH)
    });
    // What FANUC's kin shares with it says nothing against them.
    let kin = |name: &str| ["haas", "brother", "mitsubishi"].contains(&name);
    if votes.iter().any(|vote| kin(vote.0)) {
        votes.retain(|vote| vote.0 != Dialect::FANUC.name);
    }
    votes.sort_by_key(|vote| std::cmp::Reverse(vote.1));
    let Some(&(name, _, mark, line)) = votes.first() else {
        let name = if style.is_some() { Dialect::LINUXCNC.name } else { Dialect::FANUC.name };
        return Recognised { name, mark: style, against: None };
    };
    let against = votes.get(1).map(|&(name, _, mark, line)| (name, mark, line));
    Recognised { name, mark: Some((mark, line)), against }
}
