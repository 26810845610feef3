//! Synchronous strokes that are no canned cycle: G33.1, G331 with G332.

use super::output::Output;
use super::words::{check_pitch, pitch_mm, take_axes, take_length_mm};
use crate::control::cycle::{Hand, TapCycle};
use crate::gcode::blocks::Value;
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::GGroup;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{State, StrokeIn, StrokeKind};
use crate::gcode::text::Place;

/// A block under G33.1, G331 or G332:
///
/// 1. Z is the stroke's end, K the pitch of this block; G332 keeps that of its G331.
/// 2. G33.1 has the hand of the spindle, and comes out I times as fast as in. The R plane is where Z stands.
/// 3. G331 has the hand of its pitch's sign; G332 ends where G331 began, or higher.
pub(crate) fn stroke(state: &mut State, kind: StrokeKind, output: &mut Output<'_, '_>) {
    let anchor = state.block.g(GGroup::Motion).map_or(state.block.place, |code| code.place);
    let axes = [b'X', b'Y', b'Z'].map(|letter| state.block.place_of(letter));
    if axes.iter().all(Option::is_none) && state.block.g(GGroup::Motion).is_none() {
        return;
    }
    let [x_mm, y_mm, from_mm] = state.position_mm;
    let words = take_axes(state, output);
    let [to_x_mm, to_y_mm, to_mm] = [0, 1, 2].map(|axis: usize| {
        let from_mm = state.position_mm.get(axis).copied().unwrap_or_default();
        state.target_mm(axis, from_mm, words.get(axis).copied().flatten())
    });
    if let [Some(place), ..] | [_, Some(place), _] = axes
        && (to_x_mm, to_y_mm) != (x_mm, y_mm)
    {
        output.report(DiagnosticKind::StrokeNotAlongZ, place);
    }
    let pitch_place = state.block.place_of(b'K');
    let pitch_mm = take_length_mm(state, b'K', output);
    match kind {
        StrokeKind::Pair => pair(state, [from_mm, to_mm], pitch_mm.zip(pitch_place), anchor, output),
        StrokeKind::In => stroke_in(state, [from_mm, to_mm], pitch_mm.zip(pitch_place), anchor, output),
        StrokeKind::Out => stroke_out(state, to_mm, pitch_mm.zip(pitch_place), anchor, output),
    }
}

/// The pitch of a stroke, or the report that it is missing or useless.
fn stroke_pitch(
    kind: StrokeKind,
    pitch: Option<(f64, Place)>,
    anchor: Place,
    output: &mut Output<'_, '_>,
) -> Option<f64> {
    let (value, place) = output.require(pitch, DiagnosticKind::PitchMissing { name: kind.name() }, anchor)?;
    let usable = value > 0.0 || (kind != StrokeKind::Pair && value < 0.0);
    if !usable {
        output.report(DiagnosticKind::PitchNotUsable { value }, place);
    }
    usable.then_some(value)
}

fn pair(
    state: &mut State,
    [from_mm, to_mm]: [f64; 2],
    pitch: Option<(f64, Place)>,
    anchor: Place,
    output: &mut Output<'_, '_>,
) {
    let factor = state.block.take(b'I').map_or(1.0, |Value { number, place }| {
        if number.value <= 0.0 {
            output.report(DiagnosticKind::ReturnSpeedNotPositive { value: number.value }, place);
        }
        number.value
    });
    let hand = output.require(state.modal.hand, DiagnosticKind::TapWithoutSpindle, anchor);
    let speed_rpm = output.require(state.modal.turning_rpm(), DiagnosticKind::TapWithoutSpeed, anchor);
    let pitch_mm = stroke_pitch(StrokeKind::Pair, pitch, anchor, output);
    let (Some(hand), Some(speed_rpm), Some(pitch_mm)) = (hand, speed_rpm, pitch_mm) else { return };
    if to_mm >= from_mm {
        return output.report(DiagnosticKind::StrokeNotDown { from_mm, to_mm }, anchor);
    }
    check_pitch(state, pitch_mm, anchor, output);
    let [x_mm, y_mm, _] = state.position_mm;
    // It starts with a pulse of the index (LinuxCNC, G33.1).
    let start_angle_rev = state.start_angle_rev(None).or(Some(0.0));
    let hole =
        TapCycle { x_mm, y_mm, hand, start_angle_rev, ..TapCycle::right_hand(from_mm, to_mm, pitch_mm, speed_rpm) };
    output.emit(CommandKind::Tap(TapCycle {
        out_speed_rpm: factor * speed_rpm,
        tool: state.modal.tool.in_spindle(),
        ..hole
    }));
}

