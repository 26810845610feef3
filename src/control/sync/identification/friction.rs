//! Z's friction and its weight, from the force of its drive less what accelerates it.
//!
//! Least squares of force = Coulomb·direction + viscous·speed − weight + mass error·inertia + age·rate of force over windows
//! in which Z slides (friction terms after Armstrong-Hélouvry, Dupont and Canudas de Wit, A survey of models, analysis
//! tools and compensation methods for the control of machines with friction, Automatica 30(7), 1994). What the motion so far
//! cannot separate stays where the file has it.

use crate::control::math::least_squares::{NormalEquations, Prior};
use crate::control::math::{sign, sqrt};
use crate::control::sync::plant_model::ZModel;

use super::standing_out::standing_out;

/// Standard deviations of what the file says: Coulomb friction and mass, as shares of them.
const COULOMB_SHARE: f64 = 0.6;
const MASS_SHARE: f64 = 0.02;
/// Standard deviations of what no file says: viscous friction in N·s/mm, weight that nothing balances as a share of Z's, and
/// how much older or newer than speeds the reported forces are.
const VISCOUS_N_S_PER_MM: f64 = 1.0;
const WEIGHT_SHARE: f64 = 0.1;
const AGE_S: f64 = 4e-4;
const GRAVITY_M_PER_S2: f64 = 9.81;
/// Standard deviation of a window's force: as a share of the file's friction, which changes along the way, and as a share of
/// what accelerates Z in the window, since speed and force are not measured at quite the same time.
const FRICTION_RIPPLE: f64 = 0.15;
const INERTIA_SHARE: f64 = 0.01;
/// By so many times what windows scatter beyond that, a value has to stand out more.
const SCATTERS: f64 = 0.4;
/// Windows in each direction from which on weight is separated from friction.
const BOTH_WAYS_WINDOWS: f64 = 0.5;
/// Least and greatest friction over the file's: worn in, and cold.
const POSSIBLE_SHARES: (f64, f64) = (0.33, 2.6);

/// Friction and weight, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Forces {
    /// Force that holds Z up in both directions.
    pub(super) weight_n: f64,
    /// Coulomb friction.
    pub(super) friction_n: f64,
    /// Viscous friction.
    pub(super) viscous_n_s_per_mm: f64,
}

impl Forces {
    /// What the screw carries of a load that slides in a direction, ±1, at a speed and an acceleration.
    pub(super) fn on_screw_n(&self, model: &ZModel, direction: f64, mm_per_s: f64, mm_per_s2: f64) -> f64 {
        let friction_n = direction * self.friction_n + self.viscous_n_s_per_mm * mm_per_s;
        model.load_friction_share * friction_n + model.load_n(mm_per_s2) - self.weight_n
    }
}

/// What one window shows, positive into the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SlidingWindow {
    /// 1 into the hole, −1 out of it.
    pub(super) direction: f64,
    pub(super) speed_mm_per_s: f64,
    /// Mean force of the drive, and what of it the file's mass takes.
    pub(super) force_n: f64,
    pub(super) inertia_n: f64,
    /// How fast the force changes.
    pub(super) rate_n_per_s: f64,
}

/// The fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FrictionFit {
    file_n: f64,
    weight_deviation_n: f64,
    sums: NormalEquations<5>,
    /// Σ y².
    squares: f64,
}

impl FrictionFit {
    /// For what the file says of friction and mass.
    pub(super) fn new(file_n: f64, mass_kg: f64) -> Self {
        let weight_deviation_n = WEIGHT_SHARE * mass_kg * GRAVITY_M_PER_S2;
        Self { file_n, weight_deviation_n, sums: NormalEquations::default(), squares: 0.0 }
    }

    fn noise_n(&self) -> f64 {
        FRICTION_RIPPLE * self.file_n.max(1.0)
    }

    pub(super) fn add(&mut self, window: &SlidingWindow) {
        let SlidingWindow { direction, speed_mm_per_s, force_n, inertia_n, rate_n_per_s } = *window;
        // Every row is brought to the noise of one without acceleration.
        let scale = 1.0 / (1.0 + INERTIA_SHARE * inertia_n.abs() / self.noise_n());
        let row = [direction, speed_mm_per_s, -1.0, inertia_n, rate_n_per_s].map(|column| scale * column);
        let value = scale * (force_n - inertia_n);
        self.sums.add(row, value);
        self.squares += value * value;
    }

    /// What outlives a restart.
    pub(super) fn kept(&mut self) -> impl Iterator<Item = &mut f64> {
        self.sums.numbers_mut().chain([&mut self.squares])
    }

    pub(super) fn decay(&mut self, kept: f64) {
        self.sums.decay(kept);
        self.squares *= kept;
    }

