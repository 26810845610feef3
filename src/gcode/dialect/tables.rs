//! The tables of each control, each with the manual it follows.
//!
//! Held against text: FANUC's parameter 5200 bit 5 and the P and Q of the peck tap (additional manual A-78549E), and that
//! parameter 5213 is the retract distance of a chip break (the same cycle's description in an operator's manual); CYCLE84's first
//! thirteen parameters, their signs and units (a SINUMERIK 810D/840D text); that the sign of G331's pitch is the thread's
//! hand and that G332 keeps K and S (ISG kernel documentation). Held against the control itself: linuxcnc, by
//! `tests/rs274`. The rest follows the manuals as known, and waits for a reading against them: CYCLE84's VARI, DAM and
//! VRT with its 0, Haas' J, Q and setting 162, FANUC's J.

use super::codes::{GCode, MCode, MGroup};
use super::definition::{
    CycleWords, DecimalPoint, Dialect, DwellUnit, G81, Macros, PECK_BACK_MM, ReturnSpeed, Syntax, WordMeaning,
};
use super::rules;
use crate::control::cycle::{Hand, Retract};

const fn word(letter: u8, meaning: &'static str) -> WordMeaning {
    WordMeaning { letter, meaning }
}

const CHIP_BREAK: Option<Retract> = Some(Retract::ChipBreak { back_mm: PECK_BACK_MM });
const RIGHT: GCode = GCode::Tap { hand: Hand::Right, rigid: false };
const LEFT: GCode = GCode::Tap { hand: Hand::Left, rigid: false };
const RIGID_RIGHT: GCode = GCode::Tap { hand: Hand::Right, rigid: true };
const RIGID_LEFT: GCode = GCode::Tap { hand: Hand::Left, rigid: true };

const X: WordMeaning = word(b'X', "coordinate");
const Y: WordMeaning = word(b'Y', "coordinate");
const Z: WordMeaning = word(b'Z', "coordinate; in a cycle the hole's bottom, under G91 counted from R");
const R: WordMeaning =
    word(b'R', "the R plane, where the synchronous strokes begin and end; under G91 from the initial level");
const F: WordMeaning = word(b'F', "feed per minute (G94), or per revolution: the pitch (G95)");
const S: WordMeaning = word(b'S', "spindle speed in rpm");
const TOOL: WordMeaning = word(b'T', "tool number, which changes nothing here");
const H: WordMeaning = word(b'H', "number of the tool's length, which changes nothing: Z is the tip");

const ISO_WORDS: &[WordMeaning] = &[
    X,
    Y,
    Z,
    R,
    F,
    S,
    TOOL,
    H,
    word(b'P', "dwell at the bottom in whole ms; of G4 too; offset of G10; program of M98"),
    word(b'O', "number of a program"),
    word(b'Q', "depth of a peck"),
    word(b'J', "spindle speed of the stroke out, rpm"),
    word(b'K', "repeats; 0 stores the cycle's data"),
    word(b'L', "repeats of the Series 15 format; of M98; kind of G10"),
];

const HAAS_WORDS: &[WordMeaning] = &[
    X,
    Y,
    Z,
    R,
    F,
    S,
    TOOL,
    H,
    word(b'P', "dwell of G4; offset of G10; program of M98"),
    word(b'O', "number of a program"),
    word(b'Q', "depth of a peck"),
    word(b'J', "the stroke out is this many times faster (in place of setting 130)"),
    word(b'L', "repeats under G91; of M98; kind of G10"),
];

const NGC_WORDS: &[WordMeaning] = &[
    X,
    Y,
    Z,
    R,
    F,
    S,
    TOOL,
    H,
    word(b'P', "dwell in seconds; offset of G10; tolerance of G64"),
    word(b'Q', "tolerance of G64, which changes nothing here"),
    word(b'K', "pitch of G33.1"),
    word(b'I', "factor on the spindle's speed in the stroke out of G33.1"),
    word(b'L', "repeats; kind of G10"),
];

const SIEMENS_WORDS: &[WordMeaning] = &[
    X,
    Y,
    Z,
    F,
    S,
    TOOL,
    word(b'D', "number of the tool's edge, which changes nothing here"),
    word(b'K', "pitch of G331 and G332, negative for a left-hand thread"),
];

