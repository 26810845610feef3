//! Synchronous strokes that are no canned cycle: G33.1, G331 with G332, CYCLE84.

use crate::control::cycle::{Hand, Retract, TapCycle};
use crate::control::thread::StandardThread;

use super::block::Value;
use super::command::CommandKind;
use super::dialect::{CodeName, GGroup, PECK_BACK_MM};
use super::messages::DiagnosticKind;
use super::number;
use super::output::Output;
use super::span::Place;
use super::state::State;

/// Which strokes a block makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StrokeKind {
    /// In and out again.
    Pair,
    In,
    Out,
}

impl StrokeKind {
    const fn name(self) -> CodeName {
        let tenths = match self {
            Self::Pair => 331,
            Self::In => 3310,
            Self::Out => 3320,
        };
        CodeName { letter: b'G', tenths }
    }
}

/// G331, before its G332.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StrokeIn {
    start_mm: f64,
    bottom_mm: f64,
    pitch_mm: f64,
    hand: Hand,
    speed_rpm: f64,
}

/// A hole that MCALL repeats at every position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ModalHole(TapCycle);

impl State {
    /// A block under G33.1, G331 or G332:
    ///
    /// 1. Z is the stroke's end, K the pitch of this block; G332 keeps that of its G331.
    /// 2. G33.1 has the hand of the spindle, and comes out I times as fast as in. The R plane is where Z stands.
    /// 3. G331 has the hand of its pitch's sign; G332 ends where G331 began, or higher.
    pub(crate) fn stroke(&mut self, kind: StrokeKind, output: &mut Output<'_, '_>) {
        let anchor = self.block.g(GGroup::Motion).map_or(self.block.place, |code| code.place);
        let axes = [b'X', b'Y', b'Z'].map(|letter| self.block.place_of(letter));
        if axes.iter().all(Option::is_none) && self.block.g(GGroup::Motion).is_none() {
            return;
        }
        let [x_mm, y_mm, from_mm] = self.position_mm;
        let words = self.take_axes(output);
        let [to_x_mm, to_y_mm, to_mm] = [0, 1, 2].map(|axis: usize| {
            let from_mm = self.position_mm.get(axis).copied().unwrap_or_default();
            self.target_mm(axis, from_mm, words.get(axis).copied().flatten())
        });
        if let [Some(place), ..] | [_, Some(place), _] = axes
            && (to_x_mm, to_y_mm) != (x_mm, y_mm)
        {
            output.report(DiagnosticKind::StrokeNotAlongZ, place);
        }
        let pitch_place = self.block.place_of(b'K');
        let pitch_mm = self.take_length_mm(b'K', output);
        match kind {
            StrokeKind::Pair => self.pair([from_mm, to_mm], pitch_mm.zip(pitch_place), anchor, output),
            StrokeKind::In => self.stroke_in([from_mm, to_mm], pitch_mm.zip(pitch_place), anchor, output),
            StrokeKind::Out => self.stroke_out(to_mm, pitch_mm.zip(pitch_place), anchor, output),
        }
    }

    /// The pitch of a stroke, or the report that it is missing or useless.
    fn stroke_pitch(
        kind: StrokeKind,
        pitch: Option<(f64, Place)>,
        anchor: Place,
        output: &mut Output<'_, '_>,
    ) -> Option<f64> {
        let (value, place) = output.require(pitch, DiagnosticKind::PitchMissing { name: kind.name() }, anchor)?;
        let usable = value > 0.0 || (kind != StrokeKind::Pair && value < 0.0);
        if !usable {
            output.report(DiagnosticKind::PitchNotUsable { value }, place);
        }
        usable.then_some(value)
    }

    fn pair(
        &mut self,
        [from_mm, to_mm]: [f64; 2],
        pitch: Option<(f64, Place)>,
        anchor: Place,
        output: &mut Output<'_, '_>,
    ) {
        let factor = self.block.take(b'I').map_or(1.0, |Value { number, place }| {
            if number.value <= 0.0 {
                output.report(DiagnosticKind::ReturnSpeedNotPositive { value: number.value }, place);
            }
            number.value
        });
        let hand = output.require(self.modal.hand, DiagnosticKind::TapWithoutSpindle, anchor);
        let speed_rpm = output.require(self.modal.turning_rpm(), DiagnosticKind::TapWithoutSpeed, anchor);
        let pitch_mm = Self::stroke_pitch(StrokeKind::Pair, pitch, anchor, output);
        let (Some(hand), Some(speed_rpm), Some(pitch_mm)) = (hand, speed_rpm, pitch_mm) else { return };
        if to_mm >= from_mm {
            return output.report(DiagnosticKind::StrokeNotDown { from_mm, to_mm }, anchor);
        }
        self.check_pitch(pitch_mm, anchor, output);
        let [x_mm, y_mm, _] = self.position_mm;
        let hole = TapCycle { x_mm, y_mm, hand, ..TapCycle::right_hand(from_mm, to_mm, pitch_mm, speed_rpm) };
        output.emit(CommandKind::Tap(TapCycle { out_speed_rpm: factor * speed_rpm, ..hole }));
    }

