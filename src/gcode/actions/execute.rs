//! One block: the order in which its words act on the state.

use super::calls::{macro_call, named_call, next_program};
use super::modes::{set_feed, set_feed_mode, set_idle, set_modes};
use super::motion::move_axes;
use super::offsets::{change_tool, go_home, length_by_words, shift, write_offset};
use super::output::Output;
use super::plane::{leaves_open, rotate};
use super::spindle::{set_spindle, stop};
use super::strokes::{forget_stroke_in, tap_from_here};
use super::words::dwell_s;
use crate::gcode::blocks::Flow;
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::{CodeName, DecimalPoint, DwellUnit, GCode, GGroup, MGroup};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::State;

const HOME: CodeName = CodeName { letter: b'G', tenths: 280 };

/// The words of a block act in this order, whatever theirs is:
///
/// 1. units, feed mode, G90/G91, G98/G99, work offset
/// 2. F, S
/// 3. M03, M04, M05, M29; what changes nothing
/// 4. a pause, a written offset, the travel to the reference point
/// 5. the motion, the stroke or the canned cycle; a hole called by name
/// 6. M98, M99, M02, M30; variables are written
///
/// What no step acted on is an error.
pub(crate) fn execute(state: &mut State, output: &mut Output<'_, '_>) -> Flow {
    // Nothing but the last step acts.
    if state.block.only_moves() {
        move_axes(state, false, output);
        if !state.block.all_acted() {
            tell_unacted(state, output);
        }
        return Flow::Next;
    }
    if state.block.has_g_of(1 << GGroup::OneShot as u32)
        && let Some(flow) = macro_call(state, output)
    {
        return flow;
    }
    if state.dialect.syntax.calls
        && let Some(flow) = named_call(state, output)
    {
        return flow;
    }
    // RS274's order: F before the unit of length; the feed mode before F.
    if state.dialect.rules.feed_before_unit && state.block.g(GGroup::Units).is_some() {
        set_feed_mode(state);
        set_feed(state, output);
    }
    set_modes(state, output);
    set_feed(state, output);
    set_spindle(state, output);
    set_idle(state, output);
    let flow = next_program(state, output);
    let one_shot = state.block.take_g(GGroup::OneShot);
    if state.plane_is_changed() && leaves_open(state, one_shot.map(|code| code.meaning), output) {
        // What follows from it is not reported, too.
        output.damaged = true;
    }
    match one_shot.map(|code| code.meaning) {
        Some(GCode::Dwell) => dwell(state, output),
        Some(GCode::WriteOffset) => write_offset(state, output),
        Some(code @ (GCode::LocalShift | GCode::SetPosition | GCode::CancelShift)) => {
            shift(state, code, state.block.place, output);
        }
        Some(GCode::Rotate) => rotate(state, state.block.place, output),
        Some(GCode::LengthByWords) => length_by_words(state, output),
        Some(GCode::ToolChange) => change_tool(state, one_shot.map_or(HOME, |code| code.name), output),
        Some(GCode::TapFromHere { hand }) => tap_from_here(state, hand, output),
        Some(_) => go_home(state, one_shot.map_or(HOME, |code| code.name), output),
        None => {}
    }
    move_axes(state, one_shot.is_some(), output);
    tell_unacted(state, output);
    if state.dialect.rules.m00_stops_spindle && state.block.m(MGroup::Stop).is_some_and(|code| code.name.tenths == 0) {
        stop(state, output);
    }
    for (variable, value, place) in state.block.assignments.drain(..) {
        if let Err(kind) = state.variables.write(variable, value) {
            output.report(kind, place);
        }
    }
    flow
}

/// Words and codes that nobody acted on.
fn tell_unacted(state: &mut State, output: &mut Output<'_, '_>) {
    while let Some((letter, place)) = state.block.take_leftover() {
        // In a damaged block the code that would have acted on it may be the one not understood.
        let of_cycle = state.cycle.as_ref().is_some_and(|cycle| !cycle.makes_holes) && b"RZPQJKL".contains(&letter);
        let kind =
            if of_cycle { DiagnosticKind::WordWithoutHole { letter } } else { DiagnosticKind::UnusedWord { letter } };
        output.report_if_whole(kind, place);
    }
    while let Some((name, place)) = state.block.take_unacted_code() {
        output.report_if_whole(DiagnosticKind::UnusedCode { name }, place);
    }
}

/// The program's end.
pub(crate) fn end(state: &mut State, output: &mut Output<'_, '_>) {
    forget_stroke_in(state, output);
    output.emit(CommandKind::End);
}

/// G4: P by the dialect; on a Fanuc X in seconds, without its point in milliseconds; on a SINUMERIK F in seconds.
fn dwell(state: &mut State, output: &mut Output<'_, '_>) {
    let anchor = state.block.place;
    let increments = state.dialect.decimal_point == DecimalPoint::Fanuc;
    let (other, of_other) = match state.dialect.dwell_letter {
        Some(letter @ b'X') if increments => (letter, DwellUnit::SecondsWithPoint),
        Some(letter) => (letter, DwellUnit::Seconds),
        None => (b'P', DwellUnit::Seconds),
    };
    let (value, unit) = match (state.block.take(b'P'), state.dialect.dwell) {
        (Some(value), Some(unit)) => (value, unit),
        _ => match state.block.take(other) {
            Some(value) => (value, of_other),
            None => return output.report_if_whole(DiagnosticKind::DwellMissing { letter: b'P' }, anchor),
        },
    };
    if let Some(dwell_s) = dwell_s(value, unit, output) {
        output.emit(CommandKind::Dwell { dwell_s });
    }
}
