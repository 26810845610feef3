//! Z's screw between motor and scale: its backlash, and how far it gives.
//!
//! Least squares of deflection = middle + flank·half the backlash + force/stiffness, the file's values as prior. Which flank
//! a window stood on, and under which force, is only known once friction and weight are: the last windows are kept as they
//! were until then.

use arrayvec::ArrayVec;

use super::friction::Forces;
use crate::control::math::least_squares::{NormalEquations, Prior};
use crate::control::math::list::copied;
use crate::control::sync::plant_model::{PitchError, ZModel};

/// Standard deviation of a window's mean deflection.
const DEFLECTION_MM: f64 = 3e-4;
/// Standard deviations of the middle against the first deflection, of the file's backlash, and of its compliance as a ratio.
const MIDDLE_MM: f64 = 0.1;
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
/// A deflection that is further off what was known before a restart is of encoders that count from elsewhere: wind-up and pitch
/// error of a screw stay below.
const ELSEWHERE_MM: f64 = 0.02;
/// Windows kept as they were: half a second, more than an approach.
const KEPT: usize = 32;

/// A screw, positive into the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Screw {
    pub(super) backlash_mm: f64,
    pub(super) compliance_ratio: f64,
    /// Deflection in the middle of the backlash without a force, where both flanks were seen.
    pub(super) middle_mm: Option<f64>,
}

/// What is known beside the windows by now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Known<'a> {
    pub(super) model: &'a ZModel,
    pub(super) forces: Forces,
    pub(super) pitch_error: PitchError,
}

/// A window in which the load slid in one direction, ±1, 1 into the hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct DeflectionWindow {
    pub(super) direction: f64,
    pub(super) speed_mm_per_s: f64,
    pub(super) rate_mm_per_s2: f64,
    pub(super) deflection_mm: f64,
    /// Where the load was at its ends.
    pub(super) from_mm: f64,
    pub(super) to_mm: f64,
    /// It follows the one before.
    pub(super) follows: bool,
}

/// What the windows sum up to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sums {
    /// Columns are a constant, the flank, and what the screw's force is made of: direction, speed, acceleration.
    fit: NormalEquations<5>,
    /// Windows on the flank that pushes out of the hole, and into it.
    flanks: [f64; 2],
    last_flank: f64,
}

impl Sums {
    fn add(&mut self, known: &Known<'_>, window: &DeflectionWindow, origin_mm: f64) {
        let Known { model, forces, pitch_error } = known;
        let friction_n = model.load_friction_share * forces.friction_n;
        let force_n = forces.on_screw_n(model, window.direction, window.speed_mm_per_s, window.rate_mm_per_s2);
        let sure_n = (SURE_SHARE * friction_n).max(model.load_n(SURE_MM_PER_S2));
        let flank = if force_n.abs() > sure_n { 1f64.copysign(force_n) } else { 0.0 };
        // A window in which the force turned round is a mixture.
        let same = window.follows && self.last_flank == flank;
        self.last_flank = flank;
        if !same || flank == 0.0 {
            return;
        }
        let DeflectionWindow { direction, speed_mm_per_s, rate_mm_per_s2, .. } = *window;
        let deflection_mm = window.deflection_mm - pitch_error.mean(window.from_mm, window.to_mm) - origin_mm;
        self.fit.add([1.0, flank, direction, speed_mm_per_s, rate_mm_per_s2], deflection_mm);
        let [outwards, inwards] = &mut self.flanks;
        *(if flank > 0.0 { inwards } else { outwards }) += 1.0;
    }
}

/// The fit.
#[derive(Debug, Default, PartialEq)]
pub(super) struct ScrewFit {
    sums: Sums,
    windows: ArrayVec<DeflectionWindow, KEPT>,
    /// The first deflection, against which all are taken: encoders have their zeros anywhere.
    origin_mm: Option<f64>,
    is_restored: bool,
}

impl Clone for ScrewFit {
    fn clone(&self) -> Self {
        let Self { sums, origin_mm, is_restored, .. } = *self;
        Self { sums, windows: copied(&self.windows), origin_mm, is_restored }
    }
}

impl ScrewFit {
    /// Takes in a window, beside what is known of Z's forces by now.
    pub(super) fn add(&mut self, known: &Known<'_>, window: DeflectionWindow) {
        self.check_restored(known, &window);
        let origin_mm = *self.origin_mm.get_or_insert(window.deflection_mm);
        if self.windows.is_full()
            && let Some(oldest) = self.windows.pop_at(0)
        {
            self.sums.add(known, &oldest, origin_mm);
        }
        let _ = self.windows.try_push(window);
    }

