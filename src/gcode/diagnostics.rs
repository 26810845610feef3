//! Diagnostics of one program: what was found where. Their words are in [`super::messages`].

use crate::gcode::command::{Command, CommandKind};
use crate::gcode::messages::{DiagnosticKind, Severity};
use crate::gcode::planning_error::PlanError;
use crate::gcode::text::Span;
use crate::gcode::warning::Warning;

/// One finding with its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Diagnostic {
    /// What was found; displays as the message.
    pub kind: DiagnosticKind,
    /// Bytes meant.
    pub span: Span,
    /// Counted from 1.
    pub line: u32,
    /// Counted from 1, in characters, as editors do.
    pub column: u32,
    /// Commands, or words, that it was found of: the same cause is told once.
    pub commands: u32,
}

impl Diagnostic {
    /// Whether the program must not run.
    #[must_use]
    pub const fn is_error(&self) -> bool {
        matches!(self.severity(), Severity::Error)
    }

    /// Error or warning.
    #[must_use]
    pub const fn severity(&self) -> Severity {
        self.kind.severity()
    }

    /// Stable name such as `"G101"`.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        self.kind.code()
    }

    /// What is wrong.
    #[must_use]
    pub fn message(&self) -> String {
        match self.commands {
            0 | 1 => self.kind.message(),
            commands => format!("{}; so it is with {} more", self.kind.message(), commands - 1),
        }
    }

    /// What to do about it.
    #[must_use]
    pub fn hint(&self) -> String {
        self.kind.hint()
    }
}

/// Diagnostics in the order found, at most [`Diagnostics::LIMIT`] of each severity: after that one that says so.
#[derive(Clone, Debug, Default)]
pub struct Diagnostics {
    list: Vec<Diagnostic>,
    errors: usize,
    warnings: usize,
}

impl Diagnostics {
    /// How many errors, and how many warnings, are kept.
    pub const LIMIT: usize = 100;

    /// None yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a finding; its column is asked for only if it is kept.
    pub(crate) fn report(&mut self, kind: DiagnosticKind, span: Span, line: u32, column: impl FnOnce() -> u32) {
        if let Some(known) = self.list.iter_mut().find(|known| known.kind.has_cause_of(&kind)) {
            known.commands = known.commands.saturating_add(1);
            return;
        }
        let severity = kind.severity();
        let count = match severity {
            Severity::Error => &mut self.errors,
            Severity::Warning => &mut self.warnings,
        };
        *count = count.saturating_add(1);
        let kind = match (*count).checked_sub(Self::LIMIT) {
            None | Some(0) => kind,
            Some(1) => DiagnosticKind::TooMany { severity, limit: Self::LIMIT },
            Some(_) => return,
        };
        self.list.push(Diagnostic { kind, span, line, column: column(), commands: 1 });
    }

    /// Whether this was found here before, or its cause anywhere.
    pub(crate) fn knows(&self, kind: &DiagnosticKind, span: Span) -> bool {
        let code = kind.code();
        self.list.iter().any(|known| (known.span == span && known.code() == code) || known.kind.has_cause_of(kind))
    }

    /// Adds what a machine cannot carry out, at the block that asks for it; the same of further commands counts there.
    pub fn planning_error(&mut self, command: &Command, error: PlanError) {
        let pitch_mm = match &command.kind {
            CommandKind::Tap(hole) => Some(hole.pitch_mm),
            _ => None,
        };
        let kind = DiagnosticKind::Planning { error, pitch_mm };
        if let Some(known) = self.list.iter_mut().find(|known| known.kind == kind) {
            known.commands = known.commands.saturating_add(1);
            return;
        }
        self.at_command(command, kind);
    }

    /// Adds a warning of planning at its block.
    pub fn warn(&mut self, command: &Command, warning: Warning) {
        self.at_command(command, DiagnosticKind::Warning(warning));
    }

    fn at_command(&mut self, command: &Command, kind: DiagnosticKind) {
        let Command { line, column, span, .. } = *command;
        self.report(kind, span, line, || column);
    }

    /// Adds all that others found after these.
    pub fn append(&mut self, others: &Self) {
        for found in &others.list {
            self.report(found.kind, found.span, found.line, || found.column);
            if let Some(added) = self.list.last_mut().filter(|added| added.kind == found.kind) {
                added.commands = found.commands;
            }
        }
        // Those that were not kept.
        self.errors += others.errors.saturating_sub(others.errors.min(Self::LIMIT + 1));
        self.warnings += others.warnings.saturating_sub(others.warnings.min(Self::LIMIT + 1));
    }

    /// Those kept.
    #[must_use]
    pub fn as_slice(&self) -> &[Diagnostic] {
        &self.list
    }

    /// Whether the program must not run.
    #[must_use]
    pub const fn has_errors(&self) -> bool {
        self.errors > 0
    }

    /// Errors found, also those not kept.
    #[must_use]
    pub const fn error_count(&self) -> usize {
        self.errors
    }

    /// Warnings found, also those not kept.
    #[must_use]
    pub const fn warning_count(&self) -> usize {
        self.warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_do_not_crowd_out_errors() {
        let mut diagnostics = Diagnostics::new();
        for _ in 0..1000 {
            diagnostics.report(DiagnosticKind::NoProgramEnd, Span::default(), 1, || 1);
        }
        assert!(!diagnostics.has_errors());
        diagnostics.report(DiagnosticKind::EmptyProgram, Span::default(), 1, || 1);
        assert!(diagnostics.has_errors());
        assert_eq!(diagnostics.as_slice().len(), Diagnostics::LIMIT + 2);
        assert_eq!((diagnostics.error_count(), diagnostics.warning_count()), (1, 1000));
    }
}
