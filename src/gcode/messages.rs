//! Every diagnostic of the front end: its code, its severity and its words.
//!
//! Codes are stable. G1xx: characters and numbers; G2xx: words of one block; G3xx: modes, feed and spindle;
//! G4xx: the canned cycle; G5xx: the program as a whole; G6xx: what the machine cannot carry out.

use std::fmt;

use super::diagnostics::Severity;
use super::dialect::CodeName;
use super::number::Decimal;
use super::program::PlanError;
use super::unsupported;

/// A character that starts no word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Found {
    /// It reads as a character.
    Character(char),
    /// It is no UTF-8.
    Byte(u8),
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Character(c) if c.is_control() => write!(f, "control character {:#04x}", u32::from(*c)),
            Self::Character(c) => write!(f, "character '{c}'"),
            Self::Byte(byte) => write!(f, "byte {byte:#04x}"),
        }
    }
}

/// What needs a feed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeedUse {
    /// A G1 move or a drilled hole.
    Move,
    /// A tapped hole, F being a speed.
    PitchFromSpeed,
    /// A tapped hole, F being the pitch.
    Pitch,
}

/// What was found, with the numbers and letters concerned. Letters are ASCII, upper case.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs, reason = "each kind is told by its message below")]
pub enum DiagnosticKind {
    UnexpectedCharacter {
        found: Found,
    },
    MissingNumber {
        letter: u8,
    },
    MalformedNumber {
        letter: u8,
    },
    NumberTooLarge {
        letter: u8,
    },
    ExponentNotation {
        letter: u8,
    },
    NotANumber {
        letter: u8,
    },
    NumberWithoutLetter,
    TextOutsideComment,
    UnclosedComment,
    Expression,
    BlockDeleteNotFirst,
    PercentNotAlone,
    BlockTooLong {
        bytes: usize,
        limit: usize,
    },
    NotText,

    UnknownCode {
        name: CodeName,
    },
    NotACode {
        letter: u8,
        number: f64,
    },
    UnsupportedWord {
        letter: u8,
    },
    RepeatedWord {
        letter: u8,
    },
    RepeatedCode {
        name: CodeName,
    },
    ModalConflict {
        first: CodeName,
        second: CodeName,
        sets: &'static str,
    },
    LineNumberNotFirst,
    TwoRepeatWords,
    UnusedWord {
        letter: u8,
    },

    NoMotionMode,
    FeedMissing {
        needed_for: FeedUse,
    },
    FeedNotPositive {
        feed: f64,
    },
    FeedNeedsPoint,
    SpeedNegative {
        rpm: f64,
    },
    SpindleNotTurning,
    SpindleWithoutSpeed {
        name: CodeName,
    },
    CountedInIncrements {
        letter: u8,
        mm: f64,
    },
    SameWorkOffset {
        number: u8,
    },

    TapWithoutSpindle,
    TapWithoutSpeed,
    CycleWordMissing {
        letter: u8,
    },
    BottomNotBelowR {
        bottom_mm: f64,
        r_plane_mm: f64,
        incremental: bool,
    },
    BadRepeats {
        repeats: f64,
    },
    TooManyRepeats {
        repeats: f64,
        limit: u32,
    },
    SameHoleAgain {
        times: u32,
    },
    DwellNegative {
        ms: f64,
    },
    DwellWithPoint {
        value: f64,
    },
    PitchChanged {
        from_mm: f64,
        to_mm: f64,
    },

    EmptyProgram,
    NoProgramEnd,
    TextAfterEnd,
    TooMany {
        severity: Severity,
        limit: usize,
    },

    /// The machine cannot carry it out.
    Refused(PlanError),
}

use DiagnosticKind as K;

impl DiagnosticKind {
    /// Whether the program can run all the same.
    #[must_use]
    pub const fn severity(&self) -> Severity {
        match self {
            K::SpindleWithoutSpeed { .. }
            | K::CountedInIncrements { .. }
            | K::SameWorkOffset { .. }
            | K::SameHoleAgain { .. }
            | K::PitchChanged { .. }
            | K::NoProgramEnd
            | K::TextAfterEnd => Severity::Warning,
            K::TooMany { severity, .. } => *severity,
            _ => Severity::Error,
        }
    }

