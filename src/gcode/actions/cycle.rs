//! Blocks under a canned cycle: what they store, and the holes they make.

use super::cycle_words::{drills, store_cycle_words};
use super::output::Output;
use super::plane::take_xy;
use super::spindle::turn_for_cut;
use super::words::{check_pitch, feed_mm_per_s, pitch_mm, settle_xy};
use crate::control::cycle::{Hand, TapCycle};
use crate::gcode::blocks::Value;
use crate::gcode::command::CommandKind;
use crate::gcode::dialect::{CodeAlone, GCode, GGroup, ReturnSpeed, ZeroRepeats};
use crate::gcode::messages::{DiagnosticKind, FeedUse};
use crate::gcode::state::{Cycle, Level, ReturnTo, State};
use crate::gcode::text::Place;

/// Most repeats of one block, the largest a Fanuc control takes. It also bounds what few bytes can ask for.
const MAX_REPEATS: u32 = 9999;

/// What every repeat of a block shares.
#[derive(Clone, Copy, Debug)]
struct Levels {
    r_plane_mm: f64,
    bottom_mm: f64,
    return_mm: f64,
}

/// How the tap turns.
#[derive(Clone, Copy, Debug)]
struct Thread {
    hand: Hand,
    speed_rpm: f64,
    out_speed_rpm: f64,
    pitch_mm: f64,
}

/// A block under a hole cycle, after its modes, F and S are in force.
///
/// 1. Whether it makes holes, only stores or does neither is by the dialect's [`CycleRules`](crate::gcode::CycleRules).
/// 2. R, Z, P, Q and J are stored; G91 counts R from the initial level and Z from the R plane.
/// 3. K or L repeats: under G91 each repeat steps on by X and Y.
/// 4. The return level is R under G99, under G98 the initial level or R if that is higher.
pub(crate) fn cycle_block(state: &mut State, cycle: &mut Cycle, output: &mut Output<'_, '_>) {
    let named = state.block.g(GGroup::Cycle).filter(|code| code.meaning.is_hole_cycle());
    let anchor = named.map_or(state.block.place, |code| code.place);
    let rules = state.dialect.rules;
    let has_word = state.block.has(b'X') || rules.hole_words.iter().any(|&letter| state.block.has(letter));
    let makes_holes = has_word || (named.is_some() && rules.code_alone == CodeAlone::Hole);
    if let Some(code) = named {
        cycle.broken = false;
        if !has_word && rules.code_alone == CodeAlone::Error {
            cycle.broken = true;
            return output.report_if_whole(DiagnosticKind::CycleAlone { name: code.name }, code.place);
        }
    }
    cycle.makes_holes = makes_holes;
    let has_axis = state.block.has(b'X') || state.block.has(b'Y') || state.block.has(b'Z');
    if !has_axis && rules.hole_words.contains(&b'R') && !state.dialect.from_memory {
        tell_of_memory(state, makes_holes, named.is_some(), anchor, output);
    }
    if makes_holes || rules.stores_without_hole {
        store_cycle_words(state, cycle, output);
    }
    if !makes_holes {
        return;
    }
    let xy_place = state.block.place_of(b'X').or(state.block.place_of(b'Y'));
    let [x, y] = take_xy(state, output);
    settle_xy(state, [x.is_some(), y.is_some()], anchor, output);
    let Some(repeats) = take_repeats(state, output) else {
        cycle.broken = true;
        return;
    };
    if repeats == 0 {
        if rules.zero_repeats == ZeroRepeats::StoresAlone && !state.dialect.from_memory {
            output.report(DiagnosticKind::RuleFromMemory { says: "K0 stores the cycle's data" }, anchor);
        }
        let [x_mm, y_mm, z_mm] = state.position_mm;
        let [to_x_mm, to_y_mm] = state.target_xy_mm([x_mm, y_mm], [x, y]);
        let to_mm = [to_x_mm, to_y_mm, z_mm];
        match (rules.zero_repeats, xy_place) {
            (ZeroRepeats::Moves, Some(_)) => {
                output.emit(CommandKind::Rapid { to_mm });
                state.position_mm = to_mm;
            }
            (ZeroRepeats::StoresAlone, Some(_)) => {
                state.unsure_xy = [to_mm[0] != x_mm, to_mm[1] != y_mm];
            }
            _ => {}
        }
        return;
    }
    if cycle.broken {
        return;
    }
    if repeats > 1 && !(state.modal.incremental && (x.unwrap_or(0.0) != 0.0 || y.unwrap_or(0.0) != 0.0)) {
        output.report(DiagnosticKind::SameHoleAgain { times: repeats }, anchor);
    }
    let from_memory = state.dialect.from_memory && !std::mem::replace(&mut state.reported.from_memory, true);
    if from_memory {
        output.report(DiagnosticKind::DialectFromMemory { name: state.dialect.name }, anchor);
    }
    if drills(state, cycle) {
        turn_for_cut(state, output);
    }
    let [start_x_mm, start_y_mm, _] = state.position_mm;
    // From the start, not from the hole before: rounding must not add up.
    let times = |index: u32| if state.modal.incremental { f64::from(index) } else { 1.0 };
    let at = |index: u32| {
        let words_mm = [x, y].map(|word_mm| word_mm.map(|word_mm| times(index) * word_mm));
        state.target_xy_mm([start_x_mm, start_y_mm], words_mm)
    };
    let holes = (1..=repeats).map(at);
    let [end_x_mm, end_y_mm] = at(repeats);
    // Both are asked for before the first one that is missing ends it.
    let levels = levels(state, cycle, anchor, output);
    let made = if drills(state, cycle) {
        feed_mm_per_s(state, anchor, output).zip(levels).map(|(feed_mm_per_s, levels)| {
            drill(state, holes, feed_mm_per_s, levels, output);
            levels
        })
    } else {
        let thread = thread(state, cycle, named.is_some(), anchor, output);
        thread.zip(levels).map(|(thread, levels)| {
            holes.for_each(|hole| output.emit(tap(state, cycle, hole, thread, levels)));
            levels
        })
    };
    if let Some((.., pitch_mm)) = cycle.before.filter(|_| made.is_some()) {
        check_pitch(state, pitch_mm, anchor, output);
    }
    match made {
        Some(levels) => state.position_mm = [end_x_mm, end_y_mm, levels.return_mm],
        None => cycle.broken = true,
    }
}

