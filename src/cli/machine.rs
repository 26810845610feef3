//! `rigidtap machine`.

use super::args::Common;
use super::input;
use super::outcome::{Outcome, Stop, print};

/// Prints the machine file in use.
pub(super) fn machine(common: &Common) -> Result<Outcome, Stop> {
    print(&input::machine_file(common)?.to_toml())?;
    Ok(Outcome::Good)
}
