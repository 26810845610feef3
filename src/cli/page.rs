//! The reports that a browser shows.

use serde::Serialize;

use super::args::Common;
use super::input;
use super::outcome::Stop;
use super::output::Output;
use crate::report::page::{Heading, Page};
use crate::report::printable;

/// The heading of a page, with the words that this process was called with.
pub(super) fn heading(
    common: &Common,
    title: &str,
    verdict: Option<&'static str>,
    summary: Vec<String>,
    seed: Option<u64>,
) -> Heading {
    let words = std::env::args().skip(1).map(|word| printable(&word).into_owned());
    let command = std::iter::once("rigidtap".to_owned()).chain(words).collect::<Vec<_>>().join(" ");
    let machine = common.machine.as_deref().map_or_else(|| "built-in".to_owned(), input::name);
    Heading { title: title.to_owned(), verdict, summary, machine, seed, command }
}

/// Writes a page with the answer in it.
pub(super) fn write(output: &mut Output, page: Page, answer: &impl Serialize) -> Result<(), Stop> {
    let text = page.finish(answer).map_err(|error| Stop::Usage(format!("the report cannot be written: {error}")))?;
    output.write(&text)
}
