//! `rigidtap sweep`.

use std::num::NonZeroU32;
use std::sync::atomic::Ordering;

use crate::config::MachineFile;
use crate::gcode::{Command, CommandKind};
use crate::report::json::SweepAnswer;
use crate::report::page::{Page, sweep_charts};
use crate::report::table::Layout;
use crate::report::{plot, sweep_csv, table};
use crate::study::{self, Simulation, Sweep, SweepError, SweepSettings, SweptMachine};

use super::answer::{answer, layout};
use super::args::{Common, Format, Identify, PlantArgs, SweepArgs};
use super::interrupt::stop_on_ctrl_c;
use super::outcome::{Outcome, Stop, print, print_json, report};
use super::output::{self, Output};
use super::simulate::{report_unused, simulation};
use super::{input, page, progress};

/// Holes that show what learning gives, unless the command line says how many.
const LEARNING_HOLES: NonZeroU32 = NonZeroU32::new(10).expect("is not 0");
/// Title of the picture.
const TITLE: &str = "The first hole's error over all machines";

/// Taps one hole on many machines.
pub(super) fn sweep(common: &Common, args: &SweepArgs) -> Result<Outcome, Stop> {
    let SweepArgs { file: path, plant, tap, .. } = args;
    let written = [args.csv.as_ref(), args.plot.as_ref(), args.save_worst.as_ref(), args.report.as_ref()];
    output::check_paths(common, std::slice::from_ref(path), &written)?;
    let file = input::machine_file(common, &[tap.law])?;
    let machine = input::changed(file.machine.clone(), plant.tap.as_deref(), plant.material, tap.share)?;
    let reading = input::dialect(common, &file)?;
    report_unused(common, plant, tap);
    let base = simulation(machine, file.actual, plant, tap);
    let overrides = base.settings.overrides;
    let mut programs =
        input::programs(common, std::slice::from_ref(path), &reading, &base.machine, &[tap.law], overrides)?;
    let Some(program) = programs.first_mut() else { return Err(Stop::Reported) };
    let commands = program.collect()?;
    report_other_holes(common, &program.name, &commands);

    let settings = SweepSettings {
        runs: args.runs,
        seed: plant.seed,
        holes: args.holes.unwrap_or(if plant.adapting.learn { LEARNING_HOLES } else { NonZeroU32::MIN }),
        spread: (!args.nominal).then_some(file.spread),
        hard: args.hard.then_some(file.hard),
        jobs: args.jobs,
    };
    // From here on Ctrl-C leaves no file behind, a temporary one neither.
    let stop = stop_on_ctrl_c();
    let open = |path: &Option<std::path::PathBuf>| path.as_deref().map(Output::open).transpose();
    let (mut csv, mut drawing, mut worst_file) = (open(&args.csv)?, open(&args.plot)?, open(&args.save_worst)?);
    let mut paper = open(&args.report)?;
    let bar = progress::bar(common, settings.runs.get() as usize, "sweeping");
    let go_on = || {
        bar.inc(1);
        !stop.load(Ordering::Relaxed)
    };
    let found = study::sweep(&commands, &base, &settings, &go_on);
    bar.finish_and_clear();
    let found = found.map_err(|error| refused(&program.name, &error))?;
    let Some(found) = found.filter(|_| !stop.load(Ordering::Relaxed)) else {
        report("interrupted: nothing was written");
        return Ok(Outcome::Interrupted);
    };

    if let Some(csv) = &mut csv {
        csv.write(&sweep_csv::sweep_csv(&found, &base.machine))?;
    }
    if let Some(drawing) = &mut drawing {
        let values: Vec<f64> = found.machines.iter().map(|machine| machine.first.worst_um).collect();
        drawing.draw(plot::histogram_figure(
            TITLE,
            "peak-to-peak e(k), the worse of measured and true, µm",
            &values,
        ))?;
    }
    if let (Some(output), Some(worst)) = (&mut worst_file, found.worst()) {
        output.write(&worst_machine(&found, worst, &base, &file, common, args))?;
    }
    let sync = base.settings.run.sync;
    let answered =
        || answer(common, Some(plant.seed), SweepAnswer::new(&program.name, tap.law, sync, &settings, &found));
    let told = |layout| table::swept_program(layout, &program.name, tap.law, sync, &settings, &found);
    if let Some(paper) = &mut paper {
        let failing = found.count(SweptMachine::fails);
        let verdict = if failing > 0 {
            "fail"
        } else if found.warning_ratio() > 0.0 {
            "warning"
        } else {
            "ok"
        };
        let summary = format!(
            "{}: {failing} of {} machines fail, {:.0} warn.",
            program.name,
            found.machines.len(),
            found.warning_ratio() * found.machines.len() as f64
        );
        let heading = page::heading(common, "Many machines", Some(verdict), vec![summary], Some(plant.seed));
        let mut sheet = Page::new(&heading);
        let (charts, tail) = sweep_charts(&found, base.machine.sync_tolerance_um(found.hole.pitch_mm));
        sheet.figures(charts);
        sheet.heading("Which effect costs what: the worst hundredth against all");
        sheet.table(&tail);
        sheet.verbatim(&told(Layout::new(120, true)));
        page::write(paper, sheet, &answered())?;
    }
    csv.into_iter().chain(drawing).chain(worst_file).chain(paper).try_for_each(Output::keep)?;
    if common.format == Format::Json {
        print_json(&answered())?;
    } else {
        print(&told(layout(common)))?;
    }
    Ok(Outcome::Good)
}

