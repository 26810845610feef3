//! `rigidtap tune`.

use std::path::Path;

use crate::config::{MachineFile, bands_to_toml};
use crate::control::machine::{Machine, SyncSpec};
use crate::control::motor::Motor;
use crate::control::port::Feedback;
use crate::laws::TuneTask;
use crate::link::recording::DriveLog;
use crate::report::json::{DryCycleAnswer, GainsAnswer, IdentifyAnswer, TuneAnswer};
use crate::report::{identification, table};
use crate::run::RunSettings;
use crate::sim::{Plant, PlantOptions};
use crate::study::{RunUp, Tuning, dry_cycle, dry_cycle_for_linuxcnc, identify, run_dry_cycle};

use super::answer::{answer, layout};
use super::args::{Common, Format, TuneArgs};
use super::input;
use super::outcome::{Outcome, Stop, print, print_json, report};
use super::output::{self, Output};

/// Seed of the dry cycle unless another is asked for.
const DEFAULT_SEED: u64 = 1;
/// Prices are shown up to this many bands.
const PRICED: usize = 12;

/// Tunes bands or gains, or identifies the machine, as the command line asks.
pub(super) fn tune(common: &Common, args: &TuneArgs) -> Result<Outcome, Stop> {
    let file = input::machine_file(common, &[])?;
    if args.gains {
        gains(common, &file)?;
    } else if args.dry_cycle {
        let for_linuxcnc = common.dialect.as_deref() == Some("linuxcnc");
        let written = if for_linuxcnc { dry_cycle_for_linuxcnc } else { dry_cycle };
        let program = written(&file.machine);
        if common.format == Format::Json {
            print_json(&answer(common, None, DryCycleAnswer { program }))?
        } else {
            print(&program)?
        }
    } else if let Some(trace) = &args.identify {
        identify_machine(common, &file, trace.as_deref(), args)?;
    } else {
        bands(common, args, &file.machine)?;
    }
    Ok(Outcome::Good)
}

/// The gains that the rules give.
fn gains(common: &Common, file: &MachineFile) -> Result<(), Stop> {
    let machine = file.machine.with(|spec| spec.sync = SyncSpec::by_rules(spec)).map_err(input::unusable)?;
    let toml = MachineFile { machine, ..file.clone() }.sync_to_toml();
    if common.format == Format::Json {
        print_json(&answer(common, None, GainsAnswer::of_toml(&toml)))
    } else {
        print(&toml)
    }
}

/// Identifies the machine, from a trace or in the dry cycle.
fn identify_machine(common: &Common, file: &MachineFile, trace: Option<&Path>, args: &TuneArgs) -> Result<(), Stop> {
    let (machine, seed) = (&file.machine, args.seed);
    let read: Vec<_> = trace.map(Path::to_path_buf).into_iter().collect();
    output::check_paths(common, &read, &[args.save.as_ref()])?;
    let saved = args.save.as_deref().map(Output::open).transpose()?;
    let (name, feedback, readings, seed) = match trace {
        Some(_) if seed.is_some() => {
            return Err(Stop::Usage("--seed is the simulated machine's: a trace has none".into()));
        }
        Some(path) => {
            let name = input::name(path);
            let log = DriveLog::read(input::recording(path)?, machine)
                .map_err(|error| input::refused(&name, error.line, error.column, &error.kind))?;
            (name, log.feedback, log.readings, None)
        }
        None => {
            let seed = seed.unwrap_or(DEFAULT_SEED);
            let feedback = simulated_dry_cycle(file, seed)?;
            let readings = feedback.len();
            (format!("dry cycle on the simulated machine, seed {seed}"), feedback, readings, Some(seed))
        }
    };
    let source = identification::Source { name, periods: feedback.len(), left_out: readings - feedback.len() };
    let found = identify(&feedback, machine);
    if let Some(mut saved) = saved {
        let measured = file.with_measured(&identification::keys(&found, machine)).map_err(input::unusable)?;
        saved.write(&measured.to_toml())?;
        saved.keep()?;
    }
    if common.format == Format::Json {
        print_json(&answer(common, seed, IdentifyAnswer::new(&found, &source)))
    } else {
        print(&identification::table(layout(common), &found, machine, &source))
    }
}

/// The dry cycle on the machine as its file's `[actual]` says, with nothing clamped.
fn simulated_dry_cycle(file: &MachineFile, seed: u64) -> Result<Vec<Feedback>, Stop> {
    let air = file.machine.with(|spec| spec.tap.kc_n_per_mm2 = 0.0).map_err(input::unusable)?;
    let z_start_mm = RunSettings::default().start_mm[2];
    let mut plant =
        Plant::new(&air, &PlantOptions { actual: file.actual, seed, z_start_mm, ..PlantOptions::default() });
    run_dry_cycle(&file.machine, &mut plant).map_err(|error| {
        report(&format!("error: {}", identification::dry_cycle_error(&error)));
        Stop::Reported
    })
}

/// The speed bands of torque-curve.
fn bands(common: &Common, args: &TuneArgs, machine: &Machine) -> Result<(), Stop> {
    let spec = machine.spec();
    let max_rpm = spec.spindle.max_rpm;
    let measured =
        args.run_up.as_deref().map(|path| measured(path, max_rpm, spec.spindle.inertia_kg_m2)).transpose()?;
    let motor = measured.as_ref().unwrap_or(machine.motor()).clone();
    let task = TuneTask::new(motor, max_rpm, spec.law.motor_share, &args.stroke_rev);
    let task = task.map_err(|error| input::untunable(&error))?;
    let mut prices = task.best_up_to(PRICED.max(args.bands)).map_err(|error| input::untunable(&error))?;
    let Some(best) = prices.get(args.bands - 1).cloned() else {
        return Err(Stop::Usage(format!("{} bands cannot be tuned", args.bands)));
    };
    prices.truncate(PRICED);
    let law = &spec.law.torque_curve;
    let tuning = Tuning {
        specs: best.time_constants(law.start_rpm, law.end_rpm),
        best,
        prices: prices.iter().map(|found| found.stroke_over_bound).collect(),
        motor_share: spec.law.motor_share,
        max_rpm,
        strokes_rev: args.stroke_rev.clone(),
        measured: measured.map(|motor| motor.curve),
    };
    if common.format == Format::Json {
        print_json(&answer(common, None, TuneAnswer::from(&tuning)))
    } else {
        print(&format!("{}\n{}", table::tuning(layout(common), &tuning), bands_to_toml(&tuning.specs)))
    }
}

/// The motor as a recorded run-up measures it.
fn measured(path: &Path, max_rpm: f64, inertia_kg_m2: f64) -> Result<Motor, Stop> {
    let bytes = input::read(path)?;
    RunUp::read(&bytes).and_then(|run_up| run_up.motor(max_rpm, inertia_kg_m2)).map_err(|error| {
        report(&format!("{}:{}:{}: error: {error}", input::name(path), error.line, error.column));
        Stop::Reported
    })
}
