//! Subprograms: M98, M97, G65, M99; of a SINUMERIK by name.
//!
//! 1. M98 P n L k runs program n k times. On a FANUC P of more than four digits holds both, P30001; where a program of
//!    the whole number is in the file, too, it is not known which is meant.
//! 2. M97 P n L k runs the blocks of this program from N n to M99 (Haas).
//! 3. G65 P n L k runs program n with its other words as variables, at a level of its own.
//! 4. L n P k, and NAME P k, run the file of that name k times, to its M17, M02, M30 or RET (SINUMERIK). The call has a
//!    block of its own, and zeros in front count: L10 is not L010 (SINUMERIK 840D sl, Programming Manual Job Planning,
//!    "Subprogram technique").
//!
//! Numbers of five digits: Haas Mill Operator's Manual 2017, 5.10 (O40007 calls M98 P40008). Letters and variables of
//! G65: B-64304EN, "Macro call", argument specification I.

use super::output::Output;
use crate::gcode::blocks::{Flow, ProgramCall, Value};
use crate::gcode::dialect::{CodeName, DecimalPoint, GCode, GGroup, MCode, MGroup, Name};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::state::State;
use crate::gcode::text::Place;

/// Letters of arguments and their variables.
const ARGUMENTS: [(u8, u32); 21] = [
    (b'A', 1),
    (b'B', 2),
    (b'C', 3),
    (b'I', 4),
    (b'J', 5),
    (b'K', 6),
    (b'D', 7),
    (b'E', 8),
    (b'F', 9),
    (b'H', 11),
    (b'M', 13),
    (b'Q', 17),
    (b'R', 18),
    (b'S', 19),
    (b'T', 20),
    (b'U', 21),
    (b'V', 22),
    (b'W', 23),
    (b'X', 24),
    (b'Y', 25),
    (b'Z', 26),
];

/// Most times that one call runs its program.
const MAX_REPEATS: f64 = 9999.0;

/// G65 with all that its block says, before any of it acts.
pub(super) fn macro_call(state: &mut State, output: &mut Output<'_, '_>) -> Option<Flow> {
    let code = state.block.g(GGroup::OneShot).filter(|code| code.meaning == GCode::MacroCall)?;
    state.block.take_g(GGroup::OneShot);
    let program = program(state, code.name, code.place, output);
    let repeats = repeats(state, output);
    let mut arguments = Vec::new();
    for (letter, variable) in ARGUMENTS {
        let Some(Value { number, place }) = state.block.take(letter) else { continue };
        // Without its point the number counts increments of its address, and addresses differ.
        let whole = [b'H', b'M', b'S', b'T'].contains(&letter) || number.value == 0.0;
        if state.dialect.decimal_point == DecimalPoint::Fanuc && !number.has_point && !whole {
            output.report(DiagnosticKind::ArgumentNeedsPoint { letter }, place);
        }
        arguments.push((variable, number.value));
    }
    while let Some((name, place)) = state.block.take_unacted_code() {
        output.report_if_whole(DiagnosticKind::UnusedCode { name }, place);
    }
    while let Some((letter, place)) = state.block.take_leftover() {
        output.report_if_whole(DiagnosticKind::UnusedWord { letter }, place);
    }
    let Some((program, place)) = program else { return Some(Flow::Next) };
    Some(Flow::Call(ProgramCall { program, repeats_in_p: false, repeats, arguments: Some(arguments), place }))
}

/// A SINUMERIK's call by name: what runs next, if the block is one. A cycle's own block is seen to, too.
pub(super) fn named_call(state: &mut State, output: &mut Output<'_, '_>) -> Option<Flow> {
    let text = output.line.text;
    let by_number = state.block.place_of(b'L');
    let by_name = state.block.call.filter(|(name, _)| Name::of(name.text(text)).is_none());
    let of_cycle = state.block.call.filter(|(name, _)| Name::of(name.text(text)).is_some_and(Name::stands_alone));
    let (place, parameters) = match (by_number, by_name, of_cycle) {
        (Some(place), ..) => (place, None),
        (None, Some((place, parameters)), _) => (place, parameters),
        (None, None, Some((place, _))) => {
            if state.block.has_words() {
                output.report_if_whole(DiagnosticKind::CallNotAlone, place);
            }
            let returns = Name::of(place.text(text)) == Some(Name::Return);
            return returns.then_some(Flow::Return);
        }
        (None, None, None) => return None,
    };
    let _ = state.block.take(b'L');
    let written = state.block.take(b'P');
    let runs = written.map_or(1.0, |value| value.number.value);
    if runs.fract() != 0.0 || !(1.0..=MAX_REPEATS).contains(&runs) {
        output.report(DiagnosticKind::CallRepeatsBad { repeats: runs }, written.map_or(place, |value| value.place));
        return Some(Flow::Next);
    }
    let shared = state.block.has_words();
    let refused = match by_number {
        Some(_) if shared || state.block.call.is_some() => Some(DiagnosticKind::CallNotAlone),
        // Parameters are those of a cycle that is not known here, or of a subprogram with variables of its own.
        None if shared || parameters.is_some() || state.block.second_call.is_some() => {
            Some(DiagnosticKind::UnknownCall)
        }
        _ => None,
    };
    if let Some(kind) = refused {
        output.report_if_whole(kind, place);
        return Some(Flow::Next);
    }
    let name = place.text(text).iter().filter(|byte| !byte.is_ascii_whitespace()).copied().collect();
    Some(Flow::CallNamed { name, repeats: runs as u32, place })
}

/// M98, M97, M99.
pub(super) fn next_program(state: &mut State, output: &mut Output<'_, '_>) -> Flow {
    let Some(code) = state.block.take_m(MGroup::Flow) else { return Flow::Next };
    if code.meaning == MCode::Return {
        return Flow::Return;
    }
    let Some((program, place)) = program(state, code.name, code.place, output) else { return Flow::Next };
    let repeats = repeats(state, output);
    if code.meaning == MCode::CallLabel {
        return Flow::CallLabel { label: f64::from(program), repeats: repeats.unwrap_or(1), place };
    }
    let repeats_in_p = state.dialect.repeats_in_p;
    Flow::Call(ProgramCall { program, repeats_in_p, repeats, arguments: None, place })
}

/// P, a whole number.
fn program(state: &mut State, name: CodeName, anchor: Place, output: &mut Output<'_, '_>) -> Option<(u32, Place)> {
    let written = state.block.take(b'P');
    let whole = written.filter(|p| p.number.value.fract() == 0.0 && (1.0..=99_999_999.0).contains(&p.number.value));
    let place = written.map_or(anchor, |value| value.place);
    let found = whole.map(|value| (value.number.value as u32, place));
    output.require(found, DiagnosticKind::CallWithoutProgram { name }, place)
}

/// L, a whole number above zero.
fn repeats(state: &mut State, output: &mut Output<'_, '_>) -> Option<u32> {
    let Value { number, place } = state.block.take(b'L')?;
    if number.value.fract() != 0.0 || !(1.0..=MAX_REPEATS).contains(&number.value) {
        output.report(DiagnosticKind::CallRepeatsBad { repeats: number.value }, place);
        return None;
    }
    Some(number.value as u32)
}
