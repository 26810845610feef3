//! Modes, feed, and what changes nothing.

use super::offsets::numbered_offset;
use super::output::Output;
use super::plane::set_plane_modes;
use super::spindle::taps;
use super::words::take_idle;
use crate::gcode::blocks::{Code, Value};
use crate::gcode::dialect::{COMMA_I, COMMA_J, CodeName, DecimalPoint, GCode, GGroup, MCode, MGroup, Macros};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::{FeedMode, LengthUnit, ReturnTo, State, ToolLength};
use crate::gcode::text::Place;

/// Groups whose codes act by being in force.
const MODES: [GGroup; 13] = [
    GGroup::Units,
    GGroup::FeedMode,
    GGroup::Distance,
    GGroup::Return,
    GGroup::WorkOffset,
    GGroup::Plane,
    GGroup::Radius,
    GGroup::Length,
    GGroup::Path,
    GGroup::Corner,
    GGroup::SpeedMode,
    GGroup::Polar,
    GGroup::Rotation,
];

/// One bit for each of them.
const MODES_MASK: u32 = {
    let (mut mask, mut index) = (0, 0);
    while index < MODES.len() {
        mask |= 1 << MODES[index] as u32;
        index += 1;
    }
    mask
};

pub(super) fn set_modes(state: &mut State, output: &mut Output<'_, '_>) {
    if !state.block.has_g_of(MODES_MASK) {
        return;
    }
    for group in MODES {
        let Some(code) = state.block.take_g(group) else { continue };
        match code.meaning {
            GCode::Inch => set_unit(state, LengthUnit::Inch),
            GCode::Millimetre => set_unit(state, LengthUnit::Millimetre),
            GCode::FeedPerMinute | GCode::FeedPerRevolution => set_feed_mode(state),
            GCode::Absolute => state.modal.incremental = false,
            GCode::Incremental => state.modal.incremental = true,
            GCode::ReturnInitial => state.modal.return_to = ReturnTo::Initial,
            GCode::ReturnR => state.modal.return_to = ReturnTo::R,
            GCode::WorkOffset(1) if takes_number(state) => {
                if let Some(number) = numbered_offset(state, code.place, output) {
                    set_work_offset(state, number, code, output);
                }
            }
            GCode::WorkOffset(number) => set_work_offset(state, number, code, output),
            GCode::ExtendedOffset => {
                if let Some(number) = numbered_offset(state, code.place, output) {
                    set_work_offset(state, number, code, output);
                }
            }
            GCode::LengthOn => state.modal.tool_length = ToolLength::On,
            GCode::LengthOff if state.modal.tool_length == ToolLength::On => {
                state.modal.tool_length = ToolLength::Ended;
            }
            GCode::Polar | GCode::Cartesian | GCode::Unrotate => set_plane_modes(state, code.meaning),
            // G17, G40, G64, G97 say what always holds here; the rest moves, later.
            _ => {}
        }
    }
}

/// G54 P n is G54.1 P n on a FANUC, where nothing else in the block takes P.
fn takes_number(state: &State) -> bool {
    let block = &state.block;
    block.has(b'P')
        && state.dialect.g_code(CodeName { letter: b'G', tenths: 541 }).is_some()
        && block.g(GGroup::Cycle).is_none()
        && state.cycle.is_none()
        && block.g(GGroup::OneShot).is_none()
        && block.m(MGroup::Flow).is_none()
        && block.idle.is_empty()
}

fn set_work_offset(state: &mut State, number: u8, code: Code<GCode>, output: &mut Output<'_, '_>) {
    if state.modal.work_offset != number && state.frame.rotation.is_some() {
        output.report_if_whole(DiagnosticKind::PlaneNotExact { why: "a change of the work offset" }, code.place);
    }
    if state.modal.work_offset != number && state.frame.same(state.modal.work_offset, number) {
        output.report(DiagnosticKind::SameWorkOffset { name: code.name }, code.place);
    }
    state.modal.work_offset = number;
}

/// A number is another length in another unit: F must be said anew.
fn set_unit(state: &mut State, unit: LengthUnit) {
    if state.modal.unit != unit {
        state.modal.unit = unit;
        if !state.dialect.rules.feed_before_unit {
            state.modal.feed_mm = None;
        }
    }
}

/// G94, G95. A speed is no pitch: F must be said anew when its meaning changes.
pub(super) fn set_feed_mode(state: &mut State) {
    let mode = match state.block.g(GGroup::FeedMode).map(|code| code.meaning) {
        Some(GCode::FeedPerMinute) => FeedMode::PerMinute,
        Some(GCode::FeedPerRevolution) => FeedMode::PerRevolution,
        _ => return,
    };
    if state.modal.feed_mode != mode {
        state.modal.feed_mode = mode;
        state.modal.feed_mm = None;
    }
}

