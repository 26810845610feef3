//! One block: its words sorted by letter, its codes by modal group. How a line is read into it is in `read`.

use arrayvec::ArrayVec;

use super::codes::{Code, Codes};
use super::variables::Variable;
use crate::gcode::dialect::{CodeName, Dialect, GCode, GGroup, MCode, MGroup};
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
    pub(super) values: [Value; LETTERS],
    /// One bit for each letter with a value that nobody has taken yet.
    pub(super) untaken: u32,
    /// One bit for each letter that the dialect has.
    pub(super) known: u32,
    /// Codes that change no hole: any number may stand in one block.
    pub(crate) idle: ArrayVec<Code<GCode>, MAX_IDLE>,
    pub(super) g: Codes<GCode, { GGroup::COUNT }>,
    pub(super) m: Codes<MCode, { MGroup::COUNT }>,
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
    pub(super) has_names: bool,
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
    pub(super) fn has_macro_call(&self) -> bool {
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
pub(super) const fn index(letter: u8) -> usize {
    letter.wrapping_sub(b'A') as usize
}

pub(super) const fn bit(letter: u8) -> u32 {
    1u32.wrapping_shl(letter.wrapping_sub(b'A') as u32)
}
