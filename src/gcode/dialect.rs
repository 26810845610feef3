//! What the codes of a control mean, as data: another control is another table, not another interpreter.

use std::fmt;

/// Meaning of a G code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GCode {
    /// Rapid move.
    Rapid,
    /// Straight move at feed.
    Feed,
    /// XY plane: the only one, since tapping is along Z.
    PlaneXy,
    /// Lengths in inches.
    Inch,
    /// Lengths in millimetres.
    Millimetre,
    /// Cutter radius compensation off: it is never on.
    RadiusOff,
    /// Tool length compensation off: it is never on.
    LengthOff,
    /// Work offset G54 … G59, counted from 54. All offsets are zero for now.
    WorkOffset(u8),
    /// Ends the canned cycle.
    CancelCycle,
    /// G81, whose meaning is [`Dialect::g81`].
    Cycle81,
    /// Coordinates are positions.
    Absolute,
    /// Coordinates are distances.
    Incremental,
    /// F is a speed per minute.
    FeedPerMinute,
    /// F is a travel per revolution: in tapping the pitch itself.
    FeedPerRevolution,
    /// Cycles return to the initial level, or to R if that is higher.
    ReturnInitial,
    /// Cycles return to the R plane.
    ReturnR,
}

/// Of one modal group a block may hold one code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GGroup {
    /// G0, G1.
    Motion,
    /// G80, G81. Apart from [`GGroup::Motion`], as the paper's program has G80 and G0 in one block.
    Cycle,
    /// G17.
    Plane,
    /// G20, G21.
    Units,
    /// G40.
    Radius,
    /// G49.
    Length,
    /// G54 … G59.
    WorkOffset,
    /// G90, G91.
    Distance,
    /// G94, G95.
    FeedMode,
    /// G98, G99.
    Return,
}

impl GGroup {
    /// How many groups there are.
    pub(crate) const COUNT: usize = 10;

    /// What the group decides, to follow "both set".
    pub(crate) const fn sets(self) -> &'static str {
        match self {
            Self::Motion => "the motion",
            Self::Cycle => "the canned cycle",
            Self::Plane => "the plane",
            Self::Units => "the unit of length",
            Self::Radius => "the cutter radius compensation",
            Self::Length => "the tool length compensation",
            Self::WorkOffset => "the work offset",
            Self::Distance => "the distance mode",
            Self::FeedMode => "what F means",
            Self::Return => "the return level",
        }
    }
}

impl GCode {
    /// Its modal group.
    #[must_use]
    pub const fn group(self) -> GGroup {
        match self {
            Self::Rapid | Self::Feed => GGroup::Motion,
            Self::CancelCycle | Self::Cycle81 => GGroup::Cycle,
            Self::PlaneXy => GGroup::Plane,
            Self::Inch | Self::Millimetre => GGroup::Units,
            Self::RadiusOff => GGroup::Radius,
            Self::LengthOff => GGroup::Length,
            Self::WorkOffset(_) => GGroup::WorkOffset,
            Self::Absolute | Self::Incremental => GGroup::Distance,
            Self::FeedPerMinute | Self::FeedPerRevolution => GGroup::FeedMode,
            Self::ReturnInitial | Self::ReturnR => GGroup::Return,
        }
    }
}

/// Meaning of an M code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MCode {
    /// Spindle on, right hand.
    SpindleRight,
    /// Spindle on, left hand.
    SpindleLeft,
    /// Spindle off.
    SpindleStop,
    /// End of the program.
    ProgramEnd,
}

/// Modal group of an M code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MGroup {
    /// M03, M04, M05.
    Spindle,
    /// M02, M30.
    Stop,
}

impl MGroup {
    /// How many groups there are.
    pub(crate) const COUNT: usize = 2;

    /// What the group decides, to follow "both set".
    pub(crate) const fn sets(self) -> &'static str {
        match self {
            Self::Spindle => "the spindle's direction",
            Self::Stop => "the program's end",
        }
    }
}

impl MCode {
    /// Its modal group.
    #[must_use]
    pub const fn group(self) -> MGroup {
        match self {
            Self::SpindleRight | Self::SpindleLeft | Self::SpindleStop => MGroup::Spindle,
            Self::ProgramEnd => MGroup::Stop,
        }
    }
}

/// A code as the program names it: G81, G33.1, M03.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CodeName {
    /// `b'G'` or `b'M'`.
    pub letter: u8,
    /// Ten times the number, so that G33.1 is 331.
    pub tenths: u16,
}

