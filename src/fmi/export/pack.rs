//! An FMU of ours as an archive.

use std::fmt;
use std::io::{self, Read, Seek, Write};

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::description::{Which, description};
use super::stored::{MACHINE, PROGRAM, SETTINGS, Stored};
use crate::fmi::description::Description;
use crate::fmi::unpack::library_path;
use crate::run::RunSettings;

/// Why an FMU cannot be made.
#[derive(Debug)]
pub enum PackError {
    /// What it is to carry is not sound.
    Stored(String),
    /// It cannot be written.
    Io(io::Error),
}

impl fmt::Display for PackError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stored(why) => f.write_str(why),
            Self::Io(error) => error.fmt(f),
        }
    }
}

impl From<io::Error> for PackError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// Writes an FMU: the control with its program where there is one, else the plant. `library` is this crate as a shared
/// library, built with the feature `fmi`.
///
/// # Errors
/// [`PackError`].
pub fn pack(stored: &Stored, library: &mut dyn Read, to: impl Write + Seek) -> Result<(), PackError> {
    let which = if stored.program.is_some() { Which::Control } else { Which::Plant };
    let file = stored.machine_file().map_err(PackError::Stored)?;
    if let Some(program) = &stored.program {
        program.commands(&file).map_err(PackError::Stored)?;
    }
    let z_start_mm = RunSettings::default().start_mm[2];
    let text = description(which, file.machine.spec().control.period_s, z_start_mm);
    // Our own reading of it, as others' will be.
    let read = Description::read(&text).map_err(|error| PackError::Stored(error.to_string()))?;
    let mut archive = ZipWriter::new(to);
    let mut add = |name: &str, from: &mut dyn Read| -> Result<(), PackError> {
        // Without a time the same content is the same archive.
        let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
        archive.start_file(name, options).map_err(|error| PackError::Io(error.into()))?;
        io::copy(from, &mut archive)?;
        Ok(())
    };
    add("modelDescription.xml", &mut text.as_bytes())?;
    add(&library_path(&read), library)?;
    add(&format!("resources/{MACHINE}"), &mut stored.machine.as_bytes())?;
    add(&format!("resources/{SETTINGS}"), &mut stored.settings().as_bytes())?;
    if let Some(program) = &stored.program {
        add(&format!("resources/{PROGRAM}"), &mut &program.text[..])?;
    }
    archive.finish().map_err(|error| PackError::Io(error.into()))?;
    Ok(())
}