    fn all(&self, known: &Known<'_>) -> Sums {
        let mut sums = self.sums;
        let origin_mm = self.origin_mm.unwrap_or_default();
        self.windows.iter().for_each(|window| sums.add(known, window, origin_mm));
        sums
    }

    /// The sums alone, with the last windows in them.
    pub(super) fn summed(&self, known: &Known<'_>) -> Self {
        Self { sums: self.all(known), origin_mm: self.origin_mm, ..Self::default() }
    }

    /// What outlives a restart, of sums alone.
    pub(super) fn kept(&mut self) -> impl Iterator<Item = &mut f64> {
        let origin_mm = self.origin_mm.get_or_insert(0.0);
        self.sums.fit.numbers_mut().chain(&mut self.sums.flanks).chain([origin_mm])
    }

    /// Such sums have been put back: whether both encoders still count from where they did is seen by the first window.
    pub(super) fn note_restored(&mut self, kept: f64) {
        self.is_restored = true;
        self.sums.fit.decay(kept);
        self.sums.flanks = self.sums.flanks.map(|windows| kept * windows);
        self.origin_mm = self.origin_mm.filter(|_| self.sums.fit.product(0, 0) > 0.0);
    }

    /// After a restart: encoders that count from elsewhere say nothing of the middle of before.
    fn check_restored(&mut self, known: &Known<'_>, window: &DeflectionWindow) {
        if !core::mem::take(&mut self.is_restored) {
            return;
        }
        let screw = self.identified(known);
        let deflection_mm = window.deflection_mm - known.pitch_error.mean(window.from_mm, window.to_mm);
        let most_mm = 0.5 * screw.backlash_mm + ELSEWHERE_MM;
        if !screw.middle_mm.is_some_and(|middle_mm| (deflection_mm - middle_mm).abs() <= most_mm) {
            (self.sums.fit, _) = self.sums.fit.without(0);
            self.origin_mm = None;
        }
    }

    /// Older windows count less, and the next does not follow them.
    pub(super) fn decay(&mut self, known: &Known<'_>, kept: f64) {
        self.sums = self.all(known);
        self.windows.clear();
        self.sums.fit.decay(kept);
        self.sums.flanks = self.sums.flanks.map(|windows| kept * windows);
    }

    /// The screw that fits best.
    pub(super) fn identified(&self, known: &Known<'_>) -> Screw {
        let Sums { fit, flanks, .. } = self.all(known);
        let Known { model, forces, .. } = known;
        let priors = [
            Prior { mean: 0.0, deviation: MIDDLE_MM },
            Prior { mean: 0.5 * model.backlash_mm, deviation: 0.5 * BACKLASH_MM },
            Prior { mean: 1.0, deviation: COMPLIANCE_RATIO },
        ];
        // Friction and weight are those known by now, for old windows, too.
        let wind_up_mm = [
            forces.on_screw_n(model, 0.0, 0.0, 0.0),
            0.0,
            model.load_friction_share * forces.friction_n,
            model.load_friction_share * forces.viscous_n_s_per_mm,
            model.load_n(1.0),
        ]
        .map(|force_n| force_n * model.compliance_mm_per_n);
        let by_unknown = [[1.0, 0.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0], wind_up_mm];
        let [middle_mm, half_mm, compliance_ratio] = fit.combined(by_unknown).solve(priors, DEFLECTION_MM);
        let seen = flanks.iter().all(|windows| *windows >= SEEN_WINDOWS);
        Screw {
            backlash_mm: 2.0 * half_mm.max(0.0),
            compliance_ratio: compliance_ratio.max(RATIO.0).min(RATIO.1),
            middle_mm: self.origin_mm.filter(|_| seen).map(|origin_mm| origin_mm + middle_mm),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{DeflectionWindow, Forces, Known, Screw, ScrewFit};
    use crate::control::machine::Machine;
    use crate::control::sync::plant_model::{AxialForce, PitchError, ZModel};

    /// 150 N of the load's friction.
    const FORCES: Forces = Forces {
        weight_n: 0.0,
        friction_n: 300.0,
        viscous_n_s_per_mm: 0.0,
        axial: AxialForce { in_n: 0.0, out_n: 0.0 },
    };
    /// The reference machine's.
    const FILE_BACKLASH_MM: f64 = 0.002;
    const TRUE: Screw = Screw { backlash_mm: 0.0045, compliance_ratio: 1.4, middle_mm: Some(-0.0007) };
    /// A rapid in each direction: speeding up, at speed, braking.
    const ACCELERATIONS: [f64; 3] = [8000.0, 0.0, -8000.0];

    fn model() -> ZModel {
        ZModel::new(&Machine::reference())
    }

    fn known<'a>(model: &'a ZModel, forces: &Forces) -> Known<'a> {
        Known { model, forces: *forces, pitch_error: PitchError::NONE }
    }

