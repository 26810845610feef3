//! The tables of each control, each with the manual it follows.
//!
//! Held against text: FANUC's parameter 5200 bit 5 and the P and Q of the peck tap (additional manual A-78549E), and that
//! parameter 5213 is the retract distance of a chip break (the same cycle's description in an operator's manual); CYCLE84's first
//! thirteen parameters, their signs and units (a SINUMERIK 810D/840D text); that the sign of G331's pitch is the thread's
//! hand and that G332 keeps K and S (ISG kernel documentation). Held against the control itself: linuxcnc, by
//! `tests/gcode/rs274`. The rest follows the manuals as known, and waits for a reading against them: CYCLE84's VARI, DAM and
//! VRT with its 0, Haas' J, Q and setting 162, FANUC's J.

use super::codes::{GCode, MCode, MGroup};
use super::definition::{
    CycleWords, DecimalPoint, Dialect, DwellUnit, G81, Macros, PECK_BACK_MM, ReturnSpeed, Syntax, WordMeaning,
};
use super::idle;
use super::rules;
use crate::control::cycle::{Hand, Retract};

pub(super) const fn word(letter: u8, meaning: &'static str) -> WordMeaning {
    WordMeaning { letter, meaning }
}

pub(super) const CHIP_BREAK: Option<Retract> = Some(Retract::ChipBreak { back_mm: PECK_BACK_MM });
const RIGHT: GCode = GCode::Tap { hand: Hand::Right, rigid: false };
const LEFT: GCode = GCode::Tap { hand: Hand::Left, rigid: false };
pub(super) const RIGID_RIGHT: GCode = GCode::Tap { hand: Hand::Right, rigid: true };
pub(super) const RIGID_LEFT: GCode = GCode::Tap { hand: Hand::Left, rigid: true };

pub(super) const X: WordMeaning = word(b'X', "coordinate");
pub(super) const Y: WordMeaning = word(b'Y', "coordinate");
pub(super) const Z: WordMeaning = word(b'Z', "coordinate; in a cycle the hole's bottom, under G91 counted from R");
pub(super) const R: WordMeaning =
    word(b'R', "the R plane, where the synchronous strokes begin and end; under G91 from the initial level");
pub(super) const F: WordMeaning = word(b'F', "feed per minute (G94), or per revolution: the pitch (G95)");
pub(super) const S: WordMeaning = word(b'S', "spindle speed in rpm");
pub(super) const TOOL: WordMeaning = word(b'T', "tool number, which changes nothing here");
pub(super) const H: WordMeaning = word(b'H', "number of the tool's length, which changes nothing: Z is the tip");

pub(super) const ISO_WORDS: &[WordMeaning] = &[
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
    word(b'D', "number of a radius, which changes nothing here"),
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
    word(b'E', "speed at which chips are thrown off after the hole, which changes no hole; of G187"),
    word(b'D', "number of a radius, which changes nothing here"),
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
    word(b'E', "analog output of M66, which changes no hole"),
];

