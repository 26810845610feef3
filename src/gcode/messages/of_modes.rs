//! Words about modes, feed, spindle and offsets.

use super::kind::{DiagnosticKind as K, FeedUse};
use super::letter::Letter;
use crate::gcode::text::Decimal;

/// Message and hint of a finding in modes, feed, spindle or offsets; none of any other finding.
pub(super) fn words(kind: &K) -> Option<(String, String)> {
    let (message, hint): (String, &str) = match *kind {
        K::NoMotionMode => (
            "nothing says how to move: no G0, G1 or G81 is active".into(),
            "begin the block with G0 for a rapid, G1 for a feed, G81 for a hole; G80 ended the cycle before",
        ),
        K::FeedMissing { needed_for: FeedUse::Move } => (
            "there is no feed: no F is in force".into(),
            "say F in this block or before it; a change between G94 and G95 asks for F anew",
        ),
        K::FeedMissing { needed_for: FeedUse::PitchFromSpeed } => (
            "the tap has no pitch: no F is in force".into(),
            "pitch is F/S: for M6, pitch 1 mm, at S3000 say F3000; or say G95 and F1",
        ),
        K::FeedMissing { needed_for: FeedUse::Pitch } => {
            ("the tap has no pitch: no F is in force since G95".into(), "say F with the pitch: G95 F1 for M6")
        }
        K::FeedNotPositive { feed } => {
            (format!("F is {}", Decimal(feed)), "F must be above zero; the thread's hand comes from M03 or M04")
        }
        K::FeedNeedsPoint => (
            "F without a decimal point has no sure meaning here".into(),
            "write F with its point: at S500 a pitch of 1 mm is F500. under G94, F1. under G95",
        ),
        K::SpeedNegative { rpm } => {
            (format!("S is {}", Decimal(rpm)), "S is a speed in rpm, not negative; backwards is M04")
        }
        K::SpindleNotTurning => (
            "under G95 the feed follows the spindle, and the spindle does not turn".into(),
            "say S and M03 or M04 before, or G94 for a feed per minute",
        ),
        K::SpindleWithoutSpeed { name } => {
            (format!("{name} turns nothing yet: there is no S"), "say S in the same block: M03 S3000")
        }
        K::CountedInIncrements { letter, mm } => {
            return Some((
                format!("{} without a decimal point is {} mm", Letter(letter), Decimal(mm)),
                "write the point, or set decimal_point = \"calculator\" if the number is meant as it stands".into(),
            ));
        }
        K::SameWorkOffset { name } => (
            format!("{name} changes nothing: its zero is where the one before has its"),
            "holes of several work offsets lie over each other here; the times and errors stay right",
        ),
        K::DwellMissing { .. } => (
            "this pause has no time".into(),
            "P says how long: milliseconds on a Fanuc, seconds in LinuxCNC; on a SINUMERIK F, in seconds",
        ),
        K::MachineFrameIncremental { name } => {
            (format!("{name} under G91: from where?"), "machine coordinates are positions: say G90 with it")
        }
        K::BadOffset { letter: b'L', value } => (
            format!("G10 L{} is not read", Decimal(value)),
            "L2 writes a work offset by its number P; in LinuxCNC L20 as well",
        ),
        K::BadOffset { value, .. } => {
            (format!("P{} is no work offset", Decimal(value)), "P1 is G54, P6 is G59; in LinuxCNC P9 is G59.3")
        }

        K::ShiftWithoutAxes => {
            ("this shift names no axis".into(), "say X, Y or Z; a limit of the spindle's speed, G92 S, is not read")
        }
        K::ToolLengthEnded => (
            "G49 ended the tool length before this hole: Z is the spindle's nose on the control, and the tip here"
                .into(),
            "say G43 H before the hole, or G49 behind the last one",
        ),
        K::OtherReferencePoint => (
            "this reference point is not known: the first one is taken for it".into(),
            "it may stay where X, Y and Z are said anew before the next hole",
        ),
        K::PowerOnMotion => (
            "no motion code was said yet: this is a rapid, as at power on".into(),
            "say G0; a FANUC whose parameter 3402 bit 0 is 1 moves at feed",
        ),
        _ => return None,
    };
    Some((message, hint.into()))
}
