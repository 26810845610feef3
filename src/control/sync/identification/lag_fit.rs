//! The gains of a drive that takes positions alone, from how far its axis lags behind them.
//!
//! A position loop (Kp) around a velocity loop with integral part (Kv, Ti), told nothing else, sees at any time
//!
//! r − p = v/Kp + W(a + f)/(Kp·Kv), W = Ti·s/(Ti·s + 1),
//!
//! with the reference r as it acts, and friction f as an acceleration. That is linear in what is unknown, 1/Kp and 1/(Kp·Kv), with
//! the axis's own motion as it was measured (equation error; Ljung, System Identification, 1999): nothing is linearised
//! about gains as they are told. A latency that is not as told is a difference in proportion to the command's speed, and so almost
//! what 1/Kp is; the changes of speed tell them apart, and what they do not tell is taken for the gain's.

use crate::control::math::least_squares::{NormalEquations, Prior};
use crate::control::math::{filter_share, floor};
use crate::control::model::closed_loop::ClosedLoop;
use crate::control::model::washout::Washout;

use super::tracking_fit::{Tracking, TrackingSpec};
use crate::control::math::standing_out::standing_out;

/// Commands kept, for the greatest latency that a machine file may have.
const KEPT: usize = 24;
/// Standard deviations of the told gains, as ratios.
const POSITION_GAIN: f64 = 0.3;
const VELOCITY_GAIN: f64 = 0.5;
/// The same of the latency in periods; and below it a latency is as told where none that stands out is found.
const FILE_PERIODS: f64 = 1.0;
const OWN_PERIODS: f64 = 0.15;
const PINNED_PERIODS: f64 = 1e-6;
/// Of Coulomb friction, as a share of the greatest acceleration, and of viscous friction, per second.
const COULOMB_SHARE: f64 = 0.3;
const VISCOUS_PER_S: f64 = 5.0;
/// Standard deviation of a row in counts: of what the axis does beyond a rigid one.
const ROW_COUNTS: f64 = 50.0;
/// Low-pass of all signals, of so many stages: a second difference of counts is noise, were it not for that.
const SMOOTHING_S: f64 = 0.005;
const STAGES: usize = 3;
const SIGNALS: usize = 5;
/// A drive that was at its limit is off its loops for so many integral times.
const UNWINDING_INTEGRALS: f64 = 6.0;
/// Rows from which on a latency can be told from a gain: fewer are of an axis that hardly moved, or whose drive was at its limit.
const LEAST_ROWS: u32 = 100;
/// Rows from which on an approach takes the place of older ones.
const APPROACH_PERIODS: u32 = 100;
/// Found gains are within so much of the told ones, or they are not believed.
const MOST_RATIO: f64 = 2.0;

/// What a position loop sees, and what the fit needs of the axis in one period.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct LagSample {
    /// Where the position loop's encoder reads.
    pub(super) position: f64,
    /// Where the motor is, whose velocity the velocity loop reads, and the centre of all mass.
    pub(super) motor: f64,
    pub(super) mass: f64,
    /// Friction over Coulomb's, −1…1; none where its direction is that of the motion.
    pub(super) friction_ratio: Option<f64>,
}

/// The same with the reference that acts then, all of it smoothed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Smoothed {
    acting: f64,
    position: f64,
    motor: f64,
    mass: f64,
    direction: f64,
}

/// Ages, s: of an encoder's sample, of the velocity that the loop reads, and from an effort's command to the acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LagAges {
    pub(super) sample_s: f64,
    pub(super) velocity_s: f64,
    pub(super) effort_s: f64,
}

/// The fit of one axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LagFit {
    spec: TrackingSpec,
    ages: LagAges,
    /// Unknown are 1/Kp; inertia, Coulomb and viscous friction over Kp·Kv; and the latency beyond the told one.
    sums: NormalEquations<5>,
    /// References sent, newest first, and how many periods have been seen since the axis rested.
    sent: [f64; KEPT],
    seen: usize,
    /// Where the motor was a period ago, for the motion's direction.
    motor: f64,
    smoothing: [[f64; STAGES]; SIGNALS],
    /// The last periods, newest first.
    smoothed: [Smoothed; 4],
    washouts: [Washout; 3],
    unwinding_s: f64,
    /// Rows in all, and those since older ones were made to count less.
    rows: u32,
    periods: u32,
}

