//! O words: LinuxCNC's subprograms, loops and conditions (LinuxCNC documentation, O Codes).

use std::io::{Read, Seek};

use super::run_state::{Kind, Loop, Running};
use crate::gcode::blocks::{Keyword, Reader, Variable, Variables, o_word};
use crate::gcode::messages::{DiagnosticKind, Fault};
use crate::gcode::text::{Cursor, Line, Place};

/// Most arguments of a call: #1 to #30.
const MAX_ARGUMENTS: usize = 30;

/// One O word. A condition that cannot be computed does not hold.
pub(super) fn word<R: Read + Seek>(
    run: &mut Running<'_, R>,
    label: &[u8],
    keyword: Keyword,
    rest: usize,
    line: Line<'_>,
    variables: &mut Variables,
) -> Result<(), Fault> {
    let whole = Place::new(0, line.text.len());
    let fault = |kind| (kind, whole);
    let value =
        |variables: &Variables| Reader::new(line.text, rest, variables).value().map(|value| value.unwrap_or(0.0));
    match keyword {
        Keyword::Sub => skip_to(run, label, &[Keyword::EndSub]).map(drop).map_err(fault),
        Keyword::EndSub | Keyword::Return => {
            if run.calls.is_empty() {
                return Err(fault(DiagnosticKind::LoopOpen));
            }
            if let Ok(value) = value(variables) {
                // RS274 has no vacancy: this cannot fail.
                let _ = variables.write(Variable::Name(b"_value".to_vec()), Some(value));
            }
            run.return_from_call(variables);
            Ok(())
        }
        Keyword::Call => {
            let mut reader = Reader::new(line.text, rest, variables);
            let mut arguments = Vec::new();
            reader.skip_blanks();
            while reader.rest().first() == Some(&b'[') && arguments.len() < MAX_ARGUMENTS {
                arguments.push(reader.value()?.unwrap_or(0.0));
                reader.skip_blanks();
            }
            let sub = run.sub(label).ok_or(fault(DiagnosticKind::SubMissing))?;
            let (_, start) = run.text.line_at(sub).ok_or(fault(DiagnosticKind::SubMissing))?;
            run.push_call(start, 1, true).map_err(fault)?;
            variables.enter(&arguments);
            Ok(())
        }
        Keyword::If => {
            let found = value(variables);
            if matches!(found, Ok(value) if value != 0.0) {
                return Ok(());
            }
            next_branch(run, label, variables).map_err(fault)?;
            found.map(drop)
        }
        // Reached from the branch before.
        Keyword::ElseIf | Keyword::Else => skip_to(run, label, &[Keyword::EndIf]).map(drop).map_err(fault),
        Keyword::EndIf => Ok(()),
        Keyword::While => {
            let found = value(variables);
            let holds = matches!(found, Ok(value) if value != 0.0);
            while_word(run, label, holds, line).map_err(fault)?;
            found.map(drop)
        }
        Keyword::Do => run.push_loop(Loop { label: label.to_vec(), at: run.next, kind: Kind::Do }).map_err(fault),
        Keyword::Repeat => {
            let found = value(variables);
            let Ok(count) = found else {
                skip_to(run, label, &[Keyword::EndRepeat]).map_err(fault)?;
                return found.map(drop);
            };
            // Anything beyond the step limit ends there.
            let left = count.clamp(0.0, 1e9) as u32;
            if left == 0 {
                return skip_to(run, label, &[Keyword::EndRepeat]).map(drop).map_err(fault);
            }
            let new = Loop { label: label.to_vec(), at: run.next, kind: Kind::Repeat { left } };
            run.push_loop(new).map_err(fault)
        }
        Keyword::EndWhile | Keyword::EndRepeat => end_word(run, label).map_err(fault),
        Keyword::Break => break_word(run, label).map_err(fault),
        Keyword::Continue => continue_word(run, label).map_err(fault),
    }
}

