//! The command line's words.

use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

use crate::control::machine::Law;
use crate::control::model::cutting::Material;
use crate::control::profile::MAX_BANDS;
use crate::control::sync::{Compensation, Mode, Settings};
use crate::run::RunSettings;
use crate::sim::{Effect, Fault, Injection, MOST_FAULTS};
use crate::study::STROKES_REV;

/// Rigid tapping: from G-code to the synchronisation error of spindle and Z.
#[derive(Debug, Parser)]
#[command(
    name = "rigidtap",
    version,
    allow_negative_numbers = true,
    max_term_width = 100,
    subcommand_required = true,
    arg_required_else_help = true
)]
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
    /// Skip blocks that begin with /, as the control's switch does
    #[arg(long, global = true)]
    pub(super) block_delete: bool,
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
    /// Tap a hole on many machines that differ from the nominal one: percentiles, and the worst machine
    #[command(
        after_help = "The machines are drawn from the machine file's [spread]. Ctrl-C gives the sweep up: nothing is written, exit code 130.\n\nExamples:\n  rigidtap sweep gcode/s7000.ngc --runs 10000 --save-worst worst.toml\n  rigidtap sweep gcode/s7000.ngc --nominal --runs 100"
    )]
    Sweep(SweepArgs),
    /// Tune torque-curve's speed bands or the synchronizer's gains, or identify the machine; TOML ready to paste
    #[command(
        after_help = "The bands use law.motor_share of the motor. Prices are stroke times over the fastest stroke at the same share.\n\nExamples:\n  rigidtap tune\n  rigidtap tune --bands 6 --stroke-rev 8,12.5\n  rigidtap tune --run-up gcode/machines/run_up.csv\n  rigidtap tune --gains --machine mine.toml\n  rigidtap tune --identify\n  rigidtap tune --dry-cycle > dry.ngc\n  rigidtap simulate dry.ngc --material none --trace dry.csv\n  rigidtap tune --identify dry.csv"
    )]
    Tune(TuneArgs),
    /// e(k) and a verdict for each hole of real encoders: a recording, or a board on a serial line
    #[command(
        after_help = "Examples:\n  rigidtap monitor e.csv\n  rigidtap monitor scope.csv --pitch 1 --map \"time=t[ms],spindle=enc0[counts/16384],z=enc1[counts/10000]\"\n  rigidtap monitor --serial /dev/ttyUSB0 --pitch 1\n  rigidtap monitor --simulate-board gcode/s7000.ngc"
    )]
    Monitor(MonitorArgs),
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

/// What `simulate` and `compare` share: programs and their picture.
#[derive(Args, Debug)]
pub(super) struct ProgramArgs {
    /// Programs; - is standard input
    #[arg(required = true, value_name = "FILE")]
    pub(super) files: Vec<PathBuf>,
    /// Draw e(k) over k as SVG
    #[arg(long, value_name = "OUT.svg")]
    pub(super) plot: Option<PathBuf>,
}

/// What `simulate`, `compare` and `sweep` share: the plant and the work piece.
#[derive(Args, Debug)]
pub(super) struct PlantArgs {
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
    #[command(flatten)]
    pub(super) adapting: AdaptArgs,
    #[command(flatten)]
    pub(super) overrides: OverrideArgs,
}

