//! Cycles called by name: CYCLE84, by itself or modal by MCALL.

use super::output::Output;
use super::words::check_pitch;
use crate::control::cycle::{Hand, Retract, TapCycle};
use crate::control::thread::StandardThread;
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::PECK_BACK_MM;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{ModalHole, State};
use crate::gcode::text::{Place, number};

/// What the block calls by name, and the hole that MCALL makes at every position.
pub(crate) fn called_hole(state: &mut State, output: &mut Output<'_, '_>) {
    let Some((name, parameters)) = state.block.call else {
        let moved = state.block.moved_xy;
        if let Some(ModalHole(hole)) = state.modal_hole.filter(|_| moved) {
            tap_here(state, hole, output);
        }
        return;
    };
    let text = output.line.text;
    let called = name.text(text);
    // The cycles orient the spindle themselves.
    if called.eq_ignore_ascii_case(b"SPOS") {
        return;
    }
    let (modal, cycle) = if called.eq_ignore_ascii_case(b"MCALL") {
        (true, state.block.second_call)
    } else {
        (false, Some((name, parameters)))
    };
    let Some((name, parameters)) = cycle else {
        state.modal_hole = None;
        return;
    };
    if !name.text(text).eq_ignore_ascii_case(b"CYCLE84") {
        return output.report(DiagnosticKind::UnknownCall, name);
    }
    let Some(parameters) = parameters else {
        return output.report(DiagnosticKind::CallParametersMissing, name);
    };
    let hole = cycle84(state, parameters, output);
    match hole {
        Some(hole) if modal => state.modal_hole = Some(ModalHole(hole)),
        Some(hole) => tap_here(state, hole, output),
        None => {}
    }
}

fn tap_here(state: &mut State, hole: TapCycle, output: &mut Output<'_, '_>) {
    check_pitch(state, hole.pitch_mm, state.block.place, output);
    let [x_mm, y_mm, _] = state.position_mm;
    output.emit(CommandKind::Tap(TapCycle { x_mm, y_mm, ..hole }));
    state.position_mm[2] = hole.return_mm;
}

/// CYCLE84's parameters, in the order of the manual:
/// RTP retraction plane, RFP reference plane, SDIS safety distance, DP depth, DPR depth from RFP, DTB dwell in s,
/// SDAC spindle after the cycle, MPIT size M3 … M48, PIT pitch (negative is left-hand), POSS spindle angle,
/// SST speed in, SST1 speed out, AXN axis, PITA unit of PIT, TECHNO, VARI 0 one stroke, 1 chip break, 2 full
/// retract, DAM peck, VRT distance back.
fn cycle84(state: &mut State, parameters: Place, output: &mut Output<'_, '_>) -> Option<TapCycle> {
    let values = read_parameters(parameters, output)?;
    let value = |number: usize| values.get(number - 1).copied().flatten();
    let mm = state.modal.unit.mm();
    let mut need = |number: usize, name: &'static str, found: Option<f64>| {
        if found.is_none() {
            output.report(DiagnosticKind::CallParameterBad { number, name }, parameters);
        }
        found
    };
    let reference_mm = need(2, "RFP", value(2))? * mm;
    let return_mm = need(1, "RTP", value(1))? * mm;
    let r_plane_mm = reference_mm + value(3).unwrap_or(0.0).abs() * mm;
    let depth_mm = value(4).map(|depth| depth * mm).or_else(|| value(5).map(|depth| reference_mm - depth.abs() * mm));
    let bottom_mm = need(4, "DP", depth_mm.filter(|&mm| mm < r_plane_mm))?;
    let size_mm = value(8).filter(|&size| size != 0.0);
    let by_size = size_mm.and_then(|size| {
        StandardThread::by_name(&format!("M{}", size.abs())).map(|thread| thread.pitch_mm * size.signum())
    });
    if size_mm.is_some() {
        need(8, "MPIT", by_size)?;
    }
    let pitch_mm = by_size.or(value(9).filter(|&pitch| pitch != 0.0).map(|pitch| pitch * mm));
    let pitch_mm = need(9, "PIT", pitch_mm)?;
    let speed_rpm = need(11, "SST", value(11).or(state.modal.turning_rpm()).filter(|&rpm| rpm > 0.0))?;
    let out_speed_rpm = value(12).filter(|&rpm| rpm > 0.0).unwrap_or(speed_rpm);
    let dwell_s = need(6, "DTB", Some(value(6).unwrap_or(0.0)).filter(|&dwell_s| dwell_s >= 0.0))?;
    let back_mm = value(18).filter(|&back| back > 0.0).map_or(PECK_BACK_MM, |back| back * mm);
    let retract = match value(16).unwrap_or(0.0) {
        0.0 => None,
        1.0 => Some(Retract::ChipBreak { back_mm }),
        2.0 => Some(Retract::Full),
        _ => need(16, "VARI", None).map(|_| Retract::Full),
    };
    let peck_mm = match retract {
        Some(_) => Some(need(17, "DAM", value(17).map(|peck| peck * mm).filter(|&peck| peck > 0.0))?),
        None => None,
    };
    let zero_mm = state.zero_mm(2);
    let hand = if pitch_mm < 0.0 { Hand::Left } else { Hand::Right };
    Some(TapCycle {
        hand,
        out_speed_rpm,
        dwell_s,
        peck_mm,
        retract,
        return_mm: zero_mm + return_mm.max(r_plane_mm),
        ..TapCycle::right_hand(zero_mm + r_plane_mm, zero_mm + bottom_mm, pitch_mm.abs(), speed_rpm)
    })
}

/// Most parameters of a call.
const MAX_PARAMETERS: usize = 24;

/// The numbers between commas; none after a mistake.
fn read_parameters(place: Place, output: &mut Output<'_, '_>) -> Option<[Option<f64>; MAX_PARAMETERS]> {
    let mut values = [None; MAX_PARAMETERS];
    let text = place.text(output.line.text);
    let mut good = true;
    for (index, part) in text.split(|&b| b == b',').enumerate() {
        let part = part.trim_ascii();
        let parsed = number::parse(part).filter(|number| number.value.abs() <= number::LARGEST);
        match values.get_mut(index) {
            Some(_) if part.is_empty() => {}
            Some(slot) if parsed.is_some() => *slot = parsed.map(|number| number.value),
            _ => {
                output.report(DiagnosticKind::CallParameterUnread { number: index + 1 }, place);
                good = false;
                break;
            }
        }
    }
    good.then_some(values)
}
