//! `rigidtap plan`.

use crate::control::profile::StrokeRequest;
use crate::control::units::rev_per_s_from_rpm;
use crate::gcode::Options;
use crate::report::{json, picture, plot, table};
use crate::study::timeline;

use super::args::{Common, Format, PlanArgs};
use super::input;
use super::outcome::{Outcome, Stop, print, print_json};
use super::output::{self, Output};

/// Shows a program's timeline, or one stroke.
pub(super) fn plan(common: &Common, args: &PlanArgs) -> Result<Outcome, Stop> {
    output::check_paths(common, args.file.as_slice(), &[args.plot.as_ref()])?;
    match (&args.file, args.stroke_rev, args.speed_rpm) {
        (None, Some(distance_rev), Some(speed_rpm)) => stroke(common, args, distance_rev, speed_rpm),
        (Some(path), ..) => program(common, args, path),
        _ => Err(Stop::Usage("plan takes a program, or --stroke-rev with --speed-rpm".into())),
    }
}

fn stroke(common: &Common, args: &PlanArgs, distance_rev: f64, speed_rpm: f64) -> Result<Outcome, Stop> {
    let machine = input::machine_file(common)?.machine;
    let limit_rpm = machine.spec().spindle.max_rpm;
    if speed_rpm > limit_rpm {
        return Err(Stop::Usage(format!("--speed-rpm {speed_rpm} is beyond the spindle's {limit_rpm} rpm")));
    }
    let command = rev_per_s_from_rpm(speed_rpm);
    let profile = machine
        .stroke(args.law, StrokeRequest { distance: distance_rev, command })
        .map_err(|error| Stop::Usage(format!("no stroke of {distance_rev} rev: {error}")))?;
    if let Some(path) = &args.plot {
        let title = format!("{distance_rev} rev, {speed_rpm} rpm commanded");
        draw(path, plot::profile_figure(&title, &[(args.law.name(), &profile)], &machine.motor))?;
    }
    if common.format == Format::Json {
        print_json(&json::stroke_plan(args.law, speed_rpm, &profile))?;
    } else {
        let bound = machine.motor.fastest_stroke(distance_rev, command, 1.0);
        print(&table::stroke_plan(args.law, speed_rpm, &profile, bound.duration_s))?;
    }
    Ok(Outcome::Good)
}

fn program(common: &Common, args: &PlanArgs, path: &std::path::Path) -> Result<Outcome, Stop> {
    let file = input::machine_file(common)?;
    let dialect = input::dialect(common, &file)?;
    let overrides = input::overrides(&args.overrides);
    let programs = input::programs(common, &[path.to_owned()], &dialect, &file.machine, &[args.law], overrides)?;
    for program in &programs {
        let entries = timeline(&program.commands, &file.machine, args.law, overrides, Options::default().start_mm);
        let entries = entries.map_err(|error| Stop::Usage(format!("{}: {error}", program.name)))?;
        if let Some(path) = &args.plot {
            draw(path, plot::program_figure(&program.name, &picture::program_picture(&entries)))?;
        }
        if common.format == Format::Json {
            print_json(&json::timeline(&program.name, args.law, &entries))?;
        } else {
            print(&table::timeline(&program.name, args.law, &entries))?;
        }
    }
    Ok(Outcome::Good)
}

/// Draws one picture.
fn draw(path: &std::path::Path, svg: Result<String, plot::PlotError>) -> Result<(), Stop> {
    let mut drawing = Output::open(path)?;
    drawing.draw(svg)?;
    drawing.keep()
}