/// Under a cycle, a block without X, Y and Z: what it makes is known from memory alone.
fn tell_of_memory(state: &State, makes_hole: bool, named: bool, anchor: Place, output: &mut Output<'_, '_>) {
    let place = state.block.place_of(b'R').unwrap_or(anchor);
    match (makes_hole, named) {
        (true, _) => {
            output.report(DiagnosticKind::RuleFromMemory { says: "R alone makes a hole under a cycle" }, place);
        }
        (false, true) => {
            output.report(
                DiagnosticKind::RuleFromMemory { says: "a cycle's code without X, Y, Z or R only stores" },
                place,
            );
        }
        (false, false) => {}
    }
}

/// K or L, 1 if there is neither; none after a mistake.
fn take_repeats(state: &mut State, output: &mut Output<'_, '_>) -> Option<u32> {
    let mut found = None;
    for &letter in state.dialect.cycle.repeats {
        let Some(value) = state.block.take(letter) else { continue };
        if found.is_some() {
            output.report(DiagnosticKind::TwoRepeatWords, value.place);
            return None;
        }
        found = Some(value);
    }
    let Some(Value { number, place }) = found else { return Some(1) };
    let repeats = number.value;
    if repeats < 0.0
        || repeats.fract() != 0.0
        || (repeats == 0.0 && state.dialect.rules.zero_repeats == ZeroRepeats::Error)
    {
        output.report(DiagnosticKind::BadRepeats { repeats }, place);
        None
    } else if repeats > f64::from(MAX_REPEATS) {
        output.report(DiagnosticKind::TooManyRepeats { repeats, limit: MAX_REPEATS }, place);
        None
    } else {
        Some(repeats as u32)
    }
}

