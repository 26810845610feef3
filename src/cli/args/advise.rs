//! What `advise` takes.

use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;

use clap::Args;
use clap::builder::{PathBufValueParser, TypedValueParser};

use super::shared::PlantArgs;
use super::values::{html, jobs, margin, positive, runs, share};
use crate::control::machine::Law;
use crate::control::sync::{Compensation, Mode};
use crate::report::advice::Control;

#[derive(Args, Debug)]
pub(in crate::cli) struct AdviseArgs {
    /// Programs that make a part; - is standard input
    #[arg(required = true, value_name = "FILE")]
    pub(in crate::cli) files: Vec<PathBuf>,
    /// Machines that the advice is shown on, beside those of the search
    #[arg(long, value_name = "N", default_value = "200", value_parser = runs)]
    pub(in crate::cli) runs: NonZeroU32,
    /// Greatest share of tolerance and clearance that a hole may use
    #[arg(long, value_name = "X", default_value_t = 0.5, value_parser = margin)]
    pub(in crate::cli) margin: f64,
    /// Law that the programs run under now, at their own S
    #[arg(long, value_name = "LAW", value_enum, default_value_t = Law::TorqueCurve)]
    pub(in crate::cli) present: Law,
    /// Parts in a year, for what a year saves
    #[arg(long, value_name = "N", value_parser = positive)]
    pub(in crate::cli) parts_per_year: Option<f64>,
    /// Add the parameters of this control; the holes are then tapped without rigidtap's synchronizer, but on linuxcnc
    #[arg(long, value_name = "CONTROL", value_enum)]
    pub(in crate::cli) control: Option<Control>,
    /// Laws to choose from
    #[arg(long, visible_alias = "law", value_name = "LAW", value_enum, value_delimiter = ',', default_values_t = [Law::TorqueCurve, Law::TorqueCurveSmooth, Law::SCurve])]
    pub(in crate::cli) laws: Vec<Law>,
    /// Torque utilisations to choose from, for the laws that have one
    #[arg(long, visible_alias = "share", value_name = "X", value_delimiter = ',', default_values_t = [0.6, 0.7, 0.8, 0.9, 1.0], value_parser = share)]
    pub(in crate::cli) shares: Vec<f64>,
    /// What Z follows
    #[arg(long, value_enum, default_value_t = Mode::Commanded)]
    pub(in crate::cli) sync: Mode,
    /// How Z is corrected by e(k); full, or none where --control is another's
    #[arg(long, value_enum)]
    pub(in crate::cli) compensation: Option<Compensation>,
    /// Write one page for a browser: verdict, figures, tables, and this answer in JSON
    #[arg(long, value_name = "OUT.html", value_parser = PathBufValueParser::new().try_map(html))]
    pub(in crate::cli) report: Option<PathBuf>,
    /// Number of threads; one on each core without it. The advice does not depend on it
    #[arg(long, value_name = "N", value_parser = jobs)]
    pub(in crate::cli) jobs: Option<NonZeroUsize>,
    #[command(flatten)]
    pub(in crate::cli) plant: PlantArgs,
}
