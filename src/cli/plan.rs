//! `rigidtap plan`.

use std::cell::Cell;
use std::io::Write;

use crate::control::machine::{Law, Machine};
use crate::control::profile::StrokeRequest;
use crate::control::units::rev_per_s_from_rpm;
use crate::gcode::Options;
use crate::gcode::program::Overrides;
use crate::report::json::{EntryAnswer, ProgramPlan, Streamed, StrokePlan};
use crate::report::plot::ProgramPicture;
use crate::report::{picture, plot, table};
use crate::study::{TimelineEntry, timeline};

use super::answer::{answer, layout};
use super::args::{Common, Format, PlanArgs};
use super::input::{self, Program};
use super::outcome::{Outcome, Stop, print, print_json, stdout, unwritable};
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
    let machine = input::machine_file(common, &[args.law])?.machine;
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
        draw(path, plot::profile_figure(&title, &[(args.law.name(), &profile)], machine.motor()))?;
    }
    if common.format == Format::Json {
        print_json(&answer(common, None, StrokePlan::new(args.law, speed_rpm, &profile)))?;
    } else {
        let minimum = machine.motor().fastest_stroke(distance_rev, command, 1.0);
        print(&table::stroke_plan(layout(common), args.law, speed_rpm, &profile, minimum.duration_s))?;
    }
    Ok(Outcome::Good)
}

fn program(common: &Common, args: &PlanArgs, path: &std::path::Path) -> Result<Outcome, Stop> {
    let file = input::machine_file(common, &[args.law])?;
    let reading = input::dialect(common, &file)?;
    let overrides = input::overrides(&args.overrides);
    let programs = input::programs(common, &[path.to_owned()], &reading, &file.machine, &[args.law], overrides)?;
    for mut program in programs {
        let name = program.name.clone();
        if let Some(path) = &args.plot {
            let (mut drawn, mut steps) = (ProgramPicture::default(), 0);
            steps_of(&mut program, &file.machine, args.law, overrides, &mut |entry| {
                steps += 1;
                if steps <= MOST_STEPS_DRAWN {
                    picture::add_step(&mut drawn, &entry);
                }
            })?;
            if steps > MOST_STEPS_DRAWN {
                return Err(Stop::Usage(format!("--plot draws at most {MOST_STEPS_DRAWN} steps: {name} has {steps}")));
            }
            draw(path, plot::program_figure(&name, &drawn))?;
        }
        if common.format == Format::Json {
            write_json(common, &mut program, &file.machine, args.law, overrides)?;
        } else {
            write_table(common, &mut program, &file.machine, args.law, overrides)?;
        }
    }
    Ok(Outcome::Good)
}

/// Most steps of a program that are drawn: on paper more are a black bar, and each takes memory.
const MOST_STEPS_DRAWN: usize = 100_000;

/// A program's timeline, step by step; how long it takes.
fn steps_of(
    program: &mut Program,
    machine: &Machine,
    law: Law,
    overrides: Overrides,
    show: &mut dyn FnMut(TimelineEntry),
) -> Result<f64, Stop> {
    let start_mm = Options::default().start_mm;
    let total_s = timeline(program.commands(), machine, law, overrides, start_mm, show);
    program.intact()?;
    // Every command was planned before, under the same law and overrides.
    total_s.map_err(|error| Stop::Usage(format!("{}: {error}", program.name)))
}

/// The timeline as JSON, which is written while it is made.
fn write_json(
    common: &Common,
    program: &mut Program,
    machine: &Machine,
    law: Law,
    overrides: Overrides,
) -> Result<(), Stop> {
    let (file, total_s, mut found) = (program.name.clone(), Cell::new(0.0), Ok(0.0));
    let entries = Streamed::new(|add: &mut dyn FnMut(EntryAnswer)| {
        found = steps_of(program, machine, law, overrides, &mut |entry| add((&entry).into()));
        total_s.set(*found.as_ref().unwrap_or(&0.0));
    });
    let body = ProgramPlan { file, law: law.name(), entries, total_s: &total_s };
    let written = print_json(&answer(common, None, body));
    found.and(written)
}

/// The timeline as a table, page by page.
fn write_table(
    common: &Common,
    program: &mut Program,
    machine: &Machine,
    law: Law,
    overrides: Overrides,
) -> Result<(), Stop> {
    let mut out = stdout();
    let mut pages = table::TimelinePages::new(layout(common));
    // The first failure to write is reported once the timeline is made.
    let mut written = writeln!(out, "{}: {}\n", program.name, law.name());
    let mut add = |text: &str| {
        if written.is_ok() {
            written = out.write_all(text.as_bytes());
        }
    };
    let total_s = steps_of(program, machine, law, overrides, &mut |entry| {
        if let Some(page) = pages.add(&entry) {
            add(&page);
        }
    })?;
    add(&pages.finish(total_s));
    written.and_then(|()| out.flush()).map_err(unwritable)
}

/// Draws one picture.
fn draw(path: &std::path::Path, svg: Result<String, plot::PlotError>) -> Result<(), Stop> {
    let mut drawing = Output::open(path)?;
    drawing.draw(svg)?;
    drawing.keep()
}
