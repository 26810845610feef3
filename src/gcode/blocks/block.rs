//! One block: its words sorted by letter, its codes by modal group.

use arrayvec::ArrayVec;

use super::codes::{Code, Codes};
use super::lexer::Lexer;
use super::siemens::reads_behind;
use super::token::{Content, Token, Word};
use super::variables::{Variable, Variables};
use crate::gcode::dialect::{CodeName, Dialect, GCode, GGroup, MCode, MGroup, Macros, Name};
use crate::gcode::messages::{DiagnosticKind, Fault};
use crate::gcode::text::{Number, Place};

/// A word's number and place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Value {
    pub(crate) number: Number,
    pub(crate) place: Place,
}

/// Letters, and those behind a comma.
const LETTERS: usize = 30;
/// Most codes without effect in one block.
const MAX_IDLE: usize = 16;

/// Reused from line to line, so that reading allocates nothing.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    values: [Value; LETTERS],
    /// One bit for each letter with a value that nobody has taken yet.
    untaken: u32,
    /// One bit for each letter that the dialect has.
    known: u32,
    /// Codes that change no hole: any number may stand in one block.
    pub(crate) idle: ArrayVec<Code<GCode>, MAX_IDLE>,
    g: Codes<GCode, { GGroup::COUNT }>,
    m: Codes<MCode, { MGroup::COUNT }>,
    /// Name and parameters of a call.
    pub(crate) call: Option<(Place, Option<Place>)>,
    /// What MCALL makes modal.
    pub(crate) second_call: Option<(Place, Option<Place>)>,
    /// A name that changes no hole, and its place in the table of names.
    pub(crate) idle_name: Option<(u8, Place)>,
    /// A name that ends a frame, or begins one.
    pub(crate) frame_name: Option<Place>,
    /// What X, Y and Z say by IC( ) and AC( ) themselves.
    pub(crate) is_distance: [Option<bool>; 3],
    /// Variables to write when all else has acted.
    pub(crate) assignments: Vec<(Variable, Option<f64>, Place)>,
    /// X, Y or Z stood in the block.
    pub(crate) moved: bool,
    /// A name stood in it, or IC( ) or AC( ).
    has_names: bool,
    /// A word could not be read, so that a word that is missing may be that one.
    pub(crate) damaged: bool,
    /// From the first word to the last.
    pub(crate) place: Place,
}

impl Block {
    pub(crate) fn new(dialect: &Dialect) -> Self {
        let nothing = Value {
            number: Number { value: 0.0, has_point: false, computed: false },
            place: Place { start: 0, end: 0 },
        };
        Self {
            values: [nothing; LETTERS],
            untaken: 0,
            known: dialect.words.iter().map(|word| bit(word.letter)).fold(0, |known, bit| known | bit),
            idle: ArrayVec::new(),
            g: Codes::new(GCode::Rapid),
            m: Codes::new(MCode::ProgramEnd),
            call: None,
            second_call: None,
            idle_name: None,
            frame_name: None,
            is_distance: [None; 3],
            assignments: Vec::new(),
            moved: false,
            has_names: false,
            damaged: false,
            place: Place { start: 0, end: 0 },
        }
    }

