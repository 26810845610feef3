//! What the program says of itself: schemas, completions, manual pages.

use clap::CommandFactory;

use crate::report::json::schema as schema_of;

use super::args::{Cli, CompletionsArgs, ManArgs, SchemaArgs};
use super::outcome::{Outcome, Stop, print, print_json};

/// The JSON Schema of a subcommand's answers.
pub(super) fn schema(args: &SchemaArgs) -> Result<Outcome, Stop> {
    let schema = schema_of(&args.subcommand);
    // The command line's own rules leave no other name.
    print_json(&schema.ok_or_else(|| Stop::Usage(format!("{} has no answer in JSON", args.subcommand)))?)?;
    Ok(Outcome::Good)
}

/// Completions for a shell.
pub(super) fn completions(args: &CompletionsArgs) -> Result<Outcome, Stop> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "rigidtap", &mut text);
    print(&String::from_utf8_lossy(&text))?;
    Ok(Outcome::Good)
}

/// A manual page.
pub(super) fn man(args: &ManArgs) -> Result<Outcome, Stop> {
    // Built, subcommands have the common options, too.
    let mut whole = Cli::command();
    whole.build();
    let page = match &args.subcommand {
        None => whole,
        Some(name) => {
            let found = whole.find_subcommand(name).cloned();
            let found =
                found.ok_or_else(|| Stop::Usage(format!("there is no subcommand {name}: see rigidtap --help")))?;
            let title = found.get_display_name().unwrap_or(name).to_owned();
            found.display_name(title)
        }
    };
    let mut text = Vec::new();
    let written = clap_mangen::Man::new(page).render(&mut text);
    written.map_err(|error| Stop::Output { name: "the manual page".into(), error })?;
    print(&String::from_utf8_lossy(&text))?;
    Ok(Outcome::Good)
}
