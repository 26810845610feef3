//! What every subcommand takes.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

/// What every subcommand takes.
#[derive(Args, Debug)]
#[command(next_help_heading = "Common options")]
pub(in crate::cli) struct Common {
    /// Machine file; the built-in reference machine without it
    #[arg(long, global = true, value_name = "FILE")]
    pub(in crate::cli) machine: Option<PathBuf>,
    /// G-code dialect, or auto: what each program looks like; the machine file's without it
    #[arg(long, global = true, value_name = "NAME")]
    pub(in crate::cli) dialect: Option<String>,
    /// Folder with further subprograms, behind the program's own folder; more than one in the order of their search
    #[arg(long, global = true, value_name = "DIR")]
    pub(in crate::cli) subprograms: Vec<PathBuf>,
    /// Skip blocks that begin with /, as the control's switch does
    #[arg(long, global = true)]
    pub(in crate::cli) block_delete: bool,
    /// Table for people, or JSON alone on standard output
    #[arg(long, global = true, value_enum, default_value_t = Format::Table)]
    pub(in crate::cli) format: Format,
    /// Tables with all their columns, however wide
    #[arg(long, global = true)]
    pub(in crate::cli) wide: bool,
    /// No warnings, no progress
    #[arg(short, long, global = true)]
    pub(in crate::cli) quiet: bool,
    /// More about what is done, on standard error; twice for detail
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub(in crate::cli) verbose: u8,
    /// Colour in messages; NO_COLOR is obeyed
    #[arg(long, global = true, value_enum, default_value_t = ColorChoice::Auto)]
    pub(in crate::cli) color: ColorChoice,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Format {
    Table,
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum ColorChoice {
    Auto,
    Always,
    Never,
}
