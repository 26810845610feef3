//! Words about the words of one block.

use super::kind::DiagnosticKind as K;
use super::letter::Letter;
use super::unsupported;
use crate::gcode::dialect::{COMMA_I, COMMA_J};
use crate::gcode::text::Decimal;

/// Message and hint of a finding in the words of a block; none of any other finding.
pub(super) fn words(kind: &K) -> Option<(String, String)> {
    let (message, hint): (String, &str) = match *kind {
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
        K::LineNumberNotFirst => ("N stands inside the block".into(), "a line number is the first word of its block"),
        K::TwoRepeatWords => ("K and L in one block: both count the repeats".into(), "keep one"),
        K::UnusedWord { letter } => {
            return Some((format!("{} does nothing in this block", Letter(letter)), unused_hint(letter).into()));
        }

        K::IdleCode { name } if name.letter == b'M' && [60, 190].contains(&name.tenths) => (
            format!("{name} stops the spindle; nothing else of it is simulated"),
            "say M03 or M04 after it where the next cycle does not turn the spindle by itself",
        ),
        K::IdleCode { name } => {
            (format!("{name} changes nothing that is simulated"), "it may stay: it is reported once")
        }
        K::IdleWord { letter } => (
            format!("{} changes nothing that is simulated", Letter(letter)),
            match letter {
                b'E' => "it may stay, chips are thrown off after the hole: it is reported once",
                COMMA_I | COMMA_J => "it may stay, it is how exactly the axes arrive: it is reported once",
                _ => "it may stay, Z is the tap's tip whatever the tool: it is reported once",
            },
        ),
        K::UnknownCall => (
            "no cycle of this name is known, and there is no file of this name beside the program".into(),
            "read are CYCLE84( ), MCALL CYCLE84( ), HOLES1( ), HOLES2( ), MCALL, SPOS, SUPA, subprograms in files, and what changes no hole",
        ),
        K::CallParameterUnread { number } => (
            format!("parameter {number} cannot be read"),
            "parameters are numbers with commas between them; one that is left out is nothing between two commas",
        ),
        K::CallParameterBad { number, name } => (
            format!("parameter {number}, {name}, does not fit"),
            "CYCLE84(RTP, RFP, SDIS, DP, DPR, DTB, SDAC, MPIT, PIT, POSS, SST, SST1, AXN, PITA, TECHNO, VARI, DAM, VRT, 3 texts, GMODE, DMODE, AMODE): rigidtap check --explain G214",
        ),
        K::CallNotAlone => (
            "a cycle is called in a block of its own: the words beside it have no sure order".into(),
            "move the axes in the block before, and say M codes in their own",
        ),
        K::CallParametersMissing => (
            "the cycle has no parameters".into(),
            "CYCLE84(RTP, RFP, SDIS, DP, DPR, DTB, SDAC, MPIT, PIT, POSS, SST, SST1, …); MCALL alone ends a modal call",
        ),
        K::UnusedCode { name } => (
            format!("{name} does nothing in this block"),
            "take it out, or say what it is for: machine coordinates (G53) belong to G0 and G1, not to a cycle",
        ),
        K::WordWithoutHole { letter } => (
            format!("{} stands in a block that makes no hole, and is not stored there", Letter(letter)),
            "say it in a block that makes a hole: with X or Y",
        ),
        K::ArgumentNeedsPoint { letter } => (
            format!("argument {} of G65 has no decimal point", char::from(letter)),
            "write its point: without it the number counts increments that differ from letter to letter",
        ),
        K::IdleName => ("this changes nothing that is simulated".into(), "it may stay: it is reported once"),
        K::FrameNotRead => (
            "coordinates are not shifted, turned or scaled here".into(),
            "write the positions in one system, or leave the axes out: TRANS alone ends a shift",
        ),
        K::CallParameterIdle { number, name } => (
            format!("parameter {number}, {name}, changes nothing that is simulated"),
            "it may stay: TECHNO is how axes accelerate and stop; DAM and VRT act with VARI alone",
        ),
        K::DepthTwice { used } => (format!("DP and DPR are two depths: {used} holds"), "give one of them"),
        K::PatternWithoutCycle => (
            "this pattern has no cycle: no MCALL is in force".into(),
            "say MCALL CYCLE84( ) before it, and MCALL after it",
        ),
        K::PatternParameter { number, name } => (
            format!("parameter {number}, {name}, does not fit"),
            "HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM), HOLES2(CPA, CPO, RAD, STA1, INDA, NUM)",
        ),
        _ => return None,
    };
    Some((message, hint.into()))
}

/// Why a known word found no use.
const fn unused_hint(letter: u8) -> &'static str {
    match letter {
        b'P' => {
            "nothing in this block takes it: a dwell belongs to the cycle or G4, a program to M98, an offset to G10"
        }
        b'R' => "it belongs to a canned cycle, and none is active",
        b'Q' => "this cycle taps in one stroke, without pecks: leave Q out",
        b'K' | b'L' => "it repeats a hole: say it with G81, or under G81 with X, Y or Z",
        _ => "leave it out, or say what it is for",
    }
}
