//! Mitsubishi M70 to M800, and Mazak's G84.2 and G84.3: from memory, and the first hole of a program warns of it.
//!
//! G84 and G74 with `,R1` tap synchronously, with `,R0` in a floating holder; F is the pitch in mm then, or E the threads
//! per inch, whatever G94 and G95 say; `,S` is the speed out. The rest follows FANUC's tables.

use super::definition::{CycleWords, DecimalPoint, Dialect, DwellUnit, G81, ReturnSpeed, Syntax, WordMeaning};
use super::tables::{CHIP_BREAK, F, FANUC_M, H, ISO_G, ISO_SYNTAX, R, S, TOOL, X, Y, Z, word};
use super::{idle, rules};

/// The letter behind a comma, as blocks keep it.
pub(crate) const COMMA_R: u8 = b'[';
/// The letter behind a comma, as blocks keep it.
pub(crate) const COMMA_S: u8 = b'\\';
/// The letter behind a comma, as blocks keep it.
pub(crate) const COMMA_I: u8 = b']';
/// The letter behind a comma, as blocks keep it.
pub(crate) const COMMA_J: u8 = b'^';

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
    word(b'E', "threads per inch of a synchronous cycle"),
    word(b'K', "repeats; 0 stores the cycle's data"),
    word(b'L', "repeats; of M98; kind of G10"),
    word(b'O', "number of a program"),
    word(b'P', "dwell at the bottom in whole ms; of G4 too; offset of G10; program of M98"),
    word(b'Q', "depth of a peck"),
    word(COMMA_R, "1 taps synchronously, 0 in a floating holder"),
    word(COMMA_S, "speed of the stroke out, rpm"),
    word(COMMA_I, "in-position width of the positioning, which changes nothing here"),
    word(COMMA_J, "in-position width at the bottom, which changes nothing here"),
];

impl Dialect {
    /// Mitsubishi: G84 and G74 with `,R1`; Mazak's G84.2 and G84.3.
    pub const MITSUBISHI: Self = Self {
        name: "mitsubishi",
        manual: "Mitsubishi M700V/M70V Programming Manual, synchronous tapping G84 and G74 with ,R1 (from memory)",
        g81: G81::Drill,
        decimal_point: DecimalPoint::Fanuc,
        power_on_inch: false,
        start_angle_deg: None,
        whole_feed: true,
        syntax: Syntax { comma_words: true, ..ISO_SYNTAX },
        cycle: CycleWords {
            dwell: Some(DwellUnit::Milliseconds),
            peck: CHIP_BREAK,
            peck_from_memory: None,
            return_speed: Some(ReturnSpeed::Rpm),
            return_from_memory: None,
            pitch_words: false,
            feed_is_pitch: true,
            repeats: b"KL",
            needs_spindle: false,
            starts_at_r: false,
        },
        rules: rules::FANUC,
        repeats_in_p: false,
        dwell: Some(DwellUnit::Milliseconds),
        dwell_letter: Some(b'X'),
        g_codes: ISO_G,
        more_g_codes: idle::FANUC,
        m_codes: FANUC_M,
        from_memory: true,
        words: WORDS,
    };
}
