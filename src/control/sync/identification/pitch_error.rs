//! The pitch error of Z's screw, once a turn, from how far its motor leads the load along an approach.
//!
//! Where Z moves at an even speed, what is left of the deflection between motor and scale beside a mean value, friction and
//! wind-up is the screw's error. The lead is found, too: whichever of the usual ones explains most.

use core::f64::consts::TAU;

use crate::control::math::least_squares::{NormalEquations, Prior};
use crate::control::math::{cos, sin, sqrt};
use crate::control::sync::plant_model::{PitchError, ZModel};

use crate::control::math::standing_out::standing_out;

/// Usual leads of ball screws in mm (ISO 3408-2).
const LEADS_MM: [f64; 7] = [5.0, 6.0, 8.0, 10.0, 12.0, 16.0, 20.0];
/// Acceleration of the load beyond which backlash and wind-up change too much.
const EVEN_MM_PER_S2: f64 = 800.0;
/// Standard deviation of a deflection at rest, and the speed at which it is twice that: both encoders are not latched at the
/// same instant.
const DEFLECTION_MM: f64 = 3e-4;
const DOUBLED_AT_MM_PER_S: f64 = 150.0;
/// Standard deviations of a pitch error, of the mean deflection, of what it differs by between directions, of the compliance
/// over the file's, and of what viscous friction winds up at 1 mm/s.
const ERROR_MM: f64 = 5e-3;
const MIDDLE_MM: f64 = 0.1;
const FLANK_MM: f64 = 0.01;
const COMPLIANCE_RATIO: f64 = 0.35;
const VISCOUS_MM: f64 = 2e-5;
/// An amplitude that is found where there is none: what friction that changes along the way winds up.
const LEAST_MM: f64 = 8e-4;
/// Turns at an even speed over which it has to be seen: less could as well be friction.
const TURNS: f64 = 2.5;
/// Samples between which the acceleration is taken: each of two speeds is a mean over so many periods.
const SPAN: usize = 4;
const KEPT: usize = 2 * SPAN + 1;

/// Load and deflection of one period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Sample {
    load_mm: f64,
    deflection_mm: f64,
}

/// The fit, for each lead.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct PitchErrorFit {
    /// Newest last.
    recent: [Sample; KEPT],
    filled: usize,
    /// The first deflection, against which all are taken.
    origin_mm: Option<f64>,
    /// Unknown are the middle, the flank by direction, compliance, viscous wind-up, and the error's sine and cosine.
    sums: [NormalEquations<6>; LEADS_MM.len()],
    /// Way at an even speed.
    even_mm: f64,
}

impl PitchErrorFit {
    /// One period between holes.
    pub(super) fn add(&mut self, model: &ZModel, period_s: f64, load_mm: f64, deflection_mm: f64) {
        self.recent.rotate_left(1);
        if let Some(newest) = self.recent.last_mut() {
            *newest = Sample { load_mm, deflection_mm };
        }
        self.filled = (self.filled + 1).min(KEPT);
        let [first, .., last] = self.recent;
        let Some(middle) = self.recent.get(SPAN).copied().filter(|_| self.filled == KEPT) else { return };
        let half_s = SPAN as f64 * period_s;
        let speed_mm_per_s = (last.load_mm - first.load_mm) / (2.0 * half_s);
        let acceleration = (last.load_mm - 2.0 * middle.load_mm + first.load_mm) / (half_s * half_s);
        if speed_mm_per_s.abs() < model.sliding_mm_per_s() || acceleration.abs() > EVEN_MM_PER_S2 {
            return;
        }
        let at_mm = middle.load_mm;
        self.even_mm += speed_mm_per_s.abs() * period_s;
        let origin_mm = *self.origin_mm.get_or_insert(middle.deflection_mm);
        let scale = 1.0 / (1.0 + speed_mm_per_s.abs() / DOUBLED_AT_MM_PER_S);
        let wind_up_mm = model.compliance_mm_per_n * model.load_n(acceleration);
        for (sums, lead_mm) in self.sums.iter_mut().zip(LEADS_MM) {
            let angle = TAU * at_mm / lead_mm;
            let row = [1.0, speed_mm_per_s.signum(), wind_up_mm, speed_mm_per_s, sin(angle), cos(angle)];
            sums.add(row.map(|column| scale * column), scale * (middle.deflection_mm - origin_mm));
        }
    }

