//! What a block with axis words does, by the motion or the cycle in force.

use super::called_cycle::called_hole;
use super::cycle::cycle_block;
use super::output::Output;
use super::plane::take_xy;
use super::spindle::turn_for_cut;
use super::strokes::{forget_stroke_in, stroke};
use super::words::{feed_mm_per_s, settle_xy, take_length_mm};
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::{G81, GCode, GGroup, MGroup};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{Cycle, Motion, State, StrokeKind};

pub(super) fn move_axes(state: &mut State, done: bool, output: &mut Output<'_, '_>) {
    if state.block.has_g_of(1 << GGroup::Motion as u32 | 1 << GGroup::Cycle as u32) {
        change_motion(state);
    }
    if done {
        return;
    }
    if let Some(mut cycle) = state.cycle.take() {
        cycle_block(state, &mut cycle, output);
        state.cycle = Some(cycle);
    } else if let Motion::Stroke(kind) = state.motion {
        stroke(state, kind, output);
    } else {
        straight(state, output);
    }
    if state.dialect.syntax.calls {
        called_hole(state, output);
    }
}

/// The block's code of the motion or of the cycle is in force from now on.
fn change_motion(state: &mut State) {
    let motion = state.block.take_g(GGroup::Motion).map(|code| code.meaning);
    let cycle = state.block.take_g(GGroup::Cycle);
    let cancels = cycle.is_some_and(|code| code.meaning == GCode::CancelCycle);
    if motion.is_some() || cancels {
        state.modal.rigid = state.block.m(MGroup::Rigid).is_some();
        state.cycle = None;
    }
    if cancels && !state.dialect.rules.g80_leaves_motion {
        state.motion = Motion::None;
    }
    match motion {
        Some(GCode::Rapid) => state.motion = Motion::Rapid,
        Some(GCode::TapStroke) => state.motion = Motion::Stroke(StrokeKind::Pair),
        Some(GCode::StrokeIn) => state.motion = Motion::Stroke(StrokeKind::In),
        Some(GCode::StrokeOut) => state.motion = Motion::Stroke(StrokeKind::Out),
        Some(_) => state.motion = Motion::Feed,
        None => {}
    }
    if let Some(code) = cycle.filter(|code| code.meaning.is_hole_cycle()) {
        // A drilling cycle ends what M29 began.
        if code.meaning == GCode::Cycle81 && state.dialect.g81 == G81::Drill {
            state.modal.rigid = state.block.m(MGroup::Rigid).is_some();
        }
        let keeps = state.dialect.rules.change_keeps;
        match &mut state.cycle {
            Some(cycle) => cycle.change(code, keeps),
            None => {
                let follows = state.dialect.rules.initial_level_follows_offset;
                let zero_mm = if follows { state.zero_mm(2) } else { 0.0 };
                state.cycle = Some(Box::new(Cycle::new(state.position_mm[2] - zero_mm, code)));
            }
        }
    }
}

/// G0, G1.
fn straight(state: &mut State, output: &mut Output<'_, '_>) {
    let given = [state.block.has(b'X'), state.block.has(b'Y')];
    let place = state.block.place_of(b'X').or(state.block.place_of(b'Y')).or(state.block.place_of(b'Z'));
    let [x, y] = take_xy(state, output);
    let z = take_length_mm(state, b'Z', output);
    let Some(anchor) = place else { return };
    let framed = state.block.has_g_of(1 << GGroup::Frame as u32);
    let machine = if framed { state.block.take_g(GGroup::Frame) } else { None };
    settle_xy(state, given, anchor, output);
    forget_stroke_in(state, output);
    if let Some(code) = machine
        && state.modal.incremental
    {
        output.report(DiagnosticKind::MachineFrameIncremental { name: code.name }, code.place);
    }
    let [x_mm, y_mm, z_mm] = state.position_mm;
    let mut to_mm = state.position_mm;
    if machine.is_some() {
        for (axis, (to, word_mm)) in to_mm.iter_mut().zip([x, y, z]).enumerate() {
            *to = word_mm.map_or(*to, |position_mm| state.frame.machine_mm(axis) + position_mm);
        }
    } else {
        [to_mm[0], to_mm[1]] = state.target_xy_mm([x_mm, y_mm], [x, y]);
        to_mm[2] = state.target_mm(2, z_mm, z);
    }
    match state.motion {
        Motion::Rapid => output.emit(CommandKind::Rapid { to_mm }),
        Motion::Feed => {
            if let Some(feed_mm_per_s) = feed_mm_per_s(state, anchor, output) {
                turn_for_cut(state, output);
                output.emit(CommandKind::Feed { to_mm, feed_mm_per_s });
            }
        }
        // Rapid at power on (FANUC's parameter 3402 bit 0 is 0 as delivered; a Haas always).
        Motion::None if state.dialect.rules.g80_leaves_motion => {
            output.report_if_whole(DiagnosticKind::PowerOnMotion, anchor);
            state.motion = Motion::Rapid;
            output.emit(CommandKind::Rapid { to_mm });
        }
        Motion::None => {
            output.report_if_whole(DiagnosticKind::NoMotionMode, anchor);
            // Said once; the next code that moves ends it.
            state.motion = Motion::Unknown;
        }
        Motion::Unknown | Motion::Stroke(_) => {}
    }
    state.position_mm = to_mm;
}
