//! How late a setpoint acts, and what else commands and an encoder alone say of an axis that moves between holes.
//!
//! A drive that follows its setpoints without an error stands, at each sample, where it was commanded one latency before, so
//! command less sample is speed × latency. What else is in that difference is known in its form: in proportion to the
//! acceleration the age of the sample, and beyond it what the drive's loops make of disturbances that grow with acceleration
//! (an inertia that is not the file's), with the direction (Coulomb friction) and with speed (viscous friction). All five are
//! fitted at once. To the loops, the age of the velocity that they measure looks like an inertia and a viscous friction below
//! the file's; it is known.

use crate::control::math::least_squares::{NormalEquations, Prior};
use crate::control::math::poly::State;
use crate::control::model::closed_loop::{ClosedLoop, LoopState};

use crate::control::math::standing_out::standing_out;

/// Standard deviation of the file's latency, in periods: a bus cycle more or less is a usual slip.
const FILE_PERIODS: f64 = 1.0;
/// The same of the sample's age, and of disturbances: Coulomb friction as a share of the greatest acceleration, viscous
/// friction per second.
const AGE_PERIODS2: f64 = 20.0;
const COULOMB_SHARE: f64 = 0.3;
const VISCOUS_PER_S: f64 = 5.0;
/// Viscous friction that the fit finds where there is none, per second.
const LEAST_VISCOUS_PER_S: f64 = 1.2;
/// The same of the friction that holds an axis when it is first seen, as a share of the file's.
const START_SHARE: f64 = 0.25;
/// Standard deviation of a sample in counts: not of its noise, but of what the drive does beyond its model.
const SAMPLE_COUNTS: f64 = 20.0;
/// A drive that was at its limit is off its loops for so long.
const UNWINDING_S: f64 = 0.25;
/// Periods that count from which on an approach takes the place of older ones.
const APPROACH_PERIODS: u32 = 100;
/// Steps of a period in which the loops are followed: their velocity loop is about as fast as a period.
const STEPS: u32 = 4;
/// Greatest difference to the file's latency, in periods.
const MOST_PERIODS: f64 = 3.0;

/// What is known of an axis beforehand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TrackingSpec {
    pub(super) closed_loop: ClosedLoop,
    /// The drive is told its acceleration; else its loops find that, too.
    pub(super) feeds_acceleration: bool,
    pub(super) period_s: f64,
    /// Age of the velocity that the drive measures.
    pub(super) velocity_age_s: f64,
    /// Standard deviation of the file's inertia, as a ratio.
    pub(super) inertia_deviation: f64,
    /// The file's Coulomb friction, as an acceleration.
    pub(super) coulomb: f64,
    /// What the machine's file says.
    pub(super) file_s: f64,
    /// Speed below which friction has no certain direction, speed from which on a period counts, and greatest acceleration;
    /// units of the axis.
    pub(super) sliding_speed: f64,
    pub(super) least_speed: f64,
    pub(super) acceleration: f64,
    pub(super) count: f64,
}

impl TrackingSpec {
    /// What the loops make of a state in a period, under a disturbance.
    fn after(&self, from: &LoopState, disturbance: f64) -> LoopState {
        let step_s = self.period_s / f64::from(STEPS);
        (0..STEPS).fold(LoopState { disturbance, ..*from }, |state, _| self.closed_loop.after(state, step_s))
    }
}

/// What was measured of an axis in a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AxisSample {
    /// At the encoder of the position loop.
    pub(super) position: f64,
    /// By how much the motor leads it; none without an encoder of its own.
    pub(super) deflection: Option<f64>,
    /// Friction over Coulomb's, −1…1 and beyond it where the axis starts to slide; none where its direction is that of the
    /// motion.
    pub(super) friction_ratio: Option<f64>,
    /// What is left of the friction that held the axis when it was first seen, over that friction.
    pub(super) start_ratio: f64,
    /// What the effort feedforward beside the motion has come to give since the axis was first seen, as an acceleration along it.
    pub(super) fed: f64,
    /// The drive stood at its limit.
    pub(super) saturated: bool,
}

