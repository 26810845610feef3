//! Custom macro B: GOTO, WHILE … DO, END.

use std::io::{Read, Seek};

use super::run_state::{Loop, Running};
use crate::gcode::blocks::is_fanuc_end;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::text::Line;

/// GOTO: searched from here on, then from the program's start, as a Fanuc does.
pub(super) fn go_to<R: Read + Seek>(
    run: &mut Running<'_, R>,
    number: f64,
    line: Line<'_>,
) -> Result<(), DiagnosticKind> {
    let from = line.offset;
    let target = run.index(true).label(number, from).ok_or(DiagnosticKind::LabelMissing { number })?;
    run.loops.retain(|l| l.at.offset < target.offset || l.at.offset > from);
    run.next = target;
    Ok(())
}

/// WHILE [ ] DO m.
pub(super) fn fanuc_while<R: Read + Seek>(
    run: &mut Running<'_, R>,
    number: u32,
    holds: bool,
    line: Line<'_>,
) -> Result<(), DiagnosticKind> {
    let outside = run.calls.last().map_or(0, |call| call.loops);
    let label = number.to_string().into_bytes();
    let mut index = 0;
    run.loops.retain(|l| {
        index += 1;
        index <= outside || l.label != label
    });
    if holds {
        return run.push_loop(Loop::head(label, line.start()));
    }
    run.skip_past(|text| is_fanuc_end(text, number)).ok_or(DiagnosticKind::LoopOpen)
}

/// END m.
pub(super) fn fanuc_end<R: Read + Seek>(run: &mut Running<'_, R>, number: u32) -> Result<(), DiagnosticKind> {
    let label = number.to_string().into_bytes();
    let found = run.loops.iter().rev().find(|l| l.label == label).ok_or(DiagnosticKind::LoopOpen)?;
    run.next = found.at;
    Ok(())
}