pub(super) fn set_feed(state: &mut State, output: &mut Output<'_, '_>) {
    // F of a pause in seconds (SINUMERIK) is no feed.
    if state.dialect.syntax.calls && state.block.g(GGroup::OneShot).is_some() {
        return;
    }
    let Some(Value { number, place }) = state.block.take(b'F') else { return };
    if state.dialect.cycle.pitch_words || state.dialect.syntax.comma_words {
        check_second_pitch(state, place, output);
    }
    // On a FANUC mm/min alone has the same increment, 1, with and without a point. On a Haas F10 is F0.0100 (Mill
    // Operator's Manual 2017, setting 77 at DEFAULT, p. 385).
    let ambiguous = state.dialect.decimal_point == DecimalPoint::Fanuc
        && !number.has_point
        && !(state.dialect.whole_feed
            && !(state.dialect.cycle.feed_is_pitch && taps(state))
            && (state.modal.feed_mode, state.modal.unit) == (FeedMode::PerMinute, LengthUnit::Millimetre));
    if ambiguous {
        output.report(DiagnosticKind::FeedNeedsPoint, place);
    } else if number.value <= 0.0 {
        output.report(DiagnosticKind::FeedNotPositive { feed: number.value }, place);
    }
    // Also a wrong F is taken: it was given, and reported.
    state.modal.feed_mm = Some(number.value * state.modal.unit.mm());
}

/// F in a block of a cycle whose pitch is by I, J or E.
fn check_second_pitch(state: &State, place: Place, output: &mut Output<'_, '_>) {
    let own = state.dialect.cycle.pitch_words;
    let in_force = state.cycle.as_ref().filter(|_| state.block.g(GGroup::Motion).is_none());
    let meaning = state.block.g(GGroup::Cycle).map(|code| code.meaning).or(in_force.map(|cycle| cycle.meaning()));
    let taps = matches!(meaning, Some(GCode::Tap { rigid, .. }) if rigid || !own);
    let (words, letters): (&[u8], _) = if own { (b"IJ", "F and I or J") } else { (b"E", "F and E") };
    let said = words.iter().any(|&letter| state.block.has(letter));
    if taps && (said || in_force.is_some_and(|cycle| cycle.pitch_mm.is_some())) {
        output.report(DiagnosticKind::PitchTwice { letters }, place);
    }
}

/// M29, and what is known and changes nothing.
pub(super) fn set_idle(state: &mut State, output: &mut Output<'_, '_>) {
    let changes_tool = state.block.has_m() && state.block.m(MGroup::Tool).is_some();
    if state.block.has_m() {
        set_idle_codes(state, output);
    }
    if state.block.g(GGroup::Path).is_some() || state.block.has_idle(&[b'O', b'T', b'H', b'D', COMMA_I, COMMA_J]) {
        set_idle_words(state, output);
    }
    if changes_tool {
        state.modal.tool.change();
    }
}

/// Words and names that change nothing.
fn set_idle_words(state: &mut State, output: &mut Output<'_, '_>) {
    // The number of the program that begins here: whoever calls it finds it by its text.
    let program = state.block.take(b'O');
    if let Some(Value { place, .. }) = program.filter(|program| program.place.start > state.block.place.start) {
        output.report_if_whole(DiagnosticKind::UnusedWord { letter: b'O' }, place);
    }
    // How far a corner may be cut, and how far a line may be off.
    if state.block.g(GGroup::Path).is_some() {
        let _ = (state.block.take(b'P'), state.block.take(b'Q'));
    }
    let cycle = state.block.g(GGroup::Cycle).is_some();
    for index in 0..state.block.idle.len() {
        let Some(code) = state.block.idle.get(index).copied() else { break };
        let GCode::Idle { words } = code.meaning else { continue };
        // In the block of a cycle the words are the cycle's.
        for &letter in words.letters().iter().filter(|_| !cycle) {
            state.block.take(letter);
        }
        if state.reported.first_g(code.name) {
            output.report(DiagnosticKind::IdleCode { name: code.name }, code.place);
        }
    }
    if let Some((index, place)) = state.block.idle_name {
        if state.reported.names >> index & 1 == 0 {
            output.report(DiagnosticKind::IdleName, place);
        }
        state.reported.names |= 1 << index;
    }
    if let Some(place) = state.block.frame_name.filter(|_| state.block.moved) {
        output.report(DiagnosticKind::FrameNotRead, place);
    }
    if let Some(number) = take_idle(state, b'T', output) {
        state.modal.tool.select(number);
    }
    for letter in [b'H', b'D', COMMA_I, COMMA_J] {
        take_idle(state, letter, output);
    }
}

fn set_idle_codes(state: &mut State, output: &mut Output<'_, '_>) {
    state.modal.rigid |= state.block.take_m(MGroup::Rigid).is_some();
    let cycle = state.block.g(GGroup::Cycle).is_some();
    for group in [MGroup::Stop, MGroup::Tool, MGroup::Coolant, MGroup::Orient, MGroup::Panel, MGroup::Device] {
        let idle = state.block.take_m(group).filter(|code| matches!(code.meaning, MCode::Idle(_)));
        // Angle and way of M19; numbers, values and times of outputs and of the panel (LinuxCNC).
        let ngc = state.dialect.syntax.macros == Macros::Ngc;
        let words: &[u8] = match (group, ngc) {
            _ if idle.is_none() => b"",
            (MGroup::Orient, true) => b"RQP",
            (MGroup::Orient, false) => b"RP",
            (MGroup::Panel | MGroup::Device, true) => b"PQLE",
            _ => b"",
        };
        for &letter in words.iter().filter(|_| !cycle) {
            state.block.take(letter);
        }
        if let Some(code) = idle
            && state.first_of_code(code.name)
        {
            output.report(DiagnosticKind::IdleCode { name: code.name }, code.place);
        }
    }
}
