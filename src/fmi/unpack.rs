//! An FMU's archive, unpacked into a folder of its own.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use tempfile::TempDir;
use zip::ZipArchive;

use super::description::{Description, Version};
use super::error::FmuError;

/// A description is text that people can read: longer is a bomb.
const LONGEST_DESCRIPTION: u64 = 64 << 20;
/// An archive that unpacks to more is none of a machine.
const LARGEST: u64 = 4 << 30;

const DESCRIPTION: &str = "modelDescription.xml";

/// An FMU on the disk; its folder goes with it.
#[derive(Debug)]
pub(super) struct Unpacked {
    pub(super) folder: TempDir,
    pub(super) description: Description,
}

/// Reads the description first: of what is no plant nothing is unpacked.
pub(super) fn unpack(path: &Path) -> Result<Unpacked, FmuError> {
    let wrong = |error: &dyn std::fmt::Display| FmuError::Archive(error.to_string());
    let file = File::open(path).map_err(|error| wrong(&error))?;
    let mut archive = ZipArchive::new(file).map_err(|error| wrong(&error))?;
    let mut text = String::new();
    {
        let entry = archive.by_name(DESCRIPTION).map_err(|_| wrong(&"it has no modelDescription.xml"))?;
        entry.take(LONGEST_DESCRIPTION).read_to_string(&mut text).map_err(|error| wrong(&error))?;
    }
    let description = Description::read(&text)?;
    let folder = TempDir::with_prefix("rigidtap-fmu-").map_err(|error| wrong(&error))?;
    let mut left = LARGEST;
    for index in 0..archive.len() {
        let mut entry = archive.by_index(index).map_err(|error| wrong(&error))?;
        // A name that leads out of the folder is nobody's who means well.
        let Some(inside) = entry.enclosed_name() else {
            return Err(wrong(&format!("its entry {index} leads out of it")));
        };
        let target = folder.path().join(inside);
        if entry.is_dir() {
            std::fs::create_dir_all(&target).map_err(|error| wrong(&error))?;
            continue;
        }
        let written = target
            .parent()
            .map_or(Ok(()), std::fs::create_dir_all)
            .and_then(|()| io::copy(&mut (&mut entry).take(left), &mut File::create(&target)?))
            .map_err(|error| wrong(&error))?;
        left = left.saturating_sub(written);
        if left == 0 {
            return Err(wrong(&"it unpacks to more than 4 GB"));
        }
    }
    Ok(Unpacked { folder, description })
}

/// The shared library for this computer, by its path in the archive.
pub(super) fn library_path(description: &Description) -> String {
    let (two, three) = match (std::env::consts::OS, std::env::consts::ARCH) {
        ("linux", "x86_64") => ("linux64", "x86_64-linux"),
        ("linux", "aarch64") => ("aarch64-linux", "aarch64-linux"),
        ("macos", "x86_64") => ("darwin64", "x86_64-darwin"),
        ("macos", "aarch64") => ("darwin64", "aarch64-darwin"),
        ("windows", "x86_64") => ("win64", "x86_64-windows"),
        _ => ("unknown", "unknown"),
    };
    let folder = if description.version == Version::Two { two } else { three };
    let suffix = std::env::consts::DLL_SUFFIX;
    format!("binaries/{folder}/{}{suffix}", description.model_identifier)
}
