//! Words that a canned cycle stores.

use super::output::Output;
use super::words::{dwell_s, take_idle, take_length_mm};
use crate::control::units::MM_PER_INCH;
use crate::gcode::blocks::Value;
use crate::gcode::dialect::{COMMA_R, COMMA_S, G81, GCode};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{Cycle, Level, State};
use crate::gcode::text::Place;

/// Whether the cycle's holes are drilled, not tapped.
pub(super) fn drills(state: &State, cycle: &Cycle) -> bool {
    cycle.meaning == GCode::Cycle81 && state.dialect.g81 == G81::Drill
}

/// R, Z, P, Q, J and their kin, of a block that stores them.
pub(super) fn store_cycle_words(state: &mut State, cycle: &mut Cycle, output: &mut Output<'_, '_>) {
    let (incremental, unit) = (state.modal.incremental, state.modal.unit);
    let level = |value_mm: f64| Level { value_mm, incremental, unit };
    if let Some(r_mm) = take_length_mm(state, b'R', output) {
        cycle.r = Some(level(r_mm));
    }
    // None if Z is of an earlier block.
    cycle.bottom_place = state.block.place_of(b'Z');
    if let Some(z_mm) = take_length_mm(state, b'Z', output) {
        cycle.bottom = Some(level(z_mm));
    }
    // A drilling cycle has no dwell and no return speed: the words stay untaken there, and are diagnosed.
    if !drills(state, cycle) {
        store_tap_words(state, cycle, output);
    }
}

fn store_tap_words(state: &mut State, cycle: &mut Cycle, output: &mut Output<'_, '_>) {
    let words = state.dialect.cycle;
    // A Speedio's G84 and G74 have their pitch by F, and no pecks; I, J, L and Q are those of G77 and G78.
    let by_feed = words.pitch_words && !matches!(cycle.meaning, GCode::Tap { rigid: true, .. });
    if by_feed {
        (cycle.pitch_mm, cycle.return_speed, cycle.peck_mm) = (None, None, None);
    }
    if let Some(unit) = words.dwell
        && let Some(value) = state.block.take(b'P')
        && let Some(dwell_s) = dwell_s(value, unit, output)
    {
        cycle.dwell_s = dwell_s;
        state.kept_dwell_s = dwell_s;
    } else if state.dialect.rules.dwell_is_kept {
        cycle.dwell_s = state.kept_dwell_s;
    }
    if by_feed {
        return;
    }
    if words.peck.is_some()
        && let Some(place) = state.block.place_of(b'Q')
        && let Some(peck_mm) = take_length_mm(state, b'Q', output)
    {
        if let Some(says) = words.peck_from_memory {
            output.report(DiagnosticKind::RuleFromMemory { says }, place);
        }
        if peck_mm < 0.0 {
            output.report(DiagnosticKind::PeckNegative { mm: peck_mm }, place);
        }
        // Q0 taps in one stroke.
        cycle.peck_mm = Some(peck_mm).filter(|&mm| mm > 0.0);
    }
    store_pitch_words(state, cycle, output);
    let return_letter = match (words.pitch_words, state.dialect.syntax.comma_words) {
        (true, _) => b'L',
        (_, true) => COMMA_S,
        _ => b'J',
    };
    if words.return_speed.is_some()
        && let Some(Value { number, place }) = state.block.take(return_letter)
    {
        if let Some(says) = words.return_from_memory {
            output.report(DiagnosticKind::RuleFromMemory { says }, place);
        }
        if number.value <= 0.0 {
            output.report(DiagnosticKind::ReturnSpeedNotPositive { value: number.value }, place);
        }
        cycle.return_speed = Some(number.value).filter(|&value| value > 0.0);
    }
}

/// I, J or E as a pitch, `,R`, and what changes no hole.
fn store_pitch_words(state: &mut State, cycle: &mut Cycle, output: &mut Output<'_, '_>) {
    if state.dialect.cycle.pitch_words {
        let pitch_place = state.block.place_of(b'I');
        let pitch_mm = take_length_mm(state, b'I', output);
        let threads = state.block.take(b'J');
        if let (Some(_), Some(Value { place, .. })) = (pitch_mm, threads) {
            // One of them is taken, so that no pitch is missed, too.
            set_pitch(cycle, pitch_mm.zip(pitch_place), None, output);
            return output.report(DiagnosticKind::PitchTwice { letters: "I and J" }, place);
        }
        set_pitch(cycle, pitch_mm.zip(pitch_place), threads, output);
    }
    if state.dialect.syntax.comma_words {
        let threads = state.block.take(b'E');
        set_pitch(cycle, None, threads, output);
        if let Some(Value { number, place }) = state.block.take(COMMA_R) {
            cycle.synchronous = number.value == 1.0;
            if !cycle.synchronous {
                output.report(DiagnosticKind::NotSynchronous, place);
            }
        }
    }
    // The speed at which a Haas throws off chips after the hole.
    if state.dialect.name == "haas" {
        take_idle(state, b'E', output);
    }
}

/// A pitch in mm, or threads per inch.
fn set_pitch(cycle: &mut Cycle, pitch: Option<(f64, Place)>, threads: Option<Value>, output: &mut Output<'_, '_>) {
    let by_threads = threads.map(|Value { number, place }| (MM_PER_INCH / number.value, place));
    let Some((pitch_mm, place)) = pitch.or(by_threads) else { return };
    if pitch_mm > 0.0 && pitch_mm.is_finite() {
        cycle.pitch_mm = Some(pitch_mm);
    } else {
        output.report(DiagnosticKind::PitchNotUsable { value: pitch_mm }, place);
        cycle.broken = true;
    }
}
