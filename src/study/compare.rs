//! The same program under many settings, side by side, on all cores.

use crate::control::machine::Law;
use crate::control::sync::{ErrorBand, Settings};
use crate::gcode::Command;
use crate::gcode::program::PlanError;
use crate::laws::{TuneError, retuned};
use crate::run::{HoleOutcome, Learned, ProgramOutcome, Verdict};
use crate::sim::Effect;

use super::parallel::{cores, in_order};
use super::simulation::{ErrorSeries, Simulation};

/// One combination of settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variant {
    /// Time law.
    pub law: Law,
    /// Synchronisation.
    pub sync: Settings,
    /// Motor share that the bands are retuned to; none keeps the file's.
    pub share: Option<f64>,
    /// Effect that the plant lacks; none for the full plant.
    pub without: Option<Effect>,
}

/// What a program comes to, worst over its holes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Summary {
    /// Longest stroke.
    pub stroke_s: f64,
    /// Greatest stroke time over the bound.
    pub stroke_over_bound: f64,
    /// Greatest peak speed.
    pub peak_rpm: f64,
    /// Greatest torque that a plan asks for its inertia, over what the motor has at that speed.
    pub peak_torque_share: f64,
    /// Greatest planned jerk, rpm/s²; none where some acceleration steps.
    pub peak_jerk_rpm_per_s2: Option<f64>,
    /// Measured e(k) of the hole with the widest band, µm.
    pub error_um: ErrorBand,
    /// True e(k) of the hole with the widest band, µm.
    pub true_error_um: ErrorBand,
    /// Greatest following error of the spindle, a magnitude.
    pub spindle_following_error_rev: f64,
    /// Some hole saturated the spindle's drive.
    pub saturated: bool,
    /// Worst verdict.
    pub verdict: Verdict,
}

impl Summary {
    /// The worst of a program's holes.
    #[must_use]
    pub fn of(outcome: &ProgramOutcome) -> Self {
        let holes = &outcome.holes;
        let strokes = || holes.iter().flat_map(|hole| &hole.strokes);
        let greatest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        let widest = |band: fn(&HoleOutcome) -> ErrorBand| {
            holes
                .iter()
                .map(band)
                .max_by(|left, right| left.peak_to_peak().total_cmp(&right.peak_to_peak()))
                .unwrap_or_default()
        };
        Self {
            stroke_s: greatest(&mut strokes().map(|stroke| stroke.duration_s)),
            stroke_over_bound: greatest(&mut strokes().map(|stroke| stroke.stroke_over_bound())),
            peak_rpm: greatest(&mut strokes().map(|stroke| stroke.peak_rpm)),
            peak_torque_share: greatest(&mut strokes().map(|stroke| stroke.peak_torque_share)),
            peak_jerk_rpm_per_s2: strokes()
                .map(|stroke| stroke.peak_jerk_rpm_per_s2)
                .try_fold(0.0, |greatest: f64, jerk| Some(greatest.max(jerk?))),
            error_um: widest(|hole| hole.error_um),
            true_error_um: widest(|hole| hole.true_error_um),
            spindle_following_error_rev: greatest(&mut holes.iter().map(HoleOutcome::spindle_following_error_rev)),
            saturated: holes.iter().any(|hole| hole.saturated),
            verdict: outcome.verdict(),
        }
    }
}

/// One combination's result.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The combination.
    pub variant: Variant,
    /// How the program ran.
    pub outcome: ProgramOutcome,
    /// e(k) over time, for plots.
    pub series: ErrorSeries,
}

/// Why a combination cannot run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CompareError {
    /// The machine's bands cannot be retuned to the share.
    Tune(TuneError),
    /// The machine cannot carry out a command.
    Plan(PlanError),
}

/// Runs a program under each variant of a base, on as many threads as there are cores; results in the variants' order,
/// the same bytes on any number of threads; each begins with what earlier holes taught. `done` is called after each.
///
/// # Errors
/// The first variant in order that cannot run.
pub fn compare(
    commands: &[Command],
    base: &Simulation,
    variants: &[Variant],
    learned: &Learned,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<Comparison>, CompareError> {
    let job =
        |(): &mut (), index: usize| variants.get(index).map(|variant| run_variant(commands, base, *variant, learned));
    let go_on = || {
        done();
        true
    };
    let results = in_order(cores(), variants.len(), &|| (), &job, &go_on);
    results.into_iter().flatten().flatten().collect()
}

fn run_variant(
    commands: &[Command],
    base: &Simulation,
    variant: Variant,
    learned: &Learned,
) -> Result<Comparison, CompareError> {
    let mut simulation = base.clone();
    if let Some(share) = variant.share {
        simulation.machine = retuned(&base.machine, share).map_err(CompareError::Tune)?;
    }
    if let Some(effect) = variant.without {
        simulation.effects = base.effects.without(effect);
    }
    simulation.settings.law = variant.law;
    simulation.settings.run.sync = variant.sync;
    let mut series = ErrorSeries::default();
    let outcome = simulation.run_learning(commands, &mut series, &mut learned.clone()).map_err(CompareError::Plan)?;
    Ok(Comparison { variant, outcome, series })
}
