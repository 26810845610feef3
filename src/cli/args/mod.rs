//! The command line's words.

mod advise;
mod common;
mod machine;
mod programs;
mod shared;
mod values;

use clap::{Args, Parser, Subcommand};

pub(super) use advise::AdviseArgs;
pub(super) use common::{ColorChoice, Common, Format};
pub(super) use machine::{MachineArgs, MonitorArgs, TuneArgs};
pub(super) use programs::{CheckArgs, CompareArgs, PlanArgs, SimulateArgs, SweepArgs};
pub(super) use shared::{Identify, OverrideArgs, PlantArgs, Supervision, TapArgs};
pub(super) use values::Without;

use crate::report::json::SUBCOMMANDS;

/// What `rigidtap` alone says.
pub(super) const FIRST_STEPS: &str = "\
rigidtap: rigid tapping, from G-code to the synchronisation error of spindle and Z

  rigidtap check mine.ngc           what is wrong with a program, with line and column
  rigidtap simulate mine.ngc        time, error and verdict of each hole
  rigidtap machine > mine.toml      a machine file of your own, to change and to pass by --machine

rigidtap --help lists all subcommands; rigidtap help SUBCOMMAND tells more.
";

/// Rigid tapping: from G-code to the synchronisation error of spindle and Z.
#[derive(Debug, Parser)]
#[command(name = "rigidtap", version, allow_negative_numbers = true, max_term_width = 100, subcommand_required = true)]
pub(super) struct Cli {
    #[command(flatten)]
    pub(super) common: Common,
    #[command(subcommand)]
    pub(super) command: Command,
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
        after_help = "Examples:\n  rigidtap simulate gcode/s7000.ngc --law torque-curve --plot e.svg --trace e.csv\n  rigidtap simulate gcode/s3000.ngc --power-loss 1.2\n  rigidtap simulate gcode/s3000.ngc --power-loss 1.2,dead"
    )]
    Simulate(SimulateArgs),
    /// Run the same programs side by side: every combination of the lists
    #[command(
        after_help = "Example:\n  rigidtap compare gcode/s3000.ngc gcode/s5000.ngc gcode/s7000.ngc --laws s-curve,torque-curve"
    )]
    Compare(CompareArgs),
    /// Tap a hole on many machines that differ from the nominal one: percentiles, and the worst machine
    #[command(
        after_help = "The machines are drawn from the machine file's [spread]. Ctrl-C gives the sweep up: nothing is written, exit code 130.\n\nExamples:\n  rigidtap sweep gcode/s7000.ngc --runs 10000 --save-worst worst.toml\n  rigidtap sweep gcode/s7000.ngc --nominal --runs 100\n  rigidtap sweep gcode/s7000.ngc --runs 10000 --shard 3/8 --out 3.part\n  rigidtap sweep gcode/s7000.ngc --runs 10000 --merge *.part\n  rigidtap sweep gcode/s7000.ngc --hard --worst --save-worst worst.toml"
    )]
    Sweep(SweepArgs),
    /// Advise what to set: the fastest S and law that hold on this machine, what they save, and what limits them
    #[command(
        after_help = "One hole of each kind is tapped on machines drawn from the machine file's [spread]. Nothing in the program or the machine file is changed.\n\nExamples:\n  rigidtap advise mine.ngc --machine mine.toml\n  rigidtap advise mine.ngc --present s-curve --parts-per-year 50000\n  rigidtap advise mine.ngc --control siemens"
    )]
    Advise(AdviseArgs),
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
    #[command(
        after_help = "Examples:\n  rigidtap machine > mine.toml\n  rigidtap machine --new > mine.toml\n  rigidtap machine --new --power-kw 7.5 --rated-rpm 3000 --max-rpm 12000 --run-up-s 0.6 --rapid-m-per-min 36 --accel-m-per-s2 8 > mine.toml"
    )]
    Machine(MachineArgs),
    /// Print the JSON Schema of a subcommand's --format json
    #[command(after_help = "Example:\n  rigidtap schema simulate > simulate.schema.json")]
    Schema(SchemaArgs),
    /// Print completions for a shell
    #[command(
        after_help = "Example:\n  rigidtap completions bash > ~/.local/share/bash-completion/completions/rigidtap"
    )]
    Completions(CompletionsArgs),
    /// Print the manual page, of rigidtap or of one subcommand
    #[command(after_help = "Example:\n  rigidtap man simulate | man -l -")]
    Man(ManArgs),
    /// Make an FMU of our machine or of our synchronizer, for other people's simulators
    #[cfg(all(feature = "fmi", unix))]
    #[command(
        after_help = "The library is built by `cargo rustc --release --lib --features fmi --crate-type cdylib`.\n\nExamples:\n  rigidtap fmu plant plant.fmu --machine mine.toml\n  rigidtap fmu control gcode/s7000.ngc control.fmu --law torque-curve-smooth"
    )]
    Fmu(FmuArgs),
    /// The process of an FMU: called by --plant alone
    #[cfg(all(feature = "fmi", unix))]
    #[command(hide = true)]
    FmuHost(FmuHostArgs),
}

