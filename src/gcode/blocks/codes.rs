//! The codes of one block by modal group.

use crate::gcode::dialect::CodeName;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::text::Place;

/// A code with its meaning, the name it was written with, and its place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Code<T> {
    pub(crate) meaning: T,
    pub(crate) name: CodeName,
    pub(crate) place: Place,
}

/// The codes of a block by modal group. Only what `given` has a bit for means anything.
#[derive(Clone, Copy, Debug)]
pub(super) struct Codes<T, const GROUPS: usize> {
    pub(super) given: u32,
    /// One bit for each group whose code has acted.
    acted: u32,
    codes: [Code<T>; GROUPS],
}

impl<T: Copy, const GROUPS: usize> Codes<T, GROUPS> {
    pub(super) const fn new(any: T) -> Self {
        let nothing =
            Code { meaning: any, name: CodeName { letter: b'G', tenths: 0 }, place: Place { start: 0, end: 0 } };
        Self { given: 0, acted: 0, codes: [nothing; GROUPS] }
    }

    /// Before the next block.
    pub(super) const fn clear(&mut self) {
        (self.given, self.acted) = (0, 0);
    }

    /// The code of a group, for somebody who acts on it. One that nobody takes is diagnosed.
    pub(super) fn take(&mut self, group: usize) -> Option<Code<T>> {
        let code = self.get(group);
        self.acted |= 1 << group;
        code
    }

    /// Whether somebody acted on each.
    pub(super) const fn all_acted(&self) -> bool {
        self.given & !self.acted == 0
    }

    /// A code that nobody acted on; from now on it counts as acted on.
    pub(super) fn take_unacted(&mut self) -> Option<Code<T>> {
        let group = (self.given & !self.acted).trailing_zeros();
        self.get(group as usize).inspect(|_| self.acted |= 1 << group)
    }

    pub(super) fn get(&self, group: usize) -> Option<Code<T>> {
        if self.given.checked_shr(group as u32).unwrap_or(0) & 1 == 0 { None } else { self.codes.get(group).copied() }
    }

    /// Fills a group's slot, unless it or a code that excludes this one is taken.
    pub(super) fn put(
        &mut self,
        group: usize,
        other: Option<Code<T>>,
        second: Code<T>,
        sets: &'static str,
    ) -> Result<(), DiagnosticKind> {
        match self.get(group).or(other) {
            None => {
                if let Some(slot) = self.codes.get_mut(group) {
                    *slot = second;
                    self.given |= 1 << group;
                }
                Ok(())
            }
            Some(first) if first.name == second.name => Err(DiagnosticKind::RepeatedCode { name: second.name }),
            Some(first) => Err(DiagnosticKind::ModalConflict { first: first.name, second: second.name, sets }),
        }
    }
}
