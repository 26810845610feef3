//! Z's friction and its weight, from the force of its drive less what accelerates it.
//!
//! Least squares of force = Coulomb·direction + viscous·speed − weight + mass error·inertia + age·rate of force − the tap's
//! axial force, in and out, over windows in which Z slides (friction terms after Armstrong-Hélouvry, Dupont and Canudas de Wit, A survey of models, analysis
//! tools and compensation methods for the control of machines with friction, Automatica 30(7), 1994). What the motion so far
//! cannot separate stays where the file has it.

use crate::control::machine::Machine;
use crate::control::math::least_squares::{NormalEquations, Prior};
use crate::control::math::{sign, sqrt};
use crate::control::sync::plant_model::{AxialForce, ZModel};

use crate::control::math::standing_out::standing_out;

/// Standard deviations of what the file says: Coulomb friction and mass, as shares of them.
const COULOMB_SHARE: f64 = 0.6;
const MASS_SHARE: f64 = 0.02;
/// Standard deviations of what no file says: viscous friction in N·s/mm, weight that nothing balances as a share of Z's, and
/// how much older or newer than speeds the reported forces are.
const VISCOUS_N_S_PER_MM: f64 = 1.0;
const WEIGHT_SHARE: f64 = 0.1;
const AGE_S: f64 = 4e-4;
/// The same of a tap's axial force, N: some hundreds draw a spiral flute in.
const AXIAL_N: f64 = 150.0;
/// How much it changes from hole to hole, N: the tap wears.
const DRIFT_N: f64 = 5.0;
/// Columns of the axial force in and out.
const AXIAL_COLUMNS: [usize; 2] = [5, 6];
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
    /// The tap's.
    pub(super) axial: AxialForce,
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
    /// Share of the tap that cuts, 0…1.
    pub(super) engagement: f64,
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
    axial_told: AxialForce,
    /// The tap's axial force in and out, as earlier holes showed it.
    axial: [Prior; 2],
    sums: NormalEquations<7>,
    /// Σ y².
    squares: f64,
}

impl FrictionFit {
    /// For what the file says of friction, mass and tap.
    pub(super) fn new(machine: &Machine) -> Self {
        let (z, axial_told) = (&machine.spec().z_axis, AxialForce::told(machine));
        Self {
            axial: axial_before(&axial_told),
            file_n: z.coulomb_n,
            weight_deviation_n: WEIGHT_SHARE * z.mass_kg * GRAVITY_M_PER_S2,
            axial_told,
            sums: NormalEquations::default(),
            squares: 0.0,
        }
    }

    /// Another tap cuts from now on.
    pub(super) fn forget_axial(&mut self) {
        self.leave_axial_out();
        self.axial = axial_before(&self.axial_told);
    }

    /// What the hole before showed of the tap is kept apart: friction changes from hole to hole, and without motion above the
    /// work piece the one could not be told from the other any more.
    fn keep_axial(&mut self) {
        let (priors, noise_n) = (self.priors(), self.noise_n());
        let [.., in_n, out_n] = self.sums.solve(priors, noise_n);
        let [of_in, of_out] = AXIAL_COLUMNS.map(|column| self.sums.deviation(priors, noise_n, column));
        let kept =
            |mean: f64, deviation: f64| Prior { mean, deviation: sqrt(deviation * deviation + DRIFT_N * DRIFT_N) };
        self.axial = [kept(in_n, of_in), kept(out_n, of_out)];
        self.leave_axial_out();
    }

    fn leave_axial_out(&mut self) {
        for column in AXIAL_COLUMNS {
            let (sums, explained) = self.sums.without(column);
            self.sums = sums;
            self.squares -= explained;
        }
    }

    /// Of all unknowns, before anything has moved.
    fn priors(&self) -> [Prior; 7] {
        let [axial_in, axial_out] = self.axial;
        [
            Prior { mean: self.file_n, deviation: COULOMB_SHARE * self.file_n.max(1.0) },
            around_zero(VISCOUS_N_S_PER_MM),
            around_zero(self.weight_deviation_n),
            around_zero(MASS_SHARE),
            around_zero(AGE_S),
            axial_in,
            axial_out,
        ]
    }

    fn noise_n(&self) -> f64 {
        FRICTION_RIPPLE * self.file_n.max(1.0)
    }

    pub(super) fn add(&mut self, window: &SlidingWindow) {
        let SlidingWindow { direction, speed_mm_per_s, engagement, force_n, inertia_n, rate_n_per_s } = *window;
        let [axial_in, axial_out] = if direction > 0.0 { [-engagement, 0.0] } else { [0.0, engagement] };
        // Every row is brought to the noise of one without acceleration.
        let scale = 1.0 / (1.0 + INERTIA_SHARE * inertia_n.abs() / self.noise_n());
        let row = [direction, speed_mm_per_s, -1.0, inertia_n, rate_n_per_s, axial_in, axial_out];
        let row = row.map(|column| scale * column);
        let value = scale * (force_n - inertia_n);
        self.sums.add(row, value);
        self.squares += value * value;
    }

    /// What outlives a restart.
    pub(super) fn kept(&mut self) -> impl Iterator<Item = &mut f64> {
        let Self { sums, squares, axial, .. } = self;
        let axial = axial.iter_mut().flat_map(|Prior { mean, deviation }| [mean, deviation]);
        sums.numbers_mut().chain([squares]).chain(axial)
    }

    pub(super) fn decay(&mut self, kept: f64) {
        self.keep_axial();
        self.sums.decay(kept);
        self.squares *= kept;
    }

