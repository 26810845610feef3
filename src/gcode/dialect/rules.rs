//! What a canned cycle's blocks make and keep, control by control: the one table of it.
//!
//! Sources. FANUC: Operator's Manual for Machining Center B-64304EN-2, 5.1 "Canned cycle for drilling" (a block with X, Y,
//! Z, R or a further axis drills, any other does not; P, Q and R of a block that does not drill are not stored; K0 stores;
//! G80 and a code of group 01 end the cycle), group table (G80 is of group 09, G00 of group 01). Haas: Mill Operator's
//! Manual (NGC, 2017), "X/Y Plane Obstacle Avoidance in a Canned Cycle", p. 246 (L0 moves X and Y alone), setting 28 (the
//! cycle's code acts without X or Y), G74 and G84 (the control starts the spindle itself), M00 (stops the spindle).
//! LinuxCNC: held against `rs274` by `tests/rs274`. SINUMERIK has no such cycles. The paper's own program: see
//! `gcode/s3000.ngc`. From memory: that on a Haas a block with Z or R alone makes no hole; it is refused there.

/// What the code of a cycle does in a block without a word that makes a hole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CodeAlone {
    /// A hole where the tool stands.
    Hole,
    /// It only stores.
    Stores,
    /// It is an error.
    Error,
}

/// What a count of zero repeats does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ZeroRepeats {
    /// It is an error.
    Error,
    /// The cycle's data are stored, and X and Y are passed over.
    Stores,
    /// The cycle's data are stored. X and Y are refused: the manual does not say whether the control moves there.
    StoresAlone,
    /// X and Y move there, and no hole is made.
    Moves,
}

/// What a canned cycle's blocks make and keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CycleRules {
    /// Letters of which one makes a block under the cycle a hole.
    pub hole_words: &'static [u8],
    /// The cycle's code without any of them.
    pub code_alone: CodeAlone,
    /// A block that makes no hole stores the cycle's words; else they are an error there.
    pub stores_without_hole: bool,
    /// Zero repeats.
    pub zero_repeats: ZeroRepeats,
    /// Another cycle's code keeps R, Z, P, Q and J; else it asks for them anew.
    pub change_keeps: bool,
    /// R and Z of an earlier block are read anew under G90 and G91 as it is now; else as it was when they were written.
    pub levels_follow_distance_mode: bool,
    /// The initial level is a value in the coordinate system in force; else a position of the machine.
    pub initial_level_follows_offset: bool,
    /// P is kept over G80 and over a change of cycle, to the end of the program.
    pub dwell_is_kept: bool,
    /// F is read before G20 and G21 of its block act, and stays the same speed over them; else F is asked for anew.
    pub feed_before_unit: bool,
    /// G80 ends the cycle alone, and the motion of group 01 is in force again.
    pub g80_leaves_motion: bool,
    /// A rigid cycle turns the spindle by itself in its own hand, whatever M03 or M04 said before.
    pub turns_itself: bool,
    /// M00 stops the spindle, too.
    pub m00_stops_spindle: bool,
}

/// The paper's control.
pub(super) const PAPER: CycleRules = CycleRules {
    hole_words: b"XYZ",
    code_alone: CodeAlone::Hole,
    stores_without_hole: true,
    zero_repeats: ZeroRepeats::Stores,
    change_keeps: true,
    levels_follow_distance_mode: false,
    initial_level_follows_offset: false,
    dwell_is_kept: false,
    feed_before_unit: false,
    g80_leaves_motion: false,
    turns_itself: false,
    m00_stops_spindle: false,
};

pub(super) const FANUC: CycleRules = CycleRules {
    hole_words: b"XYZR",
    code_alone: CodeAlone::Stores,
    stores_without_hole: false,
    zero_repeats: ZeroRepeats::StoresAlone,
    change_keeps: true,
    levels_follow_distance_mode: false,
    initial_level_follows_offset: false,
    dwell_is_kept: false,
    feed_before_unit: false,
    g80_leaves_motion: true,
    turns_itself: true,
    m00_stops_spindle: false,
};

pub(super) const HAAS: CycleRules = CycleRules {
    hole_words: b"XY",
    code_alone: CodeAlone::Hole,
    zero_repeats: ZeroRepeats::Moves,
    m00_stops_spindle: true,
    ..FANUC
};

pub(super) const LINUXCNC: CycleRules = CycleRules {
    hole_words: b"XYZ",
    code_alone: CodeAlone::Error,
    stores_without_hole: false,
    zero_repeats: ZeroRepeats::Error,
    change_keeps: false,
    levels_follow_distance_mode: true,
    initial_level_follows_offset: true,
    dwell_is_kept: true,
    feed_before_unit: true,
    g80_leaves_motion: false,
    turns_itself: false,
    m00_stops_spindle: false,
};
