//! Names of several letters that a SINUMERIK reads.

/// What a name means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Name {
    /// The cycle that follows is called at every position.
    ModalCall,
    /// CYCLE84.
    Tap,
    /// HOLES1: a row of holes.
    Row,
    /// HOLES2: holes on a circle.
    Circle,
    /// The spindle comes to rest at an angle.
    SpindleAngle,
    /// The subprogram ends (RET).
    Return,
    /// A subprogram begins (PROC).
    Procedure,
    /// This block counts from the machine's zero.
    MachineFrame,
    /// Ends a shift or a turn of the coordinates, which is never on; with axes it begins one, and is not read.
    Frame,
    /// Changes no hole; its place in the table.
    Idle(u8),
}

/// Names that change no hole: look-ahead, feedforward, smoothing, corners, tool orientation, kinds of acceleration, texts
/// and what the screen shows (SINUMERIK 840D sl, Programming Manual Fundamentals and Job Planning, lists of statements).
const IDLE: [&[u8]; 45] = [
    b"ADIS",
    b"ADISPOS",
    b"BRISK",
    b"BRISKA",
    b"CFC",
    b"CFCTCP",
    b"CFIN",
    b"CFTCP",
    b"COMPCAD",
    b"COMPCURV",
    b"COMPOF",
    b"COMPON",
    b"COMPSURF",
    b"CUT2D",
    b"CUT2DF",
    b"CYCLE832",
    b"DIAMOF",
    b"DRIVE",
    b"DYNFINISH",
    b"DYNNORM",
    b"DYNPOS",
    b"DYNPREC",
    b"DYNROUGH",
    b"DYNSEMIFIN",
    b"FENDNORM",
    b"FFWOF",
    b"FFWON",
    b"FGREF",
    b"FIFOCTRL",
    b"FNORM",
    b"GROUP_ADDEND",
    b"GROUP_BEGIN",
    b"GROUP_END",
    b"MSG",
    b"ORIAXES",
    b"ORIMKS",
    b"ORIWKS",
    b"RTLIOF",
    b"RTLION",
    b"SOFT",
    b"SOFTA",
    b"STARTFIFO",
    b"STOPRE",
    b"TRAFOOF",
    b"WORKPIECE",
];

const OTHERS: [(&[u8], Name); 13] = [
    (b"MCALL", Name::ModalCall),
    (b"CYCLE84", Name::Tap),
    (b"HOLES1", Name::Row),
    (b"HOLES2", Name::Circle),
    (b"SPOS", Name::SpindleAngle),
    (b"RET", Name::Return),
    (b"PROC", Name::Procedure),
    (b"SUPA", Name::MachineFrame),
    (b"TRANS", Name::Frame),
    (b"ROT", Name::Frame),
    (b"AROT", Name::Frame),
    (b"MIRROR", Name::Frame),
    (b"SCALE", Name::Frame),
];

impl Name {
    /// Whether it has a block of its own.
    pub(crate) const fn stands_alone(self) -> bool {
        matches!(self, Self::ModalCall | Self::Tap | Self::Row | Self::Circle | Self::Return)
    }

    /// What a name means, in either case.
    pub(crate) fn of(name: &[u8]) -> Option<Self> {
        let idle = || IDLE.iter().position(|known| known.eq_ignore_ascii_case(name)).map(|at| Self::Idle(at as u8));
        OTHERS.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, name)| *name).or_else(idle)
    }
}
