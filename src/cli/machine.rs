//! `rigidtap machine`.

use crate::control::machine::Law;
use crate::report::json::MachineAnswer;

use super::answer::answer;
use super::args::{Common, Format};
use super::input;
use super::outcome::{Outcome, Stop, print, print_json};

/// Prints the machine file in use.
pub(super) fn machine(common: &Common) -> Result<Outcome, Stop> {
    let text = input::machine_file(common, &Law::ALL)?.to_toml();
    match common.format {
        Format::Table => print(&text)?,
        Format::Json => print_json(&answer(common, None, MachineAnswer::of_toml(&text)))?,
    }
    Ok(Outcome::Good)
}
