//! Subprograms in files of their own: where they are looked for, and by which names.

use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use crate::gcode::Subprograms;

/// Largest file of a subprogram, in bytes: it is kept in memory.
const LARGEST: u64 = 1 << 24;

/// Ends of names that controls and post processors give to programs.
const EXTENSIONS: [&str; 10] = ["", "nc", "ngc", "tap", "cnc", "txt", "min", "eia", "mpf", "spf"];

/// Folders in the order in which they are searched.
#[derive(Debug)]
pub(super) struct Folders(Vec<PathBuf>);

impl Folders {
    /// The folder of the program itself, then those of the command line.
    pub(super) fn of(program: Option<&Path>, further: &[PathBuf]) -> Self {
        let own = program.map(|path| path.parent().unwrap_or(Path::new("")).to_owned());
        Self(own.into_iter().chain(further.iter().cloned()).collect())
    }

    /// The first file that is called so in any case; of several in one folder the first by name.
    fn find(&self, is_wanted: impl Fn(&str) -> bool) -> Option<(String, Vec<u8>)> {
        self.0.iter().find_map(|folder| {
            let listed = if folder.as_os_str().is_empty() { fs::read_dir(".") } else { fs::read_dir(folder) };
            let mut names: Vec<_> =
                listed.ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
            names.retain(|name| {
                let path = Path::new(name);
                let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
                let known = EXTENSIONS.iter().any(|known| known.eq_ignore_ascii_case(extension));
                known && path.file_stem().and_then(|stem| stem.to_str()).is_some_and(&is_wanted)
            });
            names.sort();
            let path = folder.join(names.into_iter().find(|name| folder.join(name).is_file())?);
            Some((path.display().to_string(), read(&path).ok()?))
        })
    }
}

impl Subprograms for Folders {
    /// `O1000.nc`, `1000`, `O01000.NC`: the digits count, not how many zeros stand before them.
    fn numbered(&mut self, number: u32) -> Option<(String, Vec<u8>)> {
        self.find(|stem| {
            let digits = stem.strip_prefix(['O', 'o']).unwrap_or(stem);
            digits.len() <= 8 && digits.bytes().all(|byte| byte.is_ascii_digit()) && digits.parse() == Ok(number)
        })
    }

    fn named(&mut self, name: &str) -> Option<(String, Vec<u8>)> {
        self.find(|stem| stem.eq_ignore_ascii_case(name))
    }
}

fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let length = fs::File::open(path)?.take(LARGEST + 1).read_to_end(&mut bytes)?;
    if length as u64 > LARGEST { Err(io::Error::other("too long")) } else { Ok(bytes) }
}
