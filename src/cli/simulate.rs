//! `rigidtap simulate`.

use indicatif::ProgressBar;

use crate::control::machine::Machine;
use crate::control::sync::Compensation;
use crate::report::json::{SimulateAnswer, SimulatedProgram};
use crate::report::page::{HoleRecorder, Page, simulate_charts, table_of_holes};
use crate::report::picture::SpindleLines;
use crate::report::{picture, plot, table};
use crate::run::trace::TraceWriter;
use crate::run::{HoleOutcome, Learned, Listener, ProgramOutcome, ProgramSettings, Row, Verdict};
use crate::sim::{Actual, Effects, Injection, MOST_FAULTS};
use crate::study::{ErrorSeries, Simulation};

use super::answer::{answer, layout};
use super::args::{Common, Format, Identify, PlantArgs, SimulateArgs, TapArgs};
use super::outcome::{Outcome, Stop, print, print_json, report};
use super::output::Output;
use super::plant::{check_other, take_other};
use super::{input, learned, output, page, progress};

/// Title of a picture of e(k).
pub(super) const ERROR_TITLE: &str = "Synchronisation error e(k)";

/// Records a program as it runs.
struct RunRecorder<'a> {
    program: u32,
    trace: Option<&'a mut TraceWriter>,
    series: Option<ErrorSeries>,
    curves: Option<HoleRecorder>,
    spindle: Option<SpindleLines>,
    bar: &'a ProgressBar,
}

impl Listener for RunRecorder<'_> {
    fn row(&mut self, pitch_mm: f64, row: &Row) {
        if let Some(trace) = &mut self.trace {
            trace.push(self.program, pitch_mm, row);
        }
        if let Some(series) = &mut self.series {
            series.row(pitch_mm, row);
        }
        if let Some(curves) = &mut self.curves {
            curves.row(pitch_mm, row);
        }
        if let Some(spindle) = &mut self.spindle {
            spindle.row(pitch_mm, row);
        }
    }

    fn hole(&mut self, outcome: &HoleOutcome) {
        self.bar.inc(1);
        tracing::debug!(
            hole = outcome.hole,
            error_um = outcome.error_um.peak_to_peak(),
            verdict = outcome.verdict().name(),
            "tapped"
        );
        if let Some(curves) = &mut self.curves {
            curves.hole(outcome);
        }
    }

    fn unfinished(&mut self, outcome: &HoleOutcome) {
        if let Some(curves) = &mut self.curves {
            curves.unfinished(outcome);
        }
    }
}

