//! CYCLE84 with its 24 parameters: each acts, is refused with its number, or is reported as changing nothing.
//!
//! SINUMERIK 840D sl / 828D, Programming Manual, "Programming cycles externally", tapping without compensating chuck. The
//! first thirteen: SINUMERIK 840D/840Di/810D, Programming Guide Cycles 11.02, CYCLE84. 14 to 24 as the Autodesk post for
//! the SINUMERIK 840D writes and explains them (2022). In the order of the manual:
//!
//! 1. RTP retraction plane, 2. RFP reference plane, 3. SDIS safety distance, 4. DP depth, 5. DPR depth from RFP (it holds
//!    where both are given), 6. DTB dwell, 7. SDAC spindle after the cycle (3, 4, 5), 8. MPIT size M3 to M48, 9. PIT
//!    pitch, 10. POSS spindle angle, 11. SST speed in, 12. SST1 speed out, 13. AXN axis
//! 2. 14\. PITA unit of PIT (0 as in force, 1 mm, 2 threads per inch, 3 inch), 15. TECHNO, 16. VARI (0 one stroke, 1 chip
//!    break, 2 full retract), 17. DAM peck, 18. VRT distance back, 19. to 21. texts of the screen, 22. GMODE, 23. DMODE
//!    plane, 24. AMODE: from the right depth (1 from RFP, 2 absolute), dwell (1 seconds, 2 revolutions), reserved, hand (1
//!    right, 2 left; 0 by the sign of the pitch)

use super::output::Output;
use super::parameters::{Parameters, read_parameters};
use crate::control::cycle::{Hand, Retract, TapCycle};
use crate::control::units::MM_PER_INCH;
use crate::gcode::dialect::PECK_BACK_MM;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{LengthUnit, ModalHole, State};
use crate::gcode::text::Place;

/// Coarse pitches of ISO 261 by the size that MPIT names.
#[rustfmt::skip]
const SIZES: [(f64, f64); 23] = [
    (3.0, 0.5), (3.5, 0.6), (4.0, 0.7), (5.0, 0.8), (6.0, 1.0), (7.0, 1.0), (8.0, 1.25), (10.0, 1.5), (12.0, 1.75),
    (14.0, 2.0), (16.0, 2.0), (18.0, 2.5), (20.0, 2.5), (22.0, 2.5), (24.0, 3.0), (27.0, 3.0), (30.0, 3.5), (33.0, 3.5),
    (36.0, 4.0), (39.0, 4.0), (42.0, 4.5), (45.0, 4.5), (48.0, 5.0),
];
const S_PER_MIN: f64 = 60.0;

/// A digit of a parameter, from the right.
fn digit(value: f64, place: i32) -> u32 {
    (value / 10_f64.powi(place)) as u32 % 10
}

/// What is being read, and where complaints about it go.
struct Call<'a, 'o, 'b> {
    values: Parameters,
    place: Place,
    output: &'a mut Output<'o, 'b>,
}

impl Call<'_, '_, '_> {
    fn bad<T>(&mut self, number: usize, name: &'static str) -> Option<T> {
        self.output.report(DiagnosticKind::CallParameterBad { number, name }, self.place);
        None
    }

    fn need<T>(&mut self, number: usize, name: &'static str, found: Option<T>) -> Option<T> {
        if found.is_none() { self.bad(number, name) } else { found }
    }

    /// A parameter that is given and changes nothing.
    fn idle(&mut self, number: usize, name: &'static str) {
        self.output.report(DiagnosticKind::CallParameterIdle { number, name }, self.place);
    }

    /// A number that is not zero.
    fn given(&self, number: usize) -> Option<f64> {
        self.values.number(number).filter(|&value| value != 0.0)
    }
}

/// The hole that the call describes, its levels from the zero in force; none after a mistake.
pub(super) fn cycle84(state: &State, parameters: Place, output: &mut Output<'_, '_>) -> Option<ModalHole> {
    let values = read_parameters(state, parameters, output)?;
    let mut call = Call { values, place: parameters, output };
    if let Some(number) = (1..=18).find(|&number| values.is_text(number)) {
        return call.bad(number, "which is a number");
    }
    let unit = state.modal.unit;
    let mm = unit.mm();
    let mode = call.values.number(24).unwrap_or(0.0);
    let whole = mode >= 0.0 && mode.fract() == 0.0 && mode < 1e7;
    // The digits without a meaning known here are zero, and the seventh is 0 or 1, in what post processors write.
    let known = whole && [2, 4, 5].iter().all(|&place| digit(mode, place) == 0) && digit(mode, 6) <= 1;
    call.need(24, "AMODE", Some(()).filter(|()| known && [0, 1, 3].iter().all(|&place| digit(mode, place) <= 2)))?;

    let (r_plane, bottom, back_to) = levels(&mut call, mode)?;
    let (pitch_mm, hand) = pitch(&mut call, mode, unit)?;
    let speed_rpm = call.given(11);
    call.need(11, "SST", Some(()).filter(|()| speed_rpm.is_none_or(|rpm| rpm > 0.0)))?;
    let out_rpm = call.given(12);
    call.need(12, "SST1", Some(()).filter(|()| out_rpm.is_none_or(|rpm| rpm > 0.0)))?;
    let in_force = speed_rpm.or(state.modal.turning_rpm());
    let in_rpm = call.need(11, "SST", in_force)?;
    let dwell_s = dwell(&mut call, mode, in_rpm)?;
    let hand_after = match call.values.number(7) {
        None => None,
        Some(3.0) => Some(Hand::Right),
        Some(4.0) => Some(Hand::Left),
        Some(0.0 | 5.0) => None,
        Some(_) => return call.bad(7, "SDAC"),
    };
    let axis = call.values.number(13).unwrap_or(0.0);
    call.need(13, "AXN", Some(()).filter(|()| axis == 0.0 || axis == 3.0))?;
    let plane = call.values.number(23).unwrap_or(0.0);
    call.need(23, "DMODE", Some(()).filter(|()| plane == 0.0 || plane == 1.0))?;
    if call.given(22).is_some() {
        return call.bad(22, "GMODE");
    }
    if call.given(15).is_some() {
        call.idle(15, "TECHNO");
    }
    let (peck_mm, retract) = pecks(&mut call, mm)?;
    let hole = TapCycle {
        hand,
        start_angle_rev: state.start_angle_rev(call.values.number(10)),
        out_speed_rpm: out_rpm.unwrap_or(in_rpm),
        dwell_s,
        peck_mm,
        retract,
        return_mm: back_to * mm,
        ..TapCycle::right_hand(r_plane * mm, bottom * mm, pitch_mm, in_rpm)
    };
    Some(ModalHole { hole, speed_by_s: speed_rpm.is_none(), hand_after, unit })
}

