//! A line's bytes → its block.

use super::block::{Block, Value, bit, index};
use super::codes::Code;
use super::lexer::{Lexer, plain_word};
use super::siemens::reads_behind;
use super::token::{Content, Token, Word};
use super::variables::{Variable, Variables};
use crate::gcode::dialect::{CodeName, Dialect, GCode, GGroup, Macros, Name};
use crate::gcode::messages::{DiagnosticKind, Fault};
use crate::gcode::text::Place;

impl Block {
    /// Reads the plain words that a line begins with, in place of the block before; where they end. Nearly every line is
    /// such words alone, which need no variables. What is wrong with one goes to `fault`.
    pub(crate) fn begin(&mut self, text: &[u8], dialect: &Dialect, fault: &mut impl FnMut(Fault)) -> usize {
        (self.untaken, self.damaged) = (0, false);
        self.idle.clear();
        self.g.clear();
        self.m.clear();
        self.assignments.clear();
        self.moved = false;
        if std::mem::take(&mut self.has_names) {
            (self.call, self.second_call) = (None, None);
            (self.idle_name, self.frame_name, self.is_distance) = (None, None, [None; 3]);
        }
        self.place = Place { start: 0, end: 0 };
        let mut at = 0;
        while at < text.len()
            && let Some(word) = plain_word(text, at)
        {
            let first = at == 0;
            if word.letter != b'N' {
                if let Err(found) = self.add(word, dialect) {
                    self.damaged = true;
                    fault(found);
                }
            } else if !first {
                break;
            }
            if first {
                self.place.start = word.place.start;
            }
            self.place.end = word.place.end;
            at = word.place.end as usize;
        }
        at
    }

    /// Reads the line on from where [`Block::begin`] ended.
    pub(crate) fn read_on(
        &mut self,
        text: &[u8],
        at: usize,
        dialect: &Dialect,
        variables: &Variables,
        skip_deleted: bool,
        fault: &mut impl FnMut(Fault),
    ) -> Content {
        let mut content = if at == 0 { Content::Nothing } else { Content::Words };
        if at == text.len() {
            return content;
        }
        let mut lexer = Lexer::new(text, at, dialect.syntax, variables);
        let mut first = at == 0;
        loop {
            let token = match lexer.plain_word() {
                Some(word) if word.letter == b'N' => Ok(Token::LineNumber(word.place)),
                Some(word) => Ok(Token::Word(word)),
                None => match lexer.next() {
                    Some(token) => token,
                    None => return content,
                },
            };
            let is_first = std::mem::take(&mut first);
            let result = match token {
                Ok(Token::Word(word)) => self.add(word, dialect).map(|()| word.place),
                Ok(Token::Slash(_)) if is_first && skip_deleted => return Content::Deleted,
                Ok(Token::Slash(_)) if is_first => continue,
                Ok(Token::Slash(place)) => Err((DiagnosticKind::BlockDeleteNotFirst, place)),
                Ok(Token::Percent(place)) if is_first => {
                    content = Content::Percent(place);
                    continue;
                }
                Ok(Token::Percent(place)) => Err((DiagnosticKind::PercentNotAlone, place)),
                Ok(Token::LineNumber(place)) if content == Content::Nothing => Ok(place),
                Ok(Token::LineNumber(place)) => Err((DiagnosticKind::LineNumberNotFirst, place)),
                Ok(Token::Call { name, parameters }) => self.add_name(text, name, parameters),
                Ok(Token::Assignment { variable, value, place }) => {
                    let read_back = matches!(variable, Variable::Number(number)
                        if dialect.syntax.macros == Macros::Siemens && reads_behind(text, place.end as usize, number));
                    self.assignments.push((variable, value, place));
                    if read_back { Err((DiagnosticKind::ReadBehindWrite, place)) } else { Ok(place) }
                }
                Ok(Token::Vacant(place)) => Ok(place),
                Err(found) => Err(found),
            };
            let place = match result {
                Ok(place) => place,
                Err((kind, place)) => {
                    self.damaged = true;
                    fault((kind, place));
                    place
                }
            };
            match content {
                Content::Percent(percent) => {
                    fault((DiagnosticKind::PercentNotAlone, percent));
                    return content;
                }
                Content::Words => self.place.end = place.end,
                Content::Nothing | Content::Deleted => {
                    (content, self.place) = (Content::Words, place);
                }
            }
        }
    }

    #[inline]
    fn add(&mut self, word: Word, dialect: &Dialect) -> Result<(), Fault> {
        let fault = |kind| (kind, word.place);
        match word.letter {
            letter @ (b'G' | b'M') => {
                let name = CodeName::new(letter, word.number.value)
                    .ok_or(fault(DiagnosticKind::NotACode { letter, number: word.number.value }))?;
                self.add_code(name, word.place, dialect).map_err(fault)
            }
            letter if self.known & bit(letter) == 0 && !self.has_macro_call() => {
                Err(fault(DiagnosticKind::UnsupportedWord { letter }))
            }
            letter => {
                self.moved |= matches!(letter, b'X' | b'Y' | b'Z');
                if word.is_distance.is_some() {
                    self.has_names = true;
                    let axis = usize::from(letter.wrapping_sub(b'X'));
                    let slot = self.is_distance.get_mut(axis).ok_or(fault(DiagnosticKind::BadExpression))?;
                    *slot = word.is_distance;
                }
                let value = Value { number: word.number, place: word.place };
                if self.untaken & bit(letter) != 0 {
                    return Err(fault(DiagnosticKind::RepeatedWord { letter }));
                }
                if let Some(slot) = self.values.get_mut(index(letter)) {
                    *slot = value;
                    self.untaken |= bit(letter);
                }
                Ok(())
            }
        }
    }

