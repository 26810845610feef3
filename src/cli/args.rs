//! The command line's words.

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::control::machine::Law;
use crate::control::model::cutting::Material;
use crate::control::sync::{Compensation, Mode};
use crate::sim::Effect;

/// Rigid tapping: from G-code to the synchronisation error of spindle and Z.
#[derive(Debug, Parser)]
#[command(name = "rigidtap", version, max_term_width = 100, subcommand_required = true, arg_required_else_help = true)]
pub(super) struct Cli {
    #[command(flatten)]
    pub(super) common: Common,
    #[command(subcommand)]
    pub(super) command: Command,
}

#[derive(Args, Debug)]
pub(super) struct Common {
    /// Machine file; the built-in reference machine without it
    #[arg(long, global = true, value_name = "FILE")]
    pub(super) machine: Option<PathBuf>,
    /// G-code dialect; the machine file's without it
    #[arg(long, global = true, value_name = "NAME")]
    pub(super) dialect: Option<String>,
    /// Table for people, or JSON alone on standard output
    #[arg(long, global = true, value_enum, default_value_t = Format::Table)]
    pub(super) format: Format,
    /// No warnings, no progress
    #[arg(short, long, global = true)]
    pub(super) quiet: bool,
    /// More about what is done, on standard error; twice for detail
    #[arg(short, long, global = true, action = clap::ArgAction::Count)]
    pub(super) verbose: u8,
    /// Colour in messages; NO_COLOR is obeyed
    #[arg(long, global = true, value_enum, default_value_t = ColorChoice::Auto)]
    pub(super) color: ColorChoice,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    Table,
    Json,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum ColorChoice {
    Auto,
    Always,
    Never,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Parse, interpret and check programs against the machine; nothing moves
    #[command(after_help = "Examples:\n  rigidtap check gcode/s3000.ngc --canon\n  rigidtap check --explain G423")]
    Check(CheckArgs),
    /// Show a program's timeline, or one stroke's plan
    #[command(
        after_help = "Examples:\n  rigidtap plan gcode/s7000.ngc\n  rigidtap plan --stroke-rev 25 --speed-rpm 7000 --law s-curve"
    )]
    Plan(PlanArgs),
    /// Run programs against the simulated machine: e(k) and a verdict for each hole
    #[command(
        after_help = "Example:\n  rigidtap simulate gcode/s7000.ngc --law torque-curve --plot e.svg --trace e.csv"
    )]
    Simulate(SimulateArgs),
    /// Run the same programs side by side: every combination of the lists
    #[command(
        after_help = "Example:\n  rigidtap compare gcode/s3000.ngc gcode/s5000.ngc gcode/s7000.ngc --laws s-curve,torque-curve"
    )]
    Compare(CompareArgs),
    /// Print the machine file in use, commented; a file of one's own starts as its copy
    #[command(after_help = "Example:\n  rigidtap machine > mine.toml")]
    Machine,
}

#[derive(Args, Debug)]
pub(super) struct CheckArgs {
    /// Programs; - is standard input
    #[arg(required_unless_present = "explain", value_name = "FILE")]
    pub(super) files: Vec<PathBuf>,
    /// Print the canonical commands, one a line
    #[arg(long)]
    pub(super) canon: bool,
    /// Tell the long story of a diagnostic's code, and check nothing
    #[arg(long, value_name = "CODE", conflicts_with = "files")]
    pub(super) explain: Option<String>,
}

#[derive(Args, Debug)]
pub(super) struct PlanArgs {
    /// Program; - is standard input
    #[arg(value_name = "FILE", required_unless_present = "stroke_rev", conflicts_with = "stroke_rev")]
    pub(super) file: Option<PathBuf>,
    /// One stroke of this many revolutions
    #[arg(long, value_name = "R", requires = "speed_rpm", value_parser = positive)]
    pub(super) stroke_rev: Option<f64>,
    /// Its commanded speed
    #[arg(long, value_name = "N", requires = "stroke_rev", value_parser = positive)]
    pub(super) speed_rpm: Option<f64>,
    /// Time law
    #[arg(long, value_enum, default_value_t = Law::TorqueCurve)]
    pub(super) law: Law,
    /// Draw it as SVG
    #[arg(long, value_name = "OUT.svg")]
    pub(super) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(super) overrides: OverrideArgs,
}