/// Every hole of a program may be meant, and one alone is swept.
fn report_other_holes(common: &Common, name: &str, commands: &[Command]) {
    let mut holes = commands.iter().filter_map(|command| match command.kind {
        CommandKind::Tap(hole) => Some((command.line, hole)),
        _ => None,
    });
    let Some((line, first)) = holes.next() else { return };
    if !common.quiet && holes.any(|(_, hole)| !hole.is_alike(&first)) {
        report(&format!("note: {name}: its holes differ; only the first one is swept, that of line {line}"));
    }
}

fn refused(name: &str, error: &SweepError) -> Stop {
    match error {
        SweepError::NoHole => {
            report(&format!("error: {name}: there is no hole to sweep: expected a tapping cycle"));
            Stop::Reported
        }
        // Every command was planned before, under the same law and overrides.
        SweepError::Plan(error) => Stop::Usage(format!("{name}: {error}")),
    }
}

/// The nominal machine as it was run, with what makes it the worst one, and how to see it again.
fn worst_machine(
    found: &Sweep,
    worst: &SweptMachine,
    base: &Simulation,
    file: &MachineFile,
    common: &Common,
    args: &SweepArgs,
) -> String {
    let file =
        MachineFile { machine: base.machine.clone(), actual: worst.actual, warnings: Vec::new(), ..file.clone() };
    format!(
        "# The worst of {runs} machines, run {run} of a sweep with seed {sweep_seed}: {worst_um} µm in its first hole. Again:\n\
         # rigidtap simulate PROGRAM --machine THIS_FILE --seed {seed}{flags}\n#\n{toml}",
        runs = found.machines.len(),
        run = worst.run,
        sweep_seed = args.plant.seed,
        worst_um = worst.first.worst_um,
        seed = worst.seed,
        flags = flags(common, args),
        toml = file.to_toml(),
    )
}

/// The sweep's own words that no machine file holds.
fn flags(common: &Common, args: &SweepArgs) -> String {
    let SweepArgs { plant: PlantArgs { ideal, adapting, overrides, .. }, tap, .. } = args;
    let mut words =
        format!(" --law {} --sync {} --compensation {}", tap.law.name(), tap.sync.name(), tap.compensation.name());
    if let Some(dialect) = &common.dialect {
        words += &format!(" --dialect {dialect}");
    }
    if common.block_delete {
        words += " --block-delete";
    }
    match adapting.identify {
        Identify::None => words += " --identify=none",
        Identify::Approach => {}
        Identify::DryCycle => words += " --identify",
    }
    if adapting.learn {
        words += " --learn";
    }
    if *ideal {
        words += " --ideal";
    }
    if !tap.without.is_empty() {
        let names: Vec<_> = tap.without.iter().map(|effect| effect.name()).collect();
        words += &format!(" --without {}", names.join(","));
    }
    for (name, percent) in [("rapid", overrides.rapid_override), ("feed", overrides.feed_override)] {
        if percent != 100.0 {
            words += &format!(" --{name}-override {percent}");
        }
    }
    words
}
