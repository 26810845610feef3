//! Cycles called by name: CYCLE84 by itself or modal by MCALL, and HOLES1 and HOLES2 under it.

use super::cycle84::cycle84;
use super::output::Output;
use super::parameters::{Parameters, read_parameters};
use super::spindle::stop;
use super::words::check_pitch;
use crate::control::cycle::TapCycle;
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::{CodeName, Name};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{ModalHole, State};
use crate::gcode::text::Place;

/// Most holes of one pattern.
const MAX_HOLES: f64 = 9999.0;

/// What the block calls by name, and the hole that MCALL makes after every block that moves an axis.
pub(super) fn called_hole(state: &mut State, output: &mut Output<'_, '_>) {
    let Some((name, parameters)) = state.block.call else {
        if let Some(modal) = state.modal_hole.filter(|_| state.block.moved) {
            tap_here(state, modal, output);
        }
        return;
    };
    let text = output.line.text;
    match Name::of(name.text(text)) {
        Some(Name::SpindleAngle) => {
            stop(state, output);
            let angle = parameters.and_then(|place| read_parameters(state, place, output));
            state.modal.spindle_angle_deg = angle.and_then(|angle| angle.number(1));
        }
        Some(Name::ModalCall) => match state.block.second_call {
            None => state.modal_hole = None,
            Some((name, parameters)) if Name::of(name.text(text)) == Some(Name::Tap) => {
                if let Some(parameters) = needed(parameters, name, output) {
                    state.modal_hole = cycle84(state, parameters, output);
                }
            }
            Some((name, _)) => output.report(DiagnosticKind::UnknownCall, name),
        },
        Some(Name::Tap) => {
            if let Some(hole) = needed(parameters, name, output).and_then(|at| cycle84(state, at, output)) {
                tap_here(state, hole, output);
            }
        }
        Some(kind @ (Name::Row | Name::Circle)) => {
            let Some(place) = needed(parameters, name, output) else { return };
            let Some(modal) = state.modal_hole else {
                return output.report(DiagnosticKind::PatternWithoutCycle, name);
            };
            let read = read_parameters(state, place, output);
            let holes = read.and_then(|values| match kind {
                Name::Row => row(state, &values, place, output),
                _ => circle(state, &values, place, output),
            });
            let holes = holes.unwrap_or_default();
            if let [first, second, ..] = holes.as_slice()
                && first == second
            {
                output.report(DiagnosticKind::SameHoleAgain { times: holes.len() as u32 }, name);
            }
            for [x_mm, y_mm] in holes {
                [state.position_mm[0], state.position_mm[1]] = [x_mm, y_mm];
                tap_here(state, modal, output);
            }
        }
        // PROC NAME begins a subprogram; with parameters it has variables of its own.
        Some(Name::Procedure) if state.block.second_call.is_some_and(|(_, parameters)| parameters.is_none()) => {}
        _ => output.report(DiagnosticKind::UnknownCall, name),
    }
}

fn needed(parameters: Option<Place>, name: Place, output: &mut Output<'_, '_>) -> Option<Place> {
    output.require(parameters, DiagnosticKind::CallParametersMissing, name)
}

fn tap_here(state: &mut State, modal: ModalHole, output: &mut Output<'_, '_>) {
    if modal.unit != state.modal.unit {
        let name = CodeName { letter: b'G', tenths: 840 };
        return output.report(DiagnosticKind::CycleUnitChanged { name }, state.block.place);
    }
    let ModalHole { mut hole, speed_by_s, .. } = modal;
    if speed_by_s {
        let speed = state.modal.turning_rpm();
        let Some(speed_rpm) = output.require(speed, DiagnosticKind::TapWithoutSpeed, state.block.place) else { return };
        hole.out_speed_rpm *= speed_rpm / hole.speed_rpm;
        hole.speed_rpm = speed_rpm;
    }
    check_pitch(state, hole.pitch_mm, state.block.place, output);
    let [x_mm, y_mm, _] = state.position_mm;
    let zero_mm = state.zero_mm(2);
    let hole = TapCycle {
        x_mm,
        y_mm,
        r_plane_mm: hole.r_plane_mm + zero_mm,
        bottom_mm: hole.bottom_mm + zero_mm,
        return_mm: hole.return_mm + zero_mm,
        tool: state.modal.tool.in_spindle(),
        ..hole
    };
    output.emit(CommandKind::Tap(hole));
    state.position_mm[2] = hole.return_mm;
    match modal.hand_after {
        None => stop(state, output),
        hand => state.modal.hand = hand,
    }
}

/// HOLES1(SPCA, SPCO, STA1, FDIS, DBH, NUM): point of reference, angle of the row, distance of the first hole from that
/// point, distance of the holes, number. It begins at the end that is nearer.
fn row(state: &State, values: &Parameters, place: Place, output: &mut Output<'_, '_>) -> Option<Vec<[f64; 2]>> {
    let [x, y, angle, first, step, count] = six(values, ["SPCA", "SPCO", "STA1", "FDIS", "DBH", "NUM"], place, output)?;
    let mm = state.modal.unit.mm();
    let (sin, cos) = angle.to_radians().sin_cos();
    let at = |index: u32| {
        let distance_mm = (first + f64::from(index) * step) * mm;
        [state.zero_mm(0) + x * mm + distance_mm * cos, state.zero_mm(1) + y * mm + distance_mm * sin]
    };
    let mut holes: Vec<_> = (0..count as u32).map(at).collect();
    let from = |hole: Option<&[f64; 2]>| {
        hole.map_or(0.0, |[x_mm, y_mm]| (x_mm - state.position_mm[0]).hypot(y_mm - state.position_mm[1]))
    };
    if from(holes.last()) < from(holes.first()) {
        holes.reverse();
    }
    Some(holes)
}

/// HOLES2(CPA, CPO, RAD, STA1, INDA, NUM): centre, radius, first angle, angle from hole to hole (0: evenly), number.
fn circle(state: &State, values: &Parameters, place: Place, output: &mut Output<'_, '_>) -> Option<Vec<[f64; 2]>> {
    let names = ["CPA", "CPO", "RAD", "STA1", "INDA", "NUM"];
    let [x, y, radius, first, step, count] = six(values, names, place, output)?;
    let mm = state.modal.unit.mm();
    let step = if step == 0.0 { 360.0 / count } else { step };
    let at = |index: u32| {
        let (sin, cos) = (first + f64::from(index) * step).to_radians().sin_cos();
        [state.zero_mm(0) + (x + radius * cos) * mm, state.zero_mm(1) + (y + radius * sin) * mm]
    };
    Some((0..count as u32).map(at).collect())
}

/// The six of a pattern; the last one counts its holes. A further one that is not zero is not known.
fn six(values: &Parameters, names: [&'static str; 6], place: Place, output: &mut Output<'_, '_>) -> Option<[f64; 6]> {
    let [.., count_name] = names;
    if let Some(number) = (7..=values.count()).find(|&number| values.number(number).is_some_and(|value| value != 0.0)) {
        output.report(DiagnosticKind::PatternParameter { number, name: "not known here" }, place);
        return None;
    }
    let count = values.number(6).filter(|count| count.fract() == 0.0 && (1.0..=MAX_HOLES).contains(count));
    if count.is_none() {
        output.report(DiagnosticKind::PatternParameter { number: 6, name: count_name }, place);
        return None;
    }
    Some([1, 2, 3, 4, 5, 6].map(|number| values.number(number).unwrap_or(0.0)))
}