    /// The next period does not follow the last.
    pub(super) fn note_gap(&mut self) {
        self.filled = 0;
    }

    /// What explains most by now; none where it does not stand out.
    pub(super) fn identified(&self) -> PitchError {
        let around = |mean: f64, deviation: f64| Prior { mean, deviation };
        let priors = [
            around(0.0, MIDDLE_MM),
            around(0.0, FLANK_MM),
            around(1.0, COMPLIANCE_RATIO),
            around(0.0, VISCOUS_MM),
            around(0.0, ERROR_MM),
            around(0.0, ERROR_MM),
        ];
        let (mut best, mut least_misfit) = (PitchError::NONE, f64::INFINITY);
        for (sums, lead_mm) in self.sums.iter().zip(LEADS_MM) {
            if self.even_mm < TURNS * lead_mm {
                continue;
            }
            let solution = sums.solve(priors, DEFLECTION_MM);
            let misfit = sums.misfit(solution);
            if misfit < least_misfit {
                let [.., sin_mm, cos_mm] = solution;
                (best, least_misfit) = (PitchError { lead_mm, sin_mm, cos_mm }, misfit);
            }
        }
        let amplitude_mm = sqrt(best.sin_mm * best.sin_mm + best.cos_mm * best.cos_mm);
        let share = if amplitude_mm > 0.0 { standing_out(amplitude_mm, LEAST_MM) / amplitude_mm } else { 0.0 };
        PitchError { sin_mm: share * best.sin_mm, cos_mm: share * best.cos_mm, ..best }
    }
}

#[cfg(test)]
mod tests {
    use super::{PitchError, PitchErrorFit};
    use crate::control::machine::Machine;
    use crate::control::sync::plant_model::ZModel;

    const PERIOD_S: f64 = 0.001;

    /// Down at 400 mm/s from 100 mm to 10 mm over the hole, with counts of 0.1 µm.
    fn approached(error: PitchError, friction_mm: f64) -> PitchError {
        let model = ZModel::new(&Machine::reference());
        let mut fit = PitchErrorFit::default();
        for k in 0..225 {
            let load_mm = -100.0 + 0.4 * f64::from(k);
            let deflection_mm = 5.0 + friction_mm + error.at(load_mm);
            fit.add(&model, PERIOD_S, load_mm, (deflection_mm * 1e4).round() * 1e-4);
        }
        fit.identified()
    }

    #[test]
    fn error_and_lead_are_found() {
        for lead_mm in [5.0, 10.0, 16.0, 20.0] {
            for phase in [0.0_f64, 1.0, 2.5] {
                let told = PitchError { lead_mm, sin_mm: 0.003 * phase.cos(), cos_mm: 0.003 * phase.sin() };
                let found = approached(told, 0.002);
                let off_um = 1e3 * (found.sin_mm - told.sin_mm).hypot(found.cos_mm - told.cos_mm);
                assert!(found.lead_mm == lead_mm && off_um < 0.1, "{told:?} {found:?}");
            }
        }
    }

    #[test]
    fn a_screw_without_error_has_none() {
        let found = approached(PitchError::NONE, 0.003);
        assert_eq!((found.sin_mm, found.cos_mm), (0.0, 0.0));
    }

    /// 4 mm are less than a turn of each.
    #[test]
    fn a_short_approach_says_nothing() {
        let model = ZModel::new(&Machine::reference());
        let mut fit = PitchErrorFit::default();
        for k in 0..40 {
            let load_mm = 0.1 * f64::from(k);
            fit.add(&model, PERIOD_S, load_mm, 0.01 * load_mm);
        }
        assert_eq!(fit.identified(), PitchError::NONE);
    }
}
