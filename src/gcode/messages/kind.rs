//! Every diagnostic of the front end: its code, its severity and its words.
//!
//! Codes are stable. G1xx: characters and numbers; G2xx: words of one block; G3xx: modes, feed and spindle;
//! G4xx: the canned cycle; G5xx: the program as a whole; G6xx: what the machine cannot carry out;
//! G7xx: warnings of planning.

use std::fmt;

use crate::control::cycle::Hand;
use crate::control::thread::StandardPitch;
use crate::gcode::dialect::CodeName;
use crate::gcode::planning_error::PlanError;
use crate::gcode::text::Place;
use crate::gcode::warning::Warning;

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
#[allow(missing_docs, reason = "the message of each kind explains it")]
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
    TextBehindEndOfBlock,
    ExtendedAddress {
        letter: u8,
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
    UnusedCode {
        name: CodeName,
    },
    WordWithoutHole {
        letter: u8,
    },
    ArgumentNeedsPoint {
        letter: u8,
    },
    IdleName,
    FrameNotRead,
    CallParameterIdle {
        number: usize,
        name: &'static str,
    },
    DepthTwice {
        used: &'static str,
    },
    PatternWithoutCycle,
    PatternParameter {
        number: usize,
        name: &'static str,
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
    CallNotAlone,

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

    ShiftWithoutAxes,
    ToolLengthEnded,
    OtherReferencePoint,
    PowerOnMotion,
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
    CycleAlone {
        name: CodeName,
    },
    ZeroRepeatsWithPosition,
    CycleUnitChanged {
        name: CodeName,
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
    HandReplaced {
        name: CodeName,
        hand: Hand,
    },
    DialectFromMemory {
        name: &'static str,
    },
    RuleFromMemory {
        says: &'static str,
    },
    PitchTwice {
        letters: &'static str,
    },
    NotSynchronous,
    PitchTooFine {
        pitch_mm: f64,
        feed_is_pitch: bool,
        inch: bool,
    },
    PitchTapered {
        standard: StandardPitch,
    },
    NotRigid {
        name: CodeName,
        by: &'static str,
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
    ProgramNotCalled {
        program: u32,
    },
    ProgramAmbiguous {
        program: u32,
    },
    CallCountsTwice,
    CallRepeatsBad {
        repeats: f64,
    },
    LooksLike {
        name: &'static str,
    },
    TextAfterEnd,
    LabelMissing {
        number: f64,
    },
    ProgramMissing {
        program: u32,
    },
    ReadBehindWrite,
    PlaneNotExact {
        why: &'static str,
    },
    AngleNeedsPoint {
        letter: u8,
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
    Planning {
        error: PlanError,
        /// Of the hole.
        pitch_mm: Option<f64>,
    },
    /// The machine can carry it out, and should not.
    Warning(Warning),
}

/// What is wrong, and where in the block.
pub(crate) type Fault = (DiagnosticKind, Place);
