//! X and Y that are no plain coordinates: polar ones (G16), and a turned plane (G68).
//!
//! G16: under G90 X is the radius and Y the angle in degrees about the zero of the work offset, and what a block leaves out
//! stays (FANUC B-64304EN-2, "Polar coordinate command"). G68 X Y R: turns about X Y by R degrees, counter-clockwise; about
//! where the tool stands if neither is said (B-64304EN-2 and Haas Mill Operator's Manual 2017, "Rotation").

use super::output::Output;
use super::words::take_length_mm;
use crate::gcode::blocks::Value;
use crate::gcode::dialect::{DecimalPoint, GCode, GGroup};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{Rotation, State};
use crate::gcode::text::Place;

/// X and Y of a block as coordinates or distances, in mm.
pub(super) fn take_xy(state: &mut State, output: &mut Output<'_, '_>) -> [Option<f64>; 2] {
    let Some([radius, angle]) = state.modal.polar else {
        if !state.frame.turned_anew {
            return [take_length_mm(state, b'X', output), take_length_mm(state, b'Y', output)];
        }
        let place = state.block.place_of(b'X').or(state.block.place_of(b'Y'));
        let words_mm = [b'X', b'Y'].map(|letter| take_length_mm(state, letter, output));
        if let Some(place) = place.filter(|_| std::mem::take(&mut state.frame.turned_anew))
            && (state.modal.incremental || words_mm.contains(&None))
        {
            return refuse(
                "a first position behind G68 or G69 that is a distance, or of one axis alone,",
                place,
                output,
            );
        }
        return words_mm;
    };
    let Some(anchor) = state.block.place_of(b'X').or(state.block.place_of(b'Y')) else { return [None; 2] };
    let radius_mm = take_length_mm(state, b'X', output).or(radius);
    let angle_deg = take_angle_deg(state, b'Y', output).or(angle);
    state.modal.polar = Some([radius_mm, angle_deg]);
    if state.modal.incremental {
        return refuse("a distance under G91", anchor, output);
    }
    let (Some(radius_mm), Some(angle_deg)) = (radius_mm, angle_deg) else {
        return refuse("a position without its radius X or its angle Y", anchor, output);
    };
    let (sin, cos) = sin_cos(angle_deg);
    [Some(radius_mm * cos), Some(radius_mm * sin)]
}

fn refuse(why: &'static str, place: Place, output: &mut Output<'_, '_>) -> [Option<f64>; 2] {
    output.report_if_whole(DiagnosticKind::PlaneNotExact { why }, place);
    [None; 2]
}

/// Right angles are exact.
fn sin_cos(angle_deg: f64) -> (f64, f64) {
    match angle_deg.rem_euclid(360.0) {
        0.0 => (0.0, 1.0),
        90.0 => (1.0, 0.0),
        180.0 => (0.0, -1.0),
        270.0 => (-1.0, 0.0),
        angle_deg => angle_deg.to_radians().sin_cos(),
    }
}

fn take_angle_deg(state: &mut State, letter: u8, output: &mut Output<'_, '_>) -> Option<f64> {
    let Value { number, place } = state.block.take(letter)?;
    if state.dialect.decimal_point == DecimalPoint::Fanuc && !number.has_point && number.value != 0.0 {
        output.report(DiagnosticKind::AngleNeedsPoint { letter }, place);
    }
    Some(number.value)
}

/// G15, G16, G69: before the words of the block are read.
pub(super) fn set_plane_modes(state: &mut State, meaning: GCode) {
    match meaning {
        GCode::Polar => state.modal.polar = Some([None; 2]),
        GCode::Cartesian => state.modal.polar = None,
        GCode::Unrotate => {
            state.frame.turned_anew |= state.frame.rotation.take().is_some();
        }
        _ => {}
    }
}

/// G68.
pub(super) fn rotate(state: &mut State, anchor: Place, output: &mut Output<'_, '_>) {
    let incremental = state.modal.incremental;
    let words_mm = [b'X', b'Y'].map(|letter| take_length_mm(state, letter, output));
    let angle_deg = take_angle_deg(state, b'R', output);
    let refused = match (words_mm, angle_deg) {
        _ if state.plane_is_changed() => Some("a turn"),
        _ if incremental => Some("a turn by a distance, under G91,"),
        ([Some(_), Some(_)] | [None, None], Some(_)) => None,
        (_, None) => Some("a turn without its angle R"),
        _ => Some("a turn with one of X and Y alone"),
    };
    if let Some(why) = refused {
        return output.report_if_whole(DiagnosticKind::PlaneNotExact { why }, anchor);
    }
    let [x_mm, y_mm, _] = state.position_mm;
    let (sin, cos) = sin_cos(angle_deg.unwrap_or(0.0));
    state.frame.turned_anew = true;
    state.frame.rotation = Some(Rotation { centre_mm: state.target_xy_mm([x_mm, y_mm], words_mm), sin, cos });
}

/// Whether the block asks for what G16 and G68 leave open: it is reported.
pub(super) fn leaves_open(state: &State, one_shot: Option<GCode>, output: &mut Output<'_, '_>) -> bool {
    let place = state.block.place_of(b'X').or(state.block.place_of(b'Y'));
    let why = match (one_shot, place) {
        (Some(GCode::WriteOffset | GCode::LocalShift | GCode::SetPosition | GCode::CancelShift), _) => {
            "a shift of the work offset"
        }
        (Some(GCode::Home), Some(_)) => "a way to the reference point over X and Y",
        (None, Some(_)) if state.block.g(GGroup::Frame).is_some() => "a position in machine coordinates",
        _ => return false,
    };
    output.report_if_whole(DiagnosticKind::PlaneNotExact { why }, place.unwrap_or(state.block.place));
    true
}
