//! Bytes of one block → words with their places. Allocates nothing.

use super::expression::{Reader, starts_function};
use super::token::{Token, Word};
use super::variables::Variables;
use crate::gcode::dialect::{COMMA_I, COMMA_J, COMMA_R, COMMA_S, Macros, Name, Syntax};
use crate::gcode::messages::{DiagnosticKind, Fault, Found};
use crate::gcode::text::{Number, Place, number};

/// Reads one block from left to right; goes on after a fault.
#[derive(Clone, Debug)]
pub(crate) struct Lexer<'a> {
    text: &'a [u8],
    at: usize,
    syntax: Syntax,
    variables: &'a Variables,
}

impl<'a> Lexer<'a> {
    /// From a place on. The block must be shorter than 4 GiB: places are 32 bits.
    pub(crate) const fn new(text: &'a [u8], at: usize, syntax: Syntax, variables: &'a Variables) -> Self {
        Self { text, at, syntax, variables }
    }

    /// Whether a value is computed here: variable, brackets, function, with or without a sign.
    fn computes(&self) -> bool {
        // Nearly always a plain number: that is decided at its first byte.
        if matches!(self.syntax.macros, Macros::None | Macros::Siemens)
            || matches!(self.peek(0), Some(b'0'..=b'9' | b'.'))
        {
            return false;
        }
        let rest = self.text.get(self.at..).unwrap_or_default();
        let rest = rest.strip_prefix(b"-").or(rest.strip_prefix(b"+")).unwrap_or(rest).trim_ascii_start();
        matches!(rest, [b'#' | b'[', ..]) || starts_function(rest)
    }

    /// A word whose value is computed.
    fn computed(&mut self, start: usize, letter: u8) -> Result<Token, Fault> {
        let mut reader = Reader::new(self.text, self.at, self.variables);
        let value = reader.value();
        self.at = reader.at.max(self.at + 1).min(self.text.len());
        let place = self.since(start);
        match value {
            Err(fault) => {
                self.at = self.text.len();
                Err(fault)
            }
            Ok(None) => Ok(Token::Vacant(place)),
            Ok(Some(value)) if value.abs() <= number::LARGEST => Ok(Token::Word(Word {
                letter,
                number: Number { value, has_point: true, computed: true },
                place,
                is_distance: None,
            })),
            Ok(Some(_)) => Err((DiagnosticKind::NumberTooLarge { letter }, place)),
        }
    }

    /// At `#`: a variable is written.
    fn assignment(&mut self, start: usize) -> Result<Token, Fault> {
        let mut reader = Reader::new(self.text, start + 1, self.variables);
        let parsed = reader.variable().and_then(|variable| {
            let at = reader.at;
            if !reader.accept(b'=') {
                return Err((DiagnosticKind::BadExpression, Place::new(start, at)));
            }
            Ok((variable, reader.assigned()?))
        });
        self.at = reader.at.min(self.text.len());
        match parsed {
            Ok((variable, value)) => Ok(Token::Assignment { variable, value, place: self.since(start) }),
            Err(fault) => {
                self.at = self.text.len();
                Err(fault)
            }
        }
    }

    fn peek(&self, ahead: usize) -> Option<u8> {
        self.text.get(self.at + ahead).copied()
    }

    fn skip_while(&mut self, wanted: impl Fn(u8) -> bool) {
        while self.peek(0).is_some_and(&wanted) {
            self.at += 1;
        }
    }

    fn since(&self, start: usize) -> Place {
        Place::new(start, self.at)
    }

    fn rest_of_block(&mut self, start: usize) -> Place {
        self.at = self.text.len();
        self.since(start)
    }

    /// At `;` that ends the block: nothing but comments may stand behind it on its line.
    fn behind_end_of_block(&mut self, start: usize) -> Option<Fault> {
        self.at = start + 1;
        loop {
            self.skip_while(|b| is_blank(b) || b == b';');
            match self.peek(0) {
                None => return None,
                Some(b'(') => {
                    if let Some(fault) = self.comment(self.at) {
                        return Some(fault);
                    }
                }
                Some(_) => return Some((DiagnosticKind::TextBehindEndOfBlock, self.rest_of_block(start))),
            }
        }
    }

