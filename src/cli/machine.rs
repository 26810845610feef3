//! `rigidtap machine`.

use std::io::{self, BufRead, IsTerminal, Write};

use crate::config::{MachineFile, SheetInertia, SheetValues, new_machine_toml};
use crate::control::machine::{Law, LongestStop};
use crate::report::json::MachineAnswer;

use super::answer::answer;
use super::args::{Common, Format, MachineArgs};
use super::input;
use super::outcome::{Outcome, Stop, print, print_json, report};
use super::output::{self, Output};

/// Prints the machine file in use, or a new one.
pub(super) fn machine(common: &Common, args: &MachineArgs) -> Result<Outcome, Stop> {
    output::check_paths(common, &[], &[args.hal.as_ref()])?;
    let hal_file = args.hal.as_deref().map(Output::open).transpose()?;
    let (text, file) = if args.new {
        new(common, args)?
    } else {
        let file = input::machine_file(common, &Law::ALL)?;
        (file.to_toml(), file)
    };
    let stop = file.machine.longest_stop();
    if let Some(mut hal_file) = hal_file {
        hal_file.write(&file.to_hal())?;
        hal_file.keep()?;
    }
    match common.format {
        Format::Table => print(&format!("{text}\n{}", longest_stop(&stop)))?,
        Format::Json => print_json(&answer(common, None, MachineAnswer::new(&text, &stop)))?,
    }
    Ok(Outcome::Good)
}

/// What a data sheet has to say: the flag, the question, and the range of answers.
const NEEDED: [(&str, &str, [f64; 2]); 6] = [
    ("--power-kw", "power of the spindle motor, kW", [0.05, 200.0]),
    ("--rated-rpm", "speed up to which its torque is constant, rpm", [1.0, 100_000.0]),
    ("--max-rpm", "greatest speed of the spindle, rpm", [10.0, 200_000.0]),
    ("--run-up-s", "time from rest to that speed, s (or give --inertia-kg-m2)", [0.001, 1000.0]),
    ("--rapid-m-per-min", "rapid of the axes, m/min", [0.1, 300.0]),
    ("--accel-m-per-s2", "their acceleration, m/s²", [0.01, 100.0]),
];

/// A file from a data sheet's values, as text and as it is read: those of the command line, and those that a person at the terminal answers.
fn new(common: &Common, args: &MachineArgs) -> Result<(String, MachineFile), Stop> {
    let run_up_s = args.run_up_s.or(args.inertia_kg_m2.map(|_| 0.0));
    let mut found = [args.power_kw, args.rated_rpm, args.max_rpm, run_up_s, args.rapid_m_per_min, args.accel_m_per_s2];
    if found.contains(&None) && !io::stdin().is_terminal() {
        let missing = NEEDED.iter().zip(found).filter(|(_, value)| value.is_none()).map(|((flag, ..), _)| *flag);
        let missing: Vec<_> = missing.collect();
        return Err(Stop::Usage(format!("a new machine needs {}; on a terminal it asks", missing.join(", "))));
    }
    for (value, (_, question, range)) in found.iter_mut().zip(NEEDED) {
        if value.is_none() {
            *value = Some(asked(question, range)?);
        }
    }
    let [power_kw, rated_rpm, max_rpm, run_up_s, rapid_m_per_min, accel_m_per_s2] =
        found.map(Option::unwrap_or_default);
    if rated_rpm >= max_rpm {
        return Err(Stop::Usage(format!("the rated speed {rated_rpm} rpm is not below the greatest of {max_rpm} rpm")));
    }
    let text = new_machine_toml(&SheetValues {
        power_kw,
        rated_rpm,
        max_rpm,
        inertia: args.inertia_kg_m2.map_or(SheetInertia::RunUpS(run_up_s), SheetInertia::KgM2),
        rapid_m_per_min,
        accel_m_per_s2,
        screw_lead_mm: args.screw_lead_mm,
        encoder_lines_per_rev: args.encoder_lines,
        scale_um: args.scale_um,
        belt: args.belt,
        dialect: common.dialect.clone(),
    });
    // A slip in the words shows here as it would in a file.
    match MachineFile::read(text.as_bytes()) {
        Ok(file) => {
            for warning in file.warnings.iter().filter(|_| !common.quiet) {
                report(&warning.in_file("new machine").to_string());
            }
            Ok((text, file))
        }
        Err(faults) => {
            faults.iter().for_each(|fault| report(&fault.in_file("new machine").to_string()));
            Err(Stop::Reported)
        }
    }
}

/// Asks at the terminal until the answer is a number in its range.
fn asked(question: &str, [low, high]: [f64; 2]) -> Result<f64, Stop> {
    let unreadable = |error: io::Error| Stop::Usage(format!("the answer cannot be read: {error}"));
    loop {
        let mut screen = io::stderr();
        write!(screen, "{question}: ").and_then(|()| screen.flush()).map_err(unreadable)?;
        let mut line = String::new();
        if io::stdin().lock().read_line(&mut line).map_err(unreadable)? == 0 {
            return Err(Stop::Usage("the answers ended too soon".into()));
        }
        match line.trim().replace(',', ".").parse::<f64>() {
            Ok(value) if (low..=high).contains(&value) => return Ok(value),
            _ => report(&format!("expected a number from {low} to {high}")),
        }
    }
}

/// A comment below the keys.
fn longest_stop(LongestStop { time_s, angle_rev }: &LongestStop) -> String {
    format!(
        "# The longest synchronous stop, from max_rpm: {time_s:.3} s and {angle_rev:.1} rev, for the timer of the drives' safe stop\n\
         # 1 (SS1). The control itself is no safety function.\n"
    )
}
