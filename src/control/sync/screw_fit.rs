//! Z's screw as motor and scale show it: its play, and how far it gives.
//!
//! Least squares of twist = middle + side of the play·half of it + force/stiffness, with what the file says as prior.

use super::z_model::ZModel;

/// How well a window's mean twist is known.
const TWIST_MM: f64 = 3e-4;
/// How well the file knows the play, and the screw's compliance as a ratio.
const PLAY_MM: f64 = 2e-3;
const COMPLIANCE_RATIO: f64 = 0.35;
/// Least and greatest compliance over the file's: no screw is further from it.
const RATIO: (f64, f64) = (0.25, 4.0);
/// A force within this share of the table's friction does not say on which side of the play the motor pushes.
const SURE_SHARE: f64 = 0.5;
/// A force of less than this acceleration of the table says nothing in any case.
const SURE_MM_PER_S2: f64 = 50.0;
/// Windows on each side that say where the middle is.
const SEEN_WINDOWS: f64 = 0.5;

/// What a twist is made of: a constant, side of the play, direction of friction, acceleration in mm/s².
type Columns = [f64; 4];

/// A screw, in machine coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Screw {
    pub(super) play_mm: f64,
    pub(super) compliance_ratio: f64,
    /// Motor less scale in the middle of the play, where both sides of it were seen.
    pub(super) middle_mm: Option<f64>,
}

/// Sums over windows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ScrewFit {
    products: [Columns; 4],
    twists: Columns,
    /// Windows with the motor pushing down and up.
    sides: [f64; 2],
    last_side: f64,
}

impl ScrewFit {
    /// A window in which the table slid in one direction, ±1, under a friction of its own.
    pub(super) fn add(&mut self, model: &ZModel, table_n: f64, direction: f64, rate_mm_per_s2: f64, twist_mm: f64) {
        let force_n = direction * table_n + model.table_n(rate_mm_per_s2);
        let sure_n = (SURE_SHARE * table_n).max(model.table_n(SURE_MM_PER_S2));
        let side = if force_n.abs() > sure_n { 1f64.copysign(force_n) } else { 0.0 };
        // A window in which the force turned round is a mixture.
        let same = self.last_side == side;
        self.last_side = side;
        if !same || side == 0.0 {
            return;
        }
        let columns = [1.0, side, direction, rate_mm_per_s2];
        for ((row, twist), value) in self.products.iter_mut().zip(&mut self.twists).zip(columns) {
            row.iter_mut().zip(columns).for_each(|(sum, other)| *sum += value * other);
            *twist += value * twist_mm;
        }
        let [down, up] = &mut self.sides;
        *(if side > 0.0 { up } else { down }) += 1.0;
    }

    /// The next window does not follow the last.
    pub(super) fn note_gap(&mut self) {
        self.last_side = 0.0;
    }

    /// Older windows count less; the next is not compared with the last.
    pub(super) fn fade(&mut self, kept: f64) {
        self.note_gap();
        self.products.iter_mut().flatten().chain(&mut self.twists).chain(&mut self.sides).for_each(|sum| *sum *= kept);
    }

