//! Brother's CNC-C00, the Speedio: from memory, and the first hole of a program warns of it.
//!
//! G77 taps a right-hand thread and G78 a left-hand one, synchronously: I is the pitch in mm or J the threads per inch, S
//! the speed in, L the speed out, Q a peck, P a dwell. The rest follows FANUC's tables.

use super::codes::{GCode, IdleWords};
use super::definition::{CycleWords, DecimalPoint, Dialect, DwellUnit, G81, ReturnSpeed, WordMeaning};
use super::rules;
use super::tables::{
    BROTHER_M, CHIP_BREAK, F, H, ISO_G, ISO_SYNTAX, R, RIGID_LEFT, RIGID_RIGHT, S, TOOL, X, Y, Z, word,
};

const WORDS: &[WordMeaning] = &[
    X,
    Y,
    Z,
    R,
    F,
    S,
    TOOL,
    H,
    word(b'D', "number of a radius, which changes nothing here"),
    word(b'I', "pitch of G77 and G78 in mm"),
    word(b'J', "threads per inch of G77 and G78"),
    word(b'K', "repeats; 0 stores the cycle's data"),
    word(b'L', "speed of the stroke out, rpm; repeats of M98; kind of G10"),
    word(b'O', "number of a program"),
    word(b'P', "dwell at the bottom in seconds, without its point in ms; of G4 too; offset of G10; program of M98"),
    word(b'Q', "depth of a peck"),
];

impl Dialect {
    /// Brother Speedio: G77 and G78 with I or J.
    pub const BROTHER: Self = Self {
        name: "brother",
        manual: "Brother CNC-C00 Programming Manual, G77 and G78 (from memory)",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Fanuc,
        power_on_inch: false,
        start_angle_deg: None,
        whole_feed: true,
        syntax: ISO_SYNTAX,
        cycle: CycleWords {
            dwell: Some(DwellUnit::SecondsWithPoint),
            peck: CHIP_BREAK,
            peck_from_memory: None,
            return_speed: Some(ReturnSpeed::Rpm),
            return_from_memory: None,
            pitch_words: true,
            feed_is_pitch: false,
            repeats: b"K",
            needs_spindle: false,
            starts_at_r: false,
        },
        rules: rules::FANUC,
        repeats_in_p: false,
        dwell: Some(DwellUnit::SecondsWithPoint),
        dwell_letter: Some(b'X'),
        g_codes: ISO_G,
        more_g_codes: BROTHER_G,
        m_codes: BROTHER_M,
        from_memory: true,
        words: WORDS,
    };
}

#[rustfmt::skip]
const BROTHER_G: &[(u16, GCode)] = &[
    (80, GCode::Idle { words: IdleWords::P }), (90, GCode::Idle { words: IdleWords::None }), (150, GCode::Idle { words: IdleWords::None }),
    (501, GCode::Idle { words: IdleWords::None }), (520, GCode::LocalShift), (541, GCode::ExtendedOffset),
    (670, GCode::Idle { words: IdleWords::None }), (680, GCode::Rotate), (690, GCode::Unrotate), (770, RIGID_RIGHT), (780, RIGID_LEFT),
    (920, GCode::SetPosition), (1000, GCode::ToolChange),
];