#[rustfmt::skip]
pub(super) const ISO_G: &[(u16, GCode)] = &[
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

const COOLANT: MCode = MCode::Idle(MGroup::Coolant);
const DEVICE: MCode = MCode::Idle(MGroup::Device);
const PANEL: MCode = MCode::Idle(MGroup::Panel);

#[rustfmt::skip]
pub(super) const FANUC_M: &[(u16, MCode)] = common_m!(
    (100, DEVICE), (110, DEVICE), (480, PANEL), (490, PANEL), (500, MCode::Idle(MGroup::Coolant)), (510, MCode::Idle(MGroup::Coolant)), (600, DEVICE),
    (280, PANEL), (290, MCode::RigidTap), (980, MCode::Call), (990, MCode::Return), (1980, MCode::Call));
#[rustfmt::skip]
pub(super) const BROTHER_M: &[(u16, MCode)] = common_m!(
    (100, DEVICE), (110, DEVICE), (480, PANEL), (490, PANEL), (980, MCode::Call), (990, MCode::Return),
    (4000, COOLANT), (4010, COOLANT), (4020, COOLANT), (4030, COOLANT), (4940, COOLANT), (4950, COOLANT));
#[rustfmt::skip]
const HAAS_M: &[(u16, MCode)] = common_m!(
    (100, DEVICE), (110, DEVICE), (120, DEVICE), (130, DEVICE), (160, MCode::Idle(MGroup::Tool)), (310, DEVICE), (330, DEVICE), (340, DEVICE), (350, DEVICE),
    (360, DEVICE), (410, DEVICE), (420, DEVICE), (500, DEVICE), (590, DEVICE), (690, DEVICE), (730, DEVICE), (740, DEVICE),
    (800, DEVICE), (810, DEVICE), (820, DEVICE), (830, DEVICE), (840, DEVICE), (860, DEVICE), (880, MCode::Idle(MGroup::Coolant)), (890, MCode::Idle(MGroup::Coolant)), (1040, DEVICE), (1050, DEVICE),
    (970, MCode::CallLabel), (980, MCode::Call), (990, MCode::Return));
#[rustfmt::skip]
const NGC_M: &[(u16, MCode)] = common_m!((480, PANEL), (490, PANEL), (500, PANEL), (510, PANEL), (520, PANEL), (530, PANEL), (600, MCode::Idle(MGroup::Stop)), (610, DEVICE), (620, DEVICE), (630, DEVICE), (640, DEVICE), (650, DEVICE), (660, DEVICE));
pub(super) const SIEMENS_M: &[(u16, MCode)] = common_m!((170, MCode::ProgramEnd), (700, MCode::Idle(MGroup::Orient)));

pub(super) const ISO_SYNTAX: Syntax = Syntax {
    parentheses_comment: true,
    semicolon_ends: true,
    slashes_comment: false,
    macros: Macros::Fanuc,
    calls: false,
    comma_words: false,
    cycles_are_motions: false,
};

impl Dialect {
    /// The control of the torque-curve paper: G81 taps, `//` opens a comment.
    pub const PAPER: Self = Self {
        name: "paper",
        manual: "the torque-curve paper's test program",
        g81: G81::Tap,
        decimal_point: DecimalPoint::Calculator,
        power_on_inch: false,
        start_angle_deg: None,
        whole_feed: true,
        syntax: Syntax { semicolon_ends: false, slashes_comment: true, macros: Macros::None, ..ISO_SYNTAX },
        cycle: CycleWords {
            dwell: Some(DwellUnit::Milliseconds),
            peck: None,
            peck_from_memory: None,
            return_speed: None,
            return_from_memory: None,
            pitch_words: false,
            feed_is_pitch: false,
            repeats: b"KL",
            needs_spindle: true,
            starts_at_r: false,
        },
        rules: rules::PAPER,
        repeats_in_p: false,
        dwell: None,
        dwell_letter: None,
        #[rustfmt::skip]
        g_codes: &[
            (0, GCode::Rapid), (10, GCode::Feed), (170, GCode::PlaneXy), (200, GCode::Inch), (210, GCode::Millimetre),
            (400, GCode::RadiusOff), (490, GCode::LengthOff), (540, GCode::WorkOffset(1)), (550, GCode::WorkOffset(2)),
            (560, GCode::WorkOffset(3)), (570, GCode::WorkOffset(4)), (580, GCode::WorkOffset(5)),
            (590, GCode::WorkOffset(6)), (800, GCode::CancelCycle), (810, GCode::Cycle81), (900, GCode::Absolute),
            (910, GCode::Incremental), (940, GCode::FeedPerMinute), (950, GCode::FeedPerRevolution),
            (980, GCode::ReturnInitial), (990, GCode::ReturnR),
        ],
        more_g_codes: &[],
        m_codes: PAPER_M,
        from_memory: false,
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
        power_on_inch: false,
        start_angle_deg: None,
        whole_feed: true,
        syntax: ISO_SYNTAX,
        cycle: CycleWords {
            dwell: Some(DwellUnit::Milliseconds),
            peck: CHIP_BREAK,
            peck_from_memory: None,
            return_speed: Some(ReturnSpeed::Rpm),
            return_from_memory: Some("J is the spindle speed of the stroke out (parameters 5200 bit 4 and 5201 bit 4)"),
            pitch_words: false,
            feed_is_pitch: false,
            repeats: b"KL",
            needs_spindle: false,
            starts_at_r: false,
        },
        rules: rules::FANUC,
        repeats_in_p: true,
        dwell: Some(DwellUnit::Milliseconds),
        dwell_letter: Some(b'X'),
        g_codes: ISO_G,
        more_g_codes: idle::FANUC,
        m_codes: FANUC_M,
        from_memory: false,
        words: ISO_WORDS,
    };

    /// LinuxCNC 2.9: G33.1, and G84 and G74, which are rigid here though LinuxCNC's need a floating chuck.
    pub const LINUXCNC: Self = Self {
        name: "linuxcnc",
        manual: "LinuxCNC 2.9 documentation, G-Code Reference, and the NIST RS274/NGC Interpreter Version 3 (NISTIR 6556)",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Calculator,
        power_on_inch: false,
        start_angle_deg: None,
        whole_feed: true,
        syntax: Syntax { semicolon_ends: false, macros: Macros::Ngc, cycles_are_motions: true, ..ISO_SYNTAX },
        cycle: CycleWords {
            dwell: Some(DwellUnit::Seconds),
            peck: None,
            peck_from_memory: None,
            return_speed: None,
            return_from_memory: None,
            pitch_words: false,
            feed_is_pitch: false,
            repeats: b"L",
            needs_spindle: true,
            starts_at_r: true,
        },
        rules: rules::LINUXCNC,
        repeats_in_p: false,
        dwell: Some(DwellUnit::Seconds),
        dwell_letter: None,
        g_codes: NGC_G,
        more_g_codes: idle::LINUXCNC,
        m_codes: NGC_M,
        from_memory: false,
        words: NGC_WORDS,
    };

    /// Haas mills: the tapping cycle is rigid and starts the spindle itself.
    pub const HAAS: Self = Self {
        name: "haas",
        manual: "Haas Mill Operator's Manual, Next Generation Control, G84 tapping canned cycle, settings 130 and 162",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Fanuc,
        power_on_inch: false,
        start_angle_deg: None,
        whole_feed: false,
        syntax: ISO_SYNTAX,
        cycle: CycleWords {
            dwell: None,
            peck: CHIP_BREAK,
            peck_from_memory: Some("Q taps in pecks (setting 162)"),
            return_speed: Some(ReturnSpeed::Factor),
            return_from_memory: Some("J is how many times faster the stroke out is"),
            pitch_words: false,
            feed_is_pitch: false,
            repeats: b"L",
            needs_spindle: false,
            starts_at_r: false,
        },
        rules: rules::HAAS,
        repeats_in_p: false,
        dwell: Some(DwellUnit::SecondsWithPoint),
        dwell_letter: None,
        g_codes: HAAS_G,
        more_g_codes: idle::HAAS,
        m_codes: HAAS_M,
        from_memory: false,
        words: HAAS_WORDS,
    };
}