/// R plane, bottom and return, in the unit in force.
fn levels(call: &mut Call<'_, '_, '_>, mode: f64) -> Option<(f64, f64, f64)> {
    let reference = call.need(2, "RFP", call.values.number(2))?;
    let back_to = call.need(1, "RTP", call.values.number(1))?;
    let r_plane = reference + call.values.number(3).unwrap_or(0.0).abs();
    let absolute = call.values.number(4);
    let from_reference = call.given(5).map(|depth| reference - depth.abs());
    let bottom = match digit(mode, 0) {
        1 => call.need(5, "DPR", from_reference)?,
        2 => call.need(4, "DP", absolute)?,
        _ => call.need(4, "DP", from_reference.or(absolute))?,
    };
    if let (Some(absolute), Some(from_reference)) = (absolute, from_reference)
        && (absolute - from_reference).abs() > 1e-6
    {
        let used = if bottom == absolute { "DP" } else { "DPR" };
        call.output.report(DiagnosticKind::DepthTwice { used }, call.place);
    }
    call.need(4, "DP", Some(()).filter(|()| bottom < r_plane))?;
    call.need(1, "RTP", Some(()).filter(|()| back_to >= r_plane))?;
    Some((r_plane, bottom, back_to))
}

/// Pitch and hand.
fn pitch(call: &mut Call<'_, '_, '_>, mode: f64, unit: LengthUnit) -> Option<(f64, Hand)> {
    let by_size = match call.given(8) {
        None => None,
        Some(size) => {
            let found = SIZES.iter().find(|(known, _)| *known == size.abs());
            Some(call.need(8, "MPIT", found.map(|&(_, pitch_mm)| pitch_mm * size.signum()))?)
        }
    };
    let by_value = match (call.given(9), call.values.number(14).unwrap_or(0.0)) {
        (None, _) => None,
        (Some(pitch), 0.0) => Some(pitch * unit.mm()),
        (Some(pitch), 1.0) => Some(pitch),
        (Some(threads), 2.0) => Some(MM_PER_INCH / threads),
        (Some(pitch), 3.0) => Some(pitch * MM_PER_INCH),
        (Some(_), _) => return call.bad(14, "PITA"),
    };
    if let (Some(size), Some(value)) = (by_size, by_value)
        && (size - value).abs() > 1e-6
    {
        return call.bad(9, "PIT, which is not the pitch of MPIT");
    }
    let signed = call.need(9, "PIT", by_size.or(by_value))?;
    let hand = match (digit(mode, 3), signed < 0.0) {
        (0, false) | (1, false) => Hand::Right,
        (0, true) | (2, false) => Hand::Left,
        _ => return call.bad(24, "AMODE, whose hand is against the sign of the pitch"),
    };
    Some((signed.abs(), hand))
}

/// Seconds of the dwell at the bottom.
fn dwell(call: &mut Call<'_, '_, '_>, mode: f64, speed_rpm: f64) -> Option<f64> {
    let dwell = call.values.number(6).unwrap_or(0.0);
    match (digit(mode, 1), dwell < 0.0) {
        (0 | 1, false) => Some(dwell),
        (0, true) | (2, false) => Some(dwell.abs() * S_PER_MIN / speed_rpm),
        _ => call.bad(6, "DTB"),
    }
}

/// Depth of a peck, and what is done after each.
fn pecks(call: &mut Call<'_, '_, '_>, mm: f64) -> Option<(Option<f64>, Option<Retract>)> {
    let (peck, back) = (call.given(17), call.given(18));
    let back_mm = call.need(18, "VRT", Some(back.unwrap_or(0.0)).filter(|&back| back >= 0.0))? * mm;
    let retract = match call.values.number(16).unwrap_or(0.0) {
        0.0 => None,
        1.0 if back_mm > 0.0 => Some(Retract::ChipBreak { back_mm }),
        1.0 => {
            let says = "a chip break with VRT of zero turns back by 1 mm";
            call.output.report(DiagnosticKind::RuleFromMemory { says }, call.place);
            Some(Retract::ChipBreak { back_mm: PECK_BACK_MM })
        }
        2.0 => Some(Retract::Full),
        _ => return call.bad(16, "VARI"),
    };
    if peck.is_some() && retract.is_none() {
        call.idle(17, "DAM");
    }
    if back.is_some() && !matches!(retract, Some(Retract::ChipBreak { .. })) {
        call.idle(18, "VRT");
    }
    match retract {
        None => Some((None, None)),
        Some(_) => {
            let peck_mm = call.need(17, "DAM", peck.filter(|&peck| peck > 0.0))? * mm;
            Some((Some(peck_mm), retract))
        }
    }
}