fn stroke_in(
    state: &mut State,
    [start_mm, bottom_mm]: [f64; 2],
    pitch: Option<(f64, Place)>,
    anchor: Place,
    output: &mut Output<'_, '_>,
) {
    forget_stroke_in(state, output);
    let pitch_mm = stroke_pitch(StrokeKind::In, pitch, anchor, output);
    let speed_rpm = output.require(state.modal.turning_rpm(), DiagnosticKind::TapWithoutSpeed, anchor);
    if bottom_mm >= start_mm {
        output.report(DiagnosticKind::StrokeNotDown { from_mm: start_mm, to_mm: bottom_mm }, anchor);
    }
    state.position_mm[2] = bottom_mm;
    // After a mistake something has to wait for G332 all the same: it is not to be reported, too.
    let pitch_mm = pitch_mm.unwrap_or(1.0);
    let hand = if pitch_mm < 0.0 { Hand::Left } else { Hand::Right };
    let speed_rpm = speed_rpm.unwrap_or(1.0);
    let start_angle_rev = state.start_angle_rev(state.modal.spindle_angle_deg);
    let pitch_mm = pitch_mm.abs();
    state.stroke_in = Some(StrokeIn { start_mm, bottom_mm, pitch_mm, hand, speed_rpm, start_angle_rev });
}

fn stroke_out(state: &mut State, end_mm: f64, pitch: Option<(f64, Place)>, anchor: Place, output: &mut Output<'_, '_>) {
    let Some(into) = state.stroke_in.take() else {
        return output.report_if_whole(DiagnosticKind::StrokeOutAlone, anchor);
    };
    state.position_mm[2] = end_mm;
    let StrokeIn { start_mm, bottom_mm, pitch_mm: in_mm, hand, speed_rpm, start_angle_rev } = into;
    let written = pitch.map_or(Some(in_mm * hand.sign()), |_| stroke_pitch(StrokeKind::Out, pitch, anchor, output));
    let Some(out_mm) = written else { return };
    if out_mm != in_mm * hand.sign() {
        let in_mm = in_mm * hand.sign();
        return output.report(DiagnosticKind::StrokePitchDiffers { in_mm, out_mm }, anchor);
    }
    if end_mm < start_mm {
        return output.report(DiagnosticKind::StrokeOutTooShort { start_mm, end_mm }, anchor);
    }
    check_pitch(state, in_mm, anchor, output);
    let [x_mm, y_mm, _] = state.position_mm;
    output.emit(CommandKind::Tap(TapCycle {
        x_mm,
        y_mm,
        hand,
        start_angle_rev,
        return_mm: end_mm,
        out_speed_rpm: state.modal.turning_rpm().unwrap_or(speed_rpm),
        tool: state.modal.tool.in_spindle(),
        ..TapCycle::right_hand(start_mm, bottom_mm, in_mm, speed_rpm)
    }));
}

/// A stroke in that nothing followed is an error, once.
pub(crate) fn forget_stroke_in(state: &mut State, output: &mut Output<'_, '_>) {
    if state.stroke_in.is_some() {
        state.stroke_in = None;
        output.report_if_whole(DiagnosticKind::StrokeInAlone, output.place);
    }
}

/// G184, G174 with Z: from where the tool stands to Z and back, in the hand of the code; the pitch is by F.
pub(super) fn tap_from_here(state: &mut State, hand: Hand, output: &mut Output<'_, '_>) {
    let anchor = state.block.place;
    let axes = [b'X', b'Y', b'Z'].map(|letter| state.block.place_of(letter));
    let [x_mm, y_mm, from_mm] = state.position_mm;
    let [to_x_mm, to_y_mm, to_mm] = {
        let words = take_axes(state, output);
        [0, 1, 2].map(|axis: usize| {
            let from_mm = state.position_mm.get(axis).copied().unwrap_or_default();
            state.target_mm(axis, from_mm, words.get(axis).copied().flatten())
        })
    };
    if let [Some(place), ..] | [_, Some(place), _] = axes
        && (to_x_mm, to_y_mm) != (x_mm, y_mm)
    {
        return output.report(DiagnosticKind::StrokeNotAlongZ, place);
    }
    let speed_rpm = output.require(state.modal.turning_rpm(), DiagnosticKind::TapWithoutSpeed, anchor);
    let pitch_mm = pitch_mm(state, speed_rpm, anchor, output);
    let (Some(speed_rpm), Some(pitch_mm)) = (speed_rpm, pitch_mm) else { return };
    if to_mm >= from_mm {
        return output.report(DiagnosticKind::StrokeNotDown { from_mm, to_mm }, anchor);
    }
    check_pitch(state, pitch_mm, anchor, output);
    let start_angle_rev = state.start_angle_rev(None);
    let hole =
        TapCycle { x_mm, y_mm, hand, start_angle_rev, ..TapCycle::right_hand(from_mm, to_mm, pitch_mm, speed_rpm) };
    output.emit(CommandKind::Tap(TapCycle { tool: state.modal.tool.in_spindle(), ..hole }));
}
