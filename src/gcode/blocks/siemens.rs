//! What stands behind a letter on a SINUMERIK: `X=10+R1`, `X=IC(5)`, `R1=5`, `S1=500`, `T="TAP_M6"`.

use super::expression::Reader;
use super::token::{Token, Word};
use super::variables::Variables;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::text::{Number, Place, number};

/// What was read, and where it ends.
pub(super) struct Found {
    pub(super) token: Result<Token, DiagnosticKind>,
    pub(super) end: usize,
}

/// A value behind `=`; none where the letter has a plain number.
pub(super) fn after_letter(text: &[u8], at: usize, letter: u8, variables: &Variables) -> Option<Found> {
    let rest = text.get(at..).unwrap_or_default();
    let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
    let behind = rest.get(digits..).unwrap_or_default();
    let blanks = behind.iter().take_while(|b| b.is_ascii_whitespace()).count();
    if behind.get(blanks) != Some(&b'=') || behind.get(blanks + 1) == Some(&b'=') {
        return None;
    }
    let mut reader = Reader::new(text, at + digits + blanks + 1, variables);
    reader.skip_blanks();
    let start = reader.at;
    if letter == b'T' && digits == 0 && reader.rest().first() == Some(&b'"') {
        return Some(tool_name(text, start));
    }
    let call = |word: &[u8]| {
        let rest = text.get(start..).unwrap_or_default();
        rest.get(..word.len()).is_some_and(|next| next.eq_ignore_ascii_case(word))
            && rest.get(word.len()..).unwrap_or_default().trim_ascii_start().first() == Some(&b'(')
    };
    let is_distance = match (call(b"IC"), call(b"AC")) {
        (true, _) => Some(true),
        (_, true) => Some(false),
        _ => None,
    };
    reader.at += if is_distance.is_some() { 2 } else { 0 };
    let value = reader.sum();
    let end = reader.at.max(start + 1);
    let place = Place::default();
    let token = match value {
        Err((kind, _)) => return Some(Found { token: Err(kind), end: text.len() }),
        Ok(value) if letter == b'R' && digits > 0 => {
            let mut parameter = Reader::new(text, at, variables);
            match parameter.r_parameter() {
                Ok(variable) if is_distance.is_none() => Ok(Token::Assignment { variable, value, place }),
                _ => Err(DiagnosticKind::BadExpression),
            }
        }
        Ok(value) => {
            let value = value.unwrap_or(0.0);
            let number = Number { value, has_point: true, computed: true };
            let first_spindle = digits == 0 || (matches!(letter, b'S' | b'M') && rest.get(..digits) == Some(b"1"));
            match (first_spindle, value.abs() <= number::LARGEST) {
                (false, _) => Err(DiagnosticKind::ExtendedAddress { letter }),
                (true, false) => Err(DiagnosticKind::NumberTooLarge { letter }),
                (true, true) => Ok(Token::Word(Word { letter, number, place, is_distance })),
            }
        }
    };
    Some(Found { token, end })
}

/// Which tool it is tells holes apart and changes nothing else: a number that names hardly share stands for its name.
fn tool_name(text: &[u8], start: usize) -> Found {
    let name = text.get(start + 1..).unwrap_or_default();
    let length = name.iter().position(|&b| b == b'"');
    // FNV-1a, its 24 upper bits, which every number holds.
    let hash = name
        .iter()
        .take(length.unwrap_or(0))
        .fold(0x811c_9dc5_u32, |hash, byte| (hash ^ u32::from(byte.to_ascii_uppercase())).wrapping_mul(0x0100_0193));
    let number = Number { value: f64::from(hash >> 8), has_point: false, computed: true };
    let word = Word { letter: b'T', number, place: Place::default(), is_distance: None };
    match length {
        Some(length) => Found { token: Ok(Token::Word(word)), end: start + length + 2 },
        None => Found { token: Err(DiagnosticKind::MalformedNumber { letter: b'T' }), end: text.len() },
    }
}

/// Whether an R parameter is read behind a place of its block.
pub(super) fn reads_behind(text: &[u8], from: usize, number: u32) -> bool {
    let name = format!("R{number}");
    let rest = text.get(from..).unwrap_or_default();
    let rest = rest.split(|&byte| byte == b';').next().unwrap_or_default();
    rest.windows(name.len()).enumerate().any(|(at, window)| {
        let behind = rest.get(at + name.len()..).unwrap_or_default();
        window.eq_ignore_ascii_case(name.as_bytes())
            && !behind.first().is_some_and(u8::is_ascii_digit)
            && behind.trim_ascii_start().first() != Some(&b'=')
    })
}

/// Where the parenthesis closes that stands before the text: others inside it and texts in quotation marks are passed.
pub(super) fn closing(text: &[u8]) -> Option<usize> {
    let (mut depth, mut quoted) = (0_u32, false);
    text.iter().position(|&byte| {
        match byte {
            b'"' => quoted = !quoted,
            _ if quoted => {}
            b'(' => depth += 1,
            b')' if depth == 0 => return true,
            b')' => depth -= 1,
            _ => {}
        }
        false
    })
}

/// The parts between commas; those in parentheses and in quotation marks do not part.
pub(crate) fn parts(text: &[u8]) -> Vec<&[u8]> {
    let (mut depth, mut quoted, mut start) = (0_u32, false, 0);
    let mut found = Vec::new();
    for (at, &byte) in text.iter().enumerate() {
        match byte {
            b'"' => quoted = !quoted,
            _ if quoted => {}
            b'(' => depth += 1,
            b')' => depth = depth.saturating_sub(1),
            b',' if depth == 0 => {
                found.push(text.get(start..at).unwrap_or_default());
                start = at + 1;
            }
            _ => {}
        }
    }
    found.push(text.get(start..).unwrap_or_default());
    found
}
