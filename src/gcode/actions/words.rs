//! Words of a block as lengths, times, feeds and pitches.

use super::output::Output;
use crate::control::thread::StandardPitch;
use crate::control::units::{MM_PER_INCH, MS_PER_S, mm_per_s_from_mm_per_min};
use crate::gcode::blocks::Value;
use crate::gcode::dialect::{DecimalPoint, DwellUnit};
use crate::gcode::messages::{DiagnosticKind, FeedUse};
use crate::gcode::state::{FeedMode, LengthUnit, State, ToolLength};
use crate::gcode::text::Place;

/// Half the pitch of M1, the finest of ISO 261.
const FINEST_MM: f64 = 0.2;
const AXES: [u8; 3] = *b"XYZ";

/// Takes a length word, in mm.
#[inline]
pub(crate) fn take_length_mm(state: &mut State, letter: u8, output: &mut Output<'_, '_>) -> Option<f64> {
    let Value { number, place } = state.block.take(letter)?;
    if state.dialect.decimal_point == DecimalPoint::Fanuc && !number.has_point && number.value != 0.0 {
        let mm = number.value * state.modal.unit.increment_mm();
        output.report(DiagnosticKind::CountedInIncrements { letter, mm }, place);
        return Some(mm);
    }
    Some(number.value * state.modal.unit.mm())
}

/// X, Y, Z of the block, in mm.
pub(crate) fn take_axes(state: &mut State, output: &mut Output<'_, '_>) -> [Option<f64>; 3] {
    AXES.map(|letter| take_length_mm(state, letter, output))
}

/// Seconds of a dwell; none after a mistake.
pub(crate) fn dwell_s(value: Value, unit: DwellUnit, output: &mut Output<'_, '_>) -> Option<f64> {
    let Value { number, place } = value;
    let whole_ms = unit == DwellUnit::Milliseconds;
    if whole_ms && number.has_point && !number.computed && number.value != 0.0 {
        output.report(DiagnosticKind::DwellWithPoint { value: number.value }, place);
        return None;
    }
    if number.value < 0.0 {
        output.report(DiagnosticKind::DwellNegative { value: number.value }, place);
        return None;
    }
    let milliseconds = whole_ms || (unit == DwellUnit::SecondsWithPoint && !number.has_point);
    Some(if milliseconds { number.value / MS_PER_S } else { number.value })
}

/// Speed of a move at feed; none after a mistake.
pub(crate) fn feed_mm_per_s(state: &State, anchor: Place, output: &mut Output<'_, '_>) -> Option<f64> {
    let missing = DiagnosticKind::FeedMissing { needed_for: FeedUse::Move };
    let feed_mm = output.require(state.modal.feed_mm, missing, anchor)?;
    let feed_mm_per_min = match state.modal.feed_mode {
        FeedMode::PerMinute => feed_mm,
        FeedMode::PerRevolution => {
            let turning_rpm = state.modal.hand.and(state.modal.turning_rpm());
            feed_mm * output.require(turning_rpm, DiagnosticKind::SpindleNotTurning, anchor)?
        }
    };
    Some(mm_per_s_from_mm_per_min(feed_mm_per_min))
}

/// The pitch that F makes of the speed in force; none after a mistake.
pub(crate) fn pitch_mm(
    state: &State,
    speed_rpm: Option<f64>,
    anchor: Place,
    output: &mut Output<'_, '_>,
) -> Option<f64> {
    let needed_for = match state.modal.feed_mode {
        FeedMode::PerMinute => FeedUse::PitchFromSpeed,
        FeedMode::PerRevolution => FeedUse::Pitch,
    };
    let feed_mm = output.require(state.modal.feed_mm, DiagnosticKind::FeedMissing { needed_for }, anchor)?;
    match state.modal.feed_mode {
        FeedMode::PerMinute => speed_rpm.map(|speed_rpm| feed_mm / speed_rpm),
        FeedMode::PerRevolution => Some(feed_mm),
    }
}

/// Takes a word that changes no motion, and says so the first time; returns its number.
pub(crate) fn take_idle(state: &mut State, letter: u8, output: &mut Output<'_, '_>) -> Option<f64> {
    let Value { number, place } = state.block.take(letter)?;
    let bit = 1u32.wrapping_shl(u32::from(letter.wrapping_sub(b'A')));
    if state.reported.letters & bit == 0 {
        output.report(DiagnosticKind::IdleWord { letter }, place);
    }
    state.reported.letters |= bit;
    Some(number.value)
}

/// A pitch that nearly is a standard one is reported where it begins; and a hole behind G49.
pub(crate) fn check_pitch(state: &mut State, pitch_mm: f64, place: Place, output: &mut Output<'_, '_>) {
    if state.modal.tool_length == ToolLength::Ended {
        state.modal.tool_length = ToolLength::Unsaid;
        output.report(DiagnosticKind::ToolLengthEnded, place);
    }
    if state.reported.pitch_mm != pitch_mm
        && let Some(meant) = StandardPitch::near_miss(pitch_mm)
    {
        output.report(DiagnosticKind::PitchNearStandard { pitch_mm, meant }, place);
    }
    // Finer than any thread: mostly a pitch under G94, or an inch program without G20.
    if state.reported.pitch_mm != pitch_mm && pitch_mm < FINEST_MM {
        let feed_is_pitch =
            state.modal.feed_mode == FeedMode::PerMinute && state.modal.feed_mm.and_then(StandardPitch::of).is_some();
        let inch = state.modal.unit == LengthUnit::Millimetre && StandardPitch::of(pitch_mm * MM_PER_INCH).is_some();
        output.report(DiagnosticKind::PitchTooFine { pitch_mm, feed_is_pitch, inch }, place);
    }
    if state.reported.pitch_mm != pitch_mm
        && let Some(standard) = StandardPitch::of(pitch_mm).filter(StandardPitch::is_tapered)
    {
        output.report(DiagnosticKind::PitchTapered { standard }, place);
    }
    state.reported.pitch_mm = pitch_mm;
}

/// After K0 with X or Y the tool stands at one of two places. A position under G90 ends that; what counts from there, or
/// leaves the axis out, is an error.
#[inline]
pub(super) fn settle_xy(state: &mut State, given: [bool; 2], anchor: Place, output: &mut Output<'_, '_>) {
    if state.unsure_xy == [false; 2] {
        return;
    }
    let unsure = std::mem::take(&mut state.unsure_xy);
    let depends = |axis: usize| unsure[axis] && (!given[axis] || state.modal.incremental);
    if depends(0) || depends(1) {
        output.report_if_whole(DiagnosticKind::ZeroRepeatsWithPosition, anchor);
    }
}
