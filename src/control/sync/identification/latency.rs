//! How late a setpoint acts, from an axis that is commanded to move between holes.
//!
//! A drive that follows its setpoints without an error stands, at each sample, where it was commanded one latency before, so
//! command less sample is speed × latency. What else is in that difference is known in its form: in proportion to the
//! acceleration the age of the velocity that the drive measures, and beyond it what the drive's loops make of disturbances
//! that grow with acceleration (an inertia that is not as told), with the direction (Coulomb friction) and with speed
//! (viscous friction). All five are fitted at once.

use crate::control::math::least_squares::{NormalEquations, Prior};
use crate::control::math::poly::State;
use crate::control::model::closed_loop::{ClosedLoop, LoopState};

/// Standard deviation of a latency that is told, in periods: a bus cycle more or less is a usual slip.
const TOLD_PERIODS: f64 = 1.0;
/// The same of the age of the drive's velocity, and of disturbances: inertia as a ratio, Coulomb friction as a share of the
/// greatest acceleration, viscous friction per second.
const AGE_PERIODS2: f64 = 20.0;
const INERTIA_RATIO: f64 = 0.5;
const COULOMB_SHARE: f64 = 0.3;
const VISCOUS_PER_S: f64 = 5.0;
/// Standard deviation of a sample in counts: not of its noise, but of what the drive does beyond its model.
const SAMPLE_COUNTS: f64 = 20.0;
/// A drive that was at its limit is off its loops for so long.
const UNWINDING_S: f64 = 0.25;
/// Least and greatest difference to what is told, in periods.
const MOST_PERIODS: f64 = 3.0;

/// What is known of an axis beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LatencySpec {
    pub(super) closed_loop: ClosedLoop,
    pub(super) period_s: f64,
    /// What the machine's file says.
    pub(super) told_s: f64,
    /// Speed below which friction has no certain direction, and greatest acceleration; units of the axis.
    pub(super) sliding_speed: f64,
    pub(super) acceleration: f64,
    pub(super) count: f64,
}

/// The fit of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LatencyFit {
    spec: LatencySpec,
    /// Unknown are the latency, the velocity's age, and disturbances by acceleration, direction and speed.
    sums: NormalEquations<5>,
    /// What the loops make of each disturbance.
    responses: [LoopState; 3],
    unwinding_s: f64,
}

impl LatencyFit {
    pub(super) fn new(spec: LatencySpec) -> Self {
        Self { spec, sums: NormalEquations::default(), responses: [LoopState::default(); 3], unwinding_s: 0.0 }
    }

    /// One period: what is commanded for its start, and what was measured there.
    pub(super) fn add(&mut self, commanded: &State, measured: f64, saturated: bool) {
        let Self { spec: LatencySpec { closed_loop, period_s, sliding_speed, .. }, .. } = *self;
        let State { position, velocity, acceleration, .. } = *commanded;
        self.unwinding_s = if saturated { UNWINDING_S } else { self.unwinding_s - period_s };
        let [by_inertia, by_direction, by_speed] = self.responses.map(|response| response.position);
        if velocity.abs() > sliding_speed && self.unwinding_s <= 0.0 {
            self.sums.add([velocity, acceleration, by_inertia, by_direction, by_speed], position - measured);
        }
        let direction = velocity / (velocity.abs() + sliding_speed);
        for (response, disturbance) in self.responses.iter_mut().zip([acceleration, direction, velocity]) {
            *response = closed_loop.after(LoopState { disturbance, ..*response }, period_s);
        }
    }

    /// Periods have passed unseen.
    pub(super) fn note_gap(&mut self) {
        self.responses = [LoopState::default(); 3];
    }

    pub(super) fn decay(&mut self, kept: f64) {
        self.sums.decay(kept);
        self.note_gap();
    }

    /// The latency that fits best by now; `prior_s` is what it is thought to be without.
    pub(super) fn identified_s(&self, prior_s: f64) -> f64 {
        let LatencySpec { period_s, told_s, acceleration, count, .. } = self.spec;
        let around_zero = |deviation: f64| Prior { mean: 0.0, deviation };
        let priors = [
            Prior { mean: prior_s, deviation: TOLD_PERIODS * period_s },
            around_zero(AGE_PERIODS2 * period_s * period_s),
            around_zero(INERTIA_RATIO),
            around_zero(COULOMB_SHARE * acceleration),
            around_zero(VISCOUS_PER_S),
        ];
        let [latency_s, ..] = self.sums.solve(priors, SAMPLE_COUNTS * count);
        let most_s = MOST_PERIODS * period_s;
        latency_s.max(told_s - most_s).min(told_s + most_s).max(0.0)
    }
}
