//! Code and severity of every diagnostic.
//!
//! Codes are stable. G1xx: characters and numbers; G2xx: words of one block; G3xx: modes, feed and spindle;
//! G4xx: the canned cycle; G5xx: the program as a whole; G6xx: what the machine cannot carry out;
//! G7xx: warnings of planning.

use super::kind::{DiagnosticKind, DiagnosticKind as K, Severity};
use crate::gcode::warning::Warning;

impl DiagnosticKind {
    /// Whether the program can run all the same.
    #[must_use]
    pub const fn severity(&self) -> Severity {
        match self {
            K::HandReplaced { .. }
            | K::SpindleWithoutSpeed { .. }
            | K::PowerOnMotion
            | K::LooksLike { .. }
            | K::PitchTooFine { .. }
            | K::PitchTapered { .. }
            | K::OtherReferencePoint
            | K::ToolLengthEnded
            | K::DialectFromMemory { .. }
            | K::RuleFromMemory { .. }
            | K::DepthTwice { .. }
            | K::CallParameterIdle { .. }
            | K::IdleName
            | K::ProgramNotCalled { .. }
            | K::CountedInIncrements { .. }
            | K::SameWorkOffset { .. }
            | K::SameHoleAgain { .. }
            | K::PitchChanged { .. }
            | K::PitchNearStandard { .. }
            | K::NotRigid { .. }
            | K::Warning(_)
            | K::IdleCode { .. }
            | K::IdleWord { .. }
            | K::NoProgramEnd
            | K::TextAfterEnd => Severity::Warning,
            K::TooMany { severity, .. } => *severity,
            _ => Severity::Error,
        }
    }

    /// Whether both tell of one cause, which is told once: a setting of the control, or a habit of the program.
    pub(crate) fn has_cause_of(&self, other: &Self) -> bool {
        match (self, other) {
            (K::CountedInIncrements { letter, .. }, K::CountedInIncrements { letter: other, .. }) => letter == other,
            (
                K::NotRigid { .. }
                | K::HandReplaced { .. }
                | K::SameWorkOffset { .. }
                | K::PitchNearStandard { .. }
                | K::RuleFromMemory { .. },
                _,
            ) => self == other,
            _ => false,
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
            K::ReadBehindWrite => "G124",
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
            K::CallNotAlone => "G225",
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
            K::UnusedCode { .. } => "G216",
            K::CycleAlone { .. } => "G425",
            K::ZeroRepeatsWithPosition => "G426",
            K::CycleUnitChanged { .. } => "G427",
            K::HandReplaced { .. } => "G424",
            K::TextBehindEndOfBlock => "G122",
            K::WordWithoutHole { .. } => "G217",
            K::ProgramNotCalled { .. } => "G513",
            K::ProgramAmbiguous { .. } => "G514",
            K::CallCountsTwice => "G515",
            K::CallRepeatsBad { .. } => "G516",
            K::ArgumentNeedsPoint { .. } => "G218",
            K::ExtendedAddress { .. } => "G123",
            K::IdleName => "G219",
            K::FrameNotRead => "G220",
            K::CallParameterIdle { .. } => "G221",
            K::DepthTwice { .. } => "G222",
            K::PatternWithoutCycle => "G223",
            K::PatternParameter { .. } => "G224",
            K::ShiftWithoutAxes => "G313",
            K::ToolLengthEnded => "G318",
            K::PlaneNotExact { .. } => "G316",
            K::AngleNeedsPoint { .. } => "G317",
            K::DialectFromMemory { .. } => "G428",
            K::PitchTwice { .. } => "G429",
            K::NotSynchronous => "G430",
            K::OtherReferencePoint => "G314",
            K::RuleFromMemory { .. } => "G433",
            K::PitchTooFine { .. } => "G431",
            K::PitchTapered { .. } => "G432",
            K::LooksLike { .. } => "G517",
            K::PowerOnMotion => "G315",
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
            K::Planning { error, .. } => error.code(),
            K::Warning(Warning::SpeedNotReached { .. }) => "G701",
            K::Warning(Warning::CuttingTooFast { .. }) => "G702",
            K::Warning(Warning::LawSlowed { .. }) => "G703",
        }
    }
}
