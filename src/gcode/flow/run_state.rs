//! Where a running text stands: its loops, its calls, and the steps between its lines.

use std::io::{Read, Seek};

use super::index::Index;
use crate::gcode::blocks::{Keyword, ProgramCall, Variables};
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::text::{Cursor, Line, Text, Wanted};

/// Deepest nesting of calls, and of loops. A Fanuc takes 4 calls of M98, LinuxCNC 10.
const MAX_DEPTH: usize = 32;

/// A subprogram that runs.
#[derive(Clone, Debug)]
pub(super) struct Call {
    pub(super) back: Cursor,
    pub(super) start: Cursor,
    pub(super) repeats_left: u32,
    /// Loops around the call.
    pub(super) loops: usize,
    /// It has variables of its own.
    pub(super) level: bool,
    /// With these G65 begins each of its rounds.
    pub(super) arguments: Option<Vec<(u32, f64)>>,
}

/// A text that runs: where it stands, and the loops and calls around.
#[derive(Debug)]
pub(super) struct Running<'t, R> {
    pub(super) text: &'t mut Text<R>,
    pub(super) next: Cursor,
    /// One past the last byte that was run: what stands before runs another time.
    pub(super) high: usize,
    pub(super) steps: usize,
    pub(super) repeated: usize,
    pub(super) loops: Vec<Loop>,
    pub(super) calls: Vec<Call>,
    pub(super) index: Option<Index>,
    /// The index has labels.
    pub(super) labelled: bool,
    /// A limit was reached.
    pub(super) stopped: bool,
}

/// A loop that runs.
#[derive(Clone, Debug)]
pub(super) struct Loop {
    pub(super) label: Vec<u8>,
    /// Its first line; that of a repeat or do is behind its head.
    pub(super) at: Cursor,
    pub(super) kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
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

impl Kind {
    /// The keyword of its last line.
    pub(super) const fn end(self) -> Keyword {
        match self {
            Self::Head => Keyword::EndWhile,
            Self::Do => Keyword::While,
            Self::Repeat { .. } => Keyword::EndRepeat,
        }
    }
}

impl<'t, R: Read + Seek> Running<'t, R> {
    /// At the text's first line.
    pub(super) fn new(text: &'t mut Text<R>) -> Self {
        let next = text.first();
        Self {
            text,
            next,
            high: 0,
            steps: 0,
            repeated: 0,
            loops: Vec::new(),
            calls: Vec::new(),
            index: None,
            labelled: false,
            stopped: false,
        }
    }

    pub(super) fn take_line(&mut self) -> Option<Line<'_>> {
        let (line, next) = self.text.line_at(self.next)?;
        self.next = next;
        Some(line)
    }

    /// Labels are asked for by GOTO alone.
    pub(super) fn index(&mut self, with_labels: bool) -> &Index {
        if with_labels && !self.labelled {
            (self.index, self.labelled) = (None, true);
        }
        let (text, labelled) = (&mut *self.text, self.labelled);
        self.index.get_or_insert_with(|| Index::of(text, labelled))
    }

    pub(super) fn push_loop(&mut self, new: Loop) -> Result<(), DiagnosticKind> {
        if self.loops.len() >= MAX_DEPTH {
            return Err(DiagnosticKind::TooDeep { limit: MAX_DEPTH });
        }
        self.loops.push(new);
        Ok(())
    }

    /// Goes on behind the first line from here that is as wanted.
    pub(super) fn skip_past(&mut self, wanted: impl Fn(&[u8]) -> bool) -> Option<()> {
        let before = self.next;
        // Skipping costs time, too, where it happens again and again.
        let costs = self.costs_steps();
        while let Some(line) = self.take_line() {
            let found = wanted(line.text);
            self.steps += costs;
            if found {
                return Some(());
            }
        }
        self.next = before;
        None
    }

    /// What a skipped line counts as.
    pub(super) fn costs_steps(&self) -> usize {
        usize::from(self.steps > 0 || !self.loops.is_empty() || !self.calls.is_empty())
    }