    fn stroke_in(
        &mut self,
        [start_mm, bottom_mm]: [f64; 2],
        pitch: Option<(f64, Place)>,
        anchor: Place,
        output: &mut Output<'_, '_>,
    ) {
        self.forget_stroke_in(output);
        let pitch_mm = Self::stroke_pitch(StrokeKind::In, pitch, anchor, output);
        let speed_rpm = output.require(self.modal.turning_rpm(), DiagnosticKind::TapWithoutSpeed, anchor);
        if bottom_mm >= start_mm {
            output.report(DiagnosticKind::StrokeNotDown { from_mm: start_mm, to_mm: bottom_mm }, anchor);
        }
        self.position_mm[2] = bottom_mm;
        // After a mistake something has to wait for G332 all the same: it is not to be reported, too.
        let pitch_mm = pitch_mm.unwrap_or(1.0);
        let hand = if pitch_mm < 0.0 { Hand::Left } else { Hand::Right };
        let speed_rpm = speed_rpm.unwrap_or(1.0);
        self.stroke_in = Some(StrokeIn { start_mm, bottom_mm, pitch_mm: pitch_mm.abs(), hand, speed_rpm });
    }

    fn stroke_out(&mut self, end_mm: f64, pitch: Option<(f64, Place)>, anchor: Place, output: &mut Output<'_, '_>) {
        let Some(into) = self.stroke_in.take() else {
            return output.report_if_whole(DiagnosticKind::StrokeOutAlone, anchor);
        };
        self.position_mm[2] = end_mm;
        let StrokeIn { start_mm, bottom_mm, pitch_mm: in_mm, hand, speed_rpm } = into;
        let written =
            pitch.map_or(Some(in_mm * hand.sign()), |_| Self::stroke_pitch(StrokeKind::Out, pitch, anchor, output));
        let Some(out_mm) = written else { return };
        if out_mm != in_mm * hand.sign() {
            let in_mm = in_mm * hand.sign();
            return output.report(DiagnosticKind::StrokePitchDiffers { in_mm, out_mm }, anchor);
        }
        if end_mm < start_mm {
            return output.report(DiagnosticKind::StrokeOutTooShort { start_mm, end_mm }, anchor);
        }
        self.check_pitch(in_mm, anchor, output);
        let [x_mm, y_mm, _] = self.position_mm;
        output.emit(CommandKind::Tap(TapCycle {
            x_mm,
            y_mm,
            hand,
            return_mm: end_mm,
            out_speed_rpm: self.modal.turning_rpm().unwrap_or(speed_rpm),
            ..TapCycle::right_hand(start_mm, bottom_mm, in_mm, speed_rpm)
        }));
    }

    /// A stroke in that nothing followed is an error, once.
    pub(crate) fn forget_stroke_in(&mut self, output: &mut Output<'_, '_>) {
        if self.stroke_in.take().is_some() {
            output.report_if_whole(DiagnosticKind::StrokeInAlone, self.block.place);
        }
    }

    /// What the block calls by name, and the hole that MCALL makes at every position.
    pub(crate) fn called_hole(&mut self, output: &mut Output<'_, '_>) {
        let Some((name, parameters)) = self.block.call else {
            let moved = self.block.moved_xy;
            if let Some(ModalHole(hole)) = self.modal_hole.filter(|_| moved) {
                self.tap_here(hole, output);
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
            (true, self.block.second_call)
        } else {
            (false, Some((name, parameters)))
        };
        let Some((name, parameters)) = cycle else {
            self.modal_hole = None;
            return;
        };
        if !name.text(text).eq_ignore_ascii_case(b"CYCLE84") {
            return output.report(DiagnosticKind::UnknownCall, name);
        }
        let Some(parameters) = parameters else {
            return output.report(DiagnosticKind::CallParametersMissing, name);
        };
        let hole = self.cycle84(parameters, output);
        match hole {
            Some(hole) if modal => self.modal_hole = Some(ModalHole(hole)),
            Some(hole) => self.tap_here(hole, output),
            None => {}
        }
    }

    fn tap_here(&mut self, hole: TapCycle, output: &mut Output<'_, '_>) {
        self.check_pitch(hole.pitch_mm, self.block.place, output);
        let [x_mm, y_mm, _] = self.position_mm;
        output.emit(CommandKind::Tap(TapCycle { x_mm, y_mm, ..hole }));
        self.position_mm[2] = hole.return_mm;
    }

    /// CYCLE84's parameters, in the order of the manual:
    /// RTP retraction plane, RFP reference plane, SDIS safety distance, DP depth, DPR depth from RFP, DTB dwell in s,
    /// SDAC spindle after the cycle, MPIT size M3 … M48, PIT pitch (negative is left-hand), POSS spindle angle,
    /// SST speed in, SST1 speed out, AXN axis, PITA unit of PIT, TECHNO, VARI 0 one stroke, 1 chip break, 2 full
    /// retract, DAM peck, VRT distance back.
    fn cycle84(&mut self, parameters: Place, output: &mut Output<'_, '_>) -> Option<TapCycle> {
        let values = read_parameters(parameters, output)?;
        let value = |number: usize| values.get(number - 1).copied().flatten();
        let mm = self.modal.unit.mm();
        let mut need = |number: usize, name: &'static str, found: Option<f64>| {
            if found.is_none() {
                output.report(DiagnosticKind::CallParameterBad { number, name }, parameters);
            }
            found
        };
        let reference_mm = need(2, "RFP", value(2))? * mm;
        let return_mm = need(1, "RTP", value(1))? * mm;
        let r_plane_mm = reference_mm + value(3).unwrap_or(0.0).abs() * mm;
        let depth_mm =
            value(4).map(|depth| depth * mm).or_else(|| value(5).map(|depth| reference_mm - depth.abs() * mm));
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
        let speed_rpm = need(11, "SST", value(11).or(self.modal.turning_rpm()).filter(|&rpm| rpm > 0.0))?;
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
        let zero_mm = self.frame.zero_mm(self.modal.work_offset, 2);
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
