//! `rigidtap compare`.

use crate::control::sync::{Compensation, Mode};
use crate::report::json::{CompareAnswer, ComparedProgram};
use crate::report::page::{Page, compare_charts};
use crate::report::table::Layout;
use crate::report::{picture, plot, table};
use crate::run::ProgramSettings;
use crate::sim::{Actual, Effect, Effects, MOST_FAULTS};
use crate::study::{self, CompareError, Simulation, Variant};

use super::answer::{answer, layout};
use super::args::{Common, CompareArgs, Format, Without};
use super::outcome::{Outcome, Stop, print, print_json};
use super::output::{self, Output};
use super::plant::{check_other, take_other};
use super::simulate::ERROR_TITLE;
use super::{input, learned, page, progress};

/// Runs each program under every combination.
pub(super) fn compare(common: &Common, args: &CompareArgs) -> Result<Outcome, Stop> {
    let plant = &args.plant;
    output::check_paths(common, &args.program.files, &[args.program.plot.as_ref(), args.program.report.as_ref()])?;
    let drawing = args.program.plot.as_deref().map(Output::open).transpose()?;
    let mut paper = args.program.report.as_deref().map(Output::open).transpose()?;
    let file = input::machine_file(common, &args.laws)?;
    let machine = input::changed(file.machine.clone(), plant.tap.as_deref(), plant.material, None)?;
    let reading = input::dialect(common, &file)?;
    let overrides = input::overrides(&plant.overrides);
    let mut programs = input::programs(common, &args.program.files, &reading, &machine, &args.laws, overrides)?;
    input::check_selection(args.program.hole, &programs)?;

    let full = if plant.ideal { Effects::IDEAL } else { Effects::FULL };
    let mut base = Simulation {
        machine,
        actual: file.actual,
        effects: full,
        seed: plant.seed,
        faults: [None; MOST_FAULTS],
        other_plant: None,
        settings: ProgramSettings {
            overrides,
            run: plant.adapting.run(Mode::default(), Compensation::ModelBased),
            ..ProgramSettings::default()
        },
    };
    take_other(&mut base, plant)?;
    let learned = args.learned.as_deref().map(|path| learned::read(path, &base.machine)).transpose()?;
    let variants = variants(args, &lacking(&args.without, &base.actual));
    let learned = learned.unwrap_or_default();
    let bar = progress::bar(common, variants.len() * programs.len(), "comparing");
    let mut compared = Vec::new();
    for program in &mut programs {
        // Every variant runs them, on several threads.
        let commands = program.collect()?;
        let results = study::compare(&commands, &base, &variants, &learned, &|| bar.inc(1));
        let results = results.map_err(|error| match error {
            CompareError::Tune(error) => input::untunable(&error),
            CompareError::Plan(error) => Stop::Usage(format!("{}: {error}", program.name)),
        })?;
        check_other(&base, plant)?;
        compared.push((program.name.clone(), results));
    }
    bar.finish_and_clear();
    let answered = || {
        let programs = compared.iter().map(|(name, results)| ComparedProgram::new(name, results));
        answer(common, Some(plant.seed), CompareAnswer { programs: programs.collect() })
    };
    if let Some(paper) = &mut paper {
        let heading = page::heading(common, "Laws side by side", None, Vec::new(), Some(plant.seed));
        let mut found = Page::new(&heading);
        found.verbatim(&table::compared(Layout::new(160, true), &compared));
        for (name, results) in &compared {
            let named: Vec<_> = results.iter().map(|result| (variant_title(&result.variant), result)).collect();
            found.heading(name);
            found.figures(compare_charts(name, &named, base.machine.spec().control.period_s));
        }
        page::write(paper, found, &answered())?;
    }
    paper.map(Output::keep).transpose()?;
    if let Some(mut drawing) = drawing {
        let panels: Vec<_> = compared
            .iter()
            .flat_map(|(name, results)| results.iter().map(move |result| (name, result)))
            .map(|(name, result)| {
                let title = format!("{name}: {}", variant_title(&result.variant));
                let period_s = base.machine.spec().control.period_s;
                picture::error_panel(title, &result.outcome, result.series.clone(), period_s, args.program.selection())
            })
            .collect();
        drawing.draw(plot::error_figure(ERROR_TITLE, &panels))?;
        drawing.keep()?;
    }
    if common.format == Format::Json {
        print_json(&answered())?;
    } else {
        print(&table::compared(layout(common), &compared))?;
    }
    Ok(Outcome::Good)
}

/// The full plant, and beside it the plant without each listed effect; each of them is each that the machine has.
fn lacking(without: &[Without], actual: &Actual) -> Vec<Option<Effect>> {
    let listed = without.iter().flat_map(|without| match without {
        Without::Each => Effect::ALL.into_iter().filter(|effect| actual.has(*effect)).collect(),
        Without::Effect(effect) => vec![*effect],
    });
    std::iter::once(None).chain(listed.map(Some)).collect()
}

/// Every combination of the lists. A law that no motor share changes runs once for all shares.
fn variants(args: &CompareArgs, without: &[Option<Effect>]) -> Vec<Variant> {
    let shares: Vec<Option<f64>> =
        if args.shares.is_empty() { vec![None] } else { args.shares.iter().copied().map(Some).collect() };
    let mut variants = Vec::new();
    for &law in &args.laws {
        let shares = if law.follows_motor_share() { &shares[..] } else { &[None] };
        for &mode in &args.syncs {
            for &compensation in &args.compensations {
                for &share in shares {
                    for &without in without {
                        let mut sync = args.plant.adapting.run(mode, compensation).sync;
                        // The papers' tables are of controls that believe what they are told, and Z that follows unpredicted
                        // leaves the thread by its nature.
                        sync.supervise &= compensation == Compensation::ModelBased && mode != Mode::Following;
                        sync.learn |= args.learned.is_some();
                        let variant = Variant { law, sync, share, without };
                        if !variants.contains(&variant) {
                            variants.push(variant);
                        }
                    }
                }
            }
        }
    }
    variants
}

fn variant_title(variant: &Variant) -> String {
    let Variant { law, sync, share, without } = variant;
    let mut title = format!("{}, {}, {}", law.name(), sync.mode.name(), sync.compensation.name());
    if let Some(share) = share {
        title += &format!(", share {share}");
    }
    if let Some(effect) = without {
        title += &format!(", without {}", effect.name());
    }
    title
}
