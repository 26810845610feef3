//! Statements: which line comes next. Fanuc's custom macro B, and LinuxCNC's O words.

use super::expression::Reader;
use super::variables::{Variable, Variables};
use crate::gcode::dialect::Macros;
use crate::gcode::messages::{DiagnosticKind, Fault};
use crate::gcode::text::Place;

/// What an O word says.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keyword {
    Sub,
    EndSub,
    Call,
    Return,
    If,
    ElseIf,
    Else,
    EndIf,
    While,
    EndWhile,
    Do,
    Repeat,
    EndRepeat,
    Break,
    Continue,
}

const KEYWORDS: &[(&[u8], Keyword)] = &[
    (b"sub", Keyword::Sub),
    (b"endsub", Keyword::EndSub),
    (b"call", Keyword::Call),
    (b"return", Keyword::Return),
    (b"if", Keyword::If),
    (b"elseif", Keyword::ElseIf),
    (b"else", Keyword::Else),
    (b"endif", Keyword::EndIf),
    (b"while", Keyword::While),
    (b"endwhile", Keyword::EndWhile),
    (b"do", Keyword::Do),
    (b"repeat", Keyword::Repeat),
    (b"endrepeat", Keyword::EndRepeat),
    (b"break", Keyword::Break),
    (b"continue", Keyword::Continue),
];

/// A line that decides which line comes next.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Statement {
    /// An O word, with where its conditions or arguments begin.
    Word {
        label: Vec<u8>,
        keyword: Keyword,
        rest: usize,
    },
    /// Fanuc, evaluated.
    Next,
    Set(Variable, Option<f64>),
    Goto(f64),
    While {
        number: u32,
        holds: bool,
    },
    End {
        number: u32,
    },
}

/// A call of a program by its number.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ProgramCall {
    /// As written: where `repeats_in_p`, more than four digits hold a count and the number.
    pub(crate) program: u32,
    pub(crate) repeats_in_p: bool,
    /// L.
    pub(crate) repeats: Option<u32>,
    /// Variables of G65.
    pub(crate) arguments: Option<Vec<(u32, f64)>>,
    pub(crate) place: Place,
}

/// What a line says about the next one.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Flow {
    Next,
    Statement(Statement),
    /// M98, G65.
    Call(ProgramCall),
    /// M97: from the block of this number on.
    CallLabel {
        label: f64,
        repeats: u32,
        place: Place,
    },
    /// The file of this name (SINUMERIK).
    CallNamed {
        name: Vec<u8>,
        repeats: u32,
        place: Place,
    },
    /// M99.
    Return,
}

/// Whether a line begins with a word, or with its number and a word, as nearly every line does: it is no statement.
#[inline]
pub(crate) fn begins_with_word(text: &[u8]) -> bool {
    let rest = match text {
        [b'N' | b'n', rest @ ..] => {
            let digits = rest.iter().take_while(|b| b.is_ascii_digit()).count();
            match rest.get(digits..) {
                Some([b' ', rest @ ..]) => rest,
                _ => rest,
            }
        }
        _ => text,
    };
    matches!(rest, [b'F'..=b'M' | b'P'..=b'Z', b'0'..=b'9' | b'-' | b'.', ..])
}

/// The line's statement, if it is one.
pub(crate) fn statement(text: &[u8], variables: &Variables) -> Option<Result<Statement, Fault>> {
    let start = after_number(text);
    match (variables.macros, text.get(start)?.to_ascii_uppercase()) {
        (Macros::Ngc, b'O') => Some(word(text, start)),
        (Macros::Fanuc, b'I' | b'W' | b'G' | b'E' | b'D') if text.get(start + 1)?.is_ascii_alphabetic() => {
            fanuc(text, start, variables)
        }
        _ => None,
    }
}

/// Past blanks, a block delete and a line number.
fn after_number(text: &[u8]) -> usize {
    let past = |mut at: usize, skipped: fn(u8) -> bool| {
        while text.get(at).copied().is_some_and(skipped) {
            at += 1;
        }
        at
    };
    let is_blank = |b| matches!(b, b' ' | b'\t' | b'/');
    let start = past(0, is_blank);
    match text.get(start) {
        Some(b'N' | b'n') => past(past(past(start + 1, is_blank), |b| b.is_ascii_digit()), is_blank),
        _ => start,
    }
}

/// The line number of a block, to go to.
pub(crate) fn line_number(text: &[u8]) -> Option<u32> {
    let digits = text.trim_ascii_start().strip_prefix(b"N").or(text.trim_ascii_start().strip_prefix(b"n"))?;
    leading_number(digits)
}

/// The number of the program that begins here.
pub(crate) fn program_number(text: &[u8]) -> Option<u32> {
    match text.trim_ascii_start() {
        [b'O' | b'o' | b':', digits @ ..] => leading_number(digits),
        _ => None,
    }
}

fn leading_number(text: &[u8]) -> Option<u32> {
    let digits = text.iter().take_while(|b| b.is_ascii_digit()).count();
    std::str::from_utf8(text.get(..digits)?).ok()?.parse().ok()
}

