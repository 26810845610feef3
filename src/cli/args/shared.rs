//! What several subcommands share.

use std::path::PathBuf;

use clap::builder::{PathBufValueParser, TypedValueParser};
use clap::{Args, ValueEnum};

use super::values::{html, override_to_100, override_to_200, share, svg};
use crate::control::cycle::StrokeKind;
use crate::control::machine::Law;
use crate::control::model::cutting::Material;
use crate::control::sync::{Compensation, Mode, Settings};
use crate::report::picture::Selection;
use crate::run::RunSettings;
use crate::sim::Effect;

/// Overrides of the control's panel.
#[derive(Args, Debug)]
#[command(next_help_heading = "Overrides")]
pub(in crate::cli) struct OverrideArgs {
    /// Rapid override in percent; synchronous strokes ignore it
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0, value_parser = override_to_100)]
    pub(in crate::cli) rapid_override: f64,
    /// Feed override in percent; synchronous strokes ignore it
    #[arg(long, value_name = "PERCENT", default_value_t = 100.0, value_parser = override_to_200)]
    pub(in crate::cli) feed_override: f64,
}

/// What `simulate` and `compare` share: programs and their picture.
#[derive(Args, Debug)]
pub(in crate::cli) struct ProgramArgs {
    /// Programs; - is standard input
    #[arg(required = true, value_name = "FILE")]
    pub(in crate::cli) files: Vec<PathBuf>,
    /// Draw e(k) over k as SVG
    #[arg(long, value_name = "OUT.svg", value_parser = PathBufValueParser::new().try_map(svg))]
    pub(in crate::cli) plot: Option<PathBuf>,
    /// Draw this hole alone, counted from 1 in each program
    #[arg(long, value_name = "N", requires = "plot", value_parser = clap::value_parser!(u32).range(1..))]
    pub(in crate::cli) hole: Option<u32>,
    /// Draw this stroke of each hole alone
    #[arg(long, value_name = "STROKE", requires = "plot", value_enum)]
    pub(in crate::cli) stroke: Option<StrokeKind>,
    /// Write one page for a browser: verdict, figures, tables, and this answer in JSON
    #[arg(long, value_name = "OUT.html", value_parser = PathBufValueParser::new().try_map(html))]
    pub(in crate::cli) report: Option<PathBuf>,
}

impl ProgramArgs {
    /// What of the programs is drawn.
    pub(in crate::cli) const fn selection(&self) -> Selection {
        Selection { hole: self.hole, stroke: self.stroke }
    }
}

/// What `simulate`, `compare` and `sweep` share: the plant and the work piece.
#[derive(Args, Debug)]
#[command(next_help_heading = "Simulated machine and work piece")]
pub(in crate::cli) struct PlantArgs {
    /// Co-simulation FMU, 2.0 or 3.0, that is the machine in place of ours
    #[cfg(all(feature = "fmi", unix))]
    #[arg(long, value_name = "MODEL.fmu")]
    pub(in crate::cli) plant: Option<PathBuf>,
    /// Plant without any imperfection but the encoders' whole counts
    #[arg(long)]
    pub(in crate::cli) ideal: bool,
    /// Seed of everything random
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(in crate::cli) seed: u64,
    /// Tap by its designation, such as M6, M10x1.25, 1/4-28, G1/8; the usual one of the program's pitch without it
    #[arg(long, value_name = "M6")]
    pub(in crate::cli) tap: Option<String>,
    /// What is tapped; the machine file's without it
    #[arg(long, value_enum)]
    pub(in crate::cli) material: Option<Material>,
    #[command(flatten)]
    pub(in crate::cli) adapting: AdaptArgs,
    #[command(flatten)]
    pub(in crate::cli) overrides: OverrideArgs,
}

/// What the synchronizer may take from the machine itself, under compensation = full.
#[derive(Args, Clone, Copy, Debug)]
#[command(next_help_heading = "Identification and learning")]
pub(in crate::cli) struct AdaptArgs {
    /// What identifies the machine beside its file: nothing, the program's own approach, or a dry cycle in air before
    /// the first hole (--identify alone)
    #[arg(long, value_enum, num_args = 0..=1, require_equals = true, default_value_t = Identify::Approach, default_missing_value = "dry-cycle")]
    pub(in crate::cli) identify: Identify,
    /// Learn from hole to hole of the same kind
    #[arg(long)]
    pub(in crate::cli) learn: bool,
    /// Whether faults are looked for and answered; off, the control believes what it is told, as the papers' does
    #[arg(long, value_enum, default_value_t = Supervision::On)]
    pub(in crate::cli) supervision: Supervision,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Supervision {
    On,
    Off,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(in crate::cli) enum Identify {
    None,
    Approach,
    DryCycle,
}

impl AdaptArgs {
    /// The run that these words ask for.
    pub(in crate::cli) fn run(self, mode: Mode, compensation: Compensation) -> RunSettings {
        let sync = Settings {
            mode,
            compensation,
            identify: self.identify != Identify::None,
            learn: self.learn,
            supervise: self.supervision == Supervision::On,
        };
        RunSettings { sync, dry_cycle: self.identify == Identify::DryCycle, ..RunSettings::default() }
    }
}

/// What `simulate` and `sweep` share: how each hole is tapped.
#[derive(Args, Debug)]
pub(in crate::cli) struct TapArgs {
    /// Time law of the strokes
    #[arg(long, value_enum, default_value_t = Law::TorqueCurve)]
    pub(in crate::cli) law: Law,
    /// Torque utilisation: share of the motor that the law is retuned to; the file's without it
    #[arg(long, value_name = "X", value_parser = share)]
    pub(in crate::cli) share: Option<f64>,
    /// What Z follows
    #[arg(long, value_enum, default_value_t = Mode::Commanded)]
    pub(in crate::cli) sync: Mode,
    /// How Z is corrected by e(k)
    #[arg(long, value_enum, default_value_t = Compensation::ModelBased)]
    pub(in crate::cli) compensation: Compensation,
    /// Effects that the plant lacks
    #[arg(long, value_name = "EFFECT", value_enum, value_delimiter = ',')]
    pub(in crate::cli) without: Vec<Effect>,
}
