//! `rigidtap machine`.

use super::args::{Common, Format};
use super::input;
use super::outcome::{Outcome, Stop, print, print_json};

/// Prints the machine file in use.
pub(super) fn machine(common: &Common) -> Result<Outcome, Stop> {
    let text = input::machine_file(common)?.to_toml();
    match common.format {
        Format::Table => print(&text)?,
        // What was just written is TOML; its comments are for people.
        Format::Json => print_json(&toml::from_str(&text).unwrap_or_default())?,
    }
    Ok(Outcome::Good)
}