/// The cycle's levels; none after a mistake.
fn levels(state: &State, cycle: &Cycle, anchor: Place, output: &mut Output<'_, '_>) -> Option<Levels> {
    let r = output.require(cycle.r, DiagnosticKind::CycleWordMissing { name: cycle.name, letter: b'R' }, anchor);
    let bottom =
        output.require(cycle.bottom, DiagnosticKind::CycleWordMissing { name: cycle.name, letter: b'Z' }, anchor);
    let (r, bottom) = (r?, bottom?);
    if r.unit != state.modal.unit || bottom.unit != state.modal.unit {
        output.report(DiagnosticKind::CycleUnitChanged { name: cycle.name }, anchor);
        return None;
    }
    let follows = state.dialect.rules.levels_follow_distance_mode;
    let is_distance = |level: Level| if follows { state.modal.incremental } else { level.incremental };
    let zero_mm = state.zero_mm(2);
    let initial_mm = cycle.initial_mm + if state.dialect.rules.initial_level_follows_offset { zero_mm } else { 0.0 };
    let r_plane_mm = r.resolve_mm(is_distance(r), zero_mm, initial_mm);
    let bottom_mm = bottom.resolve_mm(is_distance(bottom), zero_mm, r_plane_mm);
    if bottom_mm >= r_plane_mm {
        let incremental = state.modal.incremental;
        let place = cycle.bottom_place.unwrap_or(anchor);
        output.report(DiagnosticKind::BottomNotBelowR { bottom_mm, r_plane_mm, incremental }, place);
        return None;
    }
    let return_mm = match state.modal.return_to {
        ReturnTo::Initial => initial_mm.max(r_plane_mm),
        ReturnTo::R => r_plane_mm,
    };
    Some(Levels { r_plane_mm, bottom_mm, return_mm })
}

/// What S, F, J, the code and M03 or M04 make of it; none after a mistake.
fn thread(state: &State, cycle: &mut Cycle, named: bool, anchor: Place, output: &mut Output<'_, '_>) -> Option<Thread> {
    // All three are asked for before the first one that is missing ends it.
    let hand = hand(state, cycle, named, anchor, output);
    let speed_rpm = output.require(state.modal.turning_rpm(), DiagnosticKind::TapWithoutSpeed, anchor);
    let feed_is_pitch = state.dialect.cycle.feed_is_pitch && is_rigid(state, cycle);
    let pitch_mm = match cycle.pitch_mm {
        Some(pitch_mm) => Some(pitch_mm),
        None if feed_is_pitch => {
            let missing = DiagnosticKind::FeedMissing { needed_for: FeedUse::Pitch };
            output.require(state.modal.feed_mm, missing, anchor)
        }
        None => pitch_mm(state, speed_rpm, anchor, output),
    };
    let (hand, speed_rpm, pitch_mm) = (hand?, speed_rpm?, pitch_mm?);
    let feed_mm = if cycle.pitch_mm.is_some() { pitch_mm } else { state.modal.feed_mm? };
    if let Some((feed_before_mm, _, from_mm)) = cycle.before.filter(|before| before.1 != speed_rpm)
        && feed_before_mm == feed_mm
        && pitch_mm != from_mm
    {
        output.report(DiagnosticKind::PitchChanged { from_mm, to_mm: pitch_mm }, anchor);
    }
    cycle.before = Some((feed_mm, speed_rpm, pitch_mm));
    let out_speed_rpm = match (state.dialect.cycle.return_speed, cycle.return_speed) {
        (Some(ReturnSpeed::Rpm), Some(rpm)) => rpm,
        (Some(ReturnSpeed::Factor), Some(factor)) => factor * speed_rpm,
        _ => speed_rpm,
    };
    Some(Thread { hand, speed_rpm, out_speed_rpm, pitch_mm })
}

