//! O words: LinuxCNC's subprograms, loops and conditions (LinuxCNC documentation, O Codes).

use std::io::{Read, Seek};

use super::Runner;
use super::statement::{Keyword, o_word};
use crate::gcode::expression::Reader;
use crate::gcode::interpreter::Interpreter;
use crate::gcode::lexer::Fault;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::span::{Cursor, Line, Place};
use crate::gcode::variables::Variable;

/// Most arguments of a call: #1 to #30.
const MAX_ARGUMENTS: usize = 30;

/// A loop that runs.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    pub(super) label: Vec<u8>,
    /// Its first line; that of a repeat or do is behind its head.
    pub(super) at: Cursor,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The condition stands at the head.
    Head,
    /// At the end.
    Do,
    Repeat {
        left: u32,
    },
}

impl Loop {
    pub(super) const fn head(label: Vec<u8>, at: Cursor) -> Self {
        Self { label, at, kind: Kind::Head }
    }
}

impl<R: Read + Seek> Runner<'_, R> {
    /// One O word. A condition that cannot be computed does not hold.
    pub(super) fn word(
        &mut self,
        label: &[u8],
        keyword: Keyword,
        rest: usize,
        line: Line<'_>,
        interpreter: &mut Interpreter,
    ) -> Result<(), Fault> {
        let whole = Place::new(0, line.text.len());
        let fault = |kind| (kind, whole);
        let value = |interpreter: &mut Interpreter| {
            Reader::new(line.text, rest, interpreter.variables()).value().map(|value| value.unwrap_or(0.0))
        };
        match keyword {
            Keyword::Sub => self.skip_to(label, &[Keyword::EndSub]).map(drop).map_err(fault),
            Keyword::EndSub | Keyword::Return => {
                if self.calls.is_empty() {
                    return Err(fault(DiagnosticKind::LoopOpen));
                }
                if let Ok(value) = value(interpreter) {
                    // RS274 has no vacancy: this cannot fail.
                    let _ = interpreter.variables().write(Variable::Name(b"_value".to_vec()), Some(value));
                }
                self.return_from_call(interpreter);
                Ok(())
            }
            Keyword::Call => {
                let mut reader = Reader::new(line.text, rest, interpreter.variables());
                let mut arguments = Vec::new();
                reader.skip_blanks();
                while reader.rest().first() == Some(&b'[') && arguments.len() < MAX_ARGUMENTS {
                    arguments.push(reader.value()?.unwrap_or(0.0));
                    reader.skip_blanks();
                }
                let sub = self.index(false).sub(label).ok_or(fault(DiagnosticKind::SubMissing))?;
                let (_, start) = self.text.line_at(sub).ok_or(fault(DiagnosticKind::SubMissing))?;
                self.push_call(start, 1, true).map_err(fault)?;
                interpreter.variables().enter(&arguments);
                Ok(())
            }
            Keyword::If => {
                let found = value(interpreter);
                if matches!(found, Ok(value) if value != 0.0) {
                    return Ok(());
                }
                self.next_branch(label, interpreter).map_err(fault)?;
                found.map(drop)
            }
            // Reached from the branch before.
            Keyword::ElseIf | Keyword::Else => self.skip_to(label, &[Keyword::EndIf]).map(drop).map_err(fault),
            Keyword::EndIf => Ok(()),
            Keyword::While => {
                let found = value(interpreter);
                let holds = matches!(found, Ok(value) if value != 0.0);
                self.while_word(label, holds, line).map_err(fault)?;
                found.map(drop)
            }
            Keyword::Do => self.push_loop(Loop { label: label.to_vec(), at: self.next, kind: Kind::Do }).map_err(fault),
            Keyword::Repeat => {
                let found = value(interpreter);
                let Ok(count) = found else {
                    self.skip_to(label, &[Keyword::EndRepeat]).map_err(fault)?;
                    return found.map(drop);
                };
                // Anything beyond the step limit ends there.
                let left = count.clamp(0.0, 1e9) as u32;
                if left == 0 {
                    return self.skip_to(label, &[Keyword::EndRepeat]).map(drop).map_err(fault);
                }
                let new = Loop { label: label.to_vec(), at: self.next, kind: Kind::Repeat { left } };
                self.push_loop(new).map_err(fault)
            }
            Keyword::EndWhile | Keyword::EndRepeat => self.end_word(label).map_err(fault),
            Keyword::Break => self.break_word(label).map_err(fault),
            Keyword::Continue => self.continue_word(label).map_err(fault),
        }
    }

    /// Goes on behind the next O word of a label and one of the keywords; which it was, and where.
    fn skip_to(&mut self, label: &[u8], keywords: &[Keyword]) -> Result<(Keyword, Cursor), DiagnosticKind> {
        let costs = self.costs_steps();
        let (mut before, mut at, mut found) = (self.next, self.next, None);
        while let Some((line, behind)) = self.text.line_at(at) {
            self.steps += costs;
            (before, at) = (at, behind);
            found = o_word(line.text)
                .filter(|(known, keyword, _)| known == label && keywords.contains(keyword))
                .map(|(_, keyword, _)| keyword);
            if found.is_some() {
                break;
            }
        }
        let keyword = found.ok_or(DiagnosticKind::LoopOpen)?;
        self.next = at;
        Ok((keyword, before))
    }

    /// Behind an if that does not hold: the branch that does, or the end.
    fn next_branch(&mut self, label: &[u8], interpreter: &mut Interpreter) -> Result<(), DiagnosticKind> {
        loop {
            let (keyword, at) = self.skip_to(label, &[Keyword::ElseIf, Keyword::Else, Keyword::EndIf])?;
            if keyword != Keyword::ElseIf {
                return Ok(());
            }
            let Some((line, _)) = self.text.line_at(at) else { return Ok(()) };
            let rest = o_word(line.text).map_or(0, |(.., rest)| rest);
            let holds = Reader::new(line.text, rest, interpreter.variables()).value();
            if matches!(holds, Ok(Some(value)) if value != 0.0) {
                return Ok(());
            }
        }
    }

    fn innermost(&self, label: &[u8]) -> Option<usize> {
        let outside = self.calls.last().map_or(0, |call| call.loops);
        let found = self.loops.iter().rposition(|l| l.label == label)?;
        (found >= outside).then_some(found)
    }

    /// At the head of its loop, or at the end of a do.
    fn while_word(&mut self, label: &[u8], holds: bool, line: Line<'_>) -> Result<(), DiagnosticKind> {
        let here = Self::at(line);
        let running = self.innermost(label);
        if let Some(found) = running {
            let (kind, at) = self.loops.get(found).map_or((Kind::Head, here), |l| (l.kind, l.at));
            self.loops.truncate(if holds { found + 1 } else { found });
            if kind == Kind::Do {
                if holds {
                    self.next = at;
                }
                return Ok(());
            }
        } else if holds {
            return self.push_loop(Loop::head(label.to_vec(), here));
        }
        if holds { Ok(()) } else { self.skip_to(label, &[Keyword::EndWhile]).map(drop) }
    }

    fn end_word(&mut self, label: &[u8]) -> Result<(), DiagnosticKind> {
        let found = self.innermost(label).ok_or(DiagnosticKind::LoopOpen)?;
        self.loops.truncate(found + 1);
        let Some(running) = self.loops.last_mut() else { return Ok(()) };
        if let Kind::Repeat { left } = &mut running.kind {
            *left -= 1;
            if *left == 0 {
                self.loops.pop();
                return Ok(());
            }
        }
        self.next = running.at;
        Ok(())
    }

    fn break_word(&mut self, label: &[u8]) -> Result<(), DiagnosticKind> {
        let found = self.innermost(label).ok_or(DiagnosticKind::LoopOpen)?;
        let end = self.loops.get(found).map_or(Kind::Head, |l| l.kind).end();
        self.loops.truncate(found);
        self.skip_to(label, &[end]).map(drop)
    }

    fn continue_word(&mut self, label: &[u8]) -> Result<(), DiagnosticKind> {
        let found = self.innermost(label).ok_or(DiagnosticKind::LoopOpen)?;
        self.loops.truncate(found + 1);
        let end = self.loops.last().map_or(Kind::Head, |l| l.kind).end();
        let (_, at) = self.skip_to(label, &[end])?;
        self.next = at;
        Ok(())
    }
}

impl Kind {
    /// The keyword of its last line.
    const fn end(self) -> Keyword {
        match self {
            Self::Head => Keyword::EndWhile,
            Self::Do => Keyword::While,
            Self::Repeat { .. } => Keyword::EndRepeat,
        }
    }
}