    /// The screw that fits best, for a friction of the table and the file's play.
    pub(super) fn fit(&self, model: &ZModel, table_n: f64, file_play_mm: f64) -> Screw {
        // Unknown are the middle, half of the play and the compliance ratio, the last over what the force twists by the file.
        let (by_direction, by_acceleration) = (table_n * model.compliance_mm_per_n, model.stretch_mm(1.0));
        let mixed =
            |[_, _, direction, acceleration]: Columns| by_direction * direction + by_acceleration * acceleration;
        let [ones, sides, directions, accelerations] = self.products;
        let [windows, side_sum, ..] = ones;
        let [twist_sum, side_twist, ..] = self.twists;
        let [_, side_square, ..] = sides;
        // The middle has no prior and is eliminated first.
        let windows = windows.max(f64::MIN_POSITIVE);
        let (side_mean, force_mean, twist_mean) = (side_sum / windows, mixed(ones) / windows, twist_sum / windows);
        let forces = by_direction * mixed(directions) + by_acceleration * mixed(accelerations);
        let half_play_mm = 0.5 * file_play_mm;
        let play_prior = square(TWIST_MM / (0.5 * PLAY_MM));
        let ratio_prior = square(TWIST_MM / COMPLIANCE_RATIO);
        let ss = side_square - windows * side_mean * side_mean + play_prior;
        let sf = mixed(sides) - windows * side_mean * force_mean;
        let ff = forces - windows * force_mean * force_mean + ratio_prior;
        let sy = side_twist - windows * side_mean * twist_mean + play_prior * half_play_mm;
        let fy = mixed(self.twists) - windows * force_mean * twist_mean + ratio_prior;
        let determinant = ss * ff - sf * sf;
        let half_mm = ((sy * ff - fy * sf) / determinant).max(0.0);
        let compliance_ratio = ((fy * ss - sy * sf) / determinant).max(RATIO.0).min(RATIO.1);
        let seen = self.sides.iter().all(|windows| *windows >= SEEN_WINDOWS);
        Screw {
            play_mm: 2.0 * half_mm,
            compliance_ratio,
            middle_mm: seen.then_some(twist_mean - half_mm * side_mean - compliance_ratio * force_mean),
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
    use crate::control::sync::z_model::ZModel;

    const TABLE_N: f64 = 150.0;
    const FILE_PLAY_MM: f64 = 0.002;
    const TRUE: Screw = Screw { play_mm: 0.0045, compliance_ratio: 1.4, middle_mm: Some(-0.0007) };
    /// A rapid each way: speeding up, at speed, braking.
    const ACCELERATIONS: [f64; 3] = [8000.0, 0.0, -8000.0];

    fn model() -> ZModel {
        ZModel::new(&Machine::reference())
    }

    fn twist_mm(direction: f64, acceleration: f64) -> f64 {
        let model = model();
        let force_n = direction * TABLE_N + model.table_n(acceleration);
        let stretch_mm = TRUE.compliance_ratio * force_n * model.compliance_mm_per_n;
        TRUE.middle_mm.unwrap() + 0.5 * TRUE.play_mm * force_n.signum() + stretch_mm
    }

    fn shown(directions: &[f64]) -> ScrewFit {
        let mut fit = ScrewFit::default();
        for &direction in directions {
            for acceleration in ACCELERATIONS.map(|rate| direction * rate) {
                for _ in 0..8 {
                    fit.add(&model(), TABLE_N, direction, acceleration, twist_mm(direction, acceleration));
                }
            }
        }
        fit
    }

    #[test]
    fn nothing_shown_is_the_file() {
        let screw = ScrewFit::default().fit(&model(), TABLE_N, FILE_PLAY_MM);
        assert_eq!(screw, Screw { play_mm: FILE_PLAY_MM, compliance_ratio: 1.0, middle_mm: None });
    }

    #[test]
    fn rapids_both_ways_show_the_screw() {
        let found = shown(&[-1.0, 1.0]).fit(&model(), TABLE_N, FILE_PLAY_MM);
        assert!((found.play_mm - TRUE.play_mm).abs() < 5e-5, "{found:?}");
        assert!((found.compliance_ratio / TRUE.compliance_ratio - 1.0).abs() < 0.005, "{found:?}");
        assert!((found.middle_mm.unwrap() - TRUE.middle_mm.unwrap()).abs() < 2e-5, "{found:?}");
    }

    /// Rapids carry the screw's force both ways within one direction, a slow way does not.
    #[test]
    fn one_slow_way_leaves_the_play_to_the_file() {
        let mut fit = ScrewFit::default();
        (0..20).for_each(|_| fit.add(&model(), TABLE_N, -1.0, 0.0, twist_mm(-1.0, 0.0)));
        let found = fit.fit(&model(), TABLE_N, FILE_PLAY_MM);
        assert!((found.play_mm - FILE_PLAY_MM).abs() < 2e-4 && found.middle_mm.is_none(), "{found:?}");
    }

    #[test]
    fn windows_in_which_the_force_turned_round_do_not_count() {
        let (mut fit, before) = (shown(&[-1.0, 1.0]), shown(&[-1.0, 1.0]));
        fit.add(&model(), TABLE_N, 1.0, 8000.0, 1.0);
        fit.add(&model(), TABLE_N, 1.0, -750.0, 1.0);
        let fitted = |fit: &ScrewFit| fit.fit(&model(), TABLE_N, FILE_PLAY_MM);
        assert_eq!(fitted(&fit), fitted(&before));
    }

    #[test]
    fn what_fades_still_says_the_same() {
        let mut fit = shown(&[-1.0, 1.0]);
        let before = fit.fit(&model(), TABLE_N, FILE_PLAY_MM);
        fit.fade(0.7);
        let after = fit.fit(&model(), TABLE_N, FILE_PLAY_MM);
        assert!((after.play_mm - before.play_mm).abs() < 5e-5 && after.middle_mm.is_some(), "{after:?}");
    }
}
