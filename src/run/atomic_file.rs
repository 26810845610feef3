//! Output files that appear whole or not at all, after a loss of power, too.
//!
//! A file is written beside its place, synced, moved there, and its folder is synced. What a run that was killed left
//! beside is cleared by the next one that writes into the same folder.

use std::fs::{File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What a file being written is called: hidden, and told from everyone else's.
const PREFIX: &str = ".rigidtap-";
const SUFFIX: &str = ".part";
/// A file that nobody holds is left over once it is so old: between its making and its lock lies far less.
const LEFT_OVER: Duration = Duration::from_secs(60);

/// A file being written. Until [`AtomicFile::keep`] one that stood at its path stays as it was.
#[derive(Debug)]
pub struct AtomicFile {
    writer: BufWriter<Target>,
    path: PathBuf,
}

#[derive(Debug)]
enum Target {
    /// Written beside the path and moved there at the end.
    Beside(tempfile::NamedTempFile),
    /// A terminal, pipe or device has no "beside": it is written as it comes.
    Straight(File),
}

impl Write for Target {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Beside(file) => file.write(bytes),
            Self::Straight(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Beside(file) => file.flush(),
            Self::Straight(file) => file.flush(),
        }
    }
}

impl AtomicFile {
    /// Opens a file for writing.
    ///
    /// # Errors
    /// Where its folder does not exist or cannot be written.
    pub fn create(path: &Path) -> io::Result<Self> {
        // A link stays a link: what it points to is replaced.
        let path = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let special = std::fs::metadata(&path).is_ok_and(|found| !found.is_file());
        let target = if special {
            Target::Straight(OpenOptions::new().write(true).open(&path)?)
        } else {
            let folder = folder_of(&path);
            clear_left_over(folder);
            let file = beside(&path).prefix(PREFIX).suffix(SUFFIX).tempfile_in(folder)?;
            // The lock says that someone writes it. Where there are none, nobody's file is ever cleared.
            let _ = file.as_file().try_lock();
            Target::Beside(file)
        };
        Ok(Self { writer: BufWriter::new(target), path })
    }

    /// Writes all of a text to a file, whole or not at all.
    ///
    /// # Errors
    /// As [`AtomicFile::create`] and [`AtomicFile::keep`].
    pub fn write_text(path: &Path, text: &str) -> io::Result<()> {
        let mut file = Self::create(path)?;
        file.write_all(text.as_bytes())?;
        file.keep()
    }

    /// Puts the file in its place, once its content is on the disk.
    ///
    /// # Errors
    /// Where what is left cannot be written, or the file cannot be moved to its place.
    pub fn keep(self) -> io::Result<()> {
        match self.writer.into_inner().map_err(io::IntoInnerError::into_error)? {
            Target::Beside(file) => {
                file.as_file().sync_all()?;
                file.persist(&self.path).map_err(|error| error.error)?;
                sync_folder(folder_of(&self.path));
                Ok(())
            }
            Target::Straight(mut file) => file.flush(),
        }
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.flush()
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The folder's entry is on the disk then, too. A file system that cannot do that has done what it can.
#[cfg(unix)]
fn sync_folder(folder: &Path) {
    let _ = File::open(folder).and_then(|folder| folder.sync_all());
}

/// Elsewhere a folder cannot be synced.
#[cfg(not(unix))]
fn sync_folder(_folder: &Path) {}

/// Clears what runs that were killed left in a folder: files of our own name that are old and that nobody holds. What
/// cannot be read or cleared stays, and is no fault of this run.
fn clear_left_over(folder: &Path) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let ours = entries.filter(|entry| {
        entry.file_name().to_str().is_some_and(|name| name.starts_with(PREFIX) && name.ends_with(SUFFIX))
    });
    for entry in ours {
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        let modified = entry.metadata().and_then(|found| found.modified());
        let old = modified.is_ok_and(|at| at.elapsed().is_ok_and(|age| age >= LEFT_OVER));
        if !is_file || !old {
            continue;
        }
        let nobodys = OpenOptions::new().write(true).open(entry.path()).is_ok_and(|file| file.try_lock().is_ok());
        if nobodys {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// A temporary file is for its owner alone unless told otherwise; an output file is as any other the user makes.
#[cfg(unix)]
fn beside(path: &Path) -> tempfile::Builder<'static, 'static> {
    use std::os::unix::fs::PermissionsExt;
    let permissions =
        std::fs::metadata(path).map_or_else(|_| std::fs::Permissions::from_mode(0o666), |found| found.permissions());
    let mut builder = tempfile::Builder::new();
    builder.permissions(permissions);
    builder
}

#[cfg(not(unix))]
fn beside(_path: &Path) -> tempfile::Builder<'static, 'static> {
    tempfile::Builder::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_existing_file_stays_until_kept() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        std::fs::write(&path, "old").unwrap();
        let mut file = AtomicFile::create(&path).unwrap();
        file.write_all(b"new").unwrap();
        file.flush().unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
        drop(file);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no litter");
        AtomicFile::write_text(&path, "new").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "new");
    }

    #[test]
    fn what_a_killed_run_left_is_cleared_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let old = std::time::SystemTime::now() - 2 * LEFT_OVER;
        let make = |name: &str, aged: bool| {
            let file = File::create(folder.path().join(name)).unwrap();
            if aged {
                file.set_modified(old).unwrap();
            }
            file
        };
        let names =
            [".rigidtap-a1b2c3.part", ".rigidtap-fresh1.part", ".tmpXYZ123", "rigidtap.part", ".rigidtap-notes.txt"];
        for (name, aged) in names.iter().zip([true, false, true, true, true]) {
            make(name, aged);
        }
        std::fs::create_dir(folder.path().join(".rigidtap-folder.part")).unwrap();
        let held = make(".rigidtap-writer.part", true);
        held.try_lock().unwrap();
        let path = folder.path().join("out.csv");
        let mut file = AtomicFile::create(&path).unwrap();
        file.write_all(b"new").unwrap();
        // Another one beside it that writes for long.
        AtomicFile::write_text(&folder.path().join("other.csv"), "other").unwrap();
        file.keep().unwrap();
        let mut left: Vec<_> =
            std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        left.sort();
        let due = [
            ".rigidtap-folder.part",
            ".rigidtap-fresh1.part",
            ".rigidtap-notes.txt",
            ".rigidtap-writer.part",
            ".tmpXYZ123",
            "other.csv",
            "out.csv",
            "rigidtap.part",
        ];
        assert_eq!(left, due);
    }

    #[test]
    fn a_missing_folder_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(AtomicFile::create(&folder.path().join("none/out.csv")).is_err());
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_not_replaced() {
        AtomicFile::write_text(Path::new("/dev/null"), "text").unwrap();
        assert!(!std::fs::metadata("/dev/null").unwrap().is_file());
    }
}