/// Whether the cycle is synchronous by its code, by M29 or by `,R1`.
fn is_rigid(state: &State, cycle: &Cycle) -> bool {
    matches!(cycle.meaning, GCode::Tap { rigid: true, .. }) || state.modal.rigid || cycle.synchronous
}

/// The thread's hand: of the code, where that has one, else of the spindle. Both must agree.
fn hand(state: &State, cycle: &mut Cycle, named: bool, anchor: Place, output: &mut Output<'_, '_>) -> Option<Hand> {
    let GCode::Tap { hand, .. } = cycle.meaning else {
        return output.require(state.modal.hand, DiagnosticKind::TapWithoutSpindle, anchor);
    };
    if named && !is_rigid(state, cycle) {
        let by = match (state.dialect.syntax.comma_words, state.dialect.cycle.pitch_words) {
            (true, _) => ",R1",
            (_, true) => "G77 or G78",
            _ => "M29",
        };
        output.report_if_whole(DiagnosticKind::NotRigid { name: cycle.name, by }, anchor);
    }
    let turns_itself = state.dialect.rules.turns_itself && is_rigid(state, cycle);
    match state.modal.hand {
        Some(spindle) if spindle != hand && turns_itself => {
            if named || cycle.hand_told != Some(spindle) {
                output.report(DiagnosticKind::HandReplaced { name: cycle.name, hand }, anchor);
            }
            cycle.hand_told = Some(spindle);
            Some(hand)
        }
        Some(spindle) if spindle != hand => {
            output.report(DiagnosticKind::HandAgainstSpindle { name: cycle.name, hand }, anchor);
            None
        }
        None if state.dialect.cycle.needs_spindle => output.require(None, DiagnosticKind::TapWithoutSpindle, anchor),
        _ => Some(hand),
    }
}

fn tap(state: &State, cycle: &Cycle, [x_mm, y_mm]: [f64; 2], thread: Thread, levels: Levels) -> CommandKind {
    CommandKind::Tap(TapCycle {
        x_mm,
        y_mm,
        r_plane_mm: levels.r_plane_mm,
        bottom_mm: levels.bottom_mm,
        return_mm: levels.return_mm,
        pitch_mm: thread.pitch_mm,
        speed_rpm: thread.speed_rpm,
        out_speed_rpm: thread.out_speed_rpm,
        hand: thread.hand,
        start_angle_rev: state.start_angle_rev(None),
        dwell_s: cycle.dwell_s,
        peck_mm: cycle.peck_mm,
        retract: cycle.peck_mm.and(state.dialect.cycle.peck),
        tool: state.modal.tool.in_spindle(),
    })
}

/// Drills the holes, as RS274 has it:
///
/// 1. if Z is below R, rapid to R; rapid in X and Y at that height
/// 2. rapid to R
/// 3. feed to the bottom
/// 4. rapid to the return level
fn drill(
    state: &State,
    holes: impl Iterator<Item = [f64; 2]>,
    feed_mm_per_s: f64,
    levels: Levels,
    output: &mut Output<'_, '_>,
) {
    let mut from = state.position_mm;
    for [x_mm, y_mm] in holes {
        let height_mm = from[2].max(levels.r_plane_mm);
        if height_mm > from[2] {
            output.emit(CommandKind::Rapid { to_mm: [from[0], from[1], height_mm] });
        }
        output.emit(CommandKind::Rapid { to_mm: [x_mm, y_mm, height_mm] });
        output.emit(CommandKind::Rapid { to_mm: [x_mm, y_mm, levels.r_plane_mm] });
        output.emit(CommandKind::Feed { to_mm: [x_mm, y_mm, levels.bottom_mm], feed_mm_per_s });
        from = [x_mm, y_mm, levels.return_mm];
        output.emit(CommandKind::Rapid { to_mm: from });
    }
}