/// An O word's label, keyword, and where its conditions begin.
pub(crate) fn o_word(text: &[u8]) -> Option<(Vec<u8>, Keyword, usize)> {
    let start = after_number(text);
    if !text.get(start)?.eq_ignore_ascii_case(&b'O') {
        return None;
    }
    match word(text, start).ok()? {
        Statement::Word { label, keyword, rest } => Some((label, keyword, rest)),
        _ => None,
    }
}

/// Whether the line is END m.
pub(crate) fn is_fanuc_end(text: &[u8], number: u32) -> bool {
    let rest = text.get(after_number(text)..).unwrap_or_default();
    let word = rest.get(..3).is_some_and(|word| word.eq_ignore_ascii_case(b"END"));
    word && leading_number(rest.get(3..).unwrap_or_default().trim_ascii_start()) == Some(number)
}

/// An O word at a place.
fn word(text: &[u8], start: usize) -> Result<Statement, Fault> {
    let label_at = start + 1;
    let rest = text.get(label_at..).unwrap_or_default();
    let length = match rest.first() {
        Some(b'<') => rest.iter().position(|&b| b == b'>').map_or(0, |end| end + 1),
        _ => rest.iter().take_while(|b| b.is_ascii_digit()).count(),
    };
    let label: Vec<u8> =
        rest.iter().take(length).filter(|b| !b.is_ascii_whitespace()).map(u8::to_ascii_lowercase).collect();
    let mut at = label_at + length;
    at += text.iter().skip(at).take_while(|b| b.is_ascii_whitespace()).count();
    let letters = text.iter().skip(at).take_while(|b| b.is_ascii_alphabetic()).count();
    let name = text.get(at..at + letters).unwrap_or_default();
    let keyword = KEYWORDS.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, keyword)| *keyword);
    match keyword.filter(|_| length > 0) {
        Some(keyword) => Ok(Statement::Word { label, keyword, rest: at + letters }),
        None => Err((DiagnosticKind::UnknownStatement, Place::new(start, at + letters))),
    }
}

fn fanuc(text: &[u8], start: usize, variables: &Variables) -> Option<Result<Statement, Fault>> {
    let mut reader = Reader::new(text, start, variables);
    let parsed = if reader.accept_word(b"IF") {
        conditional(&mut reader)
    } else if reader.accept_word(b"WHILE") {
        reader.value().and_then(|value| {
            let number = loop_number(&mut reader, b"DO")?;
            Ok(Statement::While { number, holds: value.unwrap_or(0.0) != 0.0 })
        })
    } else if reader.accept_word(b"GOTO") {
        reader.value().map(|value| Statement::Goto(value.unwrap_or(0.0)))
    } else if reader.accept_word(b"END") {
        reader.at -= 3;
        loop_number(&mut reader, b"END").map(|number| Statement::End { number })
    } else if reader.rest().get(..2).is_some_and(|next| next.eq_ignore_ascii_case(b"DO")) {
        loop_number(&mut reader, b"DO").map(|number| Statement::While { number, holds: true })
    } else {
        return None;
    };
    Some(parsed.and_then(|statement| {
        let place = Place::new(reader.at.min(text.len()), text.len());
        reader.skip_blanks();
        match reader.rest().first() {
            None | Some(b'(') => Ok(statement),
            Some(b';') if ends_there(reader.rest()) => Ok(statement),
            Some(b';') => Err((DiagnosticKind::TextBehindEndOfBlock, place)),
            Some(_) => Err((DiagnosticKind::UnknownStatement, place)),
        }
    }))
}

/// Whether nothing but comments stands behind the end of the block.
fn ends_there(text: &[u8]) -> bool {
    let rest = text.iter().find(|b| !b.is_ascii_whitespace() && **b != b';');
    rest.is_none_or(|&b| b == b'(')
}

/// IF [ ] GOTO n, IF [ ] THEN #i = value.
fn conditional(reader: &mut Reader<'_>) -> Result<Statement, Fault> {
    let holds = reader.value()?.unwrap_or(0.0) != 0.0;
    if reader.accept_word(b"GOTO") {
        let target = reader.value()?.unwrap_or(0.0);
        return Ok(if holds { Statement::Goto(target) } else { Statement::Next });
    }
    let start = reader.at;
    if reader.accept_word(b"THEN") && reader.accept(b'#') {
        let variable = reader.variable()?;
        if reader.accept(b'=') {
            let value = reader.assigned()?;
            return Ok(if holds { Statement::Set(variable, value) } else { Statement::Next });
        }
    }
    Err((DiagnosticKind::UnknownStatement, Place::new(start.min(reader.text.len()), reader.text.len())))
}

fn loop_number(reader: &mut Reader<'_>, word: &[u8]) -> Result<u32, Fault> {
    let start = reader.at;
    let bad = |reader: &Reader<'_>| {
        (DiagnosticKind::UnknownStatement, Place::new(start.min(reader.text.len()), reader.text.len()))
    };
    if !reader.accept_word(word) {
        return Err(bad(reader));
    }
    let number = reader.value()?.unwrap_or(0.0);
    if [1.0, 2.0, 3.0].contains(&number) { Ok(number as u32) } else { Err(bad(reader)) }
}
