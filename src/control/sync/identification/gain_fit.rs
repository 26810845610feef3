//! How an axis follows under a drive that reports no effort, whose gains are not quite those that are told.
//!
//! What such a drive makes of friction grows as its gains fall, so that a wrong gain is a wrong friction. How fast the loops
//! answer tells both apart: the tracking fit is made for three gains side by side, and what it leaves of the samples is least
//! at the right one (a bank of models; Magill, Optimal adaptive estimation of sampled stochastic processes, 1965).

use crate::control::math::poly::State;
use crate::control::model::closed_loop::ClosedLoop;

use super::tracking_fit::{AxisSample, Tracking, TrackingFit, TrackingSpec};

/// Gains of the other two over the told ones.
const SLOWER: f64 = 0.85;
const FASTER: f64 = 1.15;
/// Standard deviation of a drive's gains over the told ones.
const GAIN_DEVIATION: f64 = 0.1;
/// Independent samples of an approach: what friction does along the way is alike for some 10 mm.
const SAMPLES: f64 = 30.0;

/// The fit of one axis at three gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GainFit {
    told: TrackingFit,
    others: [TrackingFit; 2],
}

impl GainFit {
    pub(super) fn new(spec: TrackingSpec) -> Self {
        let with = |ratio: f64| {
            let ClosedLoop { position_gain_per_s, velocity_gain_per_s, integral_s } = spec.closed_loop;
            let closed_loop = ClosedLoop {
                position_gain_per_s: ratio * position_gain_per_s,
                velocity_gain_per_s: ratio * velocity_gain_per_s,
                integral_s,
            };
            TrackingFit::new(TrackingSpec { closed_loop, ..spec })
        };
        Self { told: TrackingFit::new(spec), others: [SLOWER, FASTER].map(with) }
    }

    /// One period; the gains are of matter where the drive reports no effort.
    pub(super) fn add(&mut self, commanded: &State, measured: &AxisSample, reports: bool) {
        self.told.add(commanded, measured);
        if !reports {
            self.others.iter_mut().for_each(|fit| fit.add(commanded, measured));
        }
    }

    /// Periods have passed unseen.
    pub(super) fn note_gap(&mut self) {
        self.fits().for_each(TrackingFit::note_gap);
    }

    /// A hole begins.
    pub(super) fn begin_hole(&mut self, kept: f64) {
        self.fits().for_each(|fit| fit.begin_hole(kept));
    }

    fn fits(&mut self) -> impl Iterator<Item = &mut TrackingFit> {
        self.others.iter_mut().chain([&mut self.told])
    }

    /// What fits best by now, as [`TrackingFit::identified`].
    pub(super) fn identified(&self, prior_s: f64, own_error_periods: f64) -> Tracking {
        let told = self.told.identified(prior_s, own_error_periods);
        let ratio = self.gain_ratio(prior_s);
        let [slower, faster] = &self.others;
        let (other, share) = if ratio < 1.0 {
            (slower, (1.0 - ratio) / (1.0 - SLOWER))
        } else {
            (faster, (ratio - 1.0) / (FASTER - 1.0))
        };
        if share == 0.0 {
            return told;
        }
        let other = other.identified(prior_s, own_error_periods);
        let between = |told: f64, other: f64| told + share * (other - told);
        Tracking {
            latency_s: between(told.latency_s, other.latency_s),
            inertia_ratio: between(told.inertia_ratio, other.inertia_ratio),
            coulomb: between(told.coulomb, other.coulomb),
            viscous_per_s: between(told.viscous_per_s, other.viscous_per_s),
        }
    }

    /// The drive's gains over the told ones, within the two others: the most likely, where what is left of the samples is a
    /// parabola over the gain.
    fn gain_ratio(&self, prior_s: f64) -> f64 {
        let [slower, faster] = &self.others;
        let [below, told, above] = [slower, &self.told, faster].map(|fit| fit.misfit(prior_s));
        if !(told > 0.0 && below > 0.0 && above > 0.0) {
            return 1.0;
        }
        let step = FASTER - 1.0;
        let slope = 0.5 * (above - below) / (step * told);
        let bend = ((above - 2.0 * told + below) / (step * step * told)).max(0.0);
        // −2·log of the likelihood grows by the samples times the relative misfit.
        let change = -SAMPLES * slope / (SAMPLES * bend + 2.0 / (GAIN_DEVIATION * GAIN_DEVIATION));
        1.0 + change.clamp(SLOWER - 1.0, FASTER - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::GainFit;
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::model::closed_loop::{ClosedLoop, LoopState};
    use crate::control::sync::identification::tracking_fit::AxisSample;
    use crate::control::sync::identification::tracking_specs::tracking_specs;
    use crate::control::sync::plant_model::ZModel;

    const COULOMB: f64 = 600.0;

    /// What is found of an axis to and fro against friction, whose drive has other gains than it is told to have.
    fn found(gain: f64, reports: bool) -> (f64, f64) {
        let machine = Machine::reference();
        let [_, spec] = tracking_specs(&machine, &ZModel::new(&machine));
        let told = spec.closed_loop;
        let real = ClosedLoop {
            position_gain_per_s: gain * told.position_gain_per_s,
            velocity_gain_per_s: gain * told.velocity_gain_per_s,
            ..told
        };
        let (mut fit, mut state, mut position) = (GainFit::new(spec), LoopState::default(), 0.0);
        let mut acting = 0.0;
        let direction_at = |k: u32| if (k / 150).is_multiple_of(2) { 1.0 } else { -1.0 };
        for k in 0..1200 {
            let direction = direction_at(k);
            let velocity = direction * (20.0 + 30.0 * f64::from((k / 300) % 3));
            let commanded = State { position, velocity, ..State::default() };
            let measured = AxisSample {
                position: position - velocity * spec.file_s + state.position,
                deflection: None,
                friction_ratio: Some(direction),
                start_ratio: 0.0,
                fed: 0.0,
                saturated: false,
            };
            fit.add(&commanded, &measured, reports);
            let seeming = told.velocity_gain_per_s * spec.velocity_age_s / told.integral_s;
            let friction = 0.5 * COULOMB * (direction + direction_at(k + 1));
            let disturbance = seeming * core::mem::replace(&mut acting, velocity) - friction;
            state =
                (0..50).fold(LoopState { disturbance, ..state }, |state, _| real.after(state, spec.period_s / 50.0));
            position += velocity * spec.period_s;
        }
        let tracking = fit.identified(spec.file_s, 0.03);
        (tracking.coulomb, fit.gain_ratio(spec.file_s))
    }

    #[test]
    fn friction_of_a_silent_drive_is_found_whatever_its_gains() {
        for gain in [0.88, 1.0, 1.12] {
            let (coulomb, ratio) = found(gain, false);
            assert!((ratio - gain).abs() < 0.06, "{gain}: {ratio}");
            assert!((coulomb / COULOMB - 1.0).abs() < 0.08, "{gain}: {coulomb}");
        }
    }

    #[test]
    fn gains_are_as_told_where_the_drive_reports() {
        assert_eq!(found(0.88, true).1, 1.0);
    }
}