    /// What fits best by now. Viscous friction and weight count from where they stand out of the changes of friction along the
    /// way, which would be taken for them otherwise.
    pub(super) fn identified(&self) -> Forces {
        let around = |mean: f64, deviation: f64| Prior { mean, deviation };
        let coulomb = around(self.file_n, COULOMB_SHARE * self.file_n.max(1.0));
        let (mass, age) = (around(0.0, MASS_SHARE), around(0.0, AGE_S));
        let noise_n = self.noise_n();
        let fit = |viscous: Prior, weight: Prior| self.sums.solve([coulomb, viscous, weight, mass, age], noise_n);
        let weight = around(0.0, self.weight_deviation_n);
        let free = fit(around(0.0, VISCOUS_N_S_PER_MM), weight);
        let [free_n, free_viscous, ..] = free;
        let ripple_n = FRICTION_RIPPLE * free_n.max(0.0).max(self.file_n);
        // A host that jitters measures speeds that scatter: then less stands out.
        let least_n = ripple_n + SCATTERS * (self.scatter_n(free) - ripple_n).max(0.0);
        let viscous_n_s_per_mm = standing_out(free_viscous.max(0.0), least_n / self.speed_mm_per_s());
        let viscous = around(viscous_n_s_per_mm, 1e-6);
        let weight_n = if self.fewer_windows() >= BOTH_WAYS_WINDOWS {
            let [_, _, free_weight_n, ..] = fit(viscous, weight);
            standing_out(free_weight_n, least_n)
        } else {
            // One direction shows friction less weight: what friction cannot be is weight.
            let [balanced_n, ..] = fit(viscous, around(0.0, 1e-3));
            let possible_n = balanced_n.max(POSSIBLE_SHARES.0 * self.file_n).min(POSSIBLE_SHARES.1 * self.file_n);
            self.direction() * (possible_n - balanced_n)
        };
        let [friction_n, ..] = fit(viscous, around(weight_n, 1e-3));
        Forces { weight_n, friction_n: friction_n.max(0.0), viscous_n_s_per_mm }
    }

    /// Root mean square of what a fit leaves.
    fn scatter_n(&self, solution: [f64; 5]) -> f64 {
        sqrt(((self.squares + self.sums.misfit(solution)) / self.sums.product(0, 0).max(1.0)).max(0.0))
    }

    /// Root mean square of the speeds seen.
    fn speed_mm_per_s(&self) -> f64 {
        sqrt(self.sums.product(1, 1) / self.sums.product(0, 0).max(1.0)).max(1.0)
    }

    /// Windows in the direction that was seen less.
    fn fewer_windows(&self) -> f64 {
        0.5 * (self.sums.product(0, 0) - self.sums.product(0, 2).abs())
    }

    /// The direction that was seen more.
    fn direction(&self) -> f64 {
        -sign(self.sums.product(0, 2))
    }
}

#[cfg(test)]
mod tests {
    use super::{Forces, FrictionFit, SlidingWindow};

    const TRUE: Forces = Forces { weight_n: 100.0, friction_n: 250.0, viscous_n_s_per_mm: 1.5 };

    fn window(speed_mm_per_s: f64) -> SlidingWindow {
        let direction = 1f64.copysign(speed_mm_per_s);
        let force_n = TRUE.friction_n * direction + TRUE.viscous_n_s_per_mm * speed_mm_per_s - TRUE.weight_n;
        SlidingWindow { direction, speed_mm_per_s, force_n, inertia_n: 0.0, rate_n_per_s: 0.0 }
    }

    fn after(speeds: impl IntoIterator<Item = f64>) -> Forces {
        let mut fit = FrictionFit::new(300.0, 600.0);
        speeds.into_iter().for_each(|speed| fit.add(&window(speed)));
        fit.identified()
    }

    fn assert_near(found: Forces, expected: Forces, within: f64) {
        let near = |found: f64, expected: f64| (found - expected).abs() < within;
        assert!(near(found.weight_n, expected.weight_n) && near(found.friction_n, expected.friction_n), "{found:?}");
        assert!(near(100.0 * found.viscous_n_s_per_mm, 100.0 * expected.viscous_n_s_per_mm), "{found:?}");
    }

    #[test]
    fn speeds_in_both_directions_tell_all_three_apart() {
        let speeds = (0..40).flat_map(|k| [10.0 + 4.0 * f64::from(k), -10.0 - 4.0 * f64::from(k)]);
        assert_near(after(speeds), TRUE, 5.0);
    }

    /// Friction less weight is what one direction shows: friction as far as it can be, weight beyond.
    #[test]
    fn one_direction_says_the_force_alone() {
        for (speed, weight_n) in [(20.0, 0.0), (-20.0, 0.0), (20.0, 800.0), (-20.0, 800.0), (20.0, -900.0)] {
            let mut fit = FrictionFit::new(300.0, 600.0);
            let slid = SlidingWindow { force_n: 400_f64.copysign(speed) - weight_n, ..window(speed) };
            (0..100).for_each(|_| fit.add(&slid));
            let found = fit.identified();
            let there_n = 1_f64.copysign(speed) * found.friction_n + speed * found.viscous_n_s_per_mm - found.weight_n;
            assert!((there_n - slid.force_n).abs() < 2.0, "{found:?}");
            assert!((98.0..=782.0).contains(&found.friction_n), "{found:?}");
            assert_eq!(found.weight_n == 0.0, weight_n == 0.0, "{found:?}");
        }
    }

    #[test]
    fn nothing_measured_is_the_file() {
        assert_eq!(after([]), Forces { weight_n: 0.0, friction_n: 300.0, viscous_n_s_per_mm: 0.0 });
    }

    /// A window of 5000 N of inertia that is off by 2 %.
    #[test]
    fn accelerating_windows_count_little() {
        let mut fit = FrictionFit::new(300.0, 600.0);
        for k in 0..40 {
            let speed = 10.0 + 4.0 * f64::from(k);
            fit.add(&window(speed));
            fit.add(&window(-speed));
            let fast = window(speed);
            fit.add(&SlidingWindow { inertia_n: 5000.0, force_n: fast.force_n + 5100.0, ..fast });
        }
        assert_near(fit.identified(), TRUE, 15.0);
    }
}
