//! How a command ends, and the two streams it speaks on.

use std::io::{self, Write};
use std::process::ExitCode;

use serde::Serialize;

use crate::report::{printable_json, printable_text};

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    /// Done, and good.
    Good,
    /// Input rejected.
    Rejected,
    /// Wrong words on the command line.
    WrongUsage,
    /// Everything ran and at least one verdict is fail.
    VerdictFail,
    /// Ctrl-C.
    Interrupted,
}

impl From<Outcome> for ExitCode {
    fn from(outcome: Outcome) -> Self {
        Self::from(match outcome {
            Outcome::Good => 0,
            Outcome::Rejected => 1,
            Outcome::WrongUsage => 2,
            Outcome::VerdictFail => 3,
            // What a shell makes of a process that SIGINT ended.
            Outcome::Interrupted => 130,
        })
    }
}

/// Why a command stopped early.
#[derive(Debug)]
pub(super) enum Stop {
    /// Input was rejected, and that was reported.
    Reported,
    /// The words contradict each other in a way that only their meaning shows.
    Usage(String),
    /// An output cannot be written.
    Output {
        /// Its name.
        name: String,
        /// Why.
        error: io::Error,
    },
}

/// Name of standard output where an error has to name it.
pub(super) const STDOUT: &str = "standard output";

/// Writes to standard output, all or an error; a closed pipe is for the caller's end to judge.
pub(super) fn print(text: &str) -> Result<(), Stop> {
    let mut out = io::stdout().lock();
    out.write_all(printable_text(text).as_bytes()).and_then(|()| out.flush()).map_err(unwritable)
}

/// The only way out for what comes piece by piece: no control character of a file passes.
pub(super) struct Screen {
    out: io::BufWriter<io::StdoutLock<'static>>,
    printable: fn(&str) -> std::borrow::Cow<'_, str>,
}

impl Write for Screen {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        for chunk in bytes.utf8_chunks() {
            self.out.write_all((self.printable)(chunk.valid()).as_bytes())?;
            if !chunk.invalid().is_empty() {
                self.out.write_all("\u{FFFD}".as_bytes())?;
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// Standard output for text that comes piece by piece; its owner flushes it.
pub(super) fn stdout() -> Screen {
    Screen { out: io::BufWriter::new(io::stdout().lock()), printable: printable_text }
}

/// Standard output could not be written.
pub(super) fn unwritable(error: io::Error) -> Stop {
    Stop::Output { name: STDOUT.into(), error }
}

/// Writes JSON to standard output.
pub(super) fn print_json(value: &impl Serialize) -> Result<(), Stop> {
    let mut out = Screen { printable: printable_json, ..stdout() };
    serde_json::to_writer_pretty(&mut out, value).map_err(|error| unwritable(error.into()))?;
    out.write_all(b"\n").and_then(|()| out.flush()).map_err(unwritable)
}

/// Writes a message to standard error. A standard error that is closed is no fault.
pub(super) fn report(text: &str) {
    report_styled(&printable_text(text));
}

/// Writes a message that has colours of its own, and nothing from outside that is not [printable](crate::report::printable).
pub(super) fn report_styled(text: &str) {
    let text = text.trim_end();
    if !text.is_empty() {
        let _ = writeln!(io::stderr().lock(), "{text}");
    }
}