    /// What fits best by now. Viscous friction and weight count from where they stand out of the changes of friction along the
    /// way, which would be taken for them otherwise.
    pub(super) fn identified(&self) -> Forces {
        let known = |mean: f64| Prior { mean, deviation: 1e-3 };
        let priors = self.priors();
        let [coulomb, _, weight, mass, age, ..] = priors;
        let noise_n = self.noise_n();
        let free = self.sums.solve(priors, noise_n);
        let [free_n, free_viscous, _, _, _, free_in_n, free_out_n] = free;
        let ripple_n = FRICTION_RIPPLE * free_n.max(0.0).max(self.file_n);
        // A host that jitters measures speeds that scatter: then less stands out.
        let least_n = ripple_n + SCATTERS * (self.scatter_n(free) - ripple_n).max(0.0);
        let viscous_n_s_per_mm = standing_out(free_viscous.max(0.0), least_n / self.speed_mm_per_s());
        let told = &self.axial_told;
        let beyond = |free_n: f64, told_n: f64| told_n + standing_out(free_n - told_n, least_n);
        let axial = AxialForce { in_n: beyond(free_in_n, told.in_n), out_n: beyond(free_out_n, told.out_n) };
        let fit = |weight: Prior| {
            let viscous = Prior { mean: viscous_n_s_per_mm, deviation: 1e-6 };
            self.sums.solve([coulomb, viscous, weight, mass, age, known(axial.in_n), known(axial.out_n)], noise_n)
        };
        let weight_n = if self.fewer_windows() >= BOTH_WAYS_WINDOWS {
            let [_, _, free_weight_n, ..] = fit(weight);
            standing_out(free_weight_n, least_n)
        } else {
            // One direction shows friction less weight: what friction cannot be is weight.
            let [balanced_n, ..] = fit(known(0.0));
            let possible_n = balanced_n.max(POSSIBLE_SHARES.0 * self.file_n).min(POSSIBLE_SHARES.1 * self.file_n);
            self.direction() * (possible_n - balanced_n)
        };
        let [friction_n, ..] = fit(known(weight_n));
        Forces { weight_n, friction_n: friction_n.max(0.0), viscous_n_s_per_mm, axial }
    }

    /// Root mean square of what a fit leaves.
    fn scatter_n(&self, solution: [f64; 7]) -> f64 {
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

fn around_zero(deviation: f64) -> Prior {
    Prior { mean: 0.0, deviation }
}

/// What the machine's file says of a tap that has not cut yet.
fn axial_before(told: &AxialForce) -> [Prior; 2] {
    [told.in_n, told.out_n].map(|mean| Prior { mean, deviation: AXIAL_N })
}

#[cfg(test)]
mod tests {
    use super::{Forces, FrictionFit, SlidingWindow};
    use crate::control::machine::Machine;
    use crate::control::sync::plant_model::AxialForce;

    const AIR: AxialForce = AxialForce { in_n: 0.0, out_n: 0.0 };
    const TRUE: Forces = Forces { weight_n: 100.0, friction_n: 250.0, viscous_n_s_per_mm: 1.5, axial: AIR };

    fn window(speed_mm_per_s: f64) -> SlidingWindow {
        let direction = 1f64.copysign(speed_mm_per_s);
        let force_n = TRUE.friction_n * direction + TRUE.viscous_n_s_per_mm * speed_mm_per_s - TRUE.weight_n;
        SlidingWindow { direction, speed_mm_per_s, engagement: 0.0, force_n, inertia_n: 0.0, rate_n_per_s: 0.0 }
    }

    fn after(speeds: impl IntoIterator<Item = f64>) -> Forces {
        let mut fit = FrictionFit::new(&Machine::reference());
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
            let mut fit = FrictionFit::new(&Machine::reference());
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
        assert_eq!(after([]), Forces { weight_n: 0.0, friction_n: 300.0, viscous_n_s_per_mm: 0.0, axial: AIR });
    }

    /// A window of 5000 N of inertia that is off by 2 %.
    #[test]
    fn accelerating_windows_count_little() {
        let mut fit = FrictionFit::new(&Machine::reference());
        for k in 0..40 {
            let speed = 10.0 + 4.0 * f64::from(k);
            fit.add(&window(speed));
            fit.add(&window(-speed));
            let fast = window(speed);
            fit.add(&SlidingWindow { inertia_n: 5000.0, force_n: fast.force_n + 5100.0, ..fast });
        }
        assert_near(fit.identified(), TRUE, 15.0);
    }

    /// What draws the tap is known apart from friction by the motion above the work piece, and gone with the tap.
    #[test]
    fn axial_force_of_a_tap() {
        let mut fit = FrictionFit::new(&Machine::reference());
        for k in 0..40 {
            let speed = 10.0 + 4.0 * f64::from(k);
            [speed, -speed].into_iter().for_each(|speed| fit.add(&window(speed)));
            for (speed, axial_n) in [(speed, -180.0), (-speed, 60.0)] {
                let air = window(speed);
                fit.add(&SlidingWindow { engagement: 0.5, force_n: air.force_n + 0.5 * axial_n, ..air });
            }
        }
        let found = fit.identified();
        assert!((found.axial.in_n - 180.0).abs() < 15.0 && found.axial.out_n.abs() < 60.0, "{found:?}");
        assert_near(Forces { axial: AIR, ..found }, TRUE, 12.0);
        fit.forget_axial();
        let found = fit.identified();
        assert_eq!(found.axial, AIR);
        assert!(
            (found.friction_n - TRUE.friction_n).abs() < 20.0 && (found.weight_n - TRUE.weight_n).abs() < 20.0,
            "{found:?}"
        );
    }
}