/// Goes on behind the next O word of a label and one of the keywords; which it was, and where.
fn skip_to<R: Read + Seek>(
    run: &mut Running<'_, R>,
    label: &[u8],
    keywords: &[Keyword],
) -> Result<(Keyword, Cursor), DiagnosticKind> {
    let costs = run.costs_steps();
    let (mut before, mut at, mut found) = (run.next, run.next, None);
    while let Some((line, behind)) = run.text.line_at(at) {
        run.steps += costs;
        (before, at) = (at, behind);
        found = o_word(line.text)
            .filter(|(known, keyword, _)| known == label && keywords.contains(keyword))
            .map(|(_, keyword, _)| keyword);
        if found.is_some() {
            break;
        }
    }
    let keyword = found.ok_or(DiagnosticKind::LoopOpen)?;
    run.next = at;
    Ok((keyword, before))
}

/// Behind an if that does not hold: the branch that does, or the end.
fn next_branch<R: Read + Seek>(
    run: &mut Running<'_, R>,
    label: &[u8],
    variables: &mut Variables,
) -> Result<(), DiagnosticKind> {
    loop {
        let (keyword, at) = skip_to(run, label, &[Keyword::ElseIf, Keyword::Else, Keyword::EndIf])?;
        if keyword != Keyword::ElseIf {
            return Ok(());
        }
        let Some((line, _)) = run.text.line_at(at) else { return Ok(()) };
        let rest = o_word(line.text).map_or(0, |(.., rest)| rest);
        let holds = Reader::new(line.text, rest, variables).value();
        if matches!(holds, Ok(Some(value)) if value != 0.0) {
            return Ok(());
        }
    }
}

fn innermost<R: Read + Seek>(run: &Running<'_, R>, label: &[u8]) -> Option<usize> {
    let outside = run.calls.last().map_or(0, |call| call.loops);
    let found = run.loops.iter().rposition(|l| l.label == label)?;
    (found >= outside).then_some(found)
}

/// At the head of its loop, or at the end of a do.
fn while_word<R: Read + Seek>(
    run: &mut Running<'_, R>,
    label: &[u8],
    holds: bool,
    line: Line<'_>,
) -> Result<(), DiagnosticKind> {
    let here = line.start();
    let running = innermost(run, label);
    if let Some(found) = running {
        let (kind, at) = run.loops.get(found).map_or((Kind::Head, here), |l| (l.kind, l.at));
        run.loops.truncate(if holds { found + 1 } else { found });
        if kind == Kind::Do {
            if holds {
                run.next = at;
            }
            return Ok(());
        }
    } else if holds {
        return run.push_loop(Loop::head(label.to_vec(), here));
    }
    if holds { Ok(()) } else { skip_to(run, label, &[Keyword::EndWhile]).map(drop) }
}

fn end_word<R: Read + Seek>(run: &mut Running<'_, R>, label: &[u8]) -> Result<(), DiagnosticKind> {
    let found = innermost(run, label).ok_or(DiagnosticKind::LoopOpen)?;
    run.loops.truncate(found + 1);
    let Some(running) = run.loops.last_mut() else { return Ok(()) };
    if let Kind::Repeat { left } = &mut running.kind {
        *left -= 1;
        if *left == 0 {
            run.loops.pop();
            return Ok(());
        }
    }
    run.next = running.at;
    Ok(())
}

fn break_word<R: Read + Seek>(run: &mut Running<'_, R>, label: &[u8]) -> Result<(), DiagnosticKind> {
    let found = innermost(run, label).ok_or(DiagnosticKind::LoopOpen)?;
    let end = run.loops.get(found).map_or(Kind::Head, |l| l.kind).end();
    run.loops.truncate(found);
    skip_to(run, label, &[end]).map(drop)
}

fn continue_word<R: Read + Seek>(run: &mut Running<'_, R>, label: &[u8]) -> Result<(), DiagnosticKind> {
    let found = innermost(run, label).ok_or(DiagnosticKind::LoopOpen)?;
    run.loops.truncate(found + 1);
    let end = run.loops.last().map_or(Kind::Head, |l| l.kind).end();
    let (_, at) = skip_to(run, label, &[end])?;
    run.next = at;
    Ok(())
}