/// What the synchronizer may take from the machine itself, under compensation = full.
#[derive(Args, Clone, Copy, Debug)]
pub(super) struct AdaptArgs {
    /// What the machine is known by beside its file: nothing, the program's own approach, or a dry cycle in air before
    /// the first hole (--identify alone)
    #[arg(long, value_enum, num_args = 0..=1, require_equals = true, default_value_t = Identify::Approach, default_missing_value = "dry-cycle")]
    pub(super) identify: Identify,
    /// Learn from hole to hole of the same kind
    #[arg(long)]
    pub(super) learn: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Identify {
    None,
    Approach,
    DryCycle,
}

impl AdaptArgs {
    /// The run that these words ask for.
    pub(super) fn run(self, mode: Mode, compensation: Compensation) -> RunSettings {
        let sync = Settings { mode, compensation, identify: self.identify != Identify::None, learn: self.learn };
        RunSettings { sync, dry_cycle: self.identify == Identify::DryCycle, ..RunSettings::default() }
    }
}

/// What `simulate` and `sweep` share: how each hole is tapped.
#[derive(Args, Debug)]
pub(super) struct TapArgs {
    /// Time law of the strokes
    #[arg(long, value_enum, default_value_t = Law::TorqueCurve)]
    pub(super) law: Law,
    /// Share of the motor that torque-curve's bands are retuned to; the file's bands without it
    #[arg(long, value_name = "X", value_parser = share)]
    pub(super) share: Option<f64>,
    /// What Z follows
    #[arg(long, value_enum, default_value_t = Mode::Commanded)]
    pub(super) sync: Mode,
    /// How Z is corrected by e(k)
    #[arg(long, value_enum, default_value_t = Compensation::Full)]
    pub(super) compensation: Compensation,
    /// Effects that the plant lacks
    #[arg(long, value_name = "EFFECT", value_enum, value_delimiter = ',')]
    pub(super) without: Vec<Effect>,
}

#[derive(Args, Debug)]
pub(super) struct SimulateArgs {
    #[command(flatten)]
    pub(super) program: ProgramArgs,
    #[command(flatten)]
    pub(super) plant: PlantArgs,
    #[command(flatten)]
    pub(super) tap: TapArgs,
    /// Write every period as CSV
    #[arg(long, value_name = "OUT.csv")]
    pub(super) trace: Option<PathBuf>,
    /// Let this go wrong at a time from the program's start; up to four times; --help lists the names
    #[arg(long, value_name = "NAME@S", value_delimiter = ',', value_parser = injection, long_help = fault_help())]
    pub(super) fault: Vec<Injection>,
}

#[derive(Args, Debug)]
pub(super) struct SweepArgs {
    /// Program, whose first hole each machine taps; - is standard input
    #[arg(value_name = "FILE")]
    pub(super) file: PathBuf,
    /// Number of machines
    #[arg(long, value_name = "N", default_value = "1000", value_parser = runs)]
    pub(super) runs: NonZeroU32,
    /// How often each machine taps the hole; 10 with --learn and 1 without it
    #[arg(long, value_name = "N", value_parser = holes)]
    pub(super) holes: Option<NonZeroU32>,
    /// Machines as the file says, which differ in what is random alone
    #[arg(long)]
    pub(super) nominal: bool,
    /// Draw what real machines have beside that, too: the machine file's [spread.hard]
    #[arg(long, conflicts_with = "nominal")]
    pub(super) hard: bool,
    /// Number of threads; one on each core without it. The results do not depend on it
    #[arg(long, value_name = "N", value_parser = jobs)]
    pub(super) jobs: Option<NonZeroUsize>,
    /// Write every machine as CSV: what was drawn, its seed, its results
    #[arg(long, value_name = "OUT.csv")]
    pub(super) csv: Option<PathBuf>,
    /// Draw the distribution of the first hole's error as SVG
    #[arg(long, value_name = "OUT.svg")]
    pub(super) plot: Option<PathBuf>,
    /// Write the machine with the worst first hole as a machine file, its seed in the first lines
    #[arg(long, value_name = "OUT.toml")]
    pub(super) save_worst: Option<PathBuf>,
    #[command(flatten)]
    pub(super) plant: PlantArgs,
    #[command(flatten)]
    pub(super) tap: TapArgs,
}

#[derive(Args, Debug)]
pub(super) struct CompareArgs {
    #[command(flatten)]
    pub(super) program: ProgramArgs,
    #[command(flatten)]
    pub(super) plant: PlantArgs,
    /// Time laws
    #[arg(long, visible_alias = "law", value_name = "LAW", value_enum, value_delimiter = ',', default_values_t = [Law::SCurve, Law::TorqueCurve])]
    pub(super) laws: Vec<Law>,
    /// Synchronisation modes
    #[arg(long, visible_alias = "sync", value_name = "SYNC", value_enum, value_delimiter = ',', default_values_t = [Mode::Commanded])]
    pub(super) syncs: Vec<Mode>,
    /// Compensations
    #[arg(long, visible_alias = "compensation", value_name = "COMPENSATION", value_enum, value_delimiter = ',', default_values_t = [Compensation::Full])]
    pub(super) compensations: Vec<Compensation>,
    /// Motor shares; torque-curve's bands are retuned for each
    #[arg(long, visible_alias = "share", value_name = "X", value_delimiter = ',', value_parser = share)]
    pub(super) shares: Vec<f64>,
    /// Effects to switch off, one at a time, beside the full plant; `each` is all of them
    #[arg(long, value_name = "EFFECT", value_delimiter = ',')]
    pub(super) without: Vec<Without>,
}

#[derive(Args, Debug)]
pub(super) struct TuneArgs {
    /// Number of bands, up to 16
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = band_count)]
    pub(super) bands: usize,
    /// Strokes that matter, in revolutions, at the spindle's greatest speed
    #[arg(long, value_name = "R", value_delimiter = ',', default_values_t = STROKES_REV, value_parser = positive)]
    pub(super) stroke_rev: Vec<f64>,
    /// Tune for a recorded run-up instead of the machine file's torque curve: CSV of time_s and rpm with the whole
    /// motor, from standstill to the greatest speed; - is standard input
    #[arg(long, value_name = "LOG.csv")]
    pub(super) run_up: Option<PathBuf>,
    /// Identify the machine instead: friction, lost motion, inertia, from a trace of it, or from a dry cycle on the
    /// simulated machine; - is standard input
    #[arg(long, value_name = "TRACE.csv", num_args = 0..=1, conflicts_with_all = BAND_WORDS)]
    pub(super) identify: Option<Option<PathBuf>>,
    /// Print the dry cycle that shows all of this: a program for air, to be recorded on a machine or under simulate
    #[arg(long, conflicts_with_all = BAND_WORDS, conflicts_with = "identify")]
    pub(super) dry_cycle: bool,
    /// Print the [sync] table that the documented rules give this machine
    #[arg(long, conflicts_with_all = BAND_WORDS, conflicts_with_all = ["identify", "dry_cycle"])]
    pub(super) gains: bool,
    /// Seed of everything random in the simulated machine's dry cycle; 1 without it
    #[arg(long, value_name = "N", requires = "identify")]
    pub(super) seed: Option<u64>,
}

