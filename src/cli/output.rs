//! The files that a command writes: opened before anything runs, all put in their places at its end, or none.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::report::plot::PlotError;
use crate::run::AtomicFile;

use super::args::Common;
use super::input;
use super::outcome::Stop;

/// A file being written.
pub(super) struct Output {
    file: AtomicFile,
    name: String,
}

impl Output {
    /// Opens a file; one that stands there stays as it is until [`Output::keep`].
    pub(super) fn open(path: &Path) -> Result<Self, Stop> {
        let name = input::name(path);
        match AtomicFile::create(path) {
            Ok(file) => Ok(Self { file, name }),
            Err(error) => Err(Stop::Output { name, error }),
        }
    }

    /// Writes a picture.
    pub(super) fn draw(&mut self, svg: Result<String, PlotError>) -> Result<(), Stop> {
        let refused = |error: PlotError| io::Error::other(error.to_string());
        let text = svg.map_err(|error| Stop::Output { name: self.name.clone(), error: refused(error) })?;
        self.write(&text)
    }

    /// For what is written piece by piece.
    pub(super) fn writer(&mut self) -> &mut dyn Write {
        &mut self.file
    }

    /// Writes bytes.
    #[cfg(all(feature = "fmi", unix))]
    pub(super) fn write_bytes(&mut self, bytes: &[u8]) -> Result<(), Stop> {
        self.file.write_all(bytes).map_err(|error| Stop::Output { name: self.name.clone(), error })
    }

    /// Writes a text.
    pub(super) fn write(&mut self, text: &str) -> Result<(), Stop> {
        self.file.write_all(text.as_bytes()).map_err(|error| Stop::Output { name: self.name.clone(), error })
    }

    /// Takes a file that was written elsewhere under the same rule.
    pub(super) fn of(path: &Path, file: io::Result<AtomicFile>) -> Result<Self, Stop> {
        let name = input::name(path);
        match file {
            Ok(file) => Ok(Self { file, name }),
            Err(error) => Err(Stop::Output { name, error }),
        }
    }

    /// Puts the file in its place.
    pub(super) fn keep(self) -> Result<(), Stop> {
        self.file.keep().map_err(|error| Stop::Output { name: self.name, error })
    }
}

/// Refuses to write over what is read, and to write one file twice.
pub(super) fn check_paths(common: &Common, read: &[PathBuf], written: &[Option<&PathBuf>]) -> Result<(), Stop> {
    let written: Vec<&PathBuf> = written.iter().copied().flatten().collect();
    for (index, path) in written.iter().enumerate() {
        if path.as_os_str() == "-" {
            return Err(Stop::Usage("an output is a file: - is standard input".into()));
        }
        if read.iter().chain(&common.machine).any(|input| same(input, path)) {
            return Err(Stop::Usage(format!("{} would be written over: it is also read", input::name(path))));
        }
        if written.iter().take(index).any(|other| same(other, path)) {
            return Err(Stop::Usage(format!("{} would be written twice", input::name(path))));
        }
    }
    Ok(())
}

/// Whether two paths lead to the same place, whether or not there is a file.
fn same(left: &Path, right: &Path) -> bool {
    let place = |path: &Path| {
        std::fs::canonicalize(path).or_else(|_| {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            std::fs::canonicalize(folder).map(|folder| folder.join(path.file_name().unwrap_or_default()))
        })
    };
    match (place(left), place(right)) {
        (Ok(left), Ok(right)) => left == right,
        _ => left == right,
    }
}
