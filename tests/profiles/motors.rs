//! Random motors: strokes of the laws that follow a torque curve, against integration over its own definition.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rigidtap::control::math::poly::State;
use rigidtap::control::motor::{Friction, Motor, TorqueCurve, TorquePoint};
use rigidtap::control::profile::verify::{Limits, Task, Violation, verify};
use rigidtap::control::profile::{MAX_SEGMENTS, Profile, StrokeRequest, TorqueCurveSmoothLaw, TorqueLimitLaw, Turns};

use crate::cases::{beside, count_asked, log_uniform};
use crate::oracle::{self, Best};

/// Of each law, unless the environment asks for another number in all.
const STROKES: u64 = 30_000;
/// Fewer where each is integrated numerically.
const INTEGRATED: u64 = 5_000;
/// What the numerical contract allows of duration × acceleration, in rev/s.
const SPEED_BY_TIME: f64 = 1e6;

/// Three of each law to ten of the laws without a motor, as in the normal run.
fn strokes() -> u64 {
    count_asked().map_or(STROKES, |count| u64::from(count) * 3 / 10)
}

/// A motor with a share, friction and a jerk, and one stroke of it.
#[derive(Clone, Debug)]
struct Case {
    motor: Motor,
    friction: Friction,
    share: f64,
    jerk: f64,
    stroke: StrokeRequest,
}

/// Points of two to eight speeds: constant torque, constant power, and whatever else a data sheet may draw.
fn curve(random: &mut Pcg64Mcg) -> TorqueCurve {
    let mut point = TorquePoint { speed_rpm: log_uniform(random, (10.0, 20_000.0)), torque_nm: 1.0 };
    let mut points = vec![TorquePoint { speed_rpm: 0.0, ..point }, point];
    for _ in 2..random.random_range(2..=8) {
        let speed_rpm = point.speed_rpm * (1.0 + log_uniform(random, (1e-3, 2.0)));
        let factor = match random.random_range(0..6) {
            0..3 => point.speed_rpm / speed_rpm,
            3 => log_uniform(random, (0.3, 1.0)),
            4 => log_uniform(random, (1.0, 1.5)),
            _ => 1.0,
        };
        point = TorquePoint { speed_rpm, torque_nm: point.torque_nm * factor };
        points.push(point);
    }
    TorqueCurve::new(&points).expect("rising speeds, positive torques")
}

impl Case {
    fn of_seed(seed: u64) -> Self {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        loop {
            let case = Self::random(&mut random);
            let (least, greatest) = case.accelerations();
            if least >= 1.0 && greatest <= 1e6 && case.torque_limit().duration_s() * greatest <= SPEED_BY_TIME {
                return case;
            }
        }
    }

    fn random(random: &mut Pcg64Mcg) -> Self {
        let curve = curve(random);
        let share = random.random_range(0.3..=1.0);
        let inertia_kg_m2 = share / (log_uniform(random, (2.0, 5e5)) * core::f64::consts::TAU);
        let motor = Motor { curve, inertia_kg_m2 };
        let top_rpm = motor.curve.points().last().expect("two points").speed_rpm;
        let least_nm = motor.curve.points().iter().map(|point| point.torque_nm).fold(f64::INFINITY, f64::min);
        let friction = if random.random_bool(0.5) {
            Friction::default()
        } else {
            let part = random.random_range(0.0..0.3) * share * least_nm;
            Friction {
                coulomb_nm: part,
                viscous_nm_per_rpm: random.random_range(0.0..0.3) * share * least_nm / top_rpm,
            }
        };
        let a = motor.acceleration_rev_per_s2(0.0, share);
        // The acceleration at rest is reached in half a millisecond to a second.
        let jerk = (a / log_uniform(random, (5e-4, 1.0))).clamp(1.0, 1e9);
        let speeds = motor.curve.points().iter().map(|point| point.speed_rpm / 60.0).collect::<Vec<_>>();
        let mark = speeds[random.random_range(1..speeds.len())];
        let command = match random.random_range(0..3) {
            0 => beside(random, mark),
            1 => log_uniform(random, (1e-2, 1e3)),
            _ => top_rpm / 60.0,
        };
        let distance = match random.random_range(0..4) {
            // Around where the knee, the command and the acceleration at rest are just reached.
            0 => mark * mark / a * random.random_range(0.5..3.0),
            1 => command * command / a * random.random_range(0.5..5.0),
            2 => a * a * a / (jerk * jerk) * log_uniform(random, (1e-3, 1e1)),
            _ => log_uniform(random, (1e-3, 1e4)),
        };
        let stroke = StrokeRequest { distance: distance.clamp(1e-3, 1e4), command: command.clamp(1e-2, 1e4) };
        Self { motor, friction, share, jerk, stroke }
    }

    fn command(&self) -> f64 {
        let top_rpm = self.motor.curve.points().last().expect("two points").speed_rpm;
        self.stroke.command.min(top_rpm / 60.0)
    }

    /// Greatest acceleration at a speed, from torque over inertia; `friction` less than nothing brakes.
    fn limit(&self, speed: f64, friction: f64) -> f64 {
        let rpm = speed * 60.0;
        let friction_nm = self.friction.coulomb_nm + self.friction.viscous_nm_per_rpm * rpm;
        let torque_nm = self.share * self.motor.curve.torque_nm(rpm) - friction * friction_nm;
        torque_nm / (self.motor.inertia_kg_m2 * core::f64::consts::TAU)
    }

