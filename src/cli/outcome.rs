//! How a command ends, and the two streams it speaks on.

use std::io::{self, Write};
use std::process::ExitCode;

use serde::Serialize;

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
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(unwritable)
}

/// Standard output for what comes piece by piece; its owner flushes it.
pub(super) fn stdout() -> io::BufWriter<io::StdoutLock<'static>> {
    io::BufWriter::new(io::stdout().lock())
}

/// Standard output could not be written.
pub(super) fn unwritable(error: io::Error) -> Stop {
    Stop::Output { name: STDOUT.into(), error }
}

/// Writes JSON to standard output.
pub(super) fn print_json(value: &impl Serialize) -> Result<(), Stop> {
    let mut out = stdout();
    serde_json::to_writer_pretty(&mut out, value).map_err(|error| unwritable(error.into()))?;
    out.write_all(b"\n").and_then(|()| out.flush()).map_err(unwritable)
}

/// Writes a message to standard error. A standard error that is closed is no fault.
pub(super) fn report(text: &str) {
    let text = text.trim_end();
    if !text.is_empty() {
        let _ = writeln!(io::stderr().lock(), "{text}");
    }
}
