//! What the subcommands take that read programs.

use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;

use clap::Args;
use clap::builder::{PathBufValueParser, TypedValueParser};

use super::shared::{OverrideArgs, PlantArgs, ProgramArgs, TapArgs};
use super::values::{Without, fault_help, holes, html, injection, jobs, positive, power_cut, runs, share, svg};
use crate::control::machine::Law;
use crate::control::sync::{Compensation, Mode};
use crate::run::PowerCut;
use crate::sim::Injection;
use crate::study::Shard;

#[derive(Args, Debug)]
pub(in crate::cli) struct CheckArgs {
    /// Programs; - is standard input
    #[arg(required_unless_present = "explain", value_name = "FILE")]
    pub(in crate::cli) files: Vec<PathBuf>,
    /// Print the canonical commands, one a line
    #[arg(long)]
    pub(in crate::cli) canon: bool,
    /// Tell the long story of a diagnostic's code, and check nothing
    #[arg(long, value_name = "CODE", conflicts_with = "files")]
    pub(in crate::cli) explain: Option<String>,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct PlanArgs {
    /// Program; - is standard input
    #[arg(value_name = "FILE", required_unless_present = "stroke_rev", conflicts_with = "stroke_rev")]
    pub(in crate::cli) file: Option<PathBuf>,
    /// One stroke of this many revolutions
    #[arg(long, value_name = "R", requires = "speed_rpm", value_parser = positive)]
    pub(in crate::cli) stroke_rev: Option<f64>,
    /// Its commanded speed
    #[arg(long, value_name = "N", requires = "stroke_rev", value_parser = positive)]
    pub(in crate::cli) speed_rpm: Option<f64>,
    /// Time law
    #[arg(long, value_enum, default_value_t = Law::TorqueCurve)]
    pub(in crate::cli) law: Law,
    /// Draw it as SVG
    #[arg(long, value_name = "OUT.svg", value_parser = PathBufValueParser::new().try_map(svg))]
    pub(in crate::cli) plot: Option<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) overrides: OverrideArgs,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct SimulateArgs {
    #[command(flatten)]
    pub(in crate::cli) program: ProgramArgs,
    #[command(flatten)]
    pub(in crate::cli) tap: TapArgs,
    /// Show every hole, not the worst one and those that are not ok alone
    #[arg(long)]
    pub(in crate::cli) holes: bool,
    /// Write every period as CSV
    #[arg(long, value_name = "OUT.csv")]
    pub(in crate::cli) trace: Option<PathBuf>,
    /// Let this go wrong at a time from the program's start; up to four times; --help lists the names
    #[arg(long, value_name = "NAME@S", value_delimiter = ',', value_parser = injection, long_help = fault_help())]
    pub(in crate::cli) fault: Vec<Injection>,
    /// Cut the power at a time from the program's start, and lead the tap out of the hole after the restart: drives and host live
    /// on the DC link until both axes stand; with ,dead all is off at once, and both axes coast
    #[arg(long, value_name = "S[,dead]", value_parser = power_cut)]
    pub(in crate::cli) power_loss: Option<PowerCut>,
    /// Begin with what the holes of earlier runs taught, and keep there what these teach, for every kind of hole; the file is
    /// made where there is none. With it --learn is on
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) learned: Option<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) plant: PlantArgs,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct SweepArgs {
    /// Program, whose first hole each machine taps; - is standard input
    #[arg(value_name = "FILE")]
    pub(in crate::cli) file: PathBuf,
    /// Number of machines; 5000 with --worst
    #[arg(long, value_name = "N", default_value = "1000", default_value_if("worst", "true", "5000"), value_parser = runs)]
    pub(in crate::cli) runs: NonZeroU32,
    /// How often each machine taps the hole; 10 with --learn and 1 without it
    #[arg(long, value_name = "N", value_parser = holes)]
    pub(in crate::cli) holes: Option<NonZeroU32>,
    /// Machines as the file says, which differ in what is random alone
    #[arg(long)]
    pub(in crate::cli) nominal: bool,
    /// Draw what real machines have beside that, too: the machine file's [spread.hard]
    #[arg(long, conflicts_with = "nominal")]
    pub(in crate::cli) hard: bool,
    /// Number of threads; one on each core without it. The results do not depend on it
    #[arg(long, value_name = "N", value_parser = jobs)]
    pub(in crate::cli) jobs: Option<NonZeroUsize>,
    /// Write every machine as CSV: what was drawn, its seed, its results
    #[arg(long, value_name = "OUT.csv")]
    pub(in crate::cli) csv: Option<PathBuf>,
    /// Draw the distribution of the first hole's error as SVG
    #[arg(long, value_name = "OUT.svg", value_parser = PathBufValueParser::new().try_map(svg))]
    pub(in crate::cli) plot: Option<PathBuf>,
    /// Write one page for a browser: verdict, figures, tables, and this answer in JSON
    #[arg(long, value_name = "OUT.html", value_parser = PathBufValueParser::new().try_map(html))]
    pub(in crate::cli) report: Option<PathBuf>,
    /// Write the machine with the worst first hole as a machine file, its seed in the first lines
    #[arg(long, value_name = "OUT.toml")]
    pub(in crate::cli) save_worst: Option<PathBuf>,
    /// Search the spread for the machine with the largest error, instead of drawing at random, and tell which effects make it
    #[arg(long, conflicts_with_all = ["csv", "plot", "report", "shard", "merge", "nominal"])]
    pub(in crate::cli) worst: bool,
    /// Run part K of N of the machines alone, and write it to --out for --merge
    #[arg(long, value_name = "K/N", requires = "out", conflicts_with_all = ["csv", "plot", "report", "save_worst", "merge"])]
    pub(in crate::cli) shard: Option<Shard>,
    /// File of the part
    #[arg(long, value_name = "PART", requires = "shard")]
    pub(in crate::cli) out: Option<PathBuf>,
    /// Report the whole sweep from its parts, run with these same words, instead of running it
    #[arg(long, value_name = "PART", num_args = 1..)]
    pub(in crate::cli) merge: Vec<PathBuf>,
    #[command(flatten)]
    pub(in crate::cli) tap: TapArgs,
    #[command(flatten)]
    pub(in crate::cli) plant: PlantArgs,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct CompareArgs {
    #[command(flatten)]
    pub(in crate::cli) program: ProgramArgs,
    /// Time laws
    #[arg(long, visible_alias = "law", value_name = "LAW", value_enum, value_delimiter = ',', default_values_t = [Law::SCurve, Law::TorqueCurve])]
    pub(in crate::cli) laws: Vec<Law>,
    /// Synchronisation modes
    #[arg(long, visible_alias = "sync", value_name = "SYNC", value_enum, value_delimiter = ',', default_values_t = [Mode::Commanded])]
    pub(in crate::cli) syncs: Vec<Mode>,
    /// Compensations
    #[arg(long, visible_alias = "compensation", value_name = "COMPENSATION", value_enum, value_delimiter = ',', default_values_t = [Compensation::ModelBased])]
    pub(in crate::cli) compensations: Vec<Compensation>,
    /// Torque utilisations: shares of the motor; the laws are retuned for each
    #[arg(long, visible_alias = "share", value_name = "X", value_delimiter = ',', value_parser = share)]
    pub(in crate::cli) shares: Vec<f64>,
    /// Begin each combination with what the holes of earlier runs taught, as `simulate --learned` keeps it; the file stays as
    /// it is. With it --learn is on
    #[arg(long, value_name = "FILE")]
    pub(in crate::cli) learned: Option<PathBuf>,
    /// Effects to switch off, one at a time, beside the full plant; `each` is all of them
    #[arg(long, value_name = "EFFECT", value_delimiter = ',')]
    pub(in crate::cli) without: Vec<Without>,
    #[command(flatten)]
    pub(in crate::cli) plant: PlantArgs,
}
