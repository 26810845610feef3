//! `rigidtap advise`.

use std::sync::atomic::Ordering;

use crate::config::bands_to_toml;
use crate::control::machine::{BandSpec, Law, Ramp};
use crate::control::sync::Compensation;
use crate::report::advice::{Asked, answer_sentences, control_sheet, kind_name};
use crate::report::json::AdviseAnswer;
use crate::report::page::{Page, advise_page};
use crate::report::table;
use crate::run::ProgramSettings;
use crate::sim::{Effects, MOST_FAULTS};
use crate::study::{self, Advice, AdviseError, AdviseSettings, Simulation};

use super::answer::{answer, layout};
use super::args::{AdviseArgs, Common, Format};
use super::interrupt::stop_on_ctrl_c;
use super::outcome::{Outcome, Stop, print, print_json, report};
use super::output::{self, Output};
use super::plant::refuse_other;
use super::{input, page, progress};

/// Looks for the fastest setting that holds.
pub(super) fn advise(common: &Common, args: &AdviseArgs) -> Result<Outcome, Stop> {
    let plant = &args.plant;
    refuse_other(plant, "advise")?;
    output::check_paths(common, &args.files, &[args.report.as_ref()])?;
    let mut paper = args.report.as_deref().map(Output::open).transpose()?;
    let file = input::machine_file(common, &[args.present])?;
    let machine = input::changed(file.machine.clone(), plant.tap.as_deref(), plant.material, None)?;
    let reading = input::dialect(common, &file)?;
    let overrides = input::overrides(&plant.overrides);
    // A control of its own has no synchronizer of ours.
    let theirs = args.control.is_some_and(|control| control.name() != "linuxcnc");
    let usual = if theirs { Compensation::Uncompensated } else { Compensation::ModelBased };
    let run = plant.adapting.run(args.sync, args.compensation.unwrap_or(usual));
    let base = Simulation {
        machine,
        actual: file.actual,
        effects: if plant.ideal { Effects::IDEAL } else { Effects::FULL },
        seed: plant.seed,
        faults: [None; MOST_FAULTS],
        other_plant: None,
        settings: ProgramSettings { law: args.present, overrides, run },
    };
    // Speeds are what is asked for: a program whose own S this machine has not is no reason to refuse.
    let mut programs = input::programs(common, &args.files, &reading, &base.machine, &[], overrides)?;
    let mut commands = Vec::new();
    for program in &mut programs {
        commands.push(program.collect()?);
    }
    let settings = AdviseSettings {
        runs: args.runs,
        margin: args.margin,
        laws: args.laws.clone(),
        shares: args.shares.clone(),
        spread: Some(file.spread),
        seed: plant.seed,
        present: args.present,
        jobs: args.jobs,
    };
    let stop = stop_on_ctrl_c();
    let steps = study::advise_steps(&commands, &settings);
    let bar = progress::bar(common, steps, "looking for the fastest setting");
    let go_on = || {
        bar.inc(1);
        !stop.load(Ordering::Relaxed)
    };
    let mut settings = settings;
    let mut found = study::advise(&commands, &base, &settings, &go_on);
    if matches!(found, Err(AdviseError::NothingHolds(..))) && settings.margin < 1.0 {
        if !common.quiet {
            bar.suspend(|| report(&no_margin(settings.margin)));
        }
        settings.margin = 1.0;
        found = study::advise(&commands, &base, &settings, &go_on);
    }
    bar.finish_and_clear();
    let Some(advice) = found.map_err(|error| refused(&error, &settings))?.filter(|_| !stop.load(Ordering::Relaxed))
    else {
        report("interrupted: nothing was written");
        return Ok(Outcome::Interrupted);
    };
    let asked = Asked {
        present: args.present,
        runs: args.runs.get(),
        margin: settings.margin,
        parts_per_year: args.parts_per_year,
    };
    let sheet = args.control.map(|control| control_sheet(control, &advice));
    let toml = to_paste(&advice);
    let answered = || {
        let files = programs.iter().map(|program| program.name.clone()).collect();
        let sync = &base.settings.run.sync;
        let body = AdviseAnswer::new(files, &advice, &asked, sync, sheet.as_ref(), toml.clone());
        answer(common, Some(plant.seed), body)
    };
    if let Some(paper) = &mut paper {
        let said = answer_sentences(&advice, &asked).to_vec();
        let heading = page::heading(common, "What to set", None, said, Some(plant.seed));
        let mut found = Page::new(&heading);
        advise_page(&mut found, &advice, &asked, sheet.as_ref(), &toml);
        page::write(paper, found, &answered())?;
    }
    paper.map(Output::keep).transpose()?;
    if common.format == Format::Json {
        print_json(&answered())?;
    } else {
        print(&table::advised(layout(common), &advice, &asked, sheet.as_ref(), &toml))?;
    }
    Ok(Outcome::Good)
}

/// What is told where the margin is given up.
fn no_margin(margin: f64) -> String {
    format!(
        "note: no setting holds at {:.0} % of tolerance and clearance; what follows is the fastest that holds at all",
        100.0 * margin
    )
}

/// The machine file's lines that set the advice.
fn to_paste(advice: &Advice) -> String {
    let mut toml = format!("# rigidtap simulate … --law {}, with the S above in the program\n", advice.law.name());
    if let Some(share) = advice.share {
        toml += &format!("[law]\nmotor_share = {share}\n");
    }
    if advice.law == Law::TorqueCurve {
        let bands: Vec<_> = advice.machine.spec().law.torque_curve.bands.iter().map(rounded).collect();
        toml += &bands_to_toml(&bands);
    }
    toml
}

/// A band with accelerations as a person would write them, rounded down so that they never ask more than the motor.
fn rounded(band: &BandSpec) -> BandSpec {
    let ramp = match band.ramp {
        Ramp::Rate { accel_rpm_per_s, decel_rpm_per_s } => {
            Ramp::Rate { accel_rpm_per_s: accel_rpm_per_s.floor(), decel_rpm_per_s: decel_rpm_per_s.floor() }
        }
        times @ Ramp::Time { .. } => times,
    };
    BandSpec { ramp, ..*band }
}

fn refused(error: &AdviseError, settings: &AdviseSettings) -> Stop {
    match error {
        AdviseError::NoPlan => {
            report("error: a move between the holes has no plan on this machine: `rigidtap check` says which")
        }
        AdviseError::NoHole => report("error: there is no hole to advise on: expected a tapping cycle"),
        AdviseError::NothingHolds(nearest) => {
            let (kind, trial) = nearest.as_ref();
            let came = trial.map_or_else(
                || "no law has a plan for it: Z or the spindle cannot follow".to_owned(),
                |trial| {
                    let by = if trial.by_depth { "its depth" } else { "its error" };
                    let used = 100.0 * trial.used;
                    let used =
                        if used.is_finite() { format!("{by} is {used:.0} %") } else { "an alarm stops it".to_owned() };
                    format!(
                        "at S{:.0} on {} of {} machines {used}",
                        trial.speed_rpm,
                        trial.runs - trial.good,
                        trial.runs
                    )
                },
            );
            report(&format!(
                "no setting holds at {:.0} % of tolerance and clearance: of line {}, {}, {came}\n  hint: a greater --margin, \
                 another --compensation, or a machine with less friction and backlash",
                100.0 * settings.margin,
                kind.line,
                kind_name(kind)
            ));
        }
    }
    Stop::Reported
}
