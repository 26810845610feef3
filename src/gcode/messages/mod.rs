//! Every diagnostic of the front end: its code, its severity and its words.
//!
//! Codes are stable. G1xx: characters and numbers; G2xx: words of one block; G3xx: modes, feed and spindle;
//! G4xx: the canned cycle; G5xx: the program as a whole; G6xx: what the machine cannot carry out;
//! G7xx: what runs and is unwise.

mod explain;
mod words;

pub use explain::{codes, explain};

use std::fmt;

use super::concern::Concern;
use super::dialect::CodeName;
use super::program::PlanError;
use crate::control::cycle::Hand;
use crate::control::thread::StandardPitch;

/// Whether the program can run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// The program must not run.
    Error,
    /// The program runs, perhaps not as meant.
    Warning,
}

impl Severity {
    /// `"error"` or `"warning"`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Error => "error",
            Self::Warning => "warning",
        }
    }
}

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
        limit: usize,
    },
    NotText,
    JumpInStream,
    BadExpression,
    UnknownVariable {
        number: u32,
    },
    UnknownName,
    NotComputable,
    ExpressionTooDeep {
        limit: u32,
    },
    UnknownStatement,

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
    IdleCode {
        name: CodeName,
    },
    IdleWord {
        letter: u8,
    },
    UnknownCall,
    CallParameterUnread {
        number: usize,
    },
    CallParameterBad {
        number: usize,
        name: &'static str,
    },
    CallParametersMissing,

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
        name: CodeName,
    },
    DwellMissing {
        letter: u8,
    },
    MachineFrameIncremental {
        name: CodeName,
    },
    BadOffset {
        letter: u8,
        value: f64,
    },

    TapWithoutSpindle,
    TapWithoutSpeed,
    CycleWordMissing {
        name: CodeName,
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
        value: f64,
    },
    DwellWithPoint {
        value: f64,
    },
    PitchChanged {
        from_mm: f64,
        to_mm: f64,
    },
    PitchNearStandard {
        pitch_mm: f64,
        meant: StandardPitch,
    },
    HandAgainstSpindle {
        name: CodeName,
        hand: Hand,
    },
    NotRigid {
        name: CodeName,
    },
    PeckNegative {
        mm: f64,
    },
    ReturnSpeedNotPositive {
        value: f64,
    },
    PitchMissing {
        name: CodeName,
    },
    PitchNotUsable {
        value: f64,
    },
    StrokeNotAlongZ,
    StrokeNotDown {
        from_mm: f64,
        to_mm: f64,
    },
    StrokeOutAlone,
    StrokeInAlone,
    StrokePitchDiffers {
        in_mm: f64,
        out_mm: f64,
    },
    StrokeOutTooShort {
        start_mm: f64,
        end_mm: f64,
    },

    EmptyProgram,
    NoProgramEnd,
    TextAfterEnd,
    LabelMissing {
        number: f64,
    },
    ProgramMissing {
        program: u32,
    },
    SubMissing,
    CallWithoutProgram {
        name: CodeName,
    },
    LoopOpen,
    TooDeep {
        limit: usize,
    },
    TooManySteps {
        limit: usize,
    },
    TooManyCommands {
        limit: usize,
    },
    TooMany {
        severity: Severity,
        limit: usize,
    },

    /// The machine cannot carry it out.
    Refused(PlanError),
    /// It runs, and is unwise.
    Unwise(Concern),
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
            | K::PitchNearStandard { .. }
            | K::NotRigid { .. }
            | K::Unwise(_)
            | K::IdleCode { .. }
            | K::IdleWord { .. }
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
            K::JumpInStream => "G115",
            K::BadExpression => "G116",
            K::UnknownVariable { .. } => "G117",
            K::UnknownName => "G118",
            K::NotComputable => "G119",
            K::ExpressionTooDeep { .. } => "G120",
            K::UnknownStatement => "G121",
            K::UnknownCode { .. } => "G201",
            K::NotACode { .. } => "G202",
            K::UnsupportedWord { .. } => "G203",
            K::RepeatedWord { .. } => "G204",
            K::RepeatedCode { .. } => "G205",
            K::ModalConflict { .. } => "G206",
            K::LineNumberNotFirst => "G207",
            K::TwoRepeatWords => "G208",
            K::UnusedWord { .. } => "G209",
            K::IdleCode { .. } => "G210",
            K::IdleWord { .. } => "G211",
            K::UnknownCall => "G212",
            K::CallParameterUnread { .. } => "G213",
            K::CallParameterBad { .. } => "G214",
            K::CallParametersMissing => "G215",
            K::NoMotionMode => "G301",
            K::FeedMissing { .. } => "G302",
            K::FeedNotPositive { .. } => "G303",
            K::FeedNeedsPoint => "G304",
            K::SpeedNegative { .. } => "G305",
            K::SpindleNotTurning => "G306",
            K::SpindleWithoutSpeed { .. } => "G307",
            K::CountedInIncrements { .. } => "G308",
            K::SameWorkOffset { .. } => "G309",
            K::DwellMissing { .. } => "G310",
            K::MachineFrameIncremental { .. } => "G311",
            K::BadOffset { .. } => "G312",
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
            K::HandAgainstSpindle { .. } => "G411",
            K::NotRigid { .. } => "G412",
            K::PeckNegative { .. } => "G413",
            K::ReturnSpeedNotPositive { .. } => "G414",
            K::PitchMissing { .. } => "G415",
            K::PitchNotUsable { .. } => "G416",
            K::StrokeNotAlongZ => "G417",
            K::StrokeNotDown { .. } => "G418",
            K::StrokeOutAlone => "G419",
            K::StrokeInAlone => "G420",
            K::StrokePitchDiffers { .. } => "G421",
            K::StrokeOutTooShort { .. } => "G422",
            K::PitchNearStandard { .. } => "G423",
            K::EmptyProgram => "G501",
            K::NoProgramEnd => "G502",
            K::TextAfterEnd => "G503",
            K::TooMany { .. } => "G504",
            K::TooManyCommands { .. } => "G512",
            K::LabelMissing { .. } => "G505",
            K::ProgramMissing { .. } => "G506",
            K::SubMissing => "G507",
            K::CallWithoutProgram { .. } => "G508",
            K::LoopOpen => "G509",
            K::TooDeep { .. } => "G510",
            K::TooManySteps { .. } => "G511",
            K::Refused(error) => error.code(),
            K::Unwise(Concern::SpeedNotReached { .. }) => "G701",
            K::Unwise(Concern::CuttingTooFast { .. }) => "G702",
        }
    }
}