    /// M98, G65: the number of the program that runs.
    pub(super) fn call_program(&mut self, call: ProgramCall, variables: &mut Variables) -> Result<u32, DiagnosticKind> {
        const FOUR_DIGITS: u32 = 10_000;
        let ProgramCall { program: written, repeats_in_p, repeats, arguments, .. } = call;
        let splits = repeats_in_p && written >= FOUR_DIGITS;
        let mut whole = self.index(false).program(written);
        let mut split = self.index(false).program(written % FOUR_DIGITS).filter(|_| splits);
        if whole.is_none() && split.is_none() {
            whole = self.take_in(Wanted::Number(written));
            split = if splits { self.take_in(Wanted::Number(written % FOUR_DIGITS)) } else { None };
        }
        let (program, start, repeats) = match (whole, split) {
            (Some(_), Some(_)) => return Err(DiagnosticKind::ProgramAmbiguous { program: written }),
            (None, Some(_)) if repeats.is_some() => return Err(DiagnosticKind::CallCountsTwice),
            (None, Some(split)) => (written % FOUR_DIGITS, split, written / FOUR_DIGITS),
            (Some(whole), None) => (written, whole, repeats.unwrap_or(1)),
            (None, None) => {
                let program = if splits { written % FOUR_DIGITS } else { written };
                return Err(DiagnosticKind::ProgramMissing { program });
            }
        };
        let level = arguments.is_some();
        self.push_call(start, repeats, level)?;
        if let Some(arguments) = arguments {
            variables.enter_with(&arguments);
            if let Some(call) = self.calls.last_mut() {
                call.arguments = Some(arguments);
            }
        }
        Ok(program)
    }

    /// A program of another file, which is read from now on as if it stood behind this one.
    fn take_in(&mut self, wanted: Wanted<'_>) -> Option<Cursor> {
        let start = self.text.take_in(wanted)?;
        let number = match wanted {
            Wanted::Number(number) => Some(number),
            Wanted::Name(_) => None,
        };
        self.index(false);
        let (text, index) = (&mut *self.text, self.index.as_mut()?);
        index.add(text, start, number);
        number.and_then(|number| index.program(number))
    }

    /// An O-word subprogram, of this text or of a file of its name.
    pub(super) fn sub(&mut self, label: &[u8]) -> Option<Cursor> {
        if let Some(found) = self.index(false).sub(label) {
            return Some(found);
        }
        let name = std::str::from_utf8(label).ok()?.trim_matches(['<', '>']);
        self.take_in(Wanted::Name(name));
        self.index(false).sub(label)
    }

    /// A subprogram of its own file, by its name (SINUMERIK).
    pub(super) fn call_named(&mut self, name: &[u8], repeats: u32) -> Result<(), DiagnosticKind> {
        let name = std::str::from_utf8(name).map_err(|_| DiagnosticKind::UnknownCall)?;
        let known = self.text.named_part(name);
        let start = known.or_else(|| self.text.take_in(Wanted::Name(name))).ok_or(DiagnosticKind::UnknownCall)?;
        self.push_call(start, repeats, false)
    }

    /// M97: the blocks from a number on.
    pub(super) fn call_label(&mut self, label: f64, repeats: u32, from: usize) -> Result<(), DiagnosticKind> {
        let start = self.index(true).label(label, from).ok_or(DiagnosticKind::LabelMissing { number: label })?;
        self.push_call(start, repeats, false)
    }

    pub(super) fn push_call(&mut self, start: Cursor, repeats: u32, level: bool) -> Result<(), DiagnosticKind> {
        if self.calls.len() >= MAX_DEPTH {
            return Err(DiagnosticKind::TooDeep { limit: MAX_DEPTH });
        }
        let call =
            Call { back: self.next, start, repeats_left: repeats - 1, loops: self.loops.len(), level, arguments: None };
        self.calls.push(call);
        self.next = start;
        Ok(())
    }

    /// Back to the caller, or once more.
    pub(super) fn return_from_call(&mut self, variables: &mut Variables) {
        let Some(call) = self.calls.last_mut() else { return };
        self.loops.truncate(call.loops);
        if call.repeats_left > 0 {
            call.repeats_left -= 1;
            self.next = call.start;
            if let Some(arguments) = &call.arguments {
                variables.leave();
                variables.enter_with(arguments);
            }
            return;
        }
        self.next = call.back;
        if call.level {
            variables.leave();
        }
        self.calls.pop();
    }
}
