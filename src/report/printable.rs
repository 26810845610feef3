//! Text that comes from outside: names of files, words of programs. Nothing of it commands a terminal.

use std::borrow::Cow;
use std::fmt::Write as _;

/// A name on one line: control characters, line ends, too, and those that turn the direction of writing stand as their
/// escapes.
///
/// ```
/// use rigidtap::report::printable;
/// assert_eq!(printable("a\u{1b}[31m\nb.ngc"), "a\\u{1b}[31m\\u{a}b.ngc");
/// assert_eq!(printable("Gewinde Ø6.ngc"), "Gewinde Ø6.ngc");
/// ```
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, is_command, |escape, c| {
        let _ = write!(escape, "{}", c.escape_unicode());
    })
}

/// The same of a whole text, whose line ends and tabs stay.
#[must_use]
pub fn printable_text(text: &str) -> Cow<'_, str> {
    escaped(
        text,
        |c| is_command(c) && !matches!(c, '\n' | '\t'),
        |escape, c| {
            let _ = write!(escape, "{}", c.escape_unicode());
        },
    )
}

/// The same of JSON, in its own escapes: it stays the same JSON.
#[must_use]
pub fn printable_json(text: &str) -> Cow<'_, str> {
    escaped(
        text,
        |c| is_command(c) && !matches!(c, '\n' | '\t' | '\r'),
        |escape, c| {
            for unit in c.encode_utf16(&mut [0; 2]) {
                let _ = write!(escape, "\\u{unit:04x}");
            }
        },
    )
}

/// C0, DEL, C1, and what reorders or breaks a line by itself.
pub(super) fn is_command(c: char) -> bool {
    c.is_control() || matches!(c, '\u{200E}' | '\u{200F}' | '\u{2028}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
}

fn escaped(text: &str, wrong: impl Fn(char) -> bool, escape: impl Fn(&mut String, char)) -> Cow<'_, str> {
    let plain = |byte: u8| (0x20..0x7F).contains(&byte);
    if text.bytes().all(plain) || !text.chars().any(&wrong) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if wrong(c) { escape(&mut safe, c) } else { safe.push(c) }
    }
    Cow::Owned(safe)
}
