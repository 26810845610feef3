//! `rigidtap tune`.

use crate::config::bands_to_toml;
use crate::control::motor::Motor;
use crate::report::{json, table};
use crate::study::{RunUp, TuneTask, Tuning};

use super::args::{Common, Format, TuneArgs};
use super::input;
use super::outcome::{Outcome, Stop, print, print_json, tell};

/// Prices are shown up to this many bands.
const PRICED: usize = 12;

/// Tunes the bands and shows them with their price.
pub(super) fn tune(common: &Common, args: &TuneArgs) -> Result<Outcome, Stop> {
    let machine = input::machine_file(common)?.machine;
    let spec = machine.spec();
    let max_rpm = spec.spindle.max_rpm;
    let measured =
        args.run_up.as_deref().map(|path| measured(path, max_rpm, spec.spindle.inertia_kg_m2)).transpose()?;
    let motor = measured.as_ref().unwrap_or(&machine.motor).clone();
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
        print_json(&json::tuning(&tuning))?;
    } else {
        print(&format!("{}\n{}", table::tuning(&tuning), bands_to_toml(&tuning.specs)))?;
    }
    Ok(Outcome::Good)
}

/// The motor that a recorded run-up shows.
fn measured(path: &std::path::Path, max_rpm: f64, inertia_kg_m2: f64) -> Result<Motor, Stop> {
    let bytes = input::read(path)?;
    RunUp::read(&bytes).and_then(|run_up| run_up.motor(max_rpm, inertia_kg_m2)).map_err(|error| {
        tell(&format!("{}:{}:{}: error: {error}", input::name(path), error.line, error.column));
        Stop::Told
    })
}