/// What was found, in units of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tracking {
    pub(super) latency_s: f64,
    /// Inertia per effort, over the file's.
    pub(super) inertia_ratio: f64,
    /// Coulomb friction as an acceleration.
    pub(super) coulomb: f64,
    /// Viscous friction as an acceleration per speed.
    pub(super) viscous_per_s: f64,
}

/// The fit of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TrackingFit {
    spec: TrackingSpec,
    /// Unknown are the latency, the sample's age, disturbances by acceleration, direction and speed, and what friction held
    /// the axis when it was first seen.
    sums: NormalEquations<6>,
    /// What the loops make of each disturbance.
    responses: [LoopState; 4],
    /// What they make of the load's lag behind the motor, which both encoders show.
    lag_response: LoopState,
    deflection: Option<f64>,
    /// What they make of an effort that is fed beside the motion, which is known.
    fed_response: LoopState,
    unwinding_s: f64,
    /// It was at its limit since the axis was first seen: the loops' responses then were not all of it.
    was_saturated: bool,
    /// Speed and acceleration that were commanded a period ago, and what was fed beside them: they act about now.
    acting: [f64; 3],
    /// Friction by direction and at the start, a period ago.
    friction_before: [f64; 2],
    /// Periods that counted since older ones were made to count less.
    periods: u32,
    /// Sum of the squares of what was fitted, and of how many.
    squares: f64,
    samples: f64,
}

impl TrackingFit {
    pub(super) fn new(spec: TrackingSpec) -> Self {
        Self {
            spec,
            sums: NormalEquations::default(),
            responses: [LoopState::default(); 4],
            lag_response: LoopState::default(),
            deflection: None,
            fed_response: LoopState::default(),
            unwinding_s: 0.0,
            was_saturated: false,
            acting: [0.0; 3],
            friction_before: [0.0; 2],
            periods: 0,
            squares: 0.0,
            samples: 0.0,
        }
    }

    /// One period: what is commanded for its start, and what was measured there.
    pub(super) fn add(&mut self, commanded: &State, measured: &AxisSample) {
        let TrackingSpec { feeds_acceleration, period_s, sliding_speed, least_speed, .. } = self.spec;
        let AxisSample { position: measured, deflection, friction_ratio, start_ratio, fed, saturated } = *measured;
        let State { position, velocity, acceleration, .. } = *commanded;
        if !(position.is_finite() && velocity.is_finite() && acceleration.is_finite()) {
            return;
        }
        // An effort at its limit at rest is that of the hole before.
        self.was_saturated |= saturated && velocity.abs() > least_speed;
        self.unwinding_s = if saturated { UNWINDING_S } else { self.unwinding_s - period_s };
        if let (Some(before), Some(deflection)) = (self.deflection, deflection) {
            self.lag_response.position += deflection - before;
        }
        self.deflection = deflection;
        // Friction is measured: between two samples it was their mean.
        let [acting_velocity, ..] = self.acting;
        let direction = friction_ratio.unwrap_or(acting_velocity / (acting_velocity.abs() + sliding_speed));
        let [direction_before, start_before] = core::mem::replace(&mut self.friction_before, [direction, start_ratio]);
        let frictions = [0.5 * (direction_before + direction), 0.5 * (start_before + start_ratio)];
        let [_, by_direction, _, by_start] = &mut self.responses;
        for (response, friction) in [by_direction, by_start].into_iter().zip(frictions) {
            *response = self.spec.after(response, friction);
        }
        let [by_inertia, by_direction, by_speed, by_start] = self.responses.map(|response| response.position);
        if velocity.abs() > least_speed && self.unwinding_s <= 0.0 {
            self.periods = self.periods.saturating_add(1);
            let unfed = if feeds_acceleration { 0.0 } else { by_inertia };
            let value = position - measured - self.lag_response.position - self.fed_response.position - unfed;
            self.sums.add([velocity, acceleration, by_inertia, by_direction, by_speed, by_start], value);
            (self.squares, self.samples) = (self.squares + value * value, self.samples + 1.0);
        }
        let [acting_velocity, acting_acceleration, acting_fed] =
            core::mem::replace(&mut self.acting, [velocity, acceleration, fed]);
        let [by_inertia, _, by_speed, _] = &mut self.responses;
        for (response, disturbance) in [(by_inertia, acting_acceleration), (by_speed, acting_velocity)] {
            *response = self.spec.after(response, disturbance);
        }
        self.lag_response = self.spec.after(&self.lag_response, 0.0);
        self.fed_response = self.spec.after(&self.fed_response, -acting_fed);
    }