    /// To the closing parenthesis; none if there is one.
    fn comment(&mut self, start: usize) -> Option<Fault> {
        match self.text.get(start..).and_then(|rest| rest.iter().position(|&b| b == b')')) {
            Some(length) => {
                self.at = start + length + 1;
                None
            }
            None => Some((DiagnosticKind::UnclosedComment, self.rest_of_block(start))),
        }
    }

    /// The next word, if it is a plain one; else nothing is read: that is for [`Lexer::next`].
    pub(crate) fn plain_word(&mut self) -> Option<Word> {
        let word = plain_word(self.text, self.at)?;
        self.at = word.place.end as usize;
        Some(word)
    }

    /// A letter stands at `start`.
    fn word(&mut self, start: usize, letter: u8) -> Result<Token, Fault> {
        self.at += 1;
        self.skip_while(is_blank);
        if self.syntax.calls {
            if self.peek(0).is_some_and(|b| b.is_ascii_alphabetic() || b == b'_') {
                return self.call(start);
            }
            if let Some(found) = super::siemens::after_letter(self.text, self.at, letter, self.variables) {
                self.at = found.end.min(self.text.len());
                return found.token.map_err(|kind| (kind, self.since(start))).map(|token| token.at(self.since(start)));
            }
        }
        if self.computes() {
            return self.computed(start, letter);
        }
        let first = self.at;
        self.skip_while(is_number_byte);
        let run = self.text.get(first..self.at).unwrap_or_default();
        if run.is_empty() {
            return Err(self.no_number(start, letter));
        }
        if self.peek(0).is_some_and(|b| b.eq_ignore_ascii_case(&b'e')) && self.peek(1).is_some_and(is_number_byte) {
            self.at += 1;
            self.skip_while(is_number_byte);
            return Err((DiagnosticKind::ExponentNotation { letter }, self.since(start)));
        }
        let place = self.since(start);
        match number::parse(run) {
            None => Err((DiagnosticKind::MalformedNumber { letter }, place)),
            Some(_) if letter == b'N' => Ok(Token::LineNumber(place)),
            Some(number) if number.value.abs() <= number::LARGEST => {
                Ok(Token::Word(Word { letter, number, place, is_distance: None }))
            }
            Some(_) => Err((DiagnosticKind::NumberTooLarge { letter }, place)),
        }
    }

    /// `$0`, the only spindle there is; none if it is that one.
    fn spindle_number(&mut self, start: usize) -> Option<Fault> {
        self.at += 1;
        let first = self.at;
        self.skip_while(is_number_byte);
        let number = self.text.get(first..self.at).and_then(number::parse);
        match number.is_some_and(|number| number.value == 0.0) {
            true => None,
            false => Some((DiagnosticKind::ExtendedAddress { letter: b'$' }, self.since(start))),
        }
    }

    /// `,R1`: a letter behind a comma.
    fn comma_word(&mut self, start: usize) -> Result<Token, Fault> {
        let letter = match self.peek(1).map(|b| b.to_ascii_uppercase()) {
            Some(b'R') => COMMA_R,
            Some(b'S') => COMMA_S,
            Some(b'I') => COMMA_I,
            Some(b'J') => COMMA_J,
            _ => return Err(self.unexpected(start, b',')),
        };
        self.at += 1;
        self.word(start, letter)
    }

    /// A name of several letters, and its parameters.
    fn call(&mut self, start: usize) -> Result<Token, Fault> {
        self.skip_while(|b| b.is_ascii_alphanumeric() || b == b'_');
        let name = self.since(start);
        self.skip_while(is_blank);
        if self.peek(0) == Some(b'=') {
            self.at += 1;
            let value = self.at;
            self.skip_while(|b| is_blank(b) || is_number_byte(b));
            if Name::of(name.text(self.text)) == Some(Name::SpindleAngle) && self.peek(0) != Some(b'(') {
                return Ok(Token::Call { name, parameters: Some(self.since(value)) });
            }
        }
        if self.peek(0) != Some(b'(') {
            return Ok(Token::Call { name, parameters: None });
        }
        let inside = self.at + 1;
        match super::siemens::closing(self.text.get(inside..).unwrap_or_default()) {
            Some(length) => {
                self.at = inside + length + 1;
                Ok(Token::Call { name, parameters: Some(Place::new(inside, inside + length)) })
            }
            None => Err((DiagnosticKind::UnclosedComment, self.rest_of_block(start))),
        }
    }

