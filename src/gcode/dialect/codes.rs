//! G and M codes: their meanings, and the modal groups that keep them apart.

use std::fmt;

use crate::control::cycle::Hand;

/// Words that belong to a code without effect. It is no slice, so that a code stays as small as a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IdleWords {
    /// None.
    None,
    /// P.
    P,
    /// P and E.
    Pe,
    /// P, Q and R.
    Pqr,
}

impl IdleWords {
    /// The letters, upper case.
    pub(crate) const fn letters(self) -> &'static [u8] {
        match self {
            Self::None => b"",
            Self::P => b"P",
            Self::Pe => b"PE",
            Self::Pqr => b"PQR",
        }
    }
}

/// Meaning of a G code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GCode {
    /// Rapid move.
    Rapid,
    /// Straight move at feed.
    Feed,
    /// One synchronous stroke in and out again, from where Z stands (G33.1).
    TapStroke,
    /// The synchronous stroke in alone (G331).
    StrokeIn,
    /// The synchronous stroke out that belongs to it (G332).
    StrokeOut,
    /// A pause.
    Dwell,
    /// Writes a work offset.
    WriteOffset,
    /// Over the point named to the reference point.
    Home,
    /// Calls a program with arguments (G65).
    MacroCall,
    /// This block's move counts from the machine's zero.
    MachineFrame,
    /// XY plane: the only one, since tapping is along Z.
    PlaneXy,
    /// Lengths in inches.
    Inch,
    /// Lengths in millimetres.
    Millimetre,
    /// Cutter radius compensation off: it is never on.
    RadiusOff,
    /// Tool length compensation on: Z is the tap's tip, whatever its length.
    LengthOn,
    /// Tool length compensation off: Z is the tap's tip all the same.
    LengthOff,
    /// Work offset, from 1 (G54) to 9 (G59.3).
    WorkOffset(u8),
    /// Says how exactly corners are met, which no hole depends on.
    PathMode,
    /// Says how an outside corner or an exact stop is met, which no hole depends on.
    CornerMode,
    /// Changes no hole; these words go with it.
    Idle {
        /// Letters that belong to it.
        words: IdleWords,
    },
    /// A work offset beyond G59, whose number is P.
    ExtendedOffset,
    /// Shifts every work offset by X, Y and Z (G52).
    LocalShift,
    /// Calls the present position X, Y and Z in every work offset (G92).
    SetPosition,
    /// Ends the shift of G92 (G92.1).
    CancelShift,
    /// X is a radius and Y an angle (G16).
    Polar,
    /// X and Y are coordinates again (G15).
    Cartesian,
    /// Turns X and Y about a centre (G68).
    Rotate,
    /// Ends that (G69).
    Unrotate,
    /// A tool length by its own words (G43.1).
    LengthByWords,
    /// One hole from where the tool stands to Z and back, F being its feed (G184, G174).
    TapFromHere {
        /// Hand of its thread.
        hand: Hand,
    },
    /// Changes the tool with Z at its top, then goes to X, Y and Z (G100 of a Speedio).
    ToolChange,
    /// Ends the canned cycle.
    CancelCycle,
    /// G81, whose meaning is [`Dialect::g81`](super::Dialect::g81).
    Cycle81,
    /// The tapping cycle.
    Tap {
        /// Hand of its thread.
        hand: Hand,
        /// It is rigid without a code of its own that says so.
        rigid: bool,
    },
    /// Coordinates are positions.
    Absolute,
    /// Coordinates are distances.
    Incremental,
    /// F is a speed per minute.
    FeedPerMinute,
    /// F is a travel per revolution: in tapping the pitch itself.
    FeedPerRevolution,
    /// S is a spindle speed: it always is.
    SpeedInRpm,
    /// Cycles return to the initial level, or to R if that is higher.
    ReturnInitial,
    /// Cycles return to the R plane.
    ReturnR,
}

/// Of one modal group a block may hold one code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GGroup {
    /// G0, G1, strokes.
    Motion,
    /// G80, G81, G84. Apart from [`GGroup::Motion`], as the paper's program has G80 and G0 in one block.
    Cycle,
    /// G4, G10, G28: what acts in its own block alone.
    OneShot,
    /// G53.
    Frame,
    /// G17.
    Plane,
    /// G20, G21.
    Units,
    /// G40.
    Radius,
    /// G43, G49.
    Length,
    /// G54 … G59.3.
    WorkOffset,
    /// G61, G64.
    Path,
    /// G9, G450, G601: corners and exact stops of a SINUMERIK.
    Corner,
    /// G90, G91.
    Distance,
    /// G94, G95.
    FeedMode,
    /// G97.
    SpeedMode,
    /// G98, G99.
    Return,
    /// G15, G16.
    Polar,
    /// G69; G68 acts in its block.
    Rotation,
}