impl LagFit {
    pub(super) fn new(spec: TrackingSpec, ages: LagAges) -> Self {
        Self {
            spec,
            ages,
            sums: NormalEquations::default(),
            sent: [0.0; KEPT],
            seen: 0,
            motor: 0.0,
            smoothing: [[0.0; STAGES]; SIGNALS],
            smoothed: [Smoothed::default(); 4],
            washouts: [Washout::new(spec.closed_loop.integral_s, spec.period_s); 3],
            unwinding_s: 0.0,
            rows: 0,
            periods: 0,
        }
    }

    /// The reference that acts at the start of the newest period, between two as the drive has it.
    fn acting(&self) -> f64 {
        let periods = (self.spec.file_s / self.spec.period_s).min((KEPT - 2) as f64);
        let whole = floor(periods);
        let at = |index: usize| self.sent.get(index).copied().unwrap_or_default();
        let (newer, older) = (at(whole as usize), at(whole as usize + 1));
        newer + (periods - whole) * (older - newer)
    }

    /// The signals of a period, each through the same low-pass: what holds between them holds between them still.
    fn smooth(&mut self, signals: [f64; SIGNALS]) -> Smoothed {
        if self.seen == 0 {
            self.smoothing = signals.map(|signal| [signal; STAGES]);
        }
        let share = filter_share(self.spec.period_s, SMOOTHING_S);
        for (stages, signal) in self.smoothing.iter_mut().zip(signals) {
            let mut input = signal;
            for stage in stages {
                *stage += share * (input - *stage);
                input = *stage;
            }
        }
        let [acting, position, motor, mass, direction] = self.smoothing.map(|[.., last]| last);
        Smoothed { acting, position, motor, mass, direction }
    }

    /// One period: what is sent in it, and what was measured at its start.
    pub(super) fn add(&mut self, sent: f64, sample: LagSample, saturated: bool) {
        let TrackingSpec { closed_loop, period_s, sliding_speed, least_speed, .. } = self.spec;
        if !sent.is_finite() {
            return;
        }
        if self.seen == 0 {
            (self.sent, self.motor) = ([sent; KEPT], sample.motor);
        }
        self.sent.rotate_right(1);
        if let Some(newest) = self.sent.first_mut() {
            *newest = sent;
        }
        let unwound_s = UNWINDING_INTEGRALS * closed_loop.integral_s;
        self.unwinding_s = if saturated { unwound_s } else { self.unwinding_s - period_s };
        let LagSample { position, motor, mass, friction_ratio } = sample;
        let speed = (motor - core::mem::replace(&mut self.motor, motor)) / period_s;
        let direction = friction_ratio.unwrap_or(speed / (speed.abs() + sliding_speed));
        let smoothed = self.smooth([self.acting(), position, motor, mass, direction]);
        self.smoothed.rotate_right(1);
        if let Some(newest) = self.smoothed.first_mut() {
            *newest = smoothed;
        }
        self.seen = self.seen.saturating_add(1);
        // The row is that of two periods ago: its velocity and acceleration need what came after.
        let [last, after, of, before] = self.smoothed;
        let slope = |later: f64, earlier: f64| (later - earlier) / (2.0 * period_s);
        let bend = |a: f64, b: f64, c: f64| (a - 2.0 * b + c) / (period_s * period_s);
        let velocity = slope(after.motor, before.motor);
        let [earlier, later] = [bend(after.mass, of.mass, before.mass), bend(last.mass, after.mass, of.mass)];
        let LagAges { sample_s, velocity_s, effort_s } = self.ages;
        let read_velocity = velocity + (sample_s - velocity_s) * bend(after.motor, of.motor, before.motor);
        let acceleration = earlier + (effort_s + sample_s) / period_s * (later - earlier);
        let [by_inertia, by_direction, by_speed] = &mut self.washouts;
        if self.seen < self.smoothed.len() {
            by_inertia.rest(0.0, 0.0);
            by_direction.rest(of.direction, 0.0);
            by_speed.rest(0.0, 0.0);
            return;
        }
        let row = [
            read_velocity,
            by_inertia.step(acceleration),
            by_direction.step(of.direction),
            by_speed.step(velocity),
            slope(after.acting, before.acting),
        ];
        let [.., rate] = row;
        if rate.abs() > least_speed && self.unwinding_s <= 0.0 {
            self.rows = self.rows.saturating_add(1);
            self.periods = self.periods.saturating_add(1);
            self.sums.add(row, of.acting - of.position);
        }
    }