/// The words of `tune` that speak of bands.
const BAND_WORDS: [&str; 3] = ["bands", "stroke_rev", "run_up"];

#[derive(Args, Debug)]
pub(super) struct MonitorArgs {
    /// Recording: a trace of simulate, halsampler's output, or any CSV with --map; - is standard input
    #[arg(value_name = "TRACE.csv", required_unless_present_any = ["serial", "simulate_board"], conflicts_with_all = ["serial", "simulate_board"])]
    pub(super) file: Option<PathBuf>,
    /// Serial port of a board that streams both encoders
    #[arg(long, value_name = "PORT", requires = "pitch", conflicts_with = "simulate_board")]
    pub(super) serial: Option<String>,
    /// Be that board: open a pseudo-terminal, print its path, and tap this program on the simulated machine, again and again
    #[arg(long, value_name = "PROGRAM")]
    pub(super) simulate_board: Option<PathBuf>,
    /// Its readings per second; one each interpolation period without it
    #[arg(long, value_name = "HZ", requires = "simulate_board", value_parser = rate)]
    pub(super) rate: Option<f64>,
    /// Baud rate of the port
    #[arg(long, value_name = "BAUD", default_value_t = 921_600, value_parser = clap::value_parser!(u32).range(300..))]
    pub(super) baud: u32,
    /// Nominal pitch in mm; of a recording, the coarse pitch that it shows without it
    #[arg(long, value_name = "MM", value_parser = pitch)]
    pub(super) pitch: Option<f64>,
    /// Columns of a recording, `what=column[unit]` for time, spindle and z
    #[arg(long, value_name = "MAP", requires = "file")]
    pub(super) map: Option<String>,
    /// End after so many holes; without it Ctrl-C ends a live monitor, with its report
    #[arg(long, value_name = "N", requires = "serial", value_parser = clap::value_parser!(u32).range(1..))]
    pub(super) holes: Option<u32>,
    /// Write every reading as CSV
    #[arg(long, value_name = "OUT.csv")]
    pub(super) trace: Option<PathBuf>,
    /// Draw e(k) over k as SVG
    #[arg(long, value_name = "OUT.svg")]
    pub(super) plot: Option<PathBuf>,
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
        if text == "each" {
            return Ok(Self::Each);
        }
        Effect::from_str(text, false).map(Self::Effect).map_err(|_| {
            let names: Vec<_> = Effect::ALL.iter().map(|effect| effect.name()).collect();
            format!("expected each, or one of {}", names.join(", "))
        })
    }
}

/// The long help of `--fault`.
fn fault_help() -> String {
    let names: Vec<_> = Fault::all().filter(|fault| !fault.is_of_the_clock()).map(|fault| fault.to_string()).collect();
    format!(
        "Let this go wrong at a time from the program's start, NAME@SECONDS, or NAME@SECONDS+DURATION; up to \
         {MOST_FAULTS} of them\n\nNames: {}",
        names.join(", ")
    )
}

/// A fault that a simulated machine can have.
fn injection(text: &str) -> Result<Injection, String> {
    let injection: Injection = text.parse()?;
    if injection.fault.is_of_the_clock() {
        return Err(format!("{} is of the host's clock, which simulate has none of", injection.fault));
    }
    Ok(injection)
}

/// A motor share, by the machine file's own range.
fn share(text: &str) -> Result<f64, String> {
    within(text, 0.0, 1.0).map_err(|_| "expected a share above 0 up to 1, such as 0.8 for 80 %".into())
}

fn positive(text: &str) -> Result<f64, String> {
    within(text, 0.0, 1e9)
}

fn runs(text: &str) -> Result<NonZeroU32, String> {
    count_to(text, 100_000_000)
}

fn holes(text: &str) -> Result<NonZeroU32, String> {
    count_to(text, 10_000)
}

fn jobs(text: &str) -> Result<NonZeroUsize, String> {
    count_to(text, 1024)?.try_into().map_err(|_| "expected a smaller number".to_owned())
}

fn count_to(text: &str, most: u32) -> Result<NonZeroU32, String> {
    let count = text.parse().ok().filter(|count: &NonZeroU32| count.get() <= most);
    count.ok_or_else(|| format!("expected a whole number from 1 to {most}"))
}

fn band_count(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MAX_BANDS).contains(count));
    count.ok_or_else(|| format!("expected a whole number from 1 to {MAX_BANDS}"))
}

fn pitch(text: &str) -> Result<f64, String> {
    within(text, 0.0, 100.0)
}

fn rate(text: &str) -> Result<f64, String> {
    within(text, 9.0, 10_000.0)
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
