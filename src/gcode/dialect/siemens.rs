//! SINUMERIK 840D: G331 with G332, CYCLE84, calls by name.

use super::codes::GCode;
use super::definition::{CycleWords, DecimalPoint, Dialect, DwellUnit, G81, Macros, Syntax, WordMeaning};
use super::rules;
use super::tables::{F, S, SIEMENS_M, TOOL, X, Y, Z, word};

const SIEMENS_WORDS: &[WordMeaning] = &[
    X,
    Y,
    Z,
    F,
    S,
    TOOL,
    word(b'D', "number of the tool's edge, which changes nothing here"),
    word(b'L', "number of a subprogram, whose file is L10.SPF"),
    word(b'P', "how often a subprogram runs"),
    word(b'K', "pitch of G331 and G332, negative for a left-hand thread"),
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

impl Dialect {
    /// SINUMERIK 840D: G331 with G332, and CYCLE84, by itself or modal by MCALL.
    pub const SIEMENS: Self = Self {
        name: "siemens",
        manual: "SINUMERIK 840D sl Programming Manual, Fundamentals (G331, G332) and Cycles (CYCLE84)",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Calculator,
        power_on_inch: false,
        start_angle_deg: None,
        whole_feed: true,
        syntax: Syntax {
            parentheses_comment: false,
            semicolon_ends: false,
            slashes_comment: false,
            macros: Macros::Siemens,
            calls: true,
            comma_words: false,
            cycles_are_motions: true,
        },
        cycle: CycleWords {
            dwell: None,
            peck: None,
            peck_from_memory: None,
            return_speed: None,
            return_from_memory: None,
            pitch_words: false,
            feed_is_pitch: false,
            repeats: b"",
            needs_spindle: false,
            starts_at_r: false,
        },
        rules: rules::LINUXCNC,
        repeats_in_p: false,
        dwell: Some(DwellUnit::Seconds),
        dwell_letter: Some(b'F'),
        g_codes: SIEMENS_G,
        more_g_codes: &[],
        m_codes: SIEMENS_M,
        from_memory: false,
        words: SIEMENS_WORDS,
    };
}
