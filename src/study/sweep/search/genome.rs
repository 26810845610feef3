//! A machine as a point of the unit cube: what a sweep draws of it, each number between 0 and 1.

use std::convert::Infallible;

use rand::rand_core::TryRng;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::sim::Actual;
use crate::study::sweep::machine_run::noise_seed;
use crate::study::sweep::settings::SweepSettings;

/// Bits of a number between 0 and 1 that a generator gives.
const SHARE_BITS: u32 = 53;
/// The greatest share: 1 itself is never drawn.
const MOST: f64 = 1.0 - 1.0 / (1_u64 << SHARE_BITS) as f64;

/// A machine of the box that a sweep draws from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Genome {
    /// What each draw takes, in the order of the draws.
    shares: Vec<f64>,
    /// Seed of what is random in the machine.
    seed: u64,
}

/// A generator that gives numbers which are given to it, and random ones beyond them.
struct Given<'a> {
    shares: &'a mut Vec<f64>,
    next: usize,
    beyond: &'a mut Pcg64Mcg,
}

impl TryRng for Given<'_> {
    type Error = Infallible;

    fn try_next_u32(&mut self) -> Result<u32, Infallible> {
        self.try_next_u64().map(|bits| (bits >> 32) as u32)
    }

    fn try_next_u64(&mut self) -> Result<u64, Infallible> {
        while self.shares.len() <= self.next {
            self.shares.push(self.beyond.random());
        }
        let share = self.shares.get(self.next).copied().unwrap_or(0.0);
        self.next += 1;
        // As `random::<f64>` reads it: the upper 53 bits.
        Ok(((share * (1_u64 << SHARE_BITS) as f64) as u64) << (u64::BITS - SHARE_BITS))
    }

    fn try_fill_bytes(&mut self, bytes: &mut [u8]) -> Result<(), Infallible> {
        for block in bytes.chunks_mut(8) {
            let word = self.try_next_u64()?.to_le_bytes();
            block.iter_mut().zip(word).for_each(|(byte, of)| *byte = of);
        }
        Ok(())
    }
}

/// The machine that draws of these shares make; missing shares are drawn.
fn drawn(settings: &SweepSettings, nominal: Actual, shares: &mut Vec<f64>, beyond: &mut Pcg64Mcg) -> Actual {
    let mut given = Given { shares, next: 0, beyond };
    let actual = settings.spread.map_or(nominal, |spread| spread.draw_onto(&nominal, &mut given));
    settings.hard.map_or(actual, |hard| hard.draw_onto(&actual, &mut given))
}

impl Genome {
    /// Anywhere in the box.
    pub(super) fn random(settings: &SweepSettings, nominal: Actual, random: &mut Pcg64Mcg) -> Self {
        let mut shares = Vec::new();
        drawn(settings, nominal, &mut shares, random);
        Self { shares, seed: noise_seed(random) }
    }

    /// The machine with its seed.
    pub(super) fn machine(&self, settings: &SweepSettings, nominal: Actual) -> (Actual, u64) {
        // Every share is there.
        let mut unused = Pcg64Mcg::seed_from_u64(0);
        (drawn(settings, nominal, &mut self.shares.clone(), &mut unused), self.seed)
    }

    /// Differential evolution's trial, current to one of the best (Zhang and Sanderson 2009): of each share with probability
    /// `crossover`, and of one in any case, where it leads `factor` of the way to `best` and `factor` of the difference of
    /// two others; bounded by the box. A seed is one of the parents', or now and then a new one.
    pub(super) fn trial(
        &self,
        best: &Self,
        others: [&Self; 2],
        (factor, crossover): (f64, f64),
        random: &mut Pcg64Mcg,
    ) -> Self {
        let sure = random.random_range(0..self.shares.len().max(1));
        let share = |(index, own): (usize, &f64)| {
            let of = |genome: &Self| genome.shares.get(index).copied().unwrap_or(*own);
            let taken = index == sure || random.random::<f64>() < crossover;
            let moved = own + factor * (of(best) - own) + factor * (of(others[0]) - of(others[1]));
            if taken { moved.clamp(0.0, MOST) } else { *own }
        };
        let shares = self.shares.iter().enumerate().map(share).collect();
        let seed = match random.random_range(0..4) {
            0 => noise_seed(random),
            1 => best.seed,
            _ => self.seed,
        };
        Self { shares, seed }
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZeroU32;

    use super::*;
    use crate::sim::{HardSpread, Spread};

    /// Shares from a sweep's own generator are the sweep's own machine, to the bit.
    #[test]
    fn a_genome_is_a_machine_of_the_sweep() {
        let settings = SweepSettings {
            runs: NonZeroU32::MIN,
            seed: 1,
            holes: NonZeroU32::MIN,
            spread: Some(Spread::default()),
            hard: Some(HardSpread::default()),
            jobs: None,
        };
        let nominal = Actual::default();
        for seed in 0..100 {
            let mut random = Pcg64Mcg::seed_from_u64(seed);
            let mut same = random.clone();
            let genome = Genome::random(&settings, nominal, &mut random);
            let actual = Spread::default().draw_onto(&nominal, &mut same);
            let actual = HardSpread::default().draw_onto(&actual, &mut same);
            assert_eq!(genome.machine(&settings, nominal), (actual, genome.seed));
        }
    }

    #[test]
    fn a_trial_stays_in_the_box_and_reaches_its_corners() {
        let mut random = Pcg64Mcg::seed_from_u64(1);
        let of = |share: f64| Genome { shares: vec![share; 9], seed: 3 };
        let trial = of(0.5).trial(&of(0.9), [&of(0.9), &of(0.1)], (0.9, 1.0), &mut random);
        assert_eq!(trial.shares, [MOST; 9]);
        let trial = of(0.5).trial(&of(0.1), [&of(0.1), &of(0.9)], (0.9, 0.0), &mut random);
        assert_eq!(trial.shares.iter().filter(|share| **share == 0.0).count(), 1);
        assert_eq!(trial.shares.iter().filter(|share| **share == 0.5).count(), 8);
    }
}