    /// After a letter stands no number.
    fn no_number(&mut self, start: usize, letter: u8) -> Fault {
        let next = self.text.get(self.at..).unwrap_or_default();
        match next {
            [b'#' | b'[' | b'=', ..] => (DiagnosticKind::Expression, self.rest_of_block(start)),
            [0, ..] => (DiagnosticKind::NotText, Place::new(self.at, self.at + 1)),
            [a, b, c, ..] if is_not_a_number([*a, *b, *c]) => {
                self.skip_while(|b| b.is_ascii_alphabetic());
                (DiagnosticKind::NotANumber { letter }, self.since(start))
            }
            [a, b, ..] if a.is_ascii_alphabetic() && b.is_ascii_alphabetic() => {
                self.skip_while(|b| b.is_ascii_alphabetic());
                self.skip_while(is_number_byte);
                (DiagnosticKind::TextOutsideComment, self.since(start))
            }
            // A dash that is no minus, a letter that is no ASCII: the number behind it goes with it.
            [byte, ..] if !byte.is_ascii() => {
                let fault = self.unexpected(self.at, *byte);
                self.skip_while(is_number_byte);
                fault
            }
            _ => (DiagnosticKind::MissingNumber { letter }, Place::new(start, start + 1)),
        }
    }

    /// A byte that starts nothing; a run of them that are no ASCII is one fault.
    fn unexpected(&mut self, start: usize, byte: u8) -> Fault {
        if byte.is_ascii() {
            self.at += 1;
            return match byte {
                0 => (DiagnosticKind::NotText, self.since(start)),
                _ => (
                    DiagnosticKind::UnexpectedCharacter { found: Found::Character(char::from(byte)) },
                    self.since(start),
                ),
            };
        }
        self.skip_while(|b| !b.is_ascii());
        let found = self.text.get(start..self.at).and_then(|run| run.utf8_chunks().next()?.valid().chars().next());
        let found = found.map_or(Found::Byte(byte), Found::Character);
        (DiagnosticKind::UnexpectedCharacter { found }, self.since(start))
    }
}

impl Iterator for Lexer<'_> {
    type Item = Result<Token, Fault>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            self.skip_while(is_blank);
            let start = self.at;
            let byte = self.peek(0)?;
            let fault = match byte {
                b'a'..=b'z' | b'A'..=b'Z' => return Some(self.word(start, byte.to_ascii_uppercase())),
                b'(' if self.syntax.parentheses_comment => match self.comment(start) {
                    Some(fault) => fault,
                    None => continue,
                },
                b';' if self.syntax.semicolon_ends => self.behind_end_of_block(start)?,
                b';' => return None,
                b'$' if self.syntax.macros == Macros::Ngc => match self.spindle_number(start) {
                    Some(fault) => fault,
                    None => continue,
                },
                b':' if self.syntax.macros == Macros::Fanuc => return Some(self.word(start, b'O')),
                b'/' if self.syntax.slashes_comment && self.peek(1) == Some(b'/') => return None,
                b'/' => {
                    self.at += 1;
                    // `/2` … `/9` belong to further switches of the panel; here is one switch for all.
                    self.skip_while(|b| b.is_ascii_digit());
                    return Some(Ok(Token::Slash(self.since(start))));
                }
                // The name of a program, %_N_NAME_MPF.
                b',' if self.syntax.comma_words => return Some(self.comma_word(start)),
                b'%' if self.syntax.calls && self.peek(1) == Some(b'_') => return None,
                b'%' => {
                    self.at += 1;
                    return Some(Ok(Token::Percent(self.since(start))));
                }
                b'#' if matches!(self.syntax.macros, Macros::Fanuc | Macros::Ngc) => {
                    return Some(self.assignment(start));
                }
                b'#' | b'[' | b'=' => (DiagnosticKind::Expression, self.rest_of_block(start)),
                _ if is_number_byte(byte) => {
                    self.skip_while(is_number_byte);
                    (DiagnosticKind::NumberWithoutLetter, self.since(start))
                }
                _ => self.unexpected(start, byte),
            };
            return Some(Err(fault));
        }
    }
}