#[rustfmt::skip]
const ISO_G: &[(u16, GCode)] = &[
    (0, GCode::Rapid), (10, GCode::Feed), (40, GCode::Dwell), (100, GCode::WriteOffset), (170, GCode::PlaneXy),
    (200, GCode::Inch), (210, GCode::Millimetre), (280, GCode::Home), (300, GCode::Home), (400, GCode::RadiusOff),
    (430, GCode::LengthOn), (490, GCode::LengthOff), (530, GCode::MachineFrame),
    (540, GCode::WorkOffset(1)), (550, GCode::WorkOffset(2)), (560, GCode::WorkOffset(3)),
    (570, GCode::WorkOffset(4)), (580, GCode::WorkOffset(5)), (590, GCode::WorkOffset(6)),
    (610, GCode::PathMode), (640, GCode::PathMode), (650, GCode::MacroCall), (740, LEFT), (800, GCode::CancelCycle), (810, GCode::Cycle81),
    (840, RIGHT), (842, RIGID_RIGHT), (843, RIGID_LEFT), (900, GCode::Absolute), (910, GCode::Incremental),
    (940, GCode::FeedPerMinute), (950, GCode::FeedPerRevolution), (970, GCode::SpeedInRpm),
    (980, GCode::ReturnInitial), (990, GCode::ReturnR),
];

#[rustfmt::skip]
const HAAS_G: &[(u16, GCode)] = &[
    (0, GCode::Rapid), (10, GCode::Feed), (40, GCode::Dwell), (100, GCode::WriteOffset), (170, GCode::PlaneXy),
    (200, GCode::Inch), (210, GCode::Millimetre), (280, GCode::Home), (400, GCode::RadiusOff),
    (430, GCode::LengthOn), (490, GCode::LengthOff), (530, GCode::MachineFrame),
    (540, GCode::WorkOffset(1)), (550, GCode::WorkOffset(2)), (560, GCode::WorkOffset(3)),
    (570, GCode::WorkOffset(4)), (580, GCode::WorkOffset(5)), (590, GCode::WorkOffset(6)),
    (610, GCode::PathMode), (640, GCode::PathMode), (650, GCode::MacroCall), (740, RIGID_LEFT), (800, GCode::CancelCycle),
    (810, GCode::Cycle81), (840, RIGID_RIGHT), (900, GCode::Absolute), (910, GCode::Incremental),
    (940, GCode::FeedPerMinute), (950, GCode::FeedPerRevolution), (980, GCode::ReturnInitial), (990, GCode::ReturnR),
];

#[rustfmt::skip]
const NGC_G: &[(u16, GCode)] = &[
    (0, GCode::Rapid), (10, GCode::Feed), (40, GCode::Dwell), (100, GCode::WriteOffset), (170, GCode::PlaneXy),
    (200, GCode::Inch), (210, GCode::Millimetre), (280, GCode::Home), (300, GCode::Home), (331, GCode::TapStroke),
    (400, GCode::RadiusOff), (430, GCode::LengthOn), (490, GCode::LengthOff), (530, GCode::MachineFrame),
    (540, GCode::WorkOffset(1)), (550, GCode::WorkOffset(2)), (560, GCode::WorkOffset(3)),
    (570, GCode::WorkOffset(4)), (580, GCode::WorkOffset(5)), (590, GCode::WorkOffset(6)),
    (591, GCode::WorkOffset(7)), (592, GCode::WorkOffset(8)), (593, GCode::WorkOffset(9)),
    (610, GCode::PathMode), (611, GCode::PathMode), (640, GCode::PathMode), (740, RIGID_LEFT),
    (800, GCode::CancelCycle), (810, GCode::Cycle81), (840, RIGID_RIGHT), (900, GCode::Absolute),
    (910, GCode::Incremental), (940, GCode::FeedPerMinute), (950, GCode::FeedPerRevolution),
    (970, GCode::SpeedInRpm), (980, GCode::ReturnInitial), (990, GCode::ReturnR),
];