/// Runs each program on a fresh machine.
pub(super) fn simulate(common: &Common, args: &SimulateArgs) -> Result<Outcome, Stop> {
    let SimulateArgs { program, plant, tap, holes: all_holes, trace, fault, power_loss, learned: kept_at } = args;
    let written = [program.plot.as_ref(), program.report.as_ref(), trace.as_ref(), kept_at.as_ref()];
    output::check_paths(common, &program.files, &written)?;
    let file = input::machine_file(common, &[args.tap.law])?;
    let machine = input::changed(file.machine.clone(), plant.tap.as_deref(), plant.material, tap.share)?;
    let reading = input::dialect(common, &file)?;
    report_unused(common, plant, tap);
    let mut learned = kept_at.as_deref().map(|path| learned::read(path, &machine)).transpose()?;
    let simulation = simulation(machine, file.actual, plant, tap);
    let mut simulation = Simulation { faults: faults(fault)?, ..simulation };
    simulation.settings.run.power_cut = *power_loss;
    take_other(&mut simulation, plant)?;
    simulation.settings.run.sync.learn |= kept_at.is_some();
    let Simulation { machine, settings, .. } = &simulation;
    let sync = settings.run.sync;
    let mut programs = input::programs(common, &program.files, &reading, machine, &[tap.law], settings.overrides)?;

    input::check_selection(program.hole, &programs)?;

    let holes = programs.iter().map(|program| program.holes.holes()).sum();
    let bar = progress::bar(common, holes, "tapping");
    let mut drawing = program.plot.as_deref().map(Output::open).transpose()?;
    let mut paper = program.report.as_deref().map(Output::open).transpose()?;
    let mut writer = trace.as_deref().map(|path| open_trace(path, machine)).transpose()?;
    let mut outcomes = Vec::new();
    let (mut panels, mut kept, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    for (number, program) in (1..).zip(&mut programs) {
        let series = args.program.plot.is_some().then(ErrorSeries::default);
        let curves = args.program.report.is_some().then(HoleRecorder::default);
        let spindle = SpindleLines::of(args.program.selection());
        let mut recorder = RunRecorder { program: number, trace: writer.as_mut(), series, curves, spindle, bar: &bar };
        let (commands, none) = (program.commands(), &mut Learned::default());
        let outcome = simulation.run_learning(commands, &mut recorder, learned.as_mut().unwrap_or(none));
        program.intact()?;
        check_other(&simulation, plant)?;
        // Every command was planned before, under the same law and overrides.
        let outcome = outcome.map_err(|error| Stop::Usage(format!("{}: {error}", program.name)))?;
        let title = format!("{}: {}", program.name, tap.law.name());
        let period_s = machine.spec().control.period_s;
        let selection = args.program.selection();
        panels.extend(recorder.series.map(|series| picture::error_panel(title, &outcome, series, period_s, selection)));
        kept.extend(recorder.curves.map(HoleRecorder::finish));
        lines.push(recorder.spindle.map(|spindle| spindle.panels(machine)).unwrap_or_default());
        outcomes.push(outcome);
    }
    bar.finish_and_clear();
    if power_loss.is_some() && !common.quiet {
        for (program, _) in programs.iter().zip(&outcomes).filter(|(_, outcome)| outcome.power_loss.is_none()) {
            report(&format!("note: {}: the run ended before the power cut", program.name));
        }
    }
    let keep = kept_at.as_deref().zip(learned).map(|(path, learned)| learned::write(path, &learned)).transpose()?;
    let trace = match (writer, trace) {
        (Some(trace), Some(path)) => Some(Output::of(path, trace.finish())?),
        _ => None,
    };
    if let Some(drawing) = &mut drawing {
        drawing.draw(match (panels.as_slice(), lines.as_slice()) {
            ([panel], [lines]) => plot::hole_figure(ERROR_TITLE, panel, lines),
            _ => plot::error_figure(ERROR_TITLE, &panels),
        })?;
    }
    let each = || programs.iter().zip(&outcomes);
    let answered = || {
        let found =
            each().map(|(program, outcome)| SimulatedProgram::new(&program.name, tap.law, sync, machine, outcome));
        answer(common, Some(plant.seed), SimulateAnswer { programs: found.collect() })
    };
    if let Some(paper) = &mut paper {
        let worst = outcomes.iter().map(ProgramOutcome::verdict).max().unwrap_or_default();
        let summary = each().map(|(program, outcome)| table::program_summary(&program.name, outcome));
        let heading =
            page::heading(common, "Simulated tapping", Some(worst.name()), summary.collect(), Some(plant.seed));
        let mut found = Page::new(&heading);
        for ((program, outcome), holes) in each().zip(&kept) {
            found.heading(&format!("{}, law {}", program.name, tap.law.name()));
            found.figures(simulate_charts(&program.name, machine, holes));
            found.table(&table_of_holes(outcome));
        }
        page::write(paper, found, &answered())?;
    }
    drawing.into_iter().chain(trace).chain(paper).chain(keep).try_for_each(Output::keep)?;
    if common.format == Format::Json {
        print_json(&answered())?;
    } else {
        let found = each().map(|(program, outcome)| {
            table::simulated_program(layout(common), &program.name, tap.law, sync, machine, outcome, *all_holes)
        });
        print(&found.collect::<Vec<_>>().join("\n"))?;
    }
    let failed = outcomes.iter().any(|outcome| outcome.verdict() == Verdict::Fail);
    Ok(if failed { Outcome::VerdictFail } else { Outcome::Good })
}

/// Reports what is asked for and cannot be of use.
pub(super) fn report_unused(common: &Common, plant: &PlantArgs, tap: &TapArgs) {
    let asked = plant.adapting.learn || plant.adapting.identify != Identify::Approach;
    if asked && tap.compensation != Compensation::ModelBased && !common.quiet {
        report("note: --learn and --identify are of --compensation full alone: they change nothing here");
    }
}

/// The faults that the command line asks for.
fn faults(asked: &[Injection]) -> Result<[Option<Injection>; MOST_FAULTS], Stop> {
    if asked.len() > MOST_FAULTS {
        return Err(Stop::Usage(format!("--fault: {} faults are more than the {MOST_FAULTS} of one run", asked.len())));
    }
    Ok(std::array::from_fn(|index| asked.get(index).copied()))
}

/// The simulated machine that the command line asks for.
pub(super) fn simulation(machine: Machine, actual: Actual, plant: &PlantArgs, tap: &TapArgs) -> Simulation {
    let full = if plant.ideal { Effects::IDEAL } else { Effects::FULL };
    let run = plant.adapting.run(tap.sync, tap.compensation);
    Simulation {
        machine,
        actual,
        effects: tap.without.iter().fold(full, |effects, effect| effects.without(*effect)),
        seed: plant.seed,
        faults: [None; MOST_FAULTS],
        other_plant: None,
        settings: ProgramSettings { law: tap.law, overrides: input::overrides(&plant.overrides), run },
    }
}

fn open_trace(path: &std::path::Path, machine: &Machine) -> Result<TraceWriter, Stop> {
    TraceWriter::create(path, machine).map_err(|error| Stop::Output { name: input::name(path), error })
}