/// The word behind a place, if it is one of the usual kind: a letter, a number, and then a blank, the next word or the end.
#[inline(always)]
pub(crate) fn plain_word(text: &[u8], at: usize) -> Option<Word> {
    let mut start = at;
    while text.get(start) == Some(&b' ') {
        start += 1;
    }
    let letter = text.get(start)?.to_ascii_uppercase();
    let (number, length) = number::begin(text.get(start + 1..)?)?;
    let end = start + 1 + length;
    let ends = match text.get(end) {
        None | Some(b' ') => true,
        Some(next) => next.is_ascii_alphabetic() && !next.eq_ignore_ascii_case(&b'e'),
    };
    if !ends || !letter.is_ascii_uppercase() || number.value.abs() > number::LARGEST {
        return None;
    }
    Some(Word { letter, number, place: Place::new(start, end), is_distance: None })
}

/// Vertical tab and form feed too: listings have them.
const fn is_blank(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0x0B | 0x0C)
}

const fn is_number_byte(byte: u8) -> bool {
    matches!(byte, b'0'..=b'9' | b'.' | b'+' | b'-')
}

/// What spreadsheets and broken post processors write in place of a number.
fn is_not_a_number(three: [u8; 3]) -> bool {
    three.eq_ignore_ascii_case(b"nan") || three.eq_ignore_ascii_case(b"inf")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each token as text, so that a test reads like the block.
    fn tokens(text: &str) -> Vec<String> {
        let variables = Variables::new(Macros::None);
        Lexer::new(text.as_bytes(), 0, crate::gcode::Dialect::PAPER.syntax, &variables)
            .map(|token| match token {
                Ok(Token::Word(w)) => format!("{}{}@{}", char::from(w.letter), w.number.value, w.place.start),
                Ok(Token::LineNumber(_)) => "N".into(),
                Ok(Token::Percent(_)) => "%".into(),
                Ok(Token::Slash(_)) => "/".into(),
                Ok(Token::Call { name: place, .. } | Token::Assignment { place, .. } | Token::Vacant(place)) => {
                    format!("other@{}", place.start)
                }
                Err((kind, place)) => format!("{}@{}..{}", kind.code(), place.start, place.end),
            })
            .collect()
    }

    #[test]
    fn words_run_together_or_apart() {
        assert_eq!(tokens("G91G81x-.5Y 5."), ["G91@0", "G81@3", "X-0.5@6", "Y5@10"]);
        assert_eq!(tokens("N123456789012345678901234567890 \tM03"), ["N", "M3@33"]);
    }

    #[test]
    fn comments_of_every_kind() {
        assert_eq!(tokens("G0 (a ; b // c) X1 // Y2"), ["G0@0", "X1@16"]);
        assert_eq!(tokens("G0 ; X1"), ["G0@0"]);
        assert_eq!(tokens("// G0"), [""; 0]);
        assert_eq!(tokens("/ G0 / "), ["/", "G0@2", "/"]);
    }

    #[test]
    fn reading_goes_on_after_a_fault() {
        assert_eq!(tokens("X--5 Y1e400 Z2"), ["G103@0..4", "G105@5..11", "Z2@12"]);
        assert_eq!(tokens("XNaN Yinfinity X"), ["G106@0..4", "G106@5..14", "G102@15..16"]);
        assert_eq!(tokens("−5 G0 (open"), ["G101@0..3", "G107@3..4", "G0@5", "G108@8..13"]);
        assert_eq!(tokens("X#1 Y2"), ["G109@0..6"]);
    }
}
