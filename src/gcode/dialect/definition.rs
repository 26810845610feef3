//! What the codes of a control mean, as data: another control is another table, not another interpreter.

use super::codes::{CodeName, GCode, MCode};
use super::rules::CycleRules;
use crate::control::cycle::Retract;

/// What G81 does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum G81 {
    /// Taps rigidly, as the paper's control does.
    #[default]
    Tap,
    /// Drills: rapid to R, feed to the bottom, rapid back, as in RS274 and on most controls.
    Drill,
}

/// What a length without a decimal point means.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DecimalPoint {
    /// What it says: X10 is 10 mm.
    #[default]
    Calculator,
    /// Least increments: X10 is 10 µm, in inches 0.0001 inch each. Every such length is warned.
    Fanuc,
}

/// What P of a dwell counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DwellUnit {
    /// Whole milliseconds.
    Milliseconds,
    /// Seconds.
    Seconds,
    /// Seconds with a decimal point, milliseconds without.
    SecondsWithPoint,
}

/// What J of a tapping cycle says of the stroke out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReturnSpeed {
    /// Its spindle speed.
    Rpm,
    /// How many times faster than the stroke in it is.
    Factor,
}

/// Variables and statements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Macros {
    /// None.
    None,
    /// `#1`, IF … GOTO, WHILE … DO, M98.
    Fanuc,
    /// `#1`, `#<name>`, O words.
    Ngc,
    /// R parameters.
    Siemens,
}

/// How a block is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Syntax {
    /// `( )` is a comment; else it holds the parameters of a call.
    pub parentheses_comment: bool,
    /// `;` ends the block, as on the tape; else it begins a comment.
    pub semicolon_ends: bool,
    /// `//` begins a comment.
    pub slashes_comment: bool,
    /// Variables and statements.
    pub macros: Macros,
    /// Names longer than a letter are calls: CYCLE84( ), MCALL.
    pub calls: bool,
    /// `,R1`: letters behind a comma are words of their own.
    pub comma_words: bool,
    /// G80 and the cycles are of the group of G0 and G1.
    pub cycles_are_motions: bool,
}

/// What the words of the tapping cycle mean, beside R, Z, F and S.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CycleWords {
    /// P: the dwell at the bottom; none if the cycle has none.
    pub dwell: Option<DwellUnit>,
    /// Q: the depth of a peck, and what each peck does at its end.
    pub peck: Option<Retract>,
    /// What is told of Q where no manual was found for it.
    pub peck_from_memory: Option<&'static str>,
    /// J: the stroke out.
    pub return_speed: Option<ReturnSpeed>,
    /// What is told of J where no manual was found for it.
    pub return_from_memory: Option<&'static str>,
    /// Letters of the pitch itself: I in mm, J in threads per inch (Brother).
    pub pitch_words: bool,
    /// F of a rigid cycle is the pitch, whatever G94 and G95 say (Mitsubishi).
    pub feed_is_pitch: bool,
    /// Letters that count the repeats.
    pub repeats: &'static [u8],
    /// The spindle has to turn by M03 or M04; else the cycle starts it itself.
    pub needs_spindle: bool,
    /// At power on cycles return to R (G99), else to the initial level (G98).
    pub starts_at_r: bool,
}

/// A letter with its meaning, and the manual that says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WordMeaning {
    /// Upper case.
    pub letter: u8,
    /// What the number after it is.
    pub meaning: &'static str,
}

/// One control's reading of G-code.
///
/// ```
/// use rigidtap::gcode::{Dialect, G81};
/// let drilling = Dialect { g81: G81::Drill, ..Dialect::PAPER };
/// assert_eq!(Dialect::by_name("paper").map(|d| d.name), Some(drilling.name));
/// assert!(Dialect::by_name("fanuc").unwrap().word(b'J').unwrap().meaning.contains("out"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dialect {
    /// As the machine file and the command line name it.
    pub name: &'static str,
    /// The manual that its tables follow.
    pub manual: &'static str,
    /// Meaning of G81.
    pub g81: G81,
    /// Meaning of a length without a decimal point.
    pub decimal_point: DecimalPoint,
    /// Lengths are in inches until G20 or G21 says otherwise: a setting of the control.
    pub power_on_inch: bool,
    /// Angle at which the spindle rests on the R plane before each hole that says none itself; none: wherever it comes to rest.
    pub start_angle_deg: Option<f64>,
    /// F in mm/min counts whole millimetres without its point, too; else F always needs its point.
    pub whole_feed: bool,
    /// How a block is written.
    pub syntax: Syntax,
    /// Words of the tapping cycle.
    pub cycle: CycleWords,
    /// What its blocks make and keep.
    pub rules: CycleRules,
    /// P of M98 holds a count before the last four digits, the program's number (P30001); else P is the number.
    pub repeats_in_p: bool,
    /// P of G4; none if there is no G4.
    pub dwell: Option<DwellUnit>,
    /// Another letter for the time of G4: X, or F in seconds.
    pub dwell_letter: Option<u8>,
    /// G codes, by ten times their number, in rising order.
    pub g_codes: &'static [(u16, GCode)],
    /// More of them: what this control has beside those of its family.
    pub more_g_codes: &'static [(u16, GCode)],
    /// M codes, by ten times their number.
    pub m_codes: &'static [(u16, MCode)],
    /// The tables follow what is remembered of the manual: the first hole warns of it.
    pub from_memory: bool,
    /// Letters beside G, M and N that have a meaning.
    pub words: &'static [WordMeaning],
}

/// Distance by which a chip-breaking peck turns back, unless the program or the machine file says otherwise: what
/// CYCLE84 takes where its VRT is zero (SINUMERIK 840D, Programming Manual Cycles).
pub const PECK_BACK_MM: f64 = 1.0;

impl Dialect {
    /// What a letter means, if anything.
    #[must_use]
    pub fn word(&self, letter: u8) -> Option<WordMeaning> {
        self.words.iter().find(|word| word.letter == letter).copied()
    }

    pub(crate) fn g_code(&self, name: CodeName) -> Option<GCode> {
        let find = |codes: &'static [(u16, GCode)]| {
            let found = codes.binary_search_by_key(&name.tenths, |(tenths, _)| *tenths).ok()?;
            codes.get(found).map(|(_, code)| *code)
        };
        find(self.g_codes).or_else(|| find(self.more_g_codes))
    }

    pub(crate) fn m_code(&self, name: CodeName) -> Option<MCode> {
        self.m_codes.iter().find(|(tenths, _)| *tenths == name.tenths).map(|(_, code)| *code)
    }
}
