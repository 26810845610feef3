//! Blocks that write work offsets, and the travel to the reference point.

use super::output::Output;
use super::words::take_axes;
use crate::gcode::blocks::Value;
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::CodeName;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::State;

/// G10: the zero of a work offset.
///
/// 1. L2 P n: X, Y, Z are its place from the machine's zero; under G91 how far it moves (not in RS274)
/// 2. L20 P n, in RS274 alone: X, Y, Z are what the present position shall be called
/// 3. L1, L10, L11: tool lengths, which change nothing
pub(crate) fn write_offset(state: &mut State, output: &mut Output<'_, '_>) {
    let anchor = state.block.place;
    let kind = state.block.take(b'L');
    let Some(Value { number, place }) = kind else {
        output.report_if_whole(DiagnosticKind::BadOffset { letter: b'L', value: 0.0 }, anchor);
        take_axes(state, output);
        return;
    };
    let ngc = state.dialect.name == "linuxcnc";
    let kind = number.value;
    if [1.0, 10.0, 11.0].contains(&kind) {
        if state.first_of_code(CodeName { letter: b'G', tenths: 100 }) {
            output.report(DiagnosticKind::IdleWord { letter: b'L' }, place);
        }
        let _ = (state.block.take(b'P'), state.block.take(b'R'));
        take_axes(state, output);
        return;
    }
    if kind != 2.0 && !(ngc && kind == 20.0) {
        output.report(DiagnosticKind::BadOffset { letter: b'L', value: kind }, place);
        let _ = (state.block.take(b'P'), state.block.take(b'R'));
        take_axes(state, output);
        return;
    }
    let written = state.block.take(b'P');
    let axes = take_axes(state, output);
    let number = written.map_or(-1.0, |value| value.number.value);
    let known = number.fract() == 0.0 && (if ngc { 0.0..=9.0 } else { 1.0..=6.0 }).contains(&number);
    if !known {
        let place = written.map_or(anchor, |value| value.place);
        output.report_if_whole(DiagnosticKind::BadOffset { letter: b'P', value: number.max(0.0) }, place);
        return;
    }
    let offset = if number == 0.0 { state.modal.work_offset } else { number as u8 };
    for (axis, word_mm) in axes.into_iter().enumerate() {
        let Some(word_mm) = word_mm else { continue };
        let before_mm = state.frame.zero_mm(offset, axis);
        let here_mm = state.position_mm.get(axis).copied().unwrap_or_default();
        let zero_mm = match kind == 20.0 {
            true => here_mm - word_mm,
            false if state.modal.incremental && !ngc => before_mm + word_mm,
            false => state.frame.machine_mm(axis) + word_mm,
        };
        let zeros = state.frame.zeros_mm.get_mut(usize::from(offset).wrapping_sub(1));
        if let Some(slot) = zeros.and_then(|zeros| zeros.get_mut(axis)) {
            *slot = zero_mm;
        }
    }
}

/// G28: by rapids over the point named to the reference point, those axes alone; all where none is named.
pub(crate) fn go_home(state: &mut State, output: &mut Output<'_, '_>) {
    let axes = take_axes(state, output);
    let none = axes.iter().all(Option::is_none);
    let mut over_mm = state.position_mm;
    let mut home_mm = state.position_mm;
    for (axis, word_mm) in axes.into_iter().enumerate() {
        let (Some(over), Some(home)) = (over_mm.get_mut(axis), home_mm.get_mut(axis)) else { continue };
        *over = state.target_mm(axis, *over, word_mm);
        *home = if word_mm.is_some() || none { state.frame.machine_mm(axis) } else { *over };
    }
    for to_mm in [over_mm, home_mm] {
        if to_mm != state.position_mm {
            output.emit(CommandKind::Rapid { to_mm });
            state.position_mm = to_mm;
        }
    }
}