    /// Periods have passed unseen.
    pub(super) fn note_gap(&mut self) {
        self.responses = [LoopState::default(); 4];
        (self.lag_response, self.deflection) = (LoopState::default(), None);
        self.fed_response = LoopState::default();
    }

    /// A hole begins. What an approach showed stands until another shows as much: the short moves between holes say little.
    pub(super) fn begin_hole(&mut self, kept: f64) {
        self.note_gap();
        if self.periods >= APPROACH_PERIODS {
            self.sums.decay(kept);
            (self.squares, self.samples) = (kept * self.squares, kept * self.samples);
            self.periods = 0;
        }
    }

    /// It was at its limit since the axis was first seen: what its loops made of that is not known.
    pub(super) fn was_saturated(&self) -> bool {
        self.was_saturated
    }

    /// What the velocity's age looks like: an inertia over the file's, and a viscous friction.
    fn seeming(&self) -> (f64, f64) {
        let TrackingSpec { closed_loop, velocity_age_s, .. } = self.spec;
        let inertia = -closed_loop.velocity_gain_per_s * velocity_age_s;
        (inertia, inertia / closed_loop.integral_s)
    }

    fn solve(&self, prior_s: f64) -> [f64; 6] {
        let TrackingSpec { period_s, acceleration, count, .. } = self.spec;
        let around = |mean: f64, deviation: f64| Prior { mean, deviation };
        let (seeming_inertia, seeming_viscous_per_s) = self.seeming();
        let priors = [
            around(prior_s, FILE_PERIODS * period_s),
            around(0.0, AGE_PERIODS2 * period_s * period_s),
            around(seeming_inertia, self.spec.inertia_deviation),
            around(self.spec.coulomb, COULOMB_SHARE * acceleration),
            around(seeming_viscous_per_s, VISCOUS_PER_S),
            around(0.0, START_SHARE * self.spec.coulomb),
        ];
        self.sums.solve(priors, SAMPLE_COUNTS * count)
    }

    /// Mean square of what the fit leaves, in squares of the axis's unit; 0 before an approach.
    pub(super) fn misfit(&self, prior_s: f64) -> f64 {
        if self.samples < f64::from(APPROACH_PERIODS) {
            return 0.0;
        }
        ((self.squares + self.sums.misfit(self.solve(prior_s))) / self.samples).max(0.0)
    }

