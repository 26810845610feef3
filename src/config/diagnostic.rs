//! A fault with its place in the file.

use core::fmt;
use core::ops::Range;

use crate::control::machine::Law;
use crate::gcode::Severity;

use super::fault::ConfigFault;

/// A fault with its place in the file.
#[derive(Clone, Debug, PartialEq)]
pub struct ConfigDiagnostic {
    /// What is wrong.
    pub fault: ConfigFault,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Bytes of the text, as [`String::from_utf8_lossy`] shows it.
    pub span: Range<usize>,
}

impl ConfigDiagnostic {
    /// Error or warning.
    #[must_use]
    pub fn severity(&self) -> Severity {
        if self.fault.is_warning() { Severity::Warning } else { Severity::Error }
    }

    /// The law that a warning concerns; it says nothing to whoever uses another.
    #[must_use]
    pub fn law(&self) -> Option<Law> {
        let key = match &self.fault {
            ConfigFault::Unwise(warning) => warning.key,
            ConfigFault::Slip(slip) => slip.key,
            _ => return None,
        };
        let (_, below) = key.split_once("law.")?;
        let table = below.split('.').next()?.replace('_', "-");
        Law::ALL.into_iter().find(|law| law.name() == table)
    }

    /// What was found and what was expected, without the place.
    #[must_use]
    pub fn message(&self) -> String {
        self.fault.to_string()
    }

    /// What to do about it, where more can be said.
    #[must_use]
    pub fn hint(&self) -> Option<String> {
        self.fault.hint()
    }

    /// The whole fault as text, `mine.toml:3:11: error: …`, its hint on a second line.
    ///
    /// ```
    /// let faults = rigidtap::config::MachineFile::read(b"[spindle]\nmax_rpm = -1").unwrap_err();
    /// assert_eq!(
    ///     faults[0].in_file("mine.toml").to_string(),
    ///     "mine.toml:2:11: error: spindle.max_rpm = -1 is out of range: expected 1 to 200000 rpm\n  hint: greatest speed"
    /// );
    /// ```
    pub fn in_file(&self, name: &str) -> impl fmt::Display {
        fmt::from_fn(move |f| {
            let severity = self.severity().name();
            write!(f, "{name}:{}:{}: {severity}: {}", self.line, self.column, self.fault)?;
            self.hint().map_or(Ok(()), |hint| write!(f, "\n  hint: {hint}"))
        })
    }
}

/// Where the lines of a text start.
pub(super) struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        let starts = core::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Self { text, starts }
    }

    /// The fault at its line and column.
    pub(super) fn place(&self, fault: ConfigFault, span: Range<usize>) -> ConfigDiagnostic {
        let line = self.starts.partition_point(|start| *start <= span.start).max(1);
        let start = self.starts.get(line - 1).copied().unwrap_or(0);
        // A byte order mark takes no column.
        let before = self.text.get(start..span.start).unwrap_or("").chars().filter(|c| *c != '\u{FEFF}');
        ConfigDiagnostic { fault, line, column: before.count() + 1, span }
    }
}