    fn accelerations(&self) -> (f64, f64) {
        let speeds = self.motor.curve.points().iter().map(|point| point.speed_rpm / 60.0);
        speeds.fold((f64::INFINITY, 0.0), |(least, greatest): (f64, f64), v| {
            (least.min(self.limit(v, 1.0)), greatest.max(self.limit(v, -1.0)))
        })
    }

    fn corners(&self) -> Vec<f64> {
        self.motor.curve.points().iter().map(|point| point.speed_rpm / 60.0).collect()
    }

    /// The fastest stroke with friction.
    fn best(&self) -> Option<Best> {
        self.best_with(1.0)
    }

    fn best_with(&self, friction: f64) -> Option<Best> {
        let corners = self.corners();
        oracle::limited(self.stroke.distance, self.command(), &corners, |v| {
            (self.limit(v, friction), self.limit(v, -friction))
        })
    }

    fn torque_limit(&self) -> Profile {
        TorqueLimitLaw::new(&self.motor, self.friction, self.share).plan(self.stroke).expect("feasible")
    }

    fn smooth_law(&self) -> TorqueCurveSmoothLaw {
        TorqueCurveSmoothLaw::new(&self.motor, self.share, self.jerk)
    }

    fn verify_limit(&self, profile: &Profile) -> Result<(), Violation> {
        let acceleration = |state: &State| self.limit(state.velocity, state.acceleration.signum());
        let task = Task { distance: self.stroke.distance, ..Task::default() };
        let (velocity, jerk) = (self.command(), f64::INFINITY);
        verify(profile, &task, &Limits { velocity, acceleration: &acceleration, jerk, continuous_acceleration: false })
    }

    fn verify_smooth(&self, profile: &Profile, turns: Turns) -> Result<(), Violation> {
        let acceleration = |state: &State| self.limit(state.velocity, 0.0);
        let task = Task {
            distance: self.stroke.distance,
            start_acceleration: turns.start,
            end_acceleration: -turns.end,
            ..Task::default()
        };
        let (velocity, jerk) = (self.command(), self.jerk);
        verify(profile, &task, &Limits { velocity, acceleration: &acceleration, jerk, continuous_acceleration: true })
    }
}

fn cases(strokes: u64) -> impl Iterator<Item = (u64, Case)> {
    (0..strokes).map(|seed| (seed, Case::of_seed(seed)))
}

#[test]
fn torque_limit_keeps_below_the_curve() {
    for (seed, case) in cases(strokes()) {
        let profile = case.torque_limit();
        let verified = case.verify_limit(&profile);
        assert!(verified.is_ok(), "seed {seed}: {verified:?}\n{case:#?}\n{:#?}", profile.segments());
    }
}

#[test]
fn torque_limit_is_within_one_percent_of_the_bound() {
    for (seed, case) in cases(INTEGRATED) {
        let best = case.best().expect("chosen so");
        let ratio = case.torque_limit().duration_s() / best.duration_s;
        assert!((1.0 - 1e-6..=1.01).contains(&ratio), "seed {seed}: {ratio} times the bound\n{case:#?}");
        if case.friction == Friction::default() {
            let bound = case.motor.fastest_stroke(case.stroke.distance, case.command(), case.share);
            assert!((bound.duration_s / best.duration_s - 1.0).abs() < 1e-6, "seed {seed}: {bound:?} {best:?}");
        }
    }
}

#[test]
fn torque_curve_smooth_keeps_its_contract() {
    let mut most_segments = 0;
    for (seed, case) in cases(strokes()) {
        let law = case.smooth_law();
        let turn = law.turn_acceleration(case.stroke).expect("feasible");
        assert!(turn > 0.0 && turn <= law.acceleration_at_rest());
        for turns in [
            Turns::default(),
            Turns { start: 0.0, end: turn },
            Turns { start: turn, end: 0.0 },
            Turns { start: turn / 3.0, end: turn / 2.0 },
        ] {
            let profile =
                law.plan(case.stroke, turns).unwrap_or_else(|error| panic!("seed {seed}: {error:?}\n{case:#?}"));
            let verified = case.verify_smooth(&profile, turns);
            assert!(verified.is_ok(), "seed {seed}: {turns:?} {verified:?}\n{case:#?}\n{:#?}", profile.segments());
            most_segments = most_segments.max(profile.segments().len());
        }
    }
    assert!(most_segments > MAX_SEGMENTS / 2 && most_segments <= MAX_SEGMENTS, "{most_segments} segments at most");
}

#[test]
fn torque_curve_smooth_is_near_the_bound() {
    for (seed, case) in cases(INTEGRATED) {
        let law = case.smooth_law();
        let best = case.best_with(0.0).expect("chosen so");
        let duration_s = law.plan(case.stroke, Turns::default()).expect("feasible").duration_s();
        let allowed_s = 1.05 * best.duration_s + 2.0 * law.acceleration_at_rest() / law.jerk();
        assert!(duration_s <= allowed_s, "seed {seed}: {} of what is allowed\n{case:#?}", duration_s / allowed_s);
    }
}