    /// Stable name.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            K::UnexpectedCharacter { .. } => "G101",
            K::MissingNumber { .. } => "G102",
            K::MalformedNumber { .. } => "G103",
            K::NumberTooLarge { .. } => "G104",
            K::ExponentNotation { .. } => "G105",
            K::NotANumber { .. } => "G106",
            K::NumberWithoutLetter => "G107",
            K::UnclosedComment => "G108",
            K::Expression => "G109",
            K::BlockDeleteNotFirst => "G110",
            K::PercentNotAlone => "G111",
            K::BlockTooLong { .. } => "G112",
            K::NotText => "G113",
            K::TextOutsideComment => "G114",
            K::UnknownCode { .. } => "G201",
            K::NotACode { .. } => "G202",
            K::UnsupportedWord { .. } => "G203",
            K::RepeatedWord { .. } => "G204",
            K::RepeatedCode { .. } => "G205",
            K::ModalConflict { .. } => "G206",
            K::LineNumberNotFirst => "G207",
            K::TwoRepeatWords => "G208",
            K::UnusedWord { .. } => "G209",
            K::NoMotionMode => "G301",
            K::FeedMissing { .. } => "G302",
            K::FeedNotPositive { .. } => "G303",
            K::FeedNeedsPoint => "G304",
            K::SpeedNegative { .. } => "G305",
            K::SpindleNotTurning => "G306",
            K::SpindleWithoutSpeed { .. } => "G307",
            K::CountedInIncrements { .. } => "G308",
            K::SameWorkOffset { .. } => "G309",
            K::TapWithoutSpindle => "G401",
            K::TapWithoutSpeed => "G402",
            K::CycleWordMissing { .. } => "G403",
            K::BottomNotBelowR { .. } => "G404",
            K::BadRepeats { .. } => "G405",
            K::TooManyRepeats { .. } => "G406",
            K::SameHoleAgain { .. } => "G407",
            K::DwellNegative { .. } => "G408",
            K::DwellWithPoint { .. } => "G409",
            K::PitchChanged { .. } => "G410",
            K::EmptyProgram => "G501",
            K::NoProgramEnd => "G502",
            K::TextAfterEnd => "G503",
            K::TooMany { .. } => "G504",
            K::Refused(error) => error.code(),
        }
    }

    /// What is wrong.
    #[must_use]
    pub fn message(&self) -> String {
        self.words().0
    }

    /// What to do about it.
    #[must_use]
    pub fn hint(&self) -> String {
        self.words().1
    }

    /// Message and hint side by side, so that they fit each other.
    fn words(&self) -> (String, String) {
        let (message, hint): (String, &str) = match *self {
            K::Refused(error) => (error.to_string(), error.hint()),
            K::UnexpectedCharacter { found: Found::Character(')') } => {
                ("')' closes no comment".into(), "a comment ends at its first ')': comments do not nest")
            }
            K::UnexpectedCharacter { found: Found::Character(dash @ ('\u{2010}'..='\u{2015}' | '\u{2212}')) } => {
                (format!("'{dash}' is a dash of another kind than minus"), "type '-' in its place")
            }
            K::UnexpectedCharacter { found } => (
                format!("{found} has no meaning in G-code"),
                "a block is made of words such as X12.5; text goes in a comment, ( ) or ;",
            ),
            K::MissingNumber { letter } => {
                (format!("{} has no number", Letter(letter)), "write its number right after it, as in X12.5")
            }
            K::MalformedNumber { letter } => (
                format!("the number after {} cannot be read", Letter(letter)),
                "a number has at most one sign, in front, and one point: -12.5",
            ),
            K::NumberTooLarge { letter } => {
                (format!("the number after {} is too large", Letter(letter)), "no word carries more than 1000000000")
            }
            K::ExponentNotation { letter } => (
                format!("the number after {} has an exponent", Letter(letter)),
                "G-code has no exponents: write all digits, 1500 for 1.5e3",
            ),
            K::NotANumber { letter } => (
                format!("{} is followed by a word in place of a number", Letter(letter)),
                "a post processor writes this where a calculation failed: look there",
            ),
            K::NumberWithoutLetter => (
                "this number belongs to no letter".into(),
                "put its letter in front; a number has no blanks inside, X10 and not X1 0",
            ),
            K::TextOutsideComment => (
                "these letters are no words of G-code".into(),
                "put text in a comment, ( ) or ; (statements such as IF and GOTO are not read)",
            ),
            K::UnclosedComment => ("this comment does not end".into(), "close it with ')' on the same line"),
            K::Expression => (
                "variables and expressions are not read".into(),
                "write the value itself, X12.5; the rest of the block was skipped",
            ),
            K::BlockDeleteNotFirst => (
                "'/' stands inside the block".into(),
                "block delete is the first character of a block; a comment begins with '//'",
            ),
            K::PercentNotAlone => {
                ("'%' shares its line with words".into(), "put '%' on a line of its own, first and last of the program")
            }
            K::BlockTooLong { bytes, limit } => (
                format!("this block has {bytes} bytes, more than {limit}"),
                "this is not a G-code program, or its line ends are lost: one block on each line",
            ),
            K::NotText => (
                "this file is not plain text: it holds a zero byte".into(),
                "save the program as ASCII or UTF-8 text; nothing after this was read",
            ),
            K::UnknownCode { name } => (
                format!("{name} is not known in this dialect"),
                unsupported::code_hint(name).unwrap_or("leave it out, or take the dialect that has it"),
            ),
            K::NotACode { letter, number } => (
                format!("{}{} is no code", Letter(letter), Decimal(number)),
                "codes are 0 to 999.9 with at most one decimal",
            ),
            K::UnsupportedWord { letter } => (
                format!("{} has no meaning in this dialect", Letter(letter)),
                unsupported::word_hint(letter).unwrap_or("leave the word out"),
            ),
            K::RepeatedWord { letter } => {
                (format!("{} stands twice in one block", Letter(letter)), "keep the one that is meant")
            }
            K::RepeatedCode { name } => (format!("{name} stands twice in one block"), "keep one"),
            K::ModalConflict { first, second, sets } => (
                format!("{first} and {second} in one block: both set {sets}"),
                "keep the one that is meant, or put them in two blocks",
            ),
            K::LineNumberNotFirst => {
                ("N stands inside the block".into(), "a line number is the first word of its block")
            }
            K::TwoRepeatWords => ("K and L in one block: both count the repeats".into(), "keep one"),
            K::UnusedWord { letter } => {
                return (format!("{} does nothing in this block", Letter(letter)), unused_hint(letter).into());
            }

            K::NoMotionMode => (
                "nothing says how to move: no G0, G1 or G81 is active".into(),
                "begin the block with G0 for a rapid, G1 for a feed, G81 for a hole; G80 ended the cycle before",
            ),
            K::FeedMissing { needed_for: FeedUse::Move } => (
                "there is no feed: no F is in force".into(),
                "say F in this block or before it; a change between G94 and G95 asks for F anew",
            ),
            K::FeedMissing { needed_for: FeedUse::PitchFromSpeed } => (
                "the tap has no pitch: no F is in force".into(),
                "pitch is F/S: for M6, pitch 1 mm, at S3000 say F3000; or say G95 and F1",
            ),
            K::FeedMissing { needed_for: FeedUse::Pitch } => {
                ("the tap has no pitch: no F is in force since G95".into(), "say F with the pitch: G95 F1 for M6")
            }
            K::FeedNotPositive { feed } => {
                (format!("F is {}", Decimal(feed)), "F must be above zero; the thread's hand comes from M03 or M04")
            }
            K::FeedNeedsPoint => (
                "F without a decimal point has no sure meaning here".into(),
                "under decimal_point = \"fanuc\" write F with its point, F1. for a pitch of 1 mm",
            ),
            K::SpeedNegative { rpm } => {
                (format!("S is {}", Decimal(rpm)), "S is a speed in rpm, not negative; backwards is M04")
            }
            K::SpindleNotTurning => (
                "under G95 the feed follows the spindle, and the spindle does not turn".into(),
                "say S and M03 or M04 before, or G94 for a feed per minute",
            ),
            K::SpindleWithoutSpeed { name } => {
                (format!("{name} turns nothing yet: there is no S"), "say S in the same block: M03 S3000")
            }
            K::CountedInIncrements { letter, mm } => {
                return (
                    format!("{} without a decimal point is {} mm", Letter(letter), Decimal(mm)),
                    "write the point, or set decimal_point = \"calculator\" if the number is meant as it stands".into(),
                );
            }
            K::SameWorkOffset { number } => (
                format!("G{number} changes nothing: all work offsets are zero"),
                "holes of several work offsets lie over each other here; the times and errors stay right",
            ),

            K::TapWithoutSpindle => (
                "the tap has no direction: the spindle was not switched on".into(),
                "say M03 for a right-hand thread or M04 for a left-hand one before the cycle",
            ),
            K::TapWithoutSpeed => {
                ("the tap has no speed: S is missing or zero".into(), "say S in rpm before the cycle: M03 S3000")
            }
            K::CycleWordMissing { letter: b'R' } => {
                ("G81 has no R".into(), "R is the R plane, where the tap starts, a few pitches above the part")
            }
            K::CycleWordMissing { letter } => (format!("G81 has no {}", Letter(letter)), "Z is the bottom of the hole"),
            K::BottomNotBelowR { bottom_mm, r_plane_mm, incremental } => (
                format!(
                    "the bottom, Z {} mm, is not below the R plane, Z {} mm",
                    Decimal(bottom_mm),
                    Decimal(r_plane_mm)
                ),
                if incremental {
                    "under G91 R counts from the initial level and Z from the R plane: Z-25 for 25 mm deep"
                } else {
                    "under G90 Z and R are positions: Z must be the lower one"
                },
            ),
            K::BadRepeats { repeats } => {
                (format!("a hole cannot be repeated {} times", Decimal(repeats)), "K and L are whole numbers from 0")
            }
            K::TooManyRepeats { repeats, limit } => {
                return (
                    format!("{} repeats are more than a control takes", Decimal(repeats)),
                    format!("at most {limit} in one block"),
                );
            }
            K::SameHoleAgain { times } => (
                format!("the same hole is tapped {times} times"),
                "repeats step by X and Y under G91 only; say G91, or leave the repeats out",
            ),
            K::DwellNegative { ms } => (format!("the dwell P is {}", Decimal(ms)), "P is a time, not negative"),
            K::DwellWithPoint { value } => (
                format!("the dwell P{} has a decimal point: are these seconds?", Decimal(value)),
                "P counts whole milliseconds: P500 for half a second",
            ),
            K::PitchChanged { from_mm, to_mm } => (
                format!("the pitch is now {} mm, it was {} mm: S changed, F did not", Decimal(to_mm), Decimal(from_mm)),
                "pitch is F/S: say F anew with S, or give the pitch itself by G95",
            ),

            K::EmptyProgram => ("the program is empty: there is no word in it".into(), "is this the right file?"),
            K::NoProgramEnd => (
                "the program does not end: neither M30 nor M02, nor a closing '%'".into(),
                "end it with M30, so that a cut file is noticed",
            ),
            K::TextAfterEnd => (
                "this stands after the program's end and is not read".into(),
                "delete it, or move M30 or '%' behind it",
            ),
            K::TooMany { severity, limit } => (
                format!("more than {limit} {}s: the rest is not shown", severity.name()),
                "mend the first ones and check again",
            ),
        };
        (message, hint.into())
    }
}

impl fmt::Display for DiagnosticKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message())
    }
}

/// Why a known word found no use.
const fn unused_hint(letter: u8) -> &'static str {
    match letter {
        b'P' => "a dwell belongs to the tapping cycle, and none is active",
        b'R' => "it belongs to a canned cycle, and none is active",
        b'K' | b'L' => "it repeats a hole: say it with G81, or under G81 with X, Y or Z",
        _ => "leave it out, or say what it is for",
    }
}

/// A letter as text.
struct Letter(u8);

impl fmt::Display for Letter {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", char::from(self.0))
    }
}