#[cfg(all(feature = "fmi", unix))]
#[derive(Args, Debug)]
pub(super) struct FmuArgs {
    #[command(subcommand)]
    pub(super) command: FmuCommand,
}

#[cfg(all(feature = "fmi", unix))]
#[derive(Debug, Subcommand)]
pub(super) enum FmuCommand {
    /// The simulated machine
    Plant(FmuPlantArgs),
    /// The synchronizer with a program
    Control(FmuControlArgs),
}

#[cfg(all(feature = "fmi", unix))]
#[derive(Args, Debug)]
pub(super) struct FmuPlantArgs {
    /// The FMU
    #[arg(value_name = "OUT.fmu")]
    pub(super) out: std::path::PathBuf,
    /// This crate as a shared library; the one beside rigidtap without it
    #[arg(long, value_name = "LIBRARY")]
    pub(super) library: Option<std::path::PathBuf>,
    #[command(flatten)]
    pub(super) tap: TapArgs,
    #[command(flatten)]
    pub(super) plant: PlantArgs,
}

#[cfg(all(feature = "fmi", unix))]
#[derive(Args, Debug)]
pub(super) struct FmuControlArgs {
    /// Program, all in one file
    #[arg(value_name = "FILE")]
    pub(super) file: std::path::PathBuf,
    /// The FMU
    #[arg(value_name = "OUT.fmu")]
    pub(super) out: std::path::PathBuf,
    /// This crate as a shared library; the one beside rigidtap without it
    #[arg(long, value_name = "LIBRARY")]
    pub(super) library: Option<std::path::PathBuf>,
    #[command(flatten)]
    pub(super) tap: TapArgs,
    #[command(flatten)]
    pub(super) plant: PlantArgs,
}

#[cfg(all(feature = "fmi", unix))]
#[derive(Args, Debug)]
pub(super) struct FmuHostArgs {
    /// Folder that the FMU was unpacked into
    pub(super) folder: std::path::PathBuf,
}

#[derive(Args, Debug)]
pub(super) struct SchemaArgs {
    /// Subcommand that answers in JSON
    #[arg(value_name = "SUBCOMMAND", value_parser = clap::builder::PossibleValuesParser::new(SUBCOMMANDS))]
    pub(super) subcommand: String,
}

#[derive(Args, Debug)]
pub(super) struct CompletionsArgs {
    /// Shell
    #[arg(value_name = "SHELL", value_enum)]
    pub(super) shell: clap_complete::Shell,
}

#[derive(Args, Debug)]
pub(super) struct ManArgs {
    /// Subcommand; rigidtap itself without it
    #[arg(value_name = "SUBCOMMAND")]
    pub(super) subcommand: Option<String>,
}
