//! What the subcommands take that concern the machine itself.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PathBufValueParser, TypedValueParser};

use super::values::{band_count, html, pitch, positive, rate, svg};
use crate::laws::STROKES_REV;

#[derive(Args, Debug)]
pub(in crate::cli) struct TuneArgs {
    /// Number of bands, up to 16
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = band_count)]
    pub(in crate::cli) bands: usize,
    /// Strokes that matter, in revolutions, at the spindle's greatest speed
    #[arg(long, value_name = "R", value_delimiter = ',', default_values_t = STROKES_REV, value_parser = positive)]
    pub(in crate::cli) stroke_rev: Vec<f64>,
    /// Tune for a recorded run-up instead of the machine file's torque curve: CSV of time_s and rpm with the whole
    /// motor, from standstill to the greatest speed; - is standard input
    #[arg(long, value_name = "LOG.csv")]
    pub(in crate::cli) run_up: Option<PathBuf>,
    /// Identify the machine instead: friction, reversal value, inertia, from a trace of it, or from a dry cycle on the
    /// simulated machine; - is standard input
    #[arg(long, value_name = "TRACE.csv", num_args = 0..=1, conflicts_with_all = BAND_WORDS)]
    pub(in crate::cli) identify: Option<Option<PathBuf>>,
    /// Write the machine file with what was identified in place of its own values
    #[arg(long, value_name = "OUT.toml", requires = "identify")]
    pub(in crate::cli) save: Option<PathBuf>,
    /// Print the dry cycle that identifies all of this: a program for air, to be recorded on a machine or under simulate; for
    /// LinuxCNC with --dialect linuxcnc
    #[arg(long, conflicts_with_all = BAND_WORDS, conflicts_with = "identify")]
    pub(in crate::cli) dry_cycle: bool,
    /// Print the [sync] table that the documented rules give this machine
    #[arg(long, conflicts_with_all = BAND_WORDS, conflicts_with_all = ["identify", "dry_cycle"])]
    pub(in crate::cli) gains: bool,
    /// Seed of everything random in the simulated machine's dry cycle; 1 without it
    #[arg(long, value_name = "N", requires = "identify")]
    pub(in crate::cli) seed: Option<u64>,
}

/// The words of `tune` that speak of bands.
const BAND_WORDS: [&str; 3] = ["bands", "stroke_rev", "run_up"];

#[derive(Args, Debug)]
pub(in crate::cli) struct MachineArgs {
    /// Make a new file from what data sheets say, and mark what is guessed; on a terminal it asks for what is missing
    #[arg(long)]
    pub(in crate::cli) new: bool,
    /// Write the setp lines that tell this machine to the component of LinuxCNC
    #[arg(long, value_name = "OUT.hal")]
    pub(in crate::cli) hal: Option<PathBuf>,
    /// Power of the spindle motor
    #[arg(long, value_name = "KW", requires = "new", value_parser = positive)]
    pub(in crate::cli) power_kw: Option<f64>,
    /// Speed up to which its torque is constant
    #[arg(long, value_name = "RPM", requires = "new", value_parser = positive)]
    pub(in crate::cli) rated_rpm: Option<f64>,
    /// Greatest speed of the spindle
    #[arg(long, value_name = "RPM", requires = "new", value_parser = positive)]
    pub(in crate::cli) max_rpm: Option<f64>,
    /// Inertia of motor, shaft, chuck and tool at the spindle
    #[arg(long, value_name = "KGM2", requires = "new", conflicts_with = "run_up_s", value_parser = positive)]
    pub(in crate::cli) inertia_kg_m2: Option<f64>,
    /// Time from rest to the greatest speed, in place of the inertia
    #[arg(long, value_name = "S", requires = "new", value_parser = positive)]
    pub(in crate::cli) run_up_s: Option<f64>,
    /// Rapid of the axes
    #[arg(long, value_name = "M_PER_MIN", requires = "new", value_parser = positive)]
    pub(in crate::cli) rapid_m_per_min: Option<f64>,
    /// Acceleration of the axes
    #[arg(long, value_name = "M_PER_S2", requires = "new", value_parser = positive)]
    pub(in crate::cli) accel_m_per_s2: Option<f64>,
    /// Lead of Z's screw
    #[arg(long, value_name = "MM", requires = "new", value_parser = positive)]
    pub(in crate::cli) screw_lead_mm: Option<f64>,
    /// Lines of the spindle's encoder
    #[arg(long, value_name = "LINES", requires = "new", value_parser = positive)]
    pub(in crate::cli) encoder_lines: Option<f64>,
    /// Step of Z's scale at the table; without it Z has the motor's encoder alone
    #[arg(long, value_name = "UM", requires = "new", value_parser = positive)]
    pub(in crate::cli) scale_um: Option<f64>,
    /// A belt drives the spindle
    #[arg(long, requires = "new")]
    pub(in crate::cli) belt: bool,
}

#[derive(Args, Debug)]
pub(in crate::cli) struct MonitorArgs {
    /// Recording: a trace of simulate, halsampler's output, or any CSV with --map; - is standard input
    #[arg(value_name = "TRACE.csv", required_unless_present_any = ["serial", "simulate_board"], conflicts_with_all = ["serial", "simulate_board"])]
    pub(in crate::cli) file: Option<PathBuf>,
    /// Serial port of a board that streams both encoders
    #[arg(long, value_name = "PORT", requires = "pitch", conflicts_with = "simulate_board")]
    pub(in crate::cli) serial: Option<String>,
    /// Be that board: open a pseudo-terminal, print its path, and tap this program on the simulated machine, again and again
    #[arg(long, value_name = "PROGRAM")]
    pub(in crate::cli) simulate_board: Option<PathBuf>,
    /// Its readings per second; one each interpolation period without it
    #[arg(long, value_name = "HZ", requires = "simulate_board", value_parser = rate)]
    pub(in crate::cli) rate: Option<f64>,
    /// Baud rate of the port
    #[arg(long, value_name = "BAUD", default_value_t = 921_600, value_parser = clap::value_parser!(u32).range(300..))]
    pub(in crate::cli) baud: u32,
    /// Nominal pitch in mm; of a recording, the coarse pitch that fits it without it
    #[arg(long, value_name = "MM", value_parser = pitch)]
    pub(in crate::cli) pitch: Option<f64>,
    /// Columns of a recording, `what=column[unit]` for time, spindle and z
    #[arg(long, value_name = "MAP", requires = "file")]
    pub(in crate::cli) map: Option<String>,
    /// End after so many holes; without it Ctrl-C ends a live monitor, with its report
    #[arg(long, value_name = "N", requires = "serial", value_parser = clap::value_parser!(u32).range(1..))]
    pub(in crate::cli) holes: Option<u32>,
    /// Write every reading as CSV
    #[arg(long, value_name = "OUT.csv")]
    pub(in crate::cli) trace: Option<PathBuf>,
    /// Draw e(k) over k as SVG
    #[arg(long, value_name = "OUT.svg", value_parser = PathBufValueParser::new().try_map(svg))]
    pub(in crate::cli) plot: Option<PathBuf>,
    /// Write one page for a browser: verdict, figures, tables, and this answer in JSON
    #[arg(long, value_name = "OUT.html", value_parser = PathBufValueParser::new().try_map(html))]
    pub(in crate::cli) report: Option<PathBuf>,
}
