//! Z's screw between motor and scale: its backlash, and how far it gives.
//!
//! Least squares of deflection = middle + flank·half the backlash + force/stiffness, the file's values as prior.

use crate::control::sync::plant_model::ZModel;

/// Standard deviation of a window's mean deflection.
const DEFLECTION_MM: f64 = 3e-4;
/// Standard deviations of the file's backlash, and of its compliance as a ratio.
const BACKLASH_MM: f64 = 2e-3;
const COMPLIANCE_RATIO: f64 = 0.35;
/// Least and greatest compliance over the file's: no screw is further from it.
const RATIO: (f64, f64) = (0.25, 4.0);
/// A force within this share of the load's friction does not say which flank is in contact.
const SURE_SHARE: f64 = 0.5;
/// Nor does a force of less than this acceleration of the load.
const SURE_MM_PER_S2: f64 = 50.0;
/// Windows on each flank from which on the middle is known.
const SEEN_WINDOWS: f64 = 0.5;

/// What a deflection is made of: a constant, flank, direction of friction, acceleration in mm/s².
type Columns = [f64; 4];

/// A screw, positive into the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Screw {
    pub(super) backlash_mm: f64,
    pub(super) compliance_ratio: f64,
    /// Deflection in the middle of the backlash, where both flanks were seen.
    pub(super) middle_mm: Option<f64>,
}

/// Sums over windows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ScrewFit {
    products: [Columns; 4],
    deflections: Columns,
    /// Windows on the flank that pushes out of the hole, and into it.
    flanks: [f64; 2],
    last_flank: f64,
}

impl ScrewFit {
    /// A window in which the load slid in one direction, ±1, 1 into the hole, under a friction of its own.
    pub(super) fn add(
        &mut self,
        model: &ZModel,
        friction_n: f64,
        direction: f64,
        rate_mm_per_s2: f64,
        deflection_mm: f64,
    ) {
        let force_n = direction * friction_n + model.load_n(rate_mm_per_s2);
        let sure_n = (SURE_SHARE * friction_n).max(model.load_n(SURE_MM_PER_S2));
        let flank = if force_n.abs() > sure_n { 1f64.copysign(force_n) } else { 0.0 };
        // A window in which the force turned round is a mixture.
        let same = self.last_flank == flank;
        self.last_flank = flank;
        if !same || flank == 0.0 {
            return;
        }
        let columns = [1.0, flank, direction, rate_mm_per_s2];
        for ((row, deflection), value) in self.products.iter_mut().zip(&mut self.deflections).zip(columns) {
            row.iter_mut().zip(columns).for_each(|(sum, other)| *sum += value * other);
            *deflection += value * deflection_mm;
        }
        let [outwards, inwards] = &mut self.flanks;
        *(if flank > 0.0 { inwards } else { outwards }) += 1.0;
    }

    /// The next window does not follow the last.
    pub(super) fn note_gap(&mut self) {
        self.last_flank = 0.0;
    }

    /// Older windows count less, and the next is not compared with the last.
    pub(super) fn decay(&mut self, kept: f64) {
        self.note_gap();
        self.products
            .iter_mut()
            .flatten()
            .chain(&mut self.deflections)
            .chain(&mut self.flanks)
            .for_each(|sum| *sum *= kept);
    }

    /// The screw that fits best, for a friction of the load.
    pub(super) fn identified(&self, model: &ZModel, friction_n: f64) -> Screw {
        // Unknown are the middle, half the backlash, and the compliance over the file's.
        let (by_direction, by_acceleration) =
            (friction_n * model.compliance_mm_per_n, model.inertial_deflection_mm(1.0));
        let mixed =
            |[_, _, direction, acceleration]: Columns| by_direction * direction + by_acceleration * acceleration;
        let [ones, flanks, directions, accelerations] = self.products;
        let [windows, flank_sum, ..] = ones;
        let [deflection_sum, flank_deflection, ..] = self.deflections;
        let [_, flank_square, ..] = flanks;
        // The middle has no prior and is eliminated first.
        let windows = windows.max(f64::MIN_POSITIVE);
        let (flank_mean, force_mean, deflection_mean) =
            (flank_sum / windows, mixed(ones) / windows, deflection_sum / windows);
        let forces = by_direction * mixed(directions) + by_acceleration * mixed(accelerations);
        let half_backlash_mm = 0.5 * model.backlash_mm;
        let backlash_prior = square(DEFLECTION_MM / (0.5 * BACKLASH_MM));
        let ratio_prior = square(DEFLECTION_MM / COMPLIANCE_RATIO);
        let ss = flank_square - windows * flank_mean * flank_mean + backlash_prior;
        let sf = mixed(flanks) - windows * flank_mean * force_mean;
        let ff = forces - windows * force_mean * force_mean + ratio_prior;
        let sy = flank_deflection - windows * flank_mean * deflection_mean + backlash_prior * half_backlash_mm;
        let fy = mixed(self.deflections) - windows * force_mean * deflection_mean + ratio_prior;
        let determinant = ss * ff - sf * sf;
        let half_mm = ((sy * ff - fy * sf) / determinant).max(0.0);
        let compliance_ratio = ((fy * ss - sy * sf) / determinant).max(RATIO.0).min(RATIO.1);
        let seen = self.flanks.iter().all(|windows| *windows >= SEEN_WINDOWS);
        Screw {
            backlash_mm: 2.0 * half_mm,
            compliance_ratio,
            middle_mm: seen.then_some(deflection_mean - half_mm * flank_mean - compliance_ratio * force_mean),
        }
    }
}