    /// Periods have passed unseen, and the axis rests.
    pub(super) fn note_gap(&mut self) {
        self.seen = 0;
    }

    /// A hole begins. What an approach showed stands until another shows as much.
    pub(super) fn begin_hole(&mut self, kept: f64) {
        self.note_gap();
        if self.periods >= APPROACH_PERIODS {
            self.sums.decay(kept);
            self.periods = 0;
        }
    }

    /// What fits best by now: how the axis follows, with the latency from what it is thought to be without, and the loops' gains.
    /// Inertia and velocity gain are one here: a drive of the told gain with another inertia, or the other way round.
    pub(super) fn identified(&self, prior_s: f64) -> (Tracking, ClosedLoop) {
        let TrackingSpec { closed_loop, period_s, file_s, acceleration, count, .. } = self.spec;
        let around = |mean: f64, deviation: f64| Prior { mean, deviation };
        let per_position = 1.0 / closed_loop.position_gain_per_s;
        let per_both = per_position / closed_loop.velocity_gain_per_s;
        let told_s = prior_s - file_s;
        let priors = |later_s: f64, periods: f64| {
            [
                around(per_position, POSITION_GAIN * per_position),
                around(per_both, VELOCITY_GAIN * per_both),
                around(self.spec.coulomb * per_both, COULOMB_SHARE * acceleration * per_both),
                around(0.0, VISCOUS_PER_S * per_both),
                around(later_s, periods * period_s),
            ]
        };
        let noise = ROW_COUNTS * count;
        let [.., found] = self.sums.solve(priors(told_s, FILE_PERIODS), noise);
        let found = if self.rows < LEAST_ROWS { told_s } else { found };
        let later_s = told_s + standing_out(found - told_s, OWN_PERIODS * period_s);
        let [lag, inertia, coulomb, viscous, _] = self.sums.solve(priors(later_s, PINNED_PERIODS), noise);
        let believed = |found: f64, told: f64| {
            let ratio = found / told;
            if ratio > 1.0 / MOST_RATIO && ratio < MOST_RATIO { found } else { told }
        };
        let (lag, inertia) = (believed(lag, per_position), believed(inertia, per_both));
        let (lag_ratio, inertia_ratio) = (lag / per_position, inertia / per_both);
        let loops = ClosedLoop {
            position_gain_per_s: closed_loop.position_gain_per_s / lag_ratio,
            velocity_gain_per_s: closed_loop.velocity_gain_per_s * lag_ratio / inertia_ratio,
            ..closed_loop
        };
        let tracking = Tracking {
            latency_s: (file_s + later_s).max(0.0),
            inertia_ratio: inertia_ratio / lag_ratio,
            coulomb: (coulomb / inertia).max(0.0),
            viscous_per_s: (viscous / inertia).max(0.0),
        };
        (tracking, loops)
    }
}

#[cfg(test)]
mod tests {
    use super::{LagAges, LagFit, LagSample, TrackingSpec};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::model::cascade::{Cascade, CascadeGains, Measured};
    use crate::control::model::closed_loop::ClosedLoop;

    const PERIOD_S: f64 = 0.001;
    const TICK_S: f64 = 0.000_025;
    const FILE_S: f64 = 0.001;
    const COUNTS_PER_MM: f64 = 1000.0;
    const AGES: LagAges = LagAges { sample_s: 0.0, velocity_s: 0.0, effort_s: 0.0 };

    /// To 200 mm/s in 0.05 s, for 0.2 s, and back to rest, without a step of acceleration.
    fn command(t_s: f64) -> f64 {
        let ramp = |t_s: f64| {
            let s = (t_s / 0.05).clamp(0.0, 1.0);
            200.0 * (0.05 * s * s * s * (1.0 - 0.5 * s) + (t_s - 0.05).max(0.0))
        };
        ramp(t_s) - ramp(t_s - 0.25)
    }