    fn identified(fit: &ScrewFit, forces: &Forces) -> Screw {
        fit.identified(&known(&model(), forces))
    }

    fn window(forces: &Forces, direction: f64, rate_mm_per_s2: f64) -> DeflectionWindow {
        let model = model();
        let force_n = direction * 150.0 - forces.weight_n + model.load_n(rate_mm_per_s2);
        let wind_up_mm = TRUE.compliance_ratio * force_n * model.compliance_mm_per_n;
        let deflection_mm = TRUE.middle_mm.unwrap() + 0.5 * TRUE.backlash_mm * force_n.signum() + wind_up_mm;
        DeflectionWindow {
            direction,
            speed_mm_per_s: 40.0 * direction,
            rate_mm_per_s2,
            deflection_mm,
            from_mm: 0.0,
            to_mm: 0.0,
            follows: true,
        }
    }

    /// Told of friction and weight as they are `while_moving` while it moves.
    fn measured(directions: &[f64], forces: &Forces, while_moving: &Forces) -> ScrewFit {
        let mut fit = ScrewFit::default();
        for &direction in directions {
            for acceleration in ACCELERATIONS.map(|rate| direction * rate) {
                for _ in 0..4 {
                    fit.add(&known(&model(), while_moving), window(forces, direction, acceleration));
                }
            }
        }
        fit
    }

    fn assert_true(found: &Screw) {
        assert!((found.backlash_mm - TRUE.backlash_mm).abs() < 1e-4, "{found:?}");
        assert!((found.compliance_ratio / TRUE.compliance_ratio - 1.0).abs() < 0.01, "{found:?}");
        assert!((found.middle_mm.unwrap() - TRUE.middle_mm.unwrap()).abs() < 1e-4, "{found:?}");
    }

    #[test]
    fn nothing_measured_is_the_file() {
        let screw = identified(&ScrewFit::default(), &FORCES);
        assert_eq!(screw, Screw { backlash_mm: FILE_BACKLASH_MM, compliance_ratio: 1.0, middle_mm: None });
    }

    #[test]
    fn rapids_in_both_directions_show_the_screw() {
        assert_true(&identified(&measured(&[-1.0, 1.0], &FORCES, &FORCES), &FORCES));
    }

    /// 800 N turn the flank of every window without acceleration; they are known only in the end.
    #[test]
    fn weight_that_is_found_late_still_says_the_flanks() {
        let heavy = Forces { weight_n: 800.0, ..FORCES };
        assert_true(&identified(&measured(&[-1.0, 1.0], &heavy, &FORCES), &heavy));
    }

    /// Rapids carry the screw's force both ways within one direction, a slow move does not.
    #[test]
    fn one_slow_direction_leaves_the_backlash_to_the_file() {
        let mut fit = ScrewFit::default();
        (0..20).for_each(|_| fit.add(&known(&model(), &FORCES), window(&FORCES, -1.0, 0.0)));
        let found = identified(&fit, &FORCES);
        assert!((found.backlash_mm - FILE_BACKLASH_MM).abs() < 2e-4 && found.middle_mm.is_none(), "{found:?}");
    }

    #[test]
    fn windows_in_which_the_force_turned_round_do_not_count() {
        let both = || measured(&[-1.0, 1.0], &FORCES, &FORCES);
        let mut fit = both();
        for rate_mm_per_s2 in [8000.0, -750.0] {
            let mixed = DeflectionWindow { deflection_mm: 1.0, ..window(&FORCES, 1.0, rate_mm_per_s2) };
            fit.add(&known(&model(), &FORCES), mixed);
        }
        let fitted = |fit: &ScrewFit| identified(fit, &FORCES);
        assert_eq!(fitted(&fit), fitted(&both()));
    }

    #[test]
    fn older_windows_still_say_the_same() {
        let mut fit = measured(&[-1.0, 1.0], &FORCES, &FORCES);
        fit.decay(&known(&model(), &FORCES), 0.7);
        assert_true(&identified(&fit, &FORCES));
    }

    #[test]
    fn windows_beyond_those_kept_count_too() {
        let fit = measured(&[-1.0, 1.0, -1.0, 1.0, -1.0, 1.0], &FORCES, &FORCES);
        assert!(fit.windows.is_full());
        assert_true(&identified(&fit, &FORCES));
    }
}