fn square(value: f64) -> f64 {
    value * value
}

#[cfg(test)]
mod tests {
    use super::{Screw, ScrewFit};
    use crate::control::machine::Machine;
    use crate::control::sync::plant_model::ZModel;

    const LOAD_N: f64 = 150.0;
    /// The reference machine's.
    const FILE_BACKLASH_MM: f64 = 0.002;
    const TRUE: Screw = Screw { backlash_mm: 0.0045, compliance_ratio: 1.4, middle_mm: Some(-0.0007) };
    /// A rapid in each direction: speeding up, at speed, braking.
    const ACCELERATIONS: [f64; 3] = [8000.0, 0.0, -8000.0];

    fn model() -> ZModel {
        ZModel::new(&Machine::reference())
    }

    fn deflection_mm(direction: f64, acceleration: f64) -> f64 {
        let model = model();
        let force_n = direction * LOAD_N + model.load_n(acceleration);
        let wind_up_mm = TRUE.compliance_ratio * force_n * model.compliance_mm_per_n;
        TRUE.middle_mm.unwrap() + 0.5 * TRUE.backlash_mm * force_n.signum() + wind_up_mm
    }

    fn measured(directions: &[f64]) -> ScrewFit {
        let mut fit = ScrewFit::default();
        for &direction in directions {
            for acceleration in ACCELERATIONS.map(|rate| direction * rate) {
                for _ in 0..8 {
                    fit.add(&model(), LOAD_N, direction, acceleration, deflection_mm(direction, acceleration));
                }
            }
        }
        fit
    }

    #[test]
    fn nothing_measured_is_the_file() {
        let screw = ScrewFit::default().identified(&model(), LOAD_N);
        assert_eq!(screw, Screw { backlash_mm: FILE_BACKLASH_MM, compliance_ratio: 1.0, middle_mm: None });
    }

    #[test]
    fn rapids_in_both_directions_show_the_screw() {
        let found = measured(&[-1.0, 1.0]).identified(&model(), LOAD_N);
        assert!((found.backlash_mm - TRUE.backlash_mm).abs() < 5e-5, "{found:?}");
        assert!((found.compliance_ratio / TRUE.compliance_ratio - 1.0).abs() < 0.005, "{found:?}");
        assert!((found.middle_mm.unwrap() - TRUE.middle_mm.unwrap()).abs() < 2e-5, "{found:?}");
    }

    /// Rapids carry the screw's force both ways within one direction, a slow move does not.
    #[test]
    fn one_slow_direction_leaves_the_backlash_to_the_file() {
        let mut fit = ScrewFit::default();
        (0..20).for_each(|_| fit.add(&model(), LOAD_N, -1.0, 0.0, deflection_mm(-1.0, 0.0)));
        let found = fit.identified(&model(), LOAD_N);
        assert!((found.backlash_mm - FILE_BACKLASH_MM).abs() < 2e-4 && found.middle_mm.is_none(), "{found:?}");
    }

    #[test]
    fn windows_in_which_the_force_turned_round_do_not_count() {
        let (mut fit, before) = (measured(&[-1.0, 1.0]), measured(&[-1.0, 1.0]));
        fit.add(&model(), LOAD_N, 1.0, 8000.0, 1.0);
        fit.add(&model(), LOAD_N, 1.0, -750.0, 1.0);
        let fitted = |fit: &ScrewFit| fit.identified(&model(), LOAD_N);
        assert_eq!(fitted(&fit), fitted(&before));
    }

    #[test]
    fn older_windows_still_say_the_same() {
        let mut fit = measured(&[-1.0, 1.0]);
        let before = fit.identified(&model(), LOAD_N);
        fit.decay(0.7);
        let after = fit.identified(&model(), LOAD_N);
        assert!((after.backlash_mm - before.backlash_mm).abs() < 5e-5 && after.middle_mm.is_some(), "{after:?}");
    }
}
