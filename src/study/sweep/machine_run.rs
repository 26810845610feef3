//! One machine of a sweep: drawn, run, judged.

use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::settings::SweepSettings;
use super::stability::Stability;
use super::swept_machine::{HoleErrors, SweptMachine};
use crate::control::machine::Machine;
use crate::control::units::{mm_from_um, um_from_mm};
use crate::gcode::program::Action;
use crate::run::{HoleOutcome, Listener, Row, run_actions};
use crate::sim::Actual;
use crate::study::simulation::Simulation;

/// Odd, so that no two runs of a sweep get the same seed: 2⁶⁴ over the golden ratio, which spreads them evenly.
const SEED_STEP: u64 = 0x9E37_79B9_7F4A_7C15;
/// A seed has as many bits as a double holds exactly: any reader of JSON or CSV keeps it.
const SEED_BITS: u32 = 53;

/// How one machine differs from the nominal one, and the seed of what is random in it. It depends on the sweep's seed and
/// the run's number alone, never on which thread runs it or when.
pub(super) fn draw(settings: &SweepSettings, nominal: Actual, run: u32) -> (Actual, u64) {
    let mut random = Pcg64Mcg::seed_from_u64(settings.seed.wrapping_add(SEED_STEP.wrapping_mul(run.into())));
    let actual = settings.spread.map_or(nominal, |spread| spread.draw_onto(&nominal, &mut random));
    // A generator of its own: the same machines as without it, with more on top.
    let mut further = Pcg64Mcg::seed_from_u64(!settings.seed ^ SEED_STEP.wrapping_mul(run.into()));
    let actual = settings.hard.map_or(actual, |hard| hard.draw_onto(&actual, &mut further));
    (actual, noise_seed(&mut random))
}

/// A seed of what is random in a machine.
pub(super) fn noise_seed(random: &mut impl Rng) -> u64 {
    random.next_u64() >> (u64::BITS - SEED_BITS)
}

/// Runs one machine: `actions` are the nominal machine's, planned once for all. What `recorder` held before is of no matter.
pub(in crate::study) fn run_machine(
    base: &Simulation,
    settings: &SweepSettings,
    actions: &[Action],
    run: u32,
    recorder: &mut RunRecorder,
) -> SweptMachine {
    tap(base, settings, actions, run, draw(settings, base.actual, run), recorder)
}

/// The same of a machine that is given.
pub(super) fn tap(
    base: &Simulation,
    settings: &SweepSettings,
    actions: &[Action],
    run: u32,
    (actual, seed): (Actual, u64),
    recorder: &mut RunRecorder,
) -> SweptMachine {
    recorder.reset();
    let mut plant = base.plant(actual, seed);
    let outcome = run_actions(actions, &base.machine, base.settings.run, &mut plant, recorder);
    let hole = |number: u32| recorder.holes.get(number as usize - 1).copied().unwrap_or(HoleErrors::NONE);
    let first = hole(1);
    let later_um = (2..=settings.holes.get()).map(|number| hole(number).worst_um);
    SweptMachine {
        run,
        seed,
        actual,
        first,
        last: hole(settings.holes.get()),
        worst_growth_ratio: later_um.reduce(f64::max).map(|later_um| later_um / first.worst_um),
        saturated: recorder.saturated,
        unstable: recorder.stability.unstable(),
        alarm: outcome.fault.map(|fault| fault.alarm.code()),
    }
}

/// What is seen of one machine's run; a thread keeps one for all its machines.
pub(in crate::study) struct RunRecorder {
    stability: Stability,
    holes: Vec<HoleErrors>,
    saturated: bool,
}

impl RunRecorder {
    pub(in crate::study) fn new(machine: &Machine, pitch_mm: f64) -> Self {
        let spec = machine.spec();
        let (z_count_mm, spindle_count_mm) =
            (1.0 / spec.z_axis.encoder_counts_per_mm, pitch_mm / spec.spindle.encoder_counts_per_rev);
        let interpolation_mm =
            mm_from_um(spec.drive.z_interpolation_um) + spec.drive.spindle_interpolation_counts * spindle_count_mm;
        let resolution_um = um_from_mm(z_count_mm + spindle_count_mm + 2.0 * interpolation_mm);
        Self { stability: Stability::new(spec.control.period_s, resolution_um), holes: Vec::new(), saturated: false }
    }

    fn reset(&mut self) {
        self.stability.reset();
        self.holes.clear();
        self.saturated = false;
    }
}

impl Listener for RunRecorder {
    fn row(&mut self, _pitch_mm: f64, row: &Row) {
        self.stability.row(row);
    }

    fn hole(&mut self, outcome: &HoleOutcome) {
        self.saturated |= outcome.saturated;
        self.holes.push(HoleErrors::of(outcome));
    }

    /// The hole in which an alarm came is bad, not missing.
    fn unfinished(&mut self, outcome: &HoleOutcome) {
        self.hole(outcome);
    }
}