#[derive(Args, Debug)]
pub(super) struct OverrideArgs {
    /// Rapid override in percent; synchronous strokes ignore it
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0, value_parser = override_to_100)]
    pub(super) rapid_override: f64,
    /// Feed override in percent; synchronous strokes ignore it
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0, value_parser = override_to_200)]
    pub(super) feed_override: f64,
}

/// What `simulate` and `compare` share: the plant and the work piece.
#[derive(Args, Debug)]
pub(super) struct PlantArgs {
    /// Programs; - is standard input
    #[arg(required = true, value_name = "FILE")]
    pub(super) files: Vec<PathBuf>,
    /// Plant without any imperfection but the encoders' whole counts
    #[arg(long)]
    pub(super) ideal: bool,
    /// Seed of everything random
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Tap by its designation; that of the program's pitch without it
    #[arg(long, value_name = "M6")]
    pub(super) tap: Option<String>,
    /// What is tapped; the machine file's without it
    #[arg(long, value_enum)]
    pub(super) material: Option<Material>,
    /// Draw e(k) over k as SVG
    #[arg(long, value_name = "OUT.svg")]
    pub(super) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(super) overrides: OverrideArgs,
}

#[derive(Args, Debug)]
pub(super) struct SimulateArgs {
    #[command(flatten)]
    pub(super) plant: PlantArgs,
    /// Time law of the strokes
    #[arg(long, value_enum, default_value_t = Law::TorqueCurve)]
    pub(super) law: Law,
    /// Share of the motor that torque-curve's bands are retimed to; the file's bands without it
    #[arg(long, value_name = "X", value_parser = positive)]
    pub(super) share: Option<f64>,
    /// What Z follows
    #[arg(long, value_enum, default_value_t = Mode::Commanded)]
    pub(super) sync: Mode,
    /// How Z is corrected by e(k)
    #[arg(long, value_enum, default_value_t = Compensation::None)]
    pub(super) compensation: Compensation,
    /// Effects that the plant lacks
    #[arg(long, value_name = "EFFECT", value_enum, value_delimiter = ',')]
    pub(super) without: Vec<Effect>,
    /// Write every period as CSV
    #[arg(long, value_name = "OUT.csv")]
    pub(super) trace: Option<PathBuf>,
}

#[derive(Args, Debug)]
pub(super) struct CompareArgs {
    #[command(flatten)]
    pub(super) plant: PlantArgs,
    /// Time laws
    #[arg(long, visible_alias = "law", value_name = "LAW", value_enum, value_delimiter = ',', default_values_t = [Law::SCurve, Law::TorqueCurve])]
    pub(super) laws: Vec<Law>,
    /// Synchronisation modes
    #[arg(long, visible_alias = "sync", value_name = "SYNC", value_enum, value_delimiter = ',', default_values_t = [Mode::Commanded])]
    pub(super) syncs: Vec<Mode>,
    /// Compensations
    #[arg(long, visible_alias = "compensation", value_name = "COMPENSATION", value_enum, value_delimiter = ',', default_values_t = [Compensation::None])]
    pub(super) compensations: Vec<Compensation>,
    /// Motor shares; torque-curve's bands are retimed for each
    #[arg(long, visible_alias = "share", value_name = "X", value_delimiter = ',', value_parser = positive)]
    pub(super) shares: Vec<f64>,
    /// Effects that the plant lacks, all at once; `each` switches them off one by one
    #[arg(long, value_name = "EFFECT", value_delimiter = ',')]
    pub(super) without: Vec<Without>,
}

/// An effect, or each of them in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Without {
    Each,
    Effect(Effect),
}

impl std::str::FromStr for Without {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "each" { Ok(Self::Each) } else { Effect::from_str(text, false).map(Self::Effect) }
    }
}

fn positive(text: &str) -> Result<f64, String> {
    within(text, 0.0, 1e9)
}

fn override_to_100(text: &str) -> Result<f64, String> {
    within(text, 0.0, 100.0)
}

fn override_to_200(text: &str) -> Result<f64, String> {
    within(text, 0.0, 200.0)
}

fn within(text: &str, above: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > above && value <= high => Ok(value),
        _ => Err(format!("expected a number above {above} up to {high}")),
    }
}

/// Makes an enumeration of the library a word of the command line, by the names it already has.
macro_rules! named_values {
    ($($kind:ty),*) => {$(
        impl ValueEnum for $kind {
            fn value_variants<'a>() -> &'a [Self] {
                &Self::ALL
            }

            fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
                Some(clap::builder::PossibleValue::new(self.name()))
            }
        }
    )*};
}
named_values!(Law, Mode, Compensation, Material, Effect);