    /// Reads a line in place of the block before; what is wrong with it goes to `fault`.
    pub(crate) fn read(
        &mut self,
        text: &[u8],
        dialect: &Dialect,
        variables: &Variables,
        skip_deleted: bool,
        fault: &mut impl FnMut(Fault),
    ) -> Content {
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
        let mut content = Content::Nothing;
        let mut lexer = Lexer::new(text, dialect.syntax, variables);
        let mut first = true;
        loop {
            let plain = lexer.plain_word();
            let is_first = std::mem::take(&mut first);
            if let Some(word) = plain.filter(|word| word.letter != b'N' && !matches!(content, Content::Percent(_))) {
                if let Err(found) = self.add(word, dialect) {
                    self.damaged = true;
                    fault(found);
                }
                if !matches!(content, Content::Words) {
                    (content, self.place) = (Content::Words, word.place);
                }
                self.place.end = word.place.end;
                continue;
            }
            let token = match plain {
                Some(word) if word.letter == b'N' => Ok(Token::LineNumber(word.place)),
                Some(word) => Ok(Token::Word(word)),
                None => match lexer.next() {
                    Some(token) => token,
                    None => return content,
                },
            };
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

    /// Whether there is a G code of one of these groups, a bit for each.
    pub(crate) const fn has_g_of(&self, groups: u32) -> bool {
        self.g.given & groups != 0
    }

    /// Whether it holds X, Y, Z and a code of the motion alone, as nearly every block does.
    #[inline]
    pub(crate) fn only_moves(&self) -> bool {
        let plain = self.untaken & !(bit(b'X') | bit(b'Y') | bit(b'Z')) == 0
            && self.g.given & !(1 << GGroup::Motion as u32) == 0
            && self.m.given == 0;
        plain && !self.has_names && self.idle.is_empty() && self.assignments.is_empty()
    }

    /// Whether somebody acted on each word and code.
    #[inline]
    pub(crate) const fn all_acted(&self) -> bool {
        self.untaken == 0 && self.g.all_acted() && self.m.all_acted()
    }

    /// Whether there is a word or a code beside names.
    pub(crate) const fn has_words(&self) -> bool {
        self.untaken != 0 || self.g.given != 0 || self.m.given != 0
    }

    /// Whether there is an M code.
    pub(crate) const fn has_m(&self) -> bool {
        self.m.given != 0
    }

    /// The code of a modal group.
    pub(crate) fn g(&self, group: GGroup) -> Option<Code<GCode>> {
        self.g.get(group as usize)
    }

    /// The code of a modal group.
    pub(crate) fn m(&self, group: MGroup) -> Option<Code<MCode>> {
        self.m.get(group as usize)
    }

    /// Behind G65 every letter is an argument.
    fn has_macro_call(&self) -> bool {
        self.g(GGroup::OneShot).is_some_and(|code| code.meaning == GCode::MacroCall)
    }

    /// The code of a modal group, for somebody who acts on it.
    pub(crate) fn take_g(&mut self, group: GGroup) -> Option<Code<GCode>> {
        self.g.take(group as usize)
    }

    /// The code of a modal group, for somebody who acts on it.
    pub(crate) fn take_m(&mut self, group: MGroup) -> Option<Code<MCode>> {
        self.m.take(group as usize)
    }

    /// A code that nobody acted on, with its place.
    pub(crate) fn take_unacted_code(&mut self) -> Option<(CodeName, Place)> {
        let g = self.g.take_unacted().map(|code| (code.name, code.place));
        g.or_else(|| self.m.take_unacted().map(|code| (code.name, code.place)))
    }

    /// Whether the word is there and nobody has taken it.
    pub(crate) fn has(&self, letter: u8) -> bool {
        self.untaken & bit(letter) != 0
    }

    /// Whether one of these letters is there and nobody has taken it; names, and codes without effect, count as one.
    pub(crate) fn has_idle(&self, letters: &[u8]) -> bool {
        let mask = letters.iter().fold(0, |mask, &letter| mask | bit(letter));
        self.untaken & mask != 0 || !self.idle.is_empty() || self.idle_name.is_some() || self.frame_name.is_some()
    }

    /// The word, for somebody who acts on it. What nobody takes is diagnosed.
    pub(crate) fn take(&mut self, letter: u8) -> Option<Value> {
        if !self.has(letter) {
            return None;
        }
        self.untaken &= !bit(letter);
        self.values.get(index(letter)).copied()
    }

    /// Where the word stands, if nobody has taken it.
    pub(crate) fn place_of(&self, letter: u8) -> Option<Place> {
        self.has(letter).then(|| self.values.get(index(letter)).map(|value| value.place)).flatten()
    }

    /// Takes what nobody acted on.
    pub(crate) fn take_leftover(&mut self) -> Option<(u8, Place)> {
        let lowest = self.untaken.trailing_zeros();
        self.untaken &= self.untaken.wrapping_sub(1);
        let value = self.values.get(lowest as usize)?;
        Some((b'A' + lowest as u8, value.place))
    }
}

/// Words are upper case when they come here.
const fn index(letter: u8) -> usize {
    letter.wrapping_sub(b'A') as usize
}

const fn bit(letter: u8) -> u32 {
    1u32.wrapping_shl(letter.wrapping_sub(b'A') as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (Block, Content, Vec<&'static str>) {
        let mut block = Block::new(&Dialect::PAPER);
        let variables = Variables::new(crate::gcode::Macros::None);
        let mut codes = Vec::new();
        let content =
            block.read(text.as_bytes(), &Dialect::PAPER, &variables, true, &mut |(kind, _)| codes.push(kind.code()));
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
