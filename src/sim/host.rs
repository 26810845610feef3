//! What lies between the host and the machine: a beat that jitters, readings that come twice, periods that are missed.

use arrayvec::ArrayVec;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use super::actual::Actual;
use super::effects::Effect;
use crate::control::cycle::TapCycle;

/// Most mishaps of one kind in a hole.
const MOST: usize = 32;

/// One random sequence of the many that the effects of the hard spread draw from: apart from the standard effects',
/// and apart from each other, so that switching one off leaves the others as they were.
pub(super) fn stream(seed: u64, effect: Effect) -> Pcg64Mcg {
    const APART: u64 = 0xD1B5_4A32_D192_ED03;
    Pcg64Mcg::seed_from_u64(seed ^ APART.wrapping_mul(effect as u64 + 1))
}

/// Events that happen somewhere on the strokes of a hole, evenly over its depth in both directions.
#[derive(Clone, Debug)]
struct Mishaps {
    per_hole: f64,
    random: Pcg64Mcg,
    /// Those of the hole in force: whether on the way in, and at which share of its depth.
    due: ArrayVec<(bool, f64), MOST>,
}

impl Mishaps {
    fn new(per_hole: f64, random: Pcg64Mcg) -> Self {
        Self { per_hole, random, due: ArrayVec::new() }
    }

    /// The whole part of the mean for certain, one more with what is left as its probability.
    fn begin_hole(&mut self) {
        self.due.clear();
        if self.per_hole <= 0.0 {
            return;
        }
        let one_more = self.random.random::<f64>() < self.per_hole.fract();
        let count = (self.per_hole.floor() as usize + usize::from(one_more)).min(MOST);
        for _ in 0..count {
            self.due.push((self.random.random(), self.random.random()));
        }
    }

    /// Whether one lies between two shares of the depth; it is used up.
    fn happens(&mut self, from: f64, to: f64) -> bool {
        let between = |(inwards, share): &(bool, f64)| {
            if *inwards { from < *share && *share <= to } else { to <= *share && *share < from }
        };
        let before = self.due.len();
        self.due.retain(|mishap| !between(mishap));
        self.due.len() < before
    }
}

/// The host with what goes wrong in it.
#[derive(Clone, Debug)]
pub(super) struct Host {
    jitter_s: f64,
    jitter: Pcg64Mcg,
    /// How late the host is in this period.
    late_s: f64,
    stale: Mishaps,
    missed: Mishaps,
    /// R plane and depth of the hole in force.
    hole_mm: Option<(f64, f64)>,
    /// Share of the depth that was commanded a period ago.
    depth_share: f64,
    /// The reading of this period is the one before.
    pub(super) is_stale: bool,
    /// The host misses the next period.
    pub(super) misses_next: bool,
}

impl Host {
    pub(super) fn new(actual: &Actual, seed: u64) -> Self {
        let mishaps = |per_hole: f64, effect: Effect| Mishaps::new(per_hole, stream(seed, effect));
        Self {
            jitter_s: actual.host_jitter_s,
            jitter: stream(seed, Effect::HostJitter),
            late_s: 0.0,
            stale: mishaps(actual.stale_samples_per_hole, Effect::StaleSamples),
            missed: mishaps(actual.missed_periods_per_hole, Effect::MissedPeriods),
            hole_mm: None,
            depth_share: 0.0,
            is_stale: false,
            misses_next: false,
        }
    }

    pub(super) fn begin_hole(&mut self, cycle: &TapCycle) {
        self.hole_mm = Some((cycle.r_plane_mm, cycle.depth_mm()));
        self.depth_share = 0.0;
        self.stale.begin_hole();
        self.missed.begin_hole();
    }

    /// A new period: how late the host reads and writes in it.
    pub(super) fn begin_period(&mut self) -> f64 {
        if self.jitter_s > 0.0 {
            self.late_s = self.jitter.random_range(-self.jitter_s..=self.jitter_s);
        }
        self.late_s
    }

    pub(super) fn late_s(&self) -> f64 {
        self.late_s
    }

    /// What goes wrong after this command of Z.
    pub(super) fn command(&mut self, z_mm: f64) {
        let Some((r_plane_mm, depth_mm)) = self.hole_mm else { return };
        let share = (r_plane_mm - z_mm) / depth_mm;
        self.is_stale = self.stale.happens(self.depth_share, share);
        self.misses_next = self.missed.happens(self.depth_share, share);
        self.depth_share = share;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Holes of 25 mm in 400 periods each way: how many mishaps each has, and how deep.
    fn holes(actual: Actual, count: u32) -> Vec<(u32, u32, Vec<f64>)> {
        let mut host = Host::new(&actual, 7);
        let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0);
        (0..count)
            .map(|_| {
                host.begin_hole(&hole);
                let (mut stale, mut missed, mut depths) = (0, 0, Vec::new());
                for period in 0..=800_u32 {
                    let depth_mm = 25.0 * (1.0 - (f64::from(period) / 400.0 - 1.0).abs());
                    host.command(-depth_mm);
                    stale += u32::from(host.is_stale);
                    missed += u32::from(host.misses_next);
                    if host.is_stale {
                        depths.push(depth_mm);
                    }
                }
                (stale, missed, depths)
            })
            .collect()
    }

    #[test]
    fn mishaps_come_as_often_as_their_mean_and_at_any_depth() {
        let actual = Actual { stale_samples_per_hole: 2.2, missed_periods_per_hole: 0.05, ..Actual::default() };
        let holes = holes(actual, 4000);
        let mean =
            |of: fn(&(u32, u32, Vec<f64>)) -> u32| holes.iter().map(|hole| f64::from(of(hole))).sum::<f64>() / 4000.0;
        assert!((mean(|hole| hole.0) - 2.2).abs() < 0.03 && (mean(|hole| hole.1) - 0.05).abs() < 0.012);
        // Two of a kind that fall into one period are one.
        assert!(holes.iter().all(|hole| (1..=3).contains(&hole.0) && hole.1 <= 1));
        let depths: Vec<f64> = holes.iter().flat_map(|hole| hole.2.clone()).collect();
        let mean_mm = depths.iter().sum::<f64>() / depths.len() as f64;
        assert!((mean_mm - 12.5).abs() < 0.3, "{mean_mm} mm");
    }

    #[test]
    fn one_kind_does_not_move_the_other() {
        let both = Actual { stale_samples_per_hole: 0.5, missed_periods_per_hole: 0.5, ..Actual::default() };
        let missed = |actual| holes(actual, 50).iter().map(|hole| hole.1).collect::<Vec<_>>();
        assert_eq!(missed(both), missed(both.without(Effect::StaleSamples)));
        assert!(holes(both.without(Effect::MissedPeriods), 50).iter().all(|hole| hole.1 == 0));
    }
}