impl CodeName {
    /// None if the number names no code: negative, too large, or with more than one decimal.
    #[must_use]
    pub fn new(letter: u8, number: f64) -> Option<Self> {
        let tenths = (number * 10.0).round();
        let exact = (tenths - number * 10.0).abs() < 1e-6 && (0.0..10_000.0).contains(&tenths);
        exact.then_some(Self { letter, tenths: tenths as u16 })
    }
}

impl fmt::Display for CodeName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (whole, tenth) = (self.tenths / 10, self.tenths % 10);
        let letter = char::from(self.letter);
        match (self.letter, tenth) {
            (b'M', 0) => write!(f, "M{whole:02}"),
            (_, 0) => write!(f, "{letter}{whole}"),
            _ => write!(f, "{letter}{whole}.{tenth}"),
        }
    }
}

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
    /// Least increments: X10 is 10 µm, in inches 0.001 inch. Every such length is warned.
    Fanuc,
}

/// One control's reading of G-code.
///
/// ```
/// use rigidtap::gcode::{Dialect, G81};
/// let drilling = Dialect { g81: G81::Drill, ..Dialect::PAPER };
/// assert_eq!(Dialect::by_name("paper").map(|d| d.name), Some(drilling.name));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dialect {
    /// As the machine file and the command line name it.
    pub name: &'static str,
    /// Meaning of G81.
    pub g81: G81,
    /// Meaning of a length without a decimal point.
    pub decimal_point: DecimalPoint,
    /// G codes, by ten times their number.
    pub g_codes: &'static [(u16, GCode)],
    /// M codes, by ten times their number.
    pub m_codes: &'static [(u16, MCode)],
    /// Letters beside G, M and N that have a meaning.
    pub letters: &'static [u8],
}

impl Dialect {
    /// Every dialect.
    pub const ALL: &[Self] = &[Self::PAPER];

    /// The control of the torque-curve paper: G81 taps, `//` opens a comment.
    pub const PAPER: Self = Self {
        name: "paper",
        g81: G81::Tap,
        decimal_point: DecimalPoint::Calculator,
        g_codes: &[
            (0, GCode::Rapid),
            (10, GCode::Feed),
            (170, GCode::PlaneXy),
            (200, GCode::Inch),
            (210, GCode::Millimetre),
            (400, GCode::RadiusOff),
            (490, GCode::LengthOff),
            (540, GCode::WorkOffset(54)),
            (550, GCode::WorkOffset(55)),
            (560, GCode::WorkOffset(56)),
            (570, GCode::WorkOffset(57)),
            (580, GCode::WorkOffset(58)),
            (590, GCode::WorkOffset(59)),
            (800, GCode::CancelCycle),
            (810, GCode::Cycle81),
            (900, GCode::Absolute),
            (910, GCode::Incremental),
            (940, GCode::FeedPerMinute),
            (950, GCode::FeedPerRevolution),
            (980, GCode::ReturnInitial),
            (990, GCode::ReturnR),
        ],
        m_codes: &[
            (20, MCode::ProgramEnd),
            (30, MCode::SpindleRight),
            (40, MCode::SpindleLeft),
            (50, MCode::SpindleStop),
            (300, MCode::ProgramEnd),
        ],
        letters: b"FKLPRSXYZ",
    };

    /// The dialect of this name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.iter().find(|dialect| dialect.name == name).copied()
    }

    pub(crate) fn g_code(&self, name: CodeName) -> Option<GCode> {
        find(self.g_codes, name)
    }

    pub(crate) fn m_code(&self, name: CodeName) -> Option<MCode> {
        find(self.m_codes, name)
    }

    pub(crate) fn knows_letter(&self, letter: u8) -> bool {
        self.letters.contains(&letter)
    }
}

impl Default for Dialect {
    fn default() -> Self {
        Self::PAPER
    }
}

fn find<T: Copy>(table: &[(u16, T)], name: CodeName) -> Option<T> {
    table.iter().find(|(tenths, _)| *tenths == name.tenths).map(|(_, code)| *code)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_have_at_most_one_decimal() {
        let name = |number| CodeName::new(b'G', number).map(|name| name.to_string());
        assert_eq!(name(81.0).as_deref(), Some("G81"));
        assert_eq!(name(33.1).as_deref(), Some("G33.1"));
        assert_eq!(name(33.15), None);
        assert_eq!(name(-1.0), None);
        assert_eq!(name(1000.0), None);
        assert_eq!(CodeName::new(b'M', 3.0).map(|name| name.to_string()).as_deref(), Some("M03"));
    }
}
