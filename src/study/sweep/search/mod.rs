//! The worst machine on purpose: a search of the box that a sweep draws from.
//!
//! Differential evolution (Storn and Price 1997), towards one of the best and with factors that adapt themselves (Brest et
//! al. 2006, Zhang and Sanderson 2009). It is written here since the crates at hand would bring a second generator, a
//! second linear algebra or threads of their own; it uses the sweep's, and gives the same on any number of threads.

mod genome;

use std::cmp::Ordering;

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::machine_run::{RunRecorder, tap};
use super::settings::SweepSettings;
use super::swept_machine::SweptMachine;
use crate::gcode::program::Action;
use crate::sim::{Actual, ActualValue};
use crate::study::parallel::{cores, in_order};
use crate::study::simulation::Simulation;
use genome::Genome;

/// Machines that a generation keeps.
const POPULATION: usize = 60;
/// This share of the runs looks anywhere in the box; the search goes on from the best of those.
const ANYWHERE_SHARE: f64 = 0.1;
/// This share of a generation counts as its best.
const BEST_SHARE: f64 = 0.1;
/// How often a machine's factors are drawn anew (Brest et al. 2006).
const NEW_FACTORS: f64 = 0.1;

/// The worst machine that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct WorstMachine {
    /// The machine; its number is that of the run that found it.
    pub machine: SweptMachine,
    /// Machines that were run.
    pub runs: u32,
    /// Those that looked anywhere in the box, as a sweep does.
    pub anywhere_runs: u32,
    /// The largest error among those, µm.
    pub anywhere_um: f64,
    /// Machines whose run ended before their hole began, and which have no error.
    pub without_error: u32,
    /// What each effect has in it, the one first without which the error is least.
    pub effects: Vec<WorstEffect>,
}

/// One effect of the worst machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorstEffect {
    /// Key of `[actual]`.
    pub key: &'static str,
    /// As the worst machine has it.
    pub value: ActualValue,
    /// As the nominal machine has it.
    pub nominal: ActualValue,
    /// The error with this one effect as on the nominal machine and all others as they are; none where its run then ends
    /// before the hole begins.
    pub worst_um: Option<f64>,
}

/// A machine of the population.
#[derive(Clone)]
struct Individual {
    genome: Genome,
    found: SweptMachine,
    factor: f64,
    crossover: f64,
}

/// Larger is worse; a machine whose hole never began has no error, and is none to search for.
fn compare(left: &SweptMachine, right: &SweptMachine) -> Ordering {
    let size = |machine: &SweptMachine| Some(machine.first.worst_um).filter(|um| um.is_finite()).unwrap_or(-1.0);
    size(left).total_cmp(&size(right))
}

/// Everything that a run needs.
pub(super) struct Search<'a> {
    pub(super) base: &'a Simulation,
    pub(super) settings: &'a SweepSettings,
    pub(super) actions: &'a [Action],
    pub(super) pitch_mm: f64,
    pub(super) go_on: &'a (dyn Fn() -> bool + Sync),
}