impl GGroup {
    /// How many groups there are.
    pub(crate) const COUNT: usize = 17;

    /// What the group decides, to follow "both set".
    pub(crate) const fn sets(self) -> &'static str {
        match self {
            Self::Motion => "the motion",
            Self::Cycle => "the canned cycle",
            Self::OneShot => "what this block does",
            Self::Frame => "the coordinates of this block",
            Self::Plane => "the plane",
            Self::Units => "the unit of length",
            Self::Radius => "the cutter radius compensation",
            Self::Length => "the tool length compensation",
            Self::WorkOffset => "the work offset",
            Self::Path => "how corners are met",
            Self::Corner => "how corners and stops are met",
            Self::Distance => "the distance mode",
            Self::FeedMode => "what F means",
            Self::SpeedMode => "what S means",
            Self::Return => "the return level",
            Self::Polar => "what X and Y are",
            Self::Rotation => "whether the plane is turned",
        }
    }
}

impl GCode {
    /// Its modal group.
    #[must_use]
    pub const fn group(self) -> GGroup {
        match self {
            Self::Rapid | Self::Feed | Self::TapStroke | Self::StrokeIn | Self::StrokeOut => GGroup::Motion,
            Self::CancelCycle | Self::Cycle81 | Self::Tap { .. } => GGroup::Cycle,
            Self::Dwell
            | Self::WriteOffset
            | Self::Home
            | Self::MacroCall
            | Self::LocalShift
            | Self::SetPosition
            | Self::CancelShift
            | Self::Rotate
            | Self::LengthByWords
            | Self::ToolChange
            | Self::TapFromHere { .. } => GGroup::OneShot,
            Self::MachineFrame => GGroup::Frame,
            Self::PlaneXy => GGroup::Plane,
            Self::Inch | Self::Millimetre => GGroup::Units,
            Self::RadiusOff => GGroup::Radius,
            Self::LengthOn | Self::LengthOff => GGroup::Length,
            Self::WorkOffset(_) | Self::ExtendedOffset => GGroup::WorkOffset,
            Self::PathMode => GGroup::Path,
            Self::CornerMode | Self::Idle { .. } => GGroup::Corner,
            Self::Absolute | Self::Incremental => GGroup::Distance,
            Self::FeedPerMinute | Self::FeedPerRevolution => GGroup::FeedMode,
            Self::SpeedInRpm => GGroup::SpeedMode,
            Self::ReturnInitial | Self::ReturnR => GGroup::Return,
            Self::Polar | Self::Cartesian => GGroup::Polar,
            Self::Unrotate => GGroup::Rotation,
        }
    }

    /// Makes holes where it stands and in the blocks after it.
    #[must_use]
    pub const fn is_hole_cycle(self) -> bool {
        matches!(self, Self::Cycle81 | Self::Tap { .. })
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
    /// The next tapping cycle is rigid.
    RigidTap,
    /// Known, and without any effect on what is simulated.
    Idle(MGroup),
    /// Calls a subprogram.
    Call,
    /// Calls the blocks of this program from a number on (M97).
    CallLabel,
    /// Returns from it.
    Return,
    /// End of the program.
    ProgramEnd,
}

/// Modal group of an M code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MGroup {
    /// M03, M04, M05.
    Spindle,
    /// M00, M01, M02, M30.
    Stop,
    /// M29.
    Rigid,
    /// M06.
    Tool,
    /// M07, M08, M09.
    Coolant,
    /// M19.
    Orient,
    /// M98, M99.
    Flow,
    /// M48, M49 and others of the panel.
    Panel,
    /// Conveyor, doors, clamps, probes, air: whatever moves no axis that taps.
    Device,
}

impl MGroup {
    /// How many groups there are.
    pub(crate) const COUNT: usize = 9;

    /// What the group decides, to follow "both set".
    pub(crate) const fn sets(self) -> &'static str {
        match self {
            Self::Spindle => "the spindle's direction",
            Self::Stop => "the program's end or stop",
            Self::Rigid => "how the tap is held",
            Self::Tool => "the tool",
            Self::Coolant => "the coolant",
            Self::Orient => "the spindle's angle",
            Self::Flow => "which block comes next",
            Self::Panel => "what the panel may change",
            Self::Device => "a device of the machine",
        }
    }
}

impl MCode {
    /// Its modal group.
    #[must_use]
    pub const fn group(self) -> MGroup {
        match self {
            Self::SpindleRight | Self::SpindleLeft | Self::SpindleStop => MGroup::Spindle,
            Self::RigidTap => MGroup::Rigid,
            Self::Idle(group) => group,
            Self::Call | Self::CallLabel | Self::Return => MGroup::Flow,
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
        let whole = number as u16;
        if f64::from(whole) == number && whole < 1000 {
            return Some(Self { letter, tenths: 10 * whole });
        }
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