    /// What fits best by now; `prior_s` is what the latency is thought to be without, and what differs less from it than the
    /// fit's own error, in periods, is no difference.
    pub(super) fn identified(&self, prior_s: f64, own_error_periods: f64) -> Tracking {
        let TrackingSpec { period_s, file_s, .. } = self.spec;
        let (seeming_inertia, seeming_viscous_per_s) = self.seeming();
        let [latency_s, _, inertia, coulomb, viscous_per_s, _] = self.solve(prior_s);
        let latency_s = prior_s + standing_out(latency_s - prior_s, own_error_periods * period_s);
        let most_s = MOST_PERIODS * period_s;
        Tracking {
            latency_s: latency_s.max(file_s - most_s).min(file_s + most_s).max(0.0),
            inertia_ratio: 1.0 + inertia - seeming_inertia,
            coulomb: coulomb.max(0.0),
            viscous_per_s: standing_out(viscous_per_s - seeming_viscous_per_s, LEAST_VISCOUS_PER_S).max(0.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{AxisSample, TrackingFit, TrackingSpec};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::model::cascade::{Cascade, CascadeGains, Measured};
    use crate::control::model::closed_loop::ClosedLoop;

    const PERIOD_S: f64 = 0.001;
    const FILE_S: f64 = 0.001;
    const ACCELERATION: f64 = 600.0;

    /// Up to 60 rev/s and back to rest.
    fn command(t_s: f64) -> State {
        let (up_s, down_s) = (t_s.clamp(0.0, 0.1), (t_s - 0.15).clamp(0.0, 0.1));
        let travel = |s: f64| 0.5 * ACCELERATION * s * s;
        let position = travel(up_s) + 60.0 * (t_s - 0.1).max(0.0) - travel(down_s) - 60.0 * (t_s - 0.25).max(0.0);
        let (speeds_up, slows) = ((0.0..0.1).contains(&t_s), (0.15..0.25).contains(&t_s));
        let acceleration = ACCELERATION * (f64::from(u8::from(speeds_up)) - f64::from(u8::from(slows)));
        State { position, velocity: ACCELERATION * (up_s - down_s), acceleration, jerk: 0.0 }
    }

    fn at(position: f64) -> AxisSample {
        AxisSample { position, deflection: None, friction_ratio: None, start_ratio: 0.0, fed: 0.0, saturated: false }
    }

    fn fit() -> TrackingFit {
        let machine = Machine::reference();
        let closed_loop = ClosedLoop::of_spindle(&machine.spec().drive);
        TrackingFit::new(TrackingSpec {
            closed_loop,
            feeds_acceleration: true,
            period_s: PERIOD_S,
            velocity_age_s: machine.spec().drive.velocity_filter_s + 0.5 * machine.spec().drive.period_s,
            inertia_deviation: 0.3,
            coulomb: 0.0,
            file_s: FILE_S,
            sliding_speed: 2.0,
            least_speed: 2.0,
            acceleration: ACCELERATION,
            count: 1.0 / 16_384.0,
        })
    }

    /// A rigid axis under the reference machine's spindle drive, in steps of 25 µs, with an inertia and friction that the
    /// drive does not know.
    fn found_s(latency_s: f64, inertia: f64, coulomb: f64, viscous: f64) -> f64 {
        let drive = Machine::reference().spec().drive;
        let mut cascade = Cascade::new(
            CascadeGains {
                period_s: drive.period_s,
                position_gain_per_s: drive.spindle_position_gain_per_s,
                velocity_gain_per_s: drive.spindle_velocity_gain_per_s,
                integral_s: drive.spindle_integral_s,
                velocity_filter_s: drive.velocity_filter_s,
                effort_per_acceleration: 1.0,
            },
            0.0,
        );
        let (mut position, mut velocity, mut fit) = (0.0, 0.0_f64, fit());
        for period in 0..300 {
            let now_s = f64::from(period) * PERIOD_S;
            fit.add(&command(now_s), &at(position));
            for tick in 0..8 {
                let at_s = now_s + f64::from(tick) * drive.period_s;
                let measured = Measured { position, motor_position: position };
                let effort = cascade.step(&command(at_s - latency_s), 0.0, measured, 1e9).effort;
                for _ in 0..5 {
                    let friction = coulomb * velocity / (velocity.abs() + 0.01) + viscous * velocity;
                    velocity += 25e-6 * (effort - friction) / inertia;
                    position += 25e-6 * velocity;
                }
            }
        }
        fit.identified(FILE_S, 0.003).latency_s
    }

    #[test]
    fn latency_is_separated_from_inertia_and_friction() {
        for latency_s in [0.0009, 0.001, 0.0011, 0.002] {
            for (inertia, coulomb, viscous) in [(1.0, 0.0, 0.0), (1.2, 20.0, 0.0), (0.85, 10.0, 0.5)] {
                let off_s = found_s(latency_s, inertia, coulomb, viscous) - latency_s;
                assert!(off_s.abs() < 0.01 * PERIOD_S, "{latency_s} {inertia}: {off_s}");
            }
        }
    }

    #[test]
    fn without_motion_what_was_file_stands() {
        let mut fit = fit();
        (0..100).for_each(|_| fit.add(&State::default(), &at(0.3)));
        assert_eq!(fit.identified(FILE_S, 0.003).latency_s, FILE_S);
    }

    /// Nothing that is measured makes it leave its bounds.
    #[test]
    fn latency_stays_within_bounds() {
        for measured in [1e9, -1e9] {
            let mut fit = fit();
            (0..300).for_each(|k| fit.add(&command(f64::from(k) * PERIOD_S), &at(measured)));
            assert!((0.0..=FILE_S + 3.0 * PERIOD_S).contains(&fit.identified(FILE_S, 0.003).latency_s));
        }
    }
}