    /// A name of several letters.
    #[cold]
    fn add_name(&mut self, text: &[u8], name: Place, parameters: Option<Place>) -> Result<Place, Fault> {
        self.has_names = true;
        match Name::of(name.text(text)) {
            Some(Name::Idle(index)) => self.idle_name = Some((index, name)),
            Some(Name::Frame) => self.frame_name = Some(name),
            Some(Name::MachineFrame) => {
                let supa = CodeName { letter: b'G', tenths: 530 };
                let code = Code { meaning: GCode::MachineFrame, name: supa, place: name };
                let group = GGroup::Frame;
                self.g.put(group as usize, None, code, group.sets()).map_err(|kind| (kind, name))?;
            }
            _ if self.call.is_none() => self.call = Some((name, parameters)),
            _ if self.second_call.is_none() => self.second_call = Some((name, parameters)),
            _ => return Err((DiagnosticKind::TextOutsideComment, name)),
        }
        Ok(name)
    }

    fn add_code(&mut self, name: CodeName, place: Place, dialect: &Dialect) -> Result<(), DiagnosticKind> {
        let unknown = DiagnosticKind::UnknownCode { name };
        if name.letter == b'G' {
            let meaning = dialect.g_code(name).ok_or(unknown)?;
            if let GCode::Idle { .. } = meaning {
                let repeated = self.idle.iter().any(|code| code.name == name);
                let full = self.idle.try_push(Code { meaning, name, place }).is_err();
                return if repeated || full { Err(DiagnosticKind::RepeatedCode { name }) } else { Ok(()) };
            }
            let group = meaning.group();
            // A group for each, yet in one block a move and a hole exclude each other.
            let whole = dialect.syntax.cycles_are_motions;
            let other = match group {
                GGroup::Motion => self.g(GGroup::Cycle).filter(|code| whole || code.meaning.is_hole_cycle()),
                GGroup::Cycle if whole || meaning.is_hole_cycle() => self.g(GGroup::Motion),
                _ => None,
            };
            let second = Code { meaning, name, place };
            let sets = if other.is_some() { GGroup::Motion.sets() } else { group.sets() };
            self.g.put(group as usize, other, second, sets)
        } else {
            let meaning = dialect.m_code(name).ok_or(unknown)?;
            let group = meaning.group();
            self.m.put(group as usize, None, Code { meaning, name, place }, group.sets())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Block, Content, Vec<&'static str>) {
        let mut block = Block::new(&Dialect::PAPER);
        let variables = Variables::new(crate::gcode::Macros::None);
        let mut codes = Vec::new();
        let fault = &mut |(kind, _): Fault| codes.push(DiagnosticKind::code(&kind));
        let at = block.begin(text.as_bytes(), &Dialect::PAPER, fault);
        let content = block.read_on(text.as_bytes(), at, &Dialect::PAPER, &variables, true, fault);
        (block, content, codes)
    }

    #[test]
    fn the_papers_blocks() {
        let (mut block, content, faults) = read("G91G81X0Y0Z-25R5F3000 //feed");
        assert_eq!((content, faults), (Content::Words, vec![]));
        assert_eq!(block.g(GGroup::Cycle).map(|code| code.meaning), Some(GCode::Cycle81));
        assert_eq!(block.take(b'Z').map(|value| value.number.value), Some(-25.0));
        assert!(block.take(b'Z').is_none());
        assert_eq!(std::iter::from_fn(|| block.take_leftover()).map(|(letter, _)| letter).collect::<Vec<_>>(), b"FRXY");
        assert_eq!(read("G54G17G80G90G40G49G0").2, [""; 0]);
    }

    #[test]
    fn contents() {
        assert_eq!(read(" (only a comment) // and this").1, Content::Nothing);
        assert_eq!(read("/G0X1").1, Content::Deleted);
        assert!(matches!(read("%").1, Content::Percent(_)));
        assert_eq!(read("N10").1, Content::Words);
    }

    #[test]
    fn conflicts() {
        assert_eq!(read("G90G91").2, ["G206"]);
        assert_eq!(read("G0G81").2, ["G206"]);
        assert_eq!(read("G81G1").2, ["G206"]);
        assert_eq!(read("M3M5 M30M2").2, ["G206", "G206"]);
        assert_eq!(read("G0G00 X1X2").2, ["G205", "G204"]);
        assert_eq!(read("%G0").2, ["G111"]);
        assert_eq!(read("G0%").2, ["G111"]);
        assert_eq!(read("G0 N5").2, ["G207"]);
    }
}