impl Search<'_> {
    /// Runs `settings.runs` machines; none where it was told to stop, or where no machine has an error.
    pub(super) fn worst(&self) -> Option<WorstMachine> {
        let settings = self.settings;
        let runs = settings.runs.get() as usize;
        let anywhere = ((runs as f64 * ANYWHERE_SHARE) as usize).max(POPULATION).min(runs);
        let mut random = Pcg64Mcg::seed_from_u64(settings.seed);
        let genomes = (0..anywhere).map(|_| Genome::random(settings, self.base.actual, &mut random)).collect();
        let mut all = self.individuals(genomes, 0, &[(0.5, 0.9)])?;
        let mut without_error = lost(&all);
        // Stable: of equals the one with the lower number.
        all.sort_by(|left, right| compare(&right.found, &left.found));
        let anywhere_um = all.first()?.found.first.worst_um;
        all.truncate(POPULATION);
        let mut done = anywhere;
        while done < runs {
            let count = all.len().min(runs - done);
            let best = ((all.len() as f64 * BEST_SHARE) as usize).max(1);
            let (mut genomes, mut factors) = (Vec::new(), Vec::new());
            for one in all.iter().take(count) {
                let anyone = |random: &mut Pcg64Mcg| random.random_range(0..all.len());
                let of_best = random.random_range(0..best);
                let others = [anyone(&mut random), anyone(&mut random)].map(|index| &all[index].genome);
                let mut adapted = (one.factor, one.crossover);
                if random.random::<f64>() < NEW_FACTORS {
                    adapted.0 = random.random_range(0.1..1.0);
                }
                if random.random::<f64>() < NEW_FACTORS {
                    adapted.1 = random.random();
                }
                genomes.push(one.genome.trial(&all[of_best].genome, others, adapted, &mut random));
                factors.push(adapted);
            }
            let trials = self.individuals(genomes, done, &factors)?;
            done += count;
            without_error += lost(&trials);
            for (one, trial) in all.iter_mut().zip(trials) {
                if compare(&trial.found, &one.found).is_ge() {
                    *one = trial;
                }
            }
            all.sort_by(|left, right| compare(&right.found, &left.found));
        }
        let machine = all.first()?.found;
        machine.first.worst_um.is_finite().then_some(())?;
        Some(WorstMachine {
            machine,
            runs: runs as u32,
            anywhere_runs: anywhere as u32,
            anywhere_um,
            without_error,
            effects: self.effects(&machine)?,
        })
    }

    /// Runs machines. Of fewer factors than machines the last ones are for the rest.
    fn individuals(&self, genomes: Vec<Genome>, done: usize, factors: &[(f64, f64)]) -> Option<Vec<Individual>> {
        let machines: Vec<_> = genomes.iter().map(|genome| genome.machine(self.settings, self.base.actual)).collect();
        let found = self.run(&machines, done)?;
        let last = factors.last().copied().unwrap_or((0.5, 0.9));
        let factors = factors.iter().copied().chain(std::iter::repeat(last));
        let each = genomes.into_iter().zip(found).zip(factors);
        Some(
            each.map(|((genome, found), (factor, crossover))| Individual { genome, found, factor, crossover })
                .collect(),
        )
    }

    fn run(&self, machines: &[(Actual, u64)], done: usize) -> Option<Vec<SweptMachine>> {
        let Self { base, settings, actions, pitch_mm, go_on } = *self;
        in_order(
            settings.jobs.unwrap_or_else(cores),
            machines.len(),
            &|| RunRecorder::new(&base.machine, pitch_mm),
            &|recorder, index| tap(base, settings, actions, (done + index) as u32 + 1, machines[index], recorder),
            go_on,
        )
    }

    /// Every effect that is not as on the nominal machine, set back by itself.
    fn effects(&self, worst: &SweptMachine) -> Option<Vec<WorstEffect>> {
        let nominal = self.base.actual;
        let pairs = worst.actual.values().into_iter().zip(nominal.values());
        let changed: Vec<_> = pairs.filter(|((_, value), (_, nominal))| value != nominal).collect();
        let machines: Vec<_> =
            changed.iter().map(|((key, _), _)| (worst.actual.with(key, &nominal), worst.seed)).collect();
        let found = self.run(&machines, 0)?;
        let effect = |(((key, value), (_, nominal)), found): ((_, (_, _)), SweptMachine)| WorstEffect {
            key,
            value,
            nominal,
            worst_um: Some(found.first.worst_um).filter(|um| um.is_finite()),
        };
        let mut effects: Vec<_> = changed.into_iter().zip(found).map(effect).collect();
        let size = |effect: &WorstEffect| effect.worst_um.unwrap_or(f64::INFINITY);
        effects.sort_by(|left, right| size(left).total_cmp(&size(right)));
        Some(effects)
    }
}

fn lost(found: &[Individual]) -> u32 {
    found.iter().filter(|one| !one.found.first.worst_um.is_finite()).count() as u32
}
