//! `rigidtap compare`.

use serde_json::json;

use crate::control::sync::Settings;
use crate::gcode::Options;
use crate::report::{json, picture, table};
use crate::run::{ProgramSettings, RunSettings};
use crate::sim::{Effect, Effects};
use crate::study::{self, CompareError, Simulation, Variant};

use super::args::{Common, CompareArgs, Format, Without};
use super::outcome::{Outcome, Stop, print, print_json};
use super::simulate::save_figure;
use super::{input, progress};

/// Runs each program under every combination.
pub(super) fn compare(common: &Common, args: &CompareArgs) -> Result<Outcome, Stop> {
    let plant = &args.plant;
    let file = input::machine_file(common)?;
    let machine = input::changed(file.machine.clone(), plant.tap.as_deref(), plant.material, None)?;
    let dialect = input::dialect(common, &file)?;
    let overrides = input::overrides(&plant.overrides);
    let programs = input::programs(common, &plant.files, &dialect, &machine, &args.laws, overrides)?;

    let full = if plant.ideal { Effects::IDEAL } else { Effects::FULL };
    let (effects, without) = effects(full, &args.without);
    let base = Simulation {
        machine,
        actual: file.actual,
        effects,
        seed: plant.seed,
        settings: ProgramSettings {
            overrides,
            run: RunSettings { start_mm: Options::default().start_mm, ..RunSettings::default() },
            ..ProgramSettings::default()
        },
    };
    let variants = variants(args, &without);
    let bar = progress::bar(common, variants.len() * programs.len(), "comparing");
    let mut compared = Vec::new();
    for program in &programs {
        let results = study::compare(&program.commands, &base, &variants, &|| bar.inc(1));
        let results = results.map_err(|error| match error {
            CompareError::Tune(error) => input::untunable(&error),
            CompareError::Plan(error) => Stop::Usage(format!("{}: {error}", program.name)),
        })?;
        compared.push((program.name.clone(), results));
    }
    bar.finish_and_clear();
    if let Some(path) = &plant.plot {
        let panels: Vec<_> = compared
            .iter()
            .flat_map(|(name, results)| results.iter().map(move |result| (name, result)))
            .map(|(name, result)| {
                let title = format!("{name}: {}", variant_title(&result.variant));
                picture::error_panel(title, &result.outcome, result.series.clone())
            })
            .collect();
        save_figure(path, &panels)?;
    }
    if common.format == Format::Json {
        let programs = compared.iter().map(|(name, results)| json::compared_program(name, results));
        print_json(&json!({ "programs": programs.collect::<Vec<_>>() }))?;
    } else {
        print(&table::compared(&compared))?;
    }
    Ok(Outcome::Good)
}

/// The effects every variant has, and what each variant lacks beyond that.
fn effects(full: Effects, without: &[Without]) -> (Effects, Vec<Option<Effect>>) {
    let each = without.contains(&Without::Each);
    let off = without.iter().filter_map(|without| match without {
        Without::Each => None,
        Without::Effect(effect) => Some(*effect),
    });
    let common = off.fold(full, Effects::without);
    let lacking = if each { Effect::ALL.iter().copied().map(Some).collect() } else { Vec::new() };
    (common, std::iter::once(None).chain(lacking).collect())
}

/// Every combination of the lists.
fn variants(args: &CompareArgs, without: &[Option<Effect>]) -> Vec<Variant> {
    let shares: Vec<Option<f64>> =
        if args.shares.is_empty() { vec![None] } else { args.shares.iter().copied().map(Some).collect() };
    let mut variants = Vec::new();
    for &law in &args.laws {
        for &mode in &args.syncs {
            for &compensation in &args.compensations {
                for &share in &shares {
                    for &without in without {
                        let variant = Variant { law, sync: Settings { mode, compensation }, share, without };
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
