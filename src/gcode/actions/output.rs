//! Where commands and diagnostics of a block go.

use crate::gcode::command::{Command, CommandKind};
use crate::gcode::diagnostics::Diagnostics;
use crate::gcode::messages::DiagnosticKind;
use crate::gcode::text::{Line, Place};

/// Where a block's commands and diagnostics go.
pub(crate) struct Output<'a, 'b> {
    pub(crate) line: &'a Line<'a>,
    /// The block's words.
    pub(crate) place: Place,
    /// The block could not be read whole.
    pub(crate) damaged: bool,
    /// The block has run before, in a loop or a subprogram.
    pub(crate) again: bool,
    pub(crate) sink: &'b mut dyn FnMut(&Command),
    pub(crate) diagnostics: &'b mut Diagnostics,
}

impl Output<'_, '_> {
    pub(crate) fn emit(&mut self, kind: CommandKind) {
        let column = self.place.column(self.line.text);
        (self.sink)(&Command { kind, line: self.line.number, column, span: self.place.span(self.line.offset) });
    }

    pub(crate) fn report(&mut self, kind: DiagnosticKind, place: Place) {
        if self.again && self.diagnostics.knows(&kind, place.span(self.line.offset)) {
            return;
        }
        let column = || place.column(self.line.text);
        self.diagnostics.report(kind, place.span(self.line.offset), self.line.number, column);
    }

    /// Reports what may follow from a word that could not be read: nothing, if there was one in this block.
    pub(crate) fn report_if_whole(&mut self, kind: DiagnosticKind, place: Place) {
        if !self.damaged {
            self.report(kind, place);
        }
    }

    /// The value, or the report that it is missing.
    pub(crate) fn require<T>(&mut self, value: Option<T>, missing: DiagnosticKind, place: Place) -> Option<T> {
        if value.is_none() {
            self.report_if_whole(missing, place);
        }
        value
    }
}
