//! Blocks that write work offsets, and the travel to the reference point.

use super::output::Output;
use super::words::take_axes;
use crate::gcode::blocks::Value;
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::{CodeName, GCode};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{State, ToolLength};
use crate::gcode::text::Place;

const EXTENDED: CodeName = CodeName { letter: b'G', tenths: 541 };
const EXTENDED_HAAS: CodeName = CodeName { letter: b'G', tenths: 1540 };
/// Place of the numbered offsets, behind G59.3.
const FIRST_NUMBERED: u8 = 9;

/// The offset that P names behind G54.1 or G154.
pub(super) fn numbered_offset(state: &mut State, anchor: Place, output: &mut Output<'_, '_>) -> Option<u8> {
    let written = state.block.take(b'P');
    let number = written.map_or(0.0, |value| value.number.value);
    if number.fract() == 0.0 && (1.0..=99.0).contains(&number) {
        return Some(FIRST_NUMBERED + number as u8);
    }
    let place = written.map_or(anchor, |value| value.place);
    output.report_if_whole(DiagnosticKind::BadOffset { letter: b'P', value: number.max(0.0) }, place);
    None
}

/// G52, G92, G92.1: a shift of every work offset.
///
/// 1. G52 X Y Z: the axes named lie that far from the work offset's zero.
/// 2. G92 X Y Z: the present position is called so. In RS274 G52 and G92 are one shift.
/// 3. G92.1: no shift.
///
/// On other controls G92 after G52 depends on parameters: it is refused.
pub(super) fn shift(state: &mut State, code: GCode, anchor: Place, output: &mut Output<'_, '_>) {
    let axes = take_axes(state, output);
    if code == GCode::CancelShift {
        state.frame.shift_mm = [0.0; 3];
        return;
    }
    if axes.iter().all(Option::is_none) {
        return output.report_if_whole(DiagnosticKind::ShiftWithoutAxes, anchor);
    }
    for (axis, word_mm) in axes.into_iter().enumerate() {
        let Some(word_mm) = word_mm else { continue };
        let zero_mm = state.frame.zero_mm(state.modal.work_offset, axis);
        let here_mm = state.position_mm.get(axis).copied().unwrap_or_default();
        let Some(slot) = state.frame.shift_mm.get_mut(axis) else { continue };
        if code == GCode::SetPosition && *slot != 0.0 && state.dialect.name != "linuxcnc" {
            output.report(DiagnosticKind::FrameNotRead, anchor);
        }
        *slot = if code == GCode::SetPosition { here_mm - zero_mm - word_mm } else { word_mm };
    }
}

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
    // L20 P n of a FANUC or Haas writes the numbered offsets, G54.1 P n or G154 P n.
    let numbered =
        !ngc && kind == 20.0 && state.dialect.g_code(EXTENDED).or(state.dialect.g_code(EXTENDED_HAAS)).is_some();
    if kind != 2.0 && !(ngc && kind == 20.0) && !numbered {
        output.report(DiagnosticKind::BadOffset { letter: b'L', value: kind }, place);
        let _ = (state.block.take(b'P'), state.block.take(b'R'));
        take_axes(state, output);
        return;
    }
    let written = state.block.take(b'P');
    let axes = take_axes(state, output);
    let number = written.map_or(-1.0, |value| value.number.value);
    let known = number.fract() == 0.0
        && (if ngc {
            0.0..=9.0
        } else if numbered {
            1.0..=99.0
        } else {
            1.0..=6.0
        })
        .contains(&number);
    if !known {
        let place = written.map_or(anchor, |value| value.place);
        output.report_if_whole(DiagnosticKind::BadOffset { letter: b'P', value: number.max(0.0) }, place);
        return;
    }
    let offset = match number as u8 {
        0 => state.modal.work_offset,
        number if numbered => FIRST_NUMBERED + number,
        number => number,
    };
    for (axis, word_mm) in axes.into_iter().enumerate() {
        let Some(word_mm) = word_mm else { continue };
        let before_mm = state.frame.zero_mm(offset, axis);
        let here_mm = state.position_mm.get(axis).copied().unwrap_or_default();
        let zero_mm = match ngc && kind == 20.0 {
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

/// G43.1: the length of the tool, which changes nothing, since Z is its tip. A tool beside the spindle's axis is not read.
pub(super) fn length_by_words(state: &mut State, output: &mut Output<'_, '_>) {
    let place = state.block.place_of(b'X').or(state.block.place_of(b'Y'));
    let [x_mm, y_mm, _] = take_axes(state, output);
    if x_mm.unwrap_or(0.0) != 0.0 || y_mm.unwrap_or(0.0) != 0.0 {
        output.report(DiagnosticKind::FrameNotRead, place.unwrap_or(state.block.place));
    }
    state.modal.tool_length = ToolLength::On;
    let name = CodeName { letter: b'G', tenths: 431 };
    if state.reported.first_g(name) {
        output.report(DiagnosticKind::IdleCode { name }, state.block.place);
    }
}

/// G28: by rapids over the point named to the reference point, those axes alone; all where none is named.
pub(crate) fn go_home(state: &mut State, name: CodeName, output: &mut Output<'_, '_>) {
    // G30 P2 to P4 go to further reference points, which are not known: the first is taken.
    if name.tenths == 300
        && let Some(Value { place, .. }) = state.block.take(b'P')
        && state.reported.first_g(name)
    {
        output.report(DiagnosticKind::OtherReferencePoint, place);
    }
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

/// G100: the tool is changed with Z at the machine's zero; then X and Y, then Z, all by rapids.
pub(super) fn change_tool(state: &mut State, name: CodeName, output: &mut Output<'_, '_>) {
    let anchor = state.block.place;
    state.modal.tool.change();
    let [x, y, z] = take_axes(state, output);
    if state.modal.incremental && [x, y, z].iter().any(Option::is_some) {
        return output.report_if_whole(DiagnosticKind::MachineFrameIncremental { name }, anchor);
    }
    let [x_mm, y_mm, _] = state.position_mm;
    let top_mm = state.frame.machine_mm(2);
    let [to_x_mm, to_y_mm] = state.target_xy_mm([x_mm, y_mm], [x, y]);
    let to_z_mm = state.target_mm(2, top_mm, z);
    for to_mm in [[x_mm, y_mm, top_mm], [to_x_mm, to_y_mm, top_mm], [to_x_mm, to_y_mm, to_z_mm]] {
        if to_mm != state.position_mm {
            output.emit(CommandKind::Rapid { to_mm });
            state.position_mm = to_mm;
        }
    }
}
