//! Message and hint of every diagnostic, side by side.

use std::fmt;

use super::{DiagnosticKind, DiagnosticKind as K, FeedUse, Found};
use crate::control::cycle::Hand;
use crate::gcode::concern::Concern;
use crate::gcode::number::Decimal;
use crate::gcode::unsupported;

impl DiagnosticKind {
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
            K::Unwise(Concern::SpeedNotReached { out, command_rpm, peak_rpm }) => {
                let way = if out { "out" } else { "in" };
                return (
                    format!("S{command_rpm:.0} is not reached on the stroke {way}: its peak is {peak_rpm:.0} rpm"),
                    "a lower S takes the same time: the stroke is too short for more".into(),
                );
            }
            K::Unwise(Concern::CuttingTooFast { speed_m_per_min, limit_m_per_min }) => (
                format!("{speed_m_per_min:.0} m/min cutting speed; the material bears about {limit_m_per_min:.0}"),
                "lower S, and F with it so that the pitch stays",
            ),
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
                "variables and expressions are not read here".into(),
                "write the value itself, X12.5; the rest of the block was skipped",
            ),
            K::BlockDeleteNotFirst => (
                "'/' stands inside the block".into(),
                "block delete is the first character of a block; a comment begins with '//'",
            ),
            K::PercentNotAlone => {
                ("'%' shares its line with words".into(), "put '%' on a line of its own, first and last of the program")
            }
            K::BlockTooLong { limit } => (
                format!("this block has more than {limit} bytes"),
                "this is not a G-code program, or its line ends are lost: one block on each line",
            ),
            K::NotText => (
                "this file is not plain text: it holds a zero byte".into(),
                "save the program as ASCII or UTF-8 text; nothing after this was read",
            ),
            K::JumpInStream => (
                "a jump needs the program's other lines, and this one is read line by line".into(),
                "give the program as a file",
            ),
            K::BadExpression => (
                "this expression cannot be read".into(),
                "values are numbers, #1, [1 + 2] and SIN[30]; every bracket has its partner",
            ),
            K::UnknownVariable { number } => (
                format!("#{number} is not known here"),
                "fanuc has #1 to #33, #100 to #199 and #500 to #999, linuxcnc #1 to #5000; system variables are not read",
            ),
            K::UnknownName => ("this name was never given a value".into(), "assign it first: #<depth> = 12"),
            K::NotComputable => (
                "this has no value".into(),
                "a division by zero, the root of a negative number, or a result that is too large",
            ),
            K::ExpressionTooDeep { limit } => {
                return (
                    "this expression is nested too deep".into(),
                    format!("at most {limit} levels: compute parts before"),
                );
            }
            K::UnknownStatement => (
                "this statement cannot be read".into(),
                "fanuc: IF [ ] GOTO n, IF [ ] THEN #1 = 2, WHILE [ ] DO 1, END 1, GOTO n; linuxcnc: o1 if [ ], o1 while [ ], o1 call",
            ),
            K::LabelMissing { number } => {
                (format!("there is no block N{} in this program", Decimal(number)), "GOTO names a block's number")
            }
            K::ProgramMissing { program } => (
                format!("there is no program O{program} in this file"),
                "put the subprogram behind M30, begun by its O and ended by M99: other files are not read",
            ),
            K::SubMissing => (
                "there is no subprogram of this name in this file".into(),
                "define it, o100 sub … o100 endsub: other files are not read",
            ),
            K::CallWithoutProgram { name } => (format!("{name} calls no program"), "P is its number: M98 P1000"),
            K::LoopOpen => (
                "this has no partner".into(),
                "WHILE has its END, while its endwhile, if its endif, sub its endsub, with the same number",
            ),
            K::TooDeep { limit } => {
                return (
                    format!("more than {limit} calls or loops inside each other"),
                    "does the subprogram call itself?".into(),
                );
            }
            K::TooManySteps { limit } => {
                return (
                    format!("more than {limit} blocks run again: this loop does not seem to end"),
                    "does its condition ever change?".into(),
                );
            }
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
            K::SameWorkOffset { name } => (
                format!("{name} changes nothing: its zero is where the one before has its"),
                "holes of several work offsets lie over each other here; the times and errors stay right",
            ),
            K::IdleCode { name } => {
                (format!("{name} changes nothing that is simulated"), "it may stay: it is told of once")
            }
            K::IdleWord { letter } => (
                format!("{} changes nothing that is simulated", Letter(letter)),
                "it may stay, Z is the tap's tip whatever the tool: it is told of once",
            ),
            K::UnknownCall => {
                ("no cycle of this name is known".into(), "read are CYCLE84( ), MCALL CYCLE84( ), MCALL and SPOS")
            }
            K::CallParameterUnread { number } => (
                format!("parameter {number} cannot be read"),
                "parameters are numbers with commas between them; one that is left out is nothing between two commas",
            ),
            K::CallParameterBad { number, name } => (
                format!("parameter {number}, {name}, does not fit"),
                "CYCLE84(RTP, RFP, SDIS, DP, DPR, DTB, SDAC, MPIT, PIT, POSS, SST, SST1, AXN, PITA, TECHNO, VARI, DAM, VRT)",
            ),
            K::CallParametersMissing => (
                "the cycle has no parameters".into(),
                "CYCLE84(RTP, RFP, SDIS, DP, DPR, DTB, SDAC, MPIT, PIT, POSS, SST, SST1, …); MCALL alone ends a modal call",
            ),
            K::DwellMissing { .. } => {
                ("this pause has no time".into(), "P says how long: milliseconds on a Fanuc, seconds in LinuxCNC")
            }
            K::MachineFrameIncremental { name } => {
                (format!("{name} under G91: from where?"), "machine coordinates are positions: say G90 with it")
            }
            K::BadOffset { letter: b'L', value } => (
                format!("G10 L{} is not read", Decimal(value)),
                "L2 writes a work offset by its number P; in LinuxCNC L20 as well",
            ),
            K::BadOffset { value, .. } => {
                (format!("P{} is no work offset", Decimal(value)), "P1 is G54, P6 is G59; in LinuxCNC P9 is G59.3")
            }

            K::TapWithoutSpindle => (
                "the tap has no direction: the spindle was not switched on".into(),
                "say M03 for a right-hand thread or M04 for a left-hand one before the cycle",
            ),
            K::TapWithoutSpeed => {
                ("the tap has no speed: S is missing or zero".into(), "say S in rpm before the cycle: M03 S3000")
            }
            K::CycleWordMissing { name, letter: b'R' } => {
                (format!("{name} has no R"), "R is the R plane, where the tap starts, a few pitches above the part")
            }
            K::CycleWordMissing { name, letter } => {
                (format!("{name} has no {}", Letter(letter)), "Z is the bottom of the hole")
            }
            K::PitchNearStandard { pitch_mm, meant } => {
                return (
                    format!(
                        "the pitch is {} mm, nearly but not {} mm ({})",
                        Decimal(pitch_mm),
                        Decimal(meant.pitch_mm),
                        meant.name
                    ),
                    "pitch is F/S under G94 and F under G95: is F or S mistyped or rounded?".into(),
                );
            }
            K::HandAgainstSpindle { name, hand } => {
                let (thread, spindle, right) = match hand {
                    Hand::Right => ("right", "left, M04", "G74"),
                    Hand::Left => ("left", "right, M03", "G84"),
                };
                return (
                    format!("{name} cuts a {thread}-hand thread, and the spindle turns {spindle}"),
                    format!("say the other M code, or {right} for the other hand"),
                );
            }
            K::NotRigid { name } => (
                format!(
                    "{name} without M29 taps in a floating holder, unless parameter 5200 makes it rigid: taken as rigid"
                ),
                "say M29 S… in the block before, or use G84.2 and G84.3",
            ),
            K::PeckNegative { mm } => (format!("the peck Q is {} mm", Decimal(mm)), "Q is a depth, not negative"),
            K::ReturnSpeedNotPositive { value } => {
                (format!("J is {}", Decimal(value)), "J is the speed of the stroke out, above zero")
            }
            K::PitchMissing { name } => (format!("{name} has no pitch"), "K is the pitch: K1 for M6"),
            K::PitchNotUsable { value } => (
                format!("the pitch K is {}", Decimal(value)),
                "a pitch is above zero; on a SINUMERIK a negative one is a left-hand thread",
            ),
            K::StrokeNotAlongZ => {
                ("a synchronous stroke moves Z alone".into(), "position X and Y in a block before, by G0")
            }
            K::StrokeNotDown { from_mm, to_mm } => (
                format!("the stroke in goes from Z {} mm to Z {} mm: not down", Decimal(from_mm), Decimal(to_mm)),
                "stand above the part first: Z is the bottom of the hole",
            ),
            K::StrokeOutAlone => ("this stroke out has no stroke in".into(), "G331 first, then G332"),
            K::StrokeInAlone => (
                "the stroke in before has no stroke out".into(),
                "after G331 comes G332, which turns the tap out again",
            ),
            K::StrokePitchDiffers { in_mm, out_mm } => (
                format!("in with a pitch of {} mm, out with {} mm", Decimal(in_mm), Decimal(out_mm)),
                "both strokes run in one thread: say the same K",
            ),
            K::StrokeOutTooShort { start_mm, end_mm } => (
                format!(
                    "the stroke out ends at Z {} mm, in the hole: it began at Z {} mm",
                    Decimal(end_mm),
                    Decimal(start_mm)
                ),
                "come out at least to where G331 began",
            ),
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
            K::DwellNegative { value } => (format!("the dwell P is {}", Decimal(value)), "P is a time, not negative"),
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
            K::TooManyCommands { limit } => (
                format!("repeats make more than {limit} commands"),
                "are the repeats meant? Split the program where they are",
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
        b'Q' => "this cycle taps in one stroke, without pecks: leave Q out",
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