    fn loops(gain: f64) -> ClosedLoop {
        let told = ClosedLoop::of_z(&Machine::reference().spec().drive);
        ClosedLoop {
            position_gain_per_s: gain * told.position_gain_per_s,
            velocity_gain_per_s: gain * told.velocity_gain_per_s,
            ..told
        }
    }

    fn nothing_found() -> LagFit {
        LagFit::new(
            TrackingSpec {
                closed_loop: loops(1.0),
                feeds_acceleration: false,
                period_s: PERIOD_S,
                velocity_age_s: 0.0,
                inertia_deviation: 0.1,
                coulomb: 500.0,
                file_s: FILE_S,
                sliding_speed: 2.0,
                least_speed: 2.0,
                acceleration: 10_000.0,
                count: 1.0 / COUNTS_PER_MM,
            },
            AGES,
        )
    }

    /// What is found of a rigid axis whose drive has other gains, acts at another time, and has friction to overcome.
    fn found(gain: f64, latency_s: f64, coulomb: f64) -> (f64, ClosedLoop) {
        let real = loops(gain);
        let mut drive = Cascade::new(
            CascadeGains {
                period_s: TICK_S,
                position_gain_per_s: real.position_gain_per_s,
                velocity_gain_per_s: real.velocity_gain_per_s,
                integral_s: real.integral_s,
                velocity_filter_s: 0.0,
                effort_per_acceleration: 1.0,
            },
            0.0,
        );
        let (mut fit, mut position, mut velocity) = (nothing_found(), 0.0, 0.0_f64);
        let ticks = (PERIOD_S / TICK_S) as u32;
        for k in 0..500 {
            let start_s = f64::from(k) * PERIOD_S;
            let read = (position * COUNTS_PER_MM).round() / COUNTS_PER_MM;
            let sample = LagSample { position: read, motor: read, mass: read, friction_ratio: None };
            fit.add(command(start_s), sample, false);
            for tick in 0..ticks {
                // Positions are joined by straight lines.
                let at = (start_s + f64::from(tick) * TICK_S - latency_s) / PERIOD_S;
                let (from, to) = (command(at.floor() * PERIOD_S), command((at.floor() + 1.0) * PERIOD_S));
                let reference = State { position: from + (at - at.floor()) * (to - from), ..State::default() };
                let measured = Measured { position, motor_position: position };
                let effort = drive.step(&reference, 0.0, measured, 1e9).effort;
                velocity += TICK_S * (effort - coulomb * velocity / (velocity.abs() + 0.1));
                position += TICK_S * velocity;
            }
        }
        let (tracking, loops) = fit.identified(FILE_S);
        (tracking.latency_s, loops)
    }

    #[test]
    fn gains_are_found_in_one_approach() {
        for (gain, coulomb) in [(1.0, 0.0), (0.85, 500.0), (1.15, 800.0), (0.7, 300.0), (1.3, 0.0)] {
            let (latency_s, found) = found(gain, FILE_S, coulomb);
            let [position, velocity] = [
                found.position_gain_per_s / loops(gain).position_gain_per_s,
                found.velocity_gain_per_s / loops(gain).velocity_gain_per_s,
            ];
            assert!((position - 1.0).abs() < 4e-4, "{gain} {coulomb}: {position}");
            // Friction at the start of a motion looks a little like it.
            assert!((velocity - 1.0).abs() < 0.12, "{gain} {coulomb}: {velocity}");
            assert_eq!(latency_s, FILE_S, "{gain} {coulomb}");
        }
    }

    /// A whole period is no matter of gains.
    #[test]
    fn a_latency_that_is_not_as_told_stands_out() {
        let (latency_s, found) = found(0.9, FILE_S + PERIOD_S, 300.0);
        assert!((latency_s - 2.0 * PERIOD_S).abs() < 0.05 * PERIOD_S, "{latency_s}");
        assert!((found.position_gain_per_s / 36.0 - 1.0).abs() < 2e-3, "{found:?}");
    }

    #[test]
    fn without_motion_the_told_gains_stand() {
        let (mut fit, still) = (nothing_found(), LagSample::default());
        (0..100).for_each(|_| fit.add(0.0, still, false));
        let (tracking, found) = fit.identified(FILE_S);
        assert_eq!((tracking.latency_s, found), (FILE_S, loops(1.0)));
    }
}