#[rustfmt::skip]
const SIEMENS_G: &[(u16, GCode)] = &[
    (0, GCode::Rapid), (10, GCode::Feed), (40, GCode::Dwell), (90, GCode::CornerMode), (170, GCode::PlaneXy),
    (400, GCode::RadiusOff), (530, GCode::MachineFrame),
    (540, GCode::WorkOffset(1)), (550, GCode::WorkOffset(2)), (560, GCode::WorkOffset(3)), (570, GCode::WorkOffset(4)),
    (600, GCode::PathMode), (640, GCode::PathMode), (700, GCode::Inch), (710, GCode::Millimetre),
    (900, GCode::Absolute), (910, GCode::Incremental), (940, GCode::FeedPerMinute), (950, GCode::FeedPerRevolution),
    (970, GCode::SpeedInRpm), (1530, GCode::MachineFrame), (3310, GCode::StrokeIn), (3320, GCode::StrokeOut),
    (4500, GCode::CornerMode), (4510, GCode::CornerMode), (5000, GCode::WorkOffset(0)),
    (5050, GCode::WorkOffset(5)), (5060, GCode::WorkOffset(6)), (5070, GCode::WorkOffset(7)),
    (5080, GCode::WorkOffset(8)), (5090, GCode::WorkOffset(9)),
    (6010, GCode::CornerMode), (6020, GCode::CornerMode), (6030, GCode::CornerMode), (6410, GCode::PathMode),
    (6420, GCode::PathMode), (6430, GCode::PathMode), (6440, GCode::PathMode), (6450, GCode::PathMode),
    (7000, GCode::Inch), (7100, GCode::Millimetre),
];

const PAPER_M: &[(u16, MCode)] = &[
    (20, MCode::ProgramEnd),
    (30, MCode::SpindleRight),
    (40, MCode::SpindleLeft),
    (50, MCode::SpindleStop),
    (300, MCode::ProgramEnd),
];

/// M codes of every other control.
#[rustfmt::skip]
macro_rules! common_m {
    ($($more:expr),*) => {
        &[
            (0, MCode::Idle(MGroup::Stop)), (10, MCode::Idle(MGroup::Stop)), (20, MCode::ProgramEnd),
            (30, MCode::SpindleRight), (40, MCode::SpindleLeft), (50, MCode::SpindleStop),
            (60, MCode::Idle(MGroup::Tool)), (70, MCode::Idle(MGroup::Coolant)), (80, MCode::Idle(MGroup::Coolant)),
            (90, MCode::Idle(MGroup::Coolant)), (190, MCode::Idle(MGroup::Orient)), (300, MCode::ProgramEnd),
            $($more),*
        ]
    };
}

const FANUC_M: &[(u16, MCode)] = common_m!((290, MCode::RigidTap), (980, MCode::Call), (990, MCode::Return));
const HAAS_M: &[(u16, MCode)] = common_m!((970, MCode::CallLabel), (980, MCode::Call), (990, MCode::Return));
const NGC_M: &[(u16, MCode)] = common_m!((480, MCode::Idle(MGroup::Panel)), (490, MCode::Idle(MGroup::Panel)));
const SIEMENS_M: &[(u16, MCode)] = common_m!((170, MCode::ProgramEnd), (700, MCode::Idle(MGroup::Orient)));

const ISO_SYNTAX: Syntax = Syntax {
    parentheses_comment: true,
    semicolon_ends: true,
    slashes_comment: false,
    macros: Macros::Fanuc,
    calls: false,
    cycles_are_motions: false,
};

impl Dialect {
    /// The control of the torque-curve paper: G81 taps, `//` opens a comment.
    pub const PAPER: Self = Self {
        name: "paper",
        manual: "the torque-curve paper's test program",
        g81: G81::Tap,
        decimal_point: DecimalPoint::Calculator,
        whole_feed: true,
        syntax: Syntax { semicolon_ends: false, slashes_comment: true, macros: Macros::None, ..ISO_SYNTAX },
        cycle: CycleWords {
            dwell: Some(DwellUnit::Milliseconds),
            peck: None,
            return_speed: None,
            repeats: b"KL",
            needs_spindle: true,
            starts_at_r: false,
        },
        rules: rules::PAPER,
        repeats_in_p: false,
        dwell: None,
        #[rustfmt::skip]
        g_codes: &[
            (0, GCode::Rapid), (10, GCode::Feed), (170, GCode::PlaneXy), (200, GCode::Inch), (210, GCode::Millimetre),
            (400, GCode::RadiusOff), (490, GCode::LengthOff), (540, GCode::WorkOffset(1)), (550, GCode::WorkOffset(2)),
            (560, GCode::WorkOffset(3)), (570, GCode::WorkOffset(4)), (580, GCode::WorkOffset(5)),
            (590, GCode::WorkOffset(6)), (800, GCode::CancelCycle), (810, GCode::Cycle81), (900, GCode::Absolute),
            (910, GCode::Incremental), (940, GCode::FeedPerMinute), (950, GCode::FeedPerRevolution),
            (980, GCode::ReturnInitial), (990, GCode::ReturnR),
        ],
        m_codes: PAPER_M,
        words: &[
            X,
            Y,
            Z,
            R,
            F,
            S,
            word(b'P', "dwell at the bottom in whole ms"),
            word(b'K', "repeats; 0 stores the cycle's data"),
            word(b'L', "repeats, the same as K"),
        ],
    };

