//! The file that keeps what holes taught.

use std::io::Write;
use std::path::Path;

use crate::control::machine::Machine;
use crate::run::{AtomicFile, Learned};

use super::input;
use super::outcome::{Stop, report};
use super::output::Output;

const HELP: &str =
    "it takes what simulate --learned has written for the same machine file; with a new name learning begins anew";

/// Reads what was kept; nothing where there is no file yet.
pub(super) fn read(path: &Path, machine: &Machine) -> Result<Learned, Stop> {
    if path.as_os_str() == "-" {
        return Err(Stop::Usage("--learned takes a file: - is standard input".into()));
    }
    if path.try_exists().is_ok_and(|exists| !exists) {
        return Ok(Learned::default());
    }
    let bytes = input::read(path)?;
    Learned::of(bytes, machine).map_err(|error| {
        report(&format!("error: {}: {error}\nhelp: {HELP}", input::name(path)));
        Stop::Reported
    })
}

/// The file with what is known now, to be put in its place at the end.
pub(super) fn write(path: &Path, learned: &Learned) -> Result<Output, Stop> {
    let written = AtomicFile::create(path).and_then(|mut file| {
        file.write_all(learned.bytes())?;
        Ok(file)
    });
    Output::of(path, written)
}
