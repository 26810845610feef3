//! Words about canned cycles and strokes.

use super::kind::DiagnosticKind as K;
use super::letter::Letter;
use crate::control::cycle::Hand;
use crate::gcode::text::Decimal;

/// Message and hint of a finding in a cycle or a stroke; none of any other finding.
pub(super) fn words(kind: &K) -> Option<(String, String)> {
    let (message, hint): (String, &str) = match *kind {
        K::TapWithoutSpindle => (
            "the tap has no direction: the spindle was not switched on".into(),
            "say M03 for a right-hand thread or M04 for a left-hand one before the cycle",
        ),
        K::TapWithoutSpeed => {
            ("the tap has no speed: S is missing or zero".into(), "say S in rpm before the cycle: M03 S3000")
        }
        K::CycleWordMissing { name, letter: b'R' } => {
            (format!("{name} has no R"), "R is the R plane, where the tap starts, a few pitches above the part")
        }
        K::CycleWordMissing { name, letter } => {
            (format!("{name} has no {}", Letter(letter)), "Z is the bottom of the hole")
        }
        K::PitchNearStandard { pitch_mm, meant } => {
            return Some((
                format!(
                    "the pitch is {} mm, nearly but not {} mm ({})",
                    Decimal(pitch_mm),
                    Decimal(meant.pitch_mm),
                    meant.name
                ),
                "pitch is F/S under G94 and F under G95: is F or S mistyped or rounded?".into(),
            ));
        }
        K::HandAgainstSpindle { name, hand } => {
            let (thread, spindle, right) = match hand {
                Hand::Right => ("right", "left, M04", "G74"),
                Hand::Left => ("left", "right, M03", "G84"),
            };
            return Some((
                format!("{name} cuts a {thread}-hand thread, and the spindle turns {spindle}"),
                format!("say the other M code, or {right} for the other hand"),
            ));
        }
        K::NotRigid { name, by } => (
            match by {
                "M29" => format!(
                    "{name} without M29 taps in a floating holder, unless parameter 5200 makes it rigid: taken as rigid"
                ),
                ",R1" => format!(
                    "{name} without ,R1 taps in a floating holder, unless a parameter makes it synchronous: taken as rigid"
                ),
                _ => format!("{name} taps in a floating holder; the synchronous cycle is {by}: taken as rigid"),
            },
            match by {
                "M29" => "say M29 S… in the block before, or use G84.2 and G84.3",
                ",R1" => "say ,R1 in the block of the cycle",
                _ => "G77 taps a right-hand thread, G78 a left-hand one; I is the pitch in mm, J the threads per inch",
            },
        ),
        K::PeckNegative { mm } => (format!("the peck Q is {} mm", Decimal(mm)), "Q is a depth, not negative"),
        K::ReturnSpeedNotPositive { value } => {
            (format!("J is {}", Decimal(value)), "J is the speed of the stroke out, above zero")
        }
        K::PitchMissing { name } => (format!("{name} has no pitch"), "K is the pitch: K1 for M6"),
        K::PitchNotUsable { value } => (
            format!("the pitch K is {}", Decimal(value)),
            "a pitch is above zero; on a SINUMERIK a negative one is a left-hand thread",
        ),
        K::StrokeNotAlongZ => {
            ("a synchronous stroke moves Z alone".into(), "position X and Y in a block before, by G0")
        }
        K::StrokeNotDown { from_mm, to_mm } => (
            format!("the stroke in goes from Z {} mm to Z {} mm: not down", Decimal(from_mm), Decimal(to_mm)),
            "stand above the part first: Z is the bottom of the hole",
        ),
        K::StrokeOutAlone => ("this stroke out has no stroke in".into(), "G331 first, then G332"),
        K::StrokeInAlone => {
            ("the stroke in before has no stroke out".into(), "after G331 comes G332, which turns the tap out again")
        }
        K::StrokePitchDiffers { in_mm, out_mm } => (
            format!("in with a pitch of {} mm, out with {} mm", Decimal(in_mm), Decimal(out_mm)),
            "both strokes run in one thread: say the same K",
        ),
        K::StrokeOutTooShort { start_mm, end_mm } => (
            format!(
                "the stroke out ends at Z {} mm, in the hole: it began at Z {} mm",
                Decimal(end_mm),
                Decimal(start_mm)
            ),
            "come out at least to where G331 began",
        ),
        K::BottomNotBelowR { bottom_mm, r_plane_mm, incremental } => (
            format!("the bottom, Z {} mm, is not below the R plane, Z {} mm", Decimal(bottom_mm), Decimal(r_plane_mm)),
            if incremental {
                "under G91 R counts from the initial level and Z from the R plane: Z-25 for 25 mm deep"
            } else {
                "under G90 Z and R are positions: Z must be the lower one"
            },
        ),
        K::BadRepeats { repeats } => {
            (format!("a hole cannot be repeated {} times", Decimal(repeats)), "K and L are whole numbers from 0")
        }
        K::TooManyRepeats { repeats, limit } => {
            return Some((
                format!("{} repeats are more than a control takes", Decimal(repeats)),
                format!("at most {limit} in one block"),
            ));
        }
        K::SameHoleAgain { times } => (
            format!("the same hole is tapped {times} times"),
            "repeats step by X and Y under G91 only; say G91, or leave the repeats out",
        ),
        K::DwellNegative { value } => (format!("the dwell P is {}", Decimal(value)), "P is a time, not negative"),
        K::DwellWithPoint { value } => (
            format!("the dwell P{} has a decimal point: are these seconds?", Decimal(value)),
            "P counts whole milliseconds: P500 for half a second",
        ),
        K::PitchChanged { from_mm, to_mm } => (
            format!("the pitch is now {} mm, it was {} mm: S changed, F did not", Decimal(to_mm), Decimal(from_mm)),
            "pitch is F/S: say F anew with S, or give the pitch itself by G95",
        ),

        K::CycleAlone { name } => {
            (format!("{name} stands without X, Y or Z"), "say where the hole is: this control refuses the code alone")
        }
        K::ZeroRepeatsWithPosition => (
            "this counts from where K0 with X or Y left the tool, which is not known".into(),
            "say X and Y under G90 here, or leave them out of the block with K0",
        ),
        K::CycleUnitChanged { name } => (
            format!("the unit changed under {name}: R and Z are of the other one"),
            "say R and Z anew after G20 or G21",
        ),
        K::HandReplaced { name, hand } => (
            format!(
                "{name} turns the spindle by itself, {}: the M code before is for the other hand",
                if hand == Hand::Right { "M03" } else { "M04" }
            ),
            "is the hand meant? G84 is right, G74 left; the M code may be left out",
        ),
        K::DialectFromMemory { name } => (
            format!("the tables of {name} are from memory: see that this hole is as its manual says"),
            "compare with the manual; a table that names its pages warns no more",
        ),
        K::RuleFromMemory { says } => (
            format!("{says}: no manual was found for it, see that it is so on this control"),
            "compare with the control's manual, or say it so that it does not depend on it",
        ),
        K::PitchTwice { letters } => (
            format!("{letters} give the pitch, and only one can hold"),
            "keep one: F, or I in mm or J in threads per inch (brother), E in threads per inch (mitsubishi)",
        ),
        K::NotSynchronous => (",R0 taps in a floating holder".into(), "a rigid tap is ,R1"),
        K::PitchTooFine { pitch_mm, feed_is_pitch, inch } => (
            format!("the pitch is {} mm, finer than any thread", Decimal(pitch_mm)),
            match (feed_is_pitch, inch) {
                (true, _) => "F is a speed under G94, and looks like the pitch: say G95, or F = pitch × S",
                (_, true) => "in inches it is a usual pitch: is G20 missing?",
                _ => "pitch is F/S under G94 and F under G95: is F or S mistyped?",
            },
        ),
        K::PitchTapered { standard } => (
            format!("this is the pitch of {}, a taper thread: it is tapped as a cylindrical one", standard.name),
            "a taper tap cuts along its whole length: give its torque and tolerance in [tap] and [tolerance]",
        ),
        _ => return None,
    };
    Some((message, hint.into()))
}
