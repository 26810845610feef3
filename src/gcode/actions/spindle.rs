//! The spindle's codes and speed.

use super::output::Output;
use crate::control::cycle::Hand;
use crate::gcode::blocks::Value;
use crate::gcode::command::{CommandKind, SpindleCommand};
use crate::gcode::dialect::{G81, GCode, GGroup, MCode, MGroup};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::State;

pub(super) fn set_spindle(state: &mut State, output: &mut Output<'_, '_>) {
    stop_for_tool(state, output);
    // S of G92 is a limit on a FANUC: it is left to be reported.
    let limits = state.block.g(GGroup::OneShot).is_some_and(|code| code.meaning == GCode::SetPosition);
    let speed = if limits { None } else { state.block.take(b'S') };
    if let Some(Value { number, place }) = speed {
        if number.value < 0.0 {
            output.report(DiagnosticKind::SpeedNegative { rpm: number.value }, place);
        }
        state.modal.speed_rpm = Some(number.value.abs());
    }
    let code = state.block.take_m(MGroup::Spindle);
    if code.is_some() {
        state.modal.spindle_angle_deg = None;
    }
    match code.map(|code| code.meaning) {
        Some(MCode::SpindleRight) => state.modal.hand = Some(Hand::Right),
        Some(MCode::SpindleLeft) => state.modal.hand = Some(Hand::Left),
        Some(_) => state.modal.hand = None,
        None => {}
    }
    let spindle = match (state.modal.hand, state.modal.turning_rpm()) {
        (Some(hand), Some(speed_rpm)) => SpindleCommand::On { hand, speed_rpm },
        _ => SpindleCommand::Off,
    };
    // For the next hole the spindle stands anyway, and S is but the speed of its strokes.
    if code.is_some() || (speed.is_some() && state.modal.hand.is_some() && !taps(state)) {
        turn(state, spindle, output);
    }
    if let (Some(code), Some(_), SpindleCommand::Off) = (code, state.modal.hand, spindle) {
        output.report_if_whole(DiagnosticKind::SpindleWithoutSpeed { name: code.name }, code.place);
    }
}

/// M06, M19 and G100 stop the spindle before they act.
fn stop_for_tool(state: &mut State, output: &mut Output<'_, '_>) {
    let by_m =
        state.block.has_m() && (state.block.m(MGroup::Tool).is_some() || state.block.m(MGroup::Orient).is_some());
    // Most blocks have neither.
    if by_m || state.block.g(GGroup::OneShot).is_some_and(|code| code.meaning == GCode::ToolChange) {
        stop(state, output);
    }
}

/// The spindle comes to rest until M03 or M04 is said anew.
pub(super) fn stop(state: &mut State, output: &mut Output<'_, '_>) {
    state.modal.hand = None;
    if state.turning != SpindleCommand::Off {
        turn(state, SpindleCommand::Off, output);
    }
}

/// Whether the block belongs to a tapping cycle, or readies for one.
pub(super) fn taps(state: &State) -> bool {
    let motion = state.block.g(GGroup::Motion).is_some();
    let taps = |meaning| match meaning {
        GCode::Cycle81 => state.dialect.g81 == G81::Tap,
        meaning => meaning.is_hole_cycle(),
    };
    let cycle = match (state.block.g(GGroup::Cycle), &state.cycle) {
        (Some(code), _) => taps(code.meaning),
        (None, Some(cycle)) => !motion && taps(cycle.meaning()),
        _ => false,
    };
    cycle || state.block.m(MGroup::Rigid).is_some()
}

fn turn(state: &mut State, spindle: SpindleCommand, output: &mut Output<'_, '_>) {
    state.turning = spindle;
    output.emit(CommandKind::Spindle(spindle));
}

/// Before a cut the spindle takes the speed that S gave a tapping cycle.
pub(crate) fn turn_for_cut(state: &mut State, output: &mut Output<'_, '_>) {
    if let (Some(hand), Some(speed_rpm)) = (state.modal.hand, state.modal.turning_rpm()) {
        let wanted = SpindleCommand::On { hand, speed_rpm };
        if state.turning != wanted {
            turn(state, wanted, output);
        }
    }
}