    /// FANUC series 0i, 30i: G84 and G74 with M29, or G84.2 and G84.3 of the Series 15 format. Parameter 5200 bit 5 (PCP)
    /// makes Q a chip break or a full retract; J needs parameters 5200 bit 4 and 5201 bit 4.
    pub const FANUC: Self = Self {
        name: "fanuc",
        manual: "FANUC Series 0i-D Operator's Manual for Machining Center, B-64304EN-2, canned cycles for drilling and \
                 rigid tapping; custom macros in B-64304EN",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Fanuc,
        whole_feed: true,
        syntax: ISO_SYNTAX,
        cycle: CycleWords {
            dwell: Some(DwellUnit::Milliseconds),
            peck: CHIP_BREAK,
            return_speed: Some(ReturnSpeed::Rpm),
            repeats: b"KL",
            needs_spindle: false,
            starts_at_r: false,
        },
        rules: rules::FANUC,
        repeats_in_p: true,
        dwell: Some(DwellUnit::Milliseconds),
        g_codes: ISO_G,
        m_codes: FANUC_M,
        words: ISO_WORDS,
    };

    /// LinuxCNC 2.9: G33.1, and G84 and G74, which are rigid here though LinuxCNC's need a floating chuck.
    pub const LINUXCNC: Self = Self {
        name: "linuxcnc",
        manual: "LinuxCNC 2.9 documentation, G-Code Reference, and the NIST RS274/NGC Interpreter Version 3 (NISTIR 6556)",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Calculator,
        whole_feed: true,
        syntax: Syntax { semicolon_ends: false, macros: Macros::Ngc, cycles_are_motions: true, ..ISO_SYNTAX },
        cycle: CycleWords {
            dwell: Some(DwellUnit::Seconds),
            peck: None,
            return_speed: None,
            repeats: b"L",
            needs_spindle: true,
            starts_at_r: true,
        },
        rules: rules::LINUXCNC,
        repeats_in_p: false,
        dwell: Some(DwellUnit::Seconds),
        g_codes: NGC_G,
        m_codes: NGC_M,
        words: NGC_WORDS,
    };

    /// Haas mills: the tapping cycle is rigid and starts the spindle itself.
    pub const HAAS: Self = Self {
        name: "haas",
        manual: "Haas Mill Operator's Manual, Next Generation Control, G84 tapping canned cycle, settings 130 and 162",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Fanuc,
        whole_feed: false,
        syntax: ISO_SYNTAX,
        cycle: CycleWords {
            dwell: None,
            peck: CHIP_BREAK,
            return_speed: Some(ReturnSpeed::Factor),
            repeats: b"L",
            needs_spindle: false,
            starts_at_r: false,
        },
        rules: rules::HAAS,
        repeats_in_p: false,
        dwell: Some(DwellUnit::SecondsWithPoint),
        g_codes: HAAS_G,
        m_codes: HAAS_M,
        words: HAAS_WORDS,
    };

    /// SINUMERIK 840D: G331 with G332, and CYCLE84, by itself or modal by MCALL.
    pub const SIEMENS: Self = Self {
        name: "siemens",
        manual: "SINUMERIK 840D sl Programming Manual, Fundamentals (G331, G332) and Cycles (CYCLE84)",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Calculator,
        whole_feed: true,
        syntax: Syntax {
            parentheses_comment: false,
            semicolon_ends: false,
            slashes_comment: false,
            macros: Macros::Siemens,
            calls: true,
            cycles_are_motions: true,
        },
        cycle: CycleWords {
            dwell: None,
            peck: None,
            return_speed: None,
            repeats: b"",
            needs_spindle: false,
            starts_at_r: false,
        },
        rules: rules::LINUXCNC,
        repeats_in_p: false,
        dwell: Some(DwellUnit::Seconds),
        g_codes: SIEMENS_G,
        m_codes: SIEMENS_M,
        words: SIEMENS_WORDS,
    };
}
