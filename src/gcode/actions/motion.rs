//! What a block with axis words does, by the motion or the cycle in force.

use super::called_cycle::called_hole;
use super::cycle::cycle_block;
use super::output::Output;
use super::spindle::turn_for_cut;
use super::strokes::{forget_stroke_in, stroke};
use super::words::{feed_mm_per_s, take_axes};
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::{GCode, GGroup, MGroup};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{Cycle, Movement, State, StrokeKind};

pub(super) fn move_axes(state: &mut State, done: bool, output: &mut Output<'_, '_>) {
    let motion = state.block.g(GGroup::Motion).map(|code| code.meaning);
    let cycle = state.block.g(GGroup::Cycle);
    if motion.is_some() || cycle.is_some_and(|code| code.meaning == GCode::CancelCycle) {
        state.modal.rigid = state.block.m(MGroup::Rigid).is_some();
    }
    match (motion, cycle) {
        (Some(GCode::Rapid), _) => state.movement = Movement::Rapid,
        (Some(GCode::TapStroke), _) => state.movement = Movement::Stroke(StrokeKind::Pair),
        (Some(GCode::StrokeIn), _) => state.movement = Movement::Stroke(StrokeKind::In),
        (Some(GCode::StrokeOut), _) => state.movement = Movement::Stroke(StrokeKind::Out),
        (Some(_), _) => state.movement = Movement::Feed,
        (None, Some(code)) if code.meaning == GCode::CancelCycle => state.movement = Movement::None,
        (None, Some(code)) => match &mut state.movement {
            // Within a cycle another keeps what is stored, and the initial level.
            Movement::Cycle(cycle) => cycle.rename(code),
            movement => *movement = Movement::Cycle(Cycle::new(state.position_mm[2], code)),
        },
        (None, None) => {}
    }
    if done {
        return;
    }
    match state.movement {
        Movement::Cycle(mut cycle) => {
            cycle_block(state, &mut cycle, output);
            state.movement = Movement::Cycle(cycle);
        }
        Movement::Stroke(kind) => stroke(state, kind, output),
        _ => straight(state, output),
    }
    called_hole(state, output);
}

/// G0, G1.
fn straight(state: &mut State, output: &mut Output<'_, '_>) {
    let places = [b'X', b'Y', b'Z'].map(|letter| state.block.place_of(letter));
    let words = take_axes(state, output);
    let machine = state.block.g(GGroup::Frame);
    let Some(anchor) = places.into_iter().flatten().next() else { return };
    forget_stroke_in(state, output);
    if let Some(code) = machine
        && state.modal.incremental
    {
        output.report(DiagnosticKind::MachineFrameIncremental { name: code.name }, code.place);
    }
    let mut to_mm = state.position_mm;
    for (axis, (to, word_mm)) in to_mm.iter_mut().zip(words).enumerate() {
        *to = match word_mm {
            Some(position_mm) if machine.is_some() => state.frame.machine_mm(axis) + position_mm,
            word_mm => state.target_mm(axis, *to, word_mm),
        };
    }
    match state.movement {
        Movement::Rapid => output.emit(CommandKind::Rapid { to_mm }),
        Movement::Feed => {
            if let Some(feed_mm_per_s) = feed_mm_per_s(state, anchor, output) {
                turn_for_cut(state, output);
                output.emit(CommandKind::Feed { to_mm, feed_mm_per_s });
            }
        }
        Movement::None => {
            output.report_if_whole(DiagnosticKind::NoMotionMode, anchor);
            // Said once; the next code that moves ends it.
            state.movement = Movement::Unknown;
        }
        Movement::Unknown | Movement::Stroke(_) | Movement::Cycle(_) => {}
    }
    state.position_mm = to_mm;
}
