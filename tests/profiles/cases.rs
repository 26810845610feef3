//! Random strokes, denser where laws have their special cases.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rigidtap::control::math::poly::State;
use rigidtap::control::profile::verify::{Limits, Task, Violation, verify};
use rigidtap::control::profile::{
    ImprovedSCurveLaw, LinearLaw, MAX_BANDS, Profile, ProfileError, SCurveLaw, SpeedBand, StrokeRequest,
    TorqueCurveLaw, TrapezoidJerkLaw,
};

use crate::oracle::{self, Best};

/// The number of random strokes that the environment asks for.
pub(crate) fn count_asked() -> Option<u32> {
    std::env::var("STROKES").ok().map(|count| count.parse().expect("STROKES is a number"))
}

#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "one at a time is alive")]
pub(crate) enum Law {
    TorqueCurve(TorqueCurveLaw),
    SCurve(SCurveLaw),
    SCurveBetween(SCurveLaw, f64, f64),
    Linear(LinearLaw),
    TrapezoidJerk(TrapezoidJerkLaw),
    ImprovedSCurve(ImprovedSCurveLaw, f64, f64),
}

/// One stroke to plan; `Debug` prints all that is needed to plan it again.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) law: Law,
    pub(crate) stroke: StrokeRequest,
}

// The ranges of the numerical contract in `control::profile`.
const DISTANCE: (f64, f64) = (1e-3, 1e4);
const SPEED: (f64, f64) = (1e-2, 1e4);
const ACCELERATION: (f64, f64) = (1.0, 1e6);
const JERK: (f64, f64) = (1.0, 1e9);
const SNAP: (f64, f64) = (1.0, 1e12);
const PERIOD: (f64, f64) = (1e-5, 0.1);
const STOPPING_DISTANCE: f64 = 1e5;
const SPEED_BY_TIME: f64 = 1e6;

pub(crate) fn log_uniform(random: &mut Pcg64Mcg, (low, high): (f64, f64)) -> f64 {
    (low.ln() + random.random_range(0.0..=1.0) * (high / low).ln()).exp().clamp(low, high)
}

/// Exactly on a boundary, an ulp or a little beside it, or far away.
pub(crate) fn beside(random: &mut Pcg64Mcg, value: f64) -> f64 {
    match random.random_range(0..8) {
        0..3 => value,
        3 => value.next_up(),
        4 => value.next_down(),
        5 => value * (1.0 + 1e-12),
        6 => value * (1.0 - 1e-9),
        _ => value * random.random_range(0.5..2.0),
    }
}

fn bands(random: &mut Pcg64Mcg) -> Vec<SpeedBand> {
    let count = random.random_range(1..=MAX_BANDS);
    let mut top = log_uniform(random, SPEED) / 10.0;
    let same = random.random_bool(0.2);
    (0..count)
        .map(|_| {
            top *= 1.0 + log_uniform(random, (1e-6, 2.0));
            let accel_rev_per_s2 = log_uniform(random, ACCELERATION);
            let decel_rev_per_s2 = if same { accel_rev_per_s2 } else { log_uniform(random, ACCELERATION) };
            SpeedBand { to_rev_per_s: top, accel_rev_per_s2, decel_rev_per_s2 }
        })
        .collect()
}

fn any_top(random: &mut Pcg64Mcg, bands: &[SpeedBand]) -> f64 {
    bands[random.random_range(0..bands.len())].to_rev_per_s
}

/// Rest, a band's top, or any speed below the top of all.
fn end_speed(random: &mut Pcg64Mcg, bands: &[SpeedBand]) -> f64 {
    match random.random_range(0..4) {
        0 | 1 => 0.0,
        2 => any_top(random, bands),
        _ => bands[bands.len() - 1].to_rev_per_s * random.random_range(0.0..1.0),
    }
}

fn torque_curve(random: &mut Pcg64Mcg) -> Case {
    let bands = bands(random);
    let mut law = TorqueCurveLaw::from_rest(&bands).expect("at most MAX_BANDS");
    law.start_rev_per_s = end_speed(random, &bands);
    law.end_rev_per_s = if random.random_bool(0.1) { law.start_rev_per_s } else { end_speed(random, &bands) };
    let command = match random.random_range(0..3) {
        0 => log_uniform(random, SPEED),
        1 => bands[bands.len() - 1].to_rev_per_s * random.random_range(0.1..1.5),
        _ => {
            let top = any_top(random, &bands);
            beside(random, top)
        }
    };
    // Where one special case passes into the next: too short, peak at a band's top, no cruise left.
    let ends = law.start_rev_per_s.max(law.end_rev_per_s);
    let boundary = match random.random_range(0..3) {
        0 => ends,
        1 => any_top(random, &bands).max(ends),
        _ => command.clamp(ends, ends.max(oracle::top(&law))),
    };
    let distance = match random.random_range(0..2) {
        0 => log_uniform(random, DISTANCE),
        _ => {
            let distance = oracle::banded_ramps(&law, boundary).1;
            beside(random, distance)
        }
    };
    Case { law: Law::TorqueCurve(law), stroke: StrokeRequest { distance, command } }
}

fn s_curve(random: &mut Pcg64Mcg, between: bool) -> Case {
    let law = SCurveLaw { acceleration: log_uniform(random, ACCELERATION), jerk: log_uniform(random, JERK) };
    let SCurveLaw { acceleration: a, jerk: j } = law;
    // Speed and distance at which A is just reached, and distance at which the command is.
    let command = if random.random_bool(0.5) { log_uniform(random, SPEED) } else { beside(random, a * a / j) };
    let reaching_command =
        command * if command * j >= a * a { command / a + a / j } else { 2.0 * (command / j).sqrt() };
    let distance = match random.random_range(0..4) {
        0 => beside(random, 2.0 * a * a * a / (j * j)),
        1 => beside(random, reaching_command),
        _ => log_uniform(random, DISTANCE),
    };
    let stroke = StrokeRequest { distance, command };
    if !between {
        return Case { law: Law::SCurve(law), stroke };
    }
    let mut end = || match random.random_range(0..5) {
        0 | 1 => 0.0,
        2 => command,
        3 => command * (1.0 - log_uniform(random, (1e-12, 1e-3))),
        _ => command * random.random_range(0.0..1.01),
    };
    let (start, end) = (end(), end());
    Case { law: Law::SCurveBetween(law, start, end), stroke }
}

/// With limits of any kind, and with such that one of them is just reached where another is.
fn trapezoid_jerk(random: &mut Pcg64Mcg) -> Case {
    let (acceleration, jerk) = (log_uniform(random, ACCELERATION), log_uniform(random, JERK));
    let just = jerk * jerk / acceleration;
    let snap = if random.random_bool(0.3) { beside(random, just) } else { log_uniform(random, SNAP) };
    let quantised_s = random.random_bool(0.4).then(|| log_uniform(random, PERIOD));
    let law = TrapezoidJerkLaw { acceleration, jerk, snap, quantised_s };
    let full = oracle::JerkRamp::greatest(&law);
    let command = match random.random_range(0..4) {
        0 => beside(random, full.gain),
        1 => beside(random, 2.0 * jerk.powi(3) / (snap * snap)),
        _ => log_uniform(random, SPEED),
    };
    let distance = match random.random_range(0..4) {
        0 => beside(random, full.gain * full.duration_s),
        1 => beside(random, 8.0 * jerk.powi(4) / snap.powi(3)),
        2 => {
            let distance = command * oracle::JerkRamp::to(&law, command).duration_s;
            beside(random, distance)
        }
        _ => log_uniform(random, DISTANCE),
    };
    Case { law: Law::TrapezoidJerk(law), stroke: StrokeRequest { distance, command } }
}

fn improved_s_curve(random: &mut Pcg64Mcg) -> Case {
    let law = ImprovedSCurveLaw { acceleration: log_uniform(random, ACCELERATION) };
    let command = log_uniform(random, SPEED);
    let mut end = || match random.random_range(0..5) {
        0 | 1 => 0.0,
        2 => command,
        3 => command * (1.0 - log_uniform(random, (1e-6, 1e-3))),
        _ => command * random.random_range(0.0..1.01),
    };
    let (start, end) = (end(), end());
    let distance = match random.random_range(0..3) {
        0 => beside(random, 18.0 / 11.0 * command * command / law.acceleration),
        _ => log_uniform(random, DISTANCE),
    };
    Case { law: Law::ImprovedSCurve(law, start, end), stroke: StrokeRequest { distance, command } }
}

fn linear(random: &mut Pcg64Mcg) -> Case {
    let law = LinearLaw { acceleration: log_uniform(random, ACCELERATION) };
    let command = log_uniform(random, SPEED);
    let boundary = command * command / law.acceleration;
    let distance = if random.random_bool(0.3) { beside(random, boundary) } else { log_uniform(random, DISTANCE) };
    Case { law: Law::Linear(law), stroke: StrokeRequest { distance, command } }
}

impl Case {
    /// The case of a seed, within the contract's ranges.
    pub(crate) fn of_seed(seed: u64) -> Self {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        loop {
            let case = match random.random_range(0..12) {
                0..5 => torque_curve(&mut random),
                5 => s_curve(&mut random, false),
                6 | 7 => s_curve(&mut random, true),
                8 | 9 => trapezoid_jerk(&mut random),
                10 => improved_s_curve(&mut random),
                _ => linear(&mut random),
            };
            if case.in_contract() {
                return case;
            }
        }
    }

    fn in_contract(&self) -> bool {
        let StrokeRequest { distance, command } = self.stroke;
        let inside = |value: f64, (low, high): (f64, f64)| value >= low && value <= high;
        let (start, end) = self.end_speeds();
        let (least, greatest) = self.accelerations();
        let ends = start.max(end);
        inside(distance, DISTANCE)
            && inside(command, SPEED)
            && ends * ends / (2.0 * least) <= STOPPING_DISTANCE
            && !self.takes_longer_than(SPEED_BY_TIME / greatest)
    }

    /// The oracle is asked only where the planner says so, too: it is slow.
    fn takes_longer_than(&self, limit_s: f64) -> bool {
        self.plan().is_ok_and(|profile| profile.duration_s() > limit_s)
            && self.best().is_some_and(|best| best.duration_s > limit_s)
    }

    pub(crate) fn end_speeds(&self) -> (f64, f64) {
        match &self.law {
            Law::TorqueCurve(law) => (law.start_rev_per_s, law.end_rev_per_s),
            Law::SCurveBetween(_, start, end) | Law::ImprovedSCurve(_, start, end) => (*start, *end),
            Law::SCurve(_) | Law::Linear(_) | Law::TrapezoidJerk(_) => (0.0, 0.0),
        }
    }

    /// The commanded speed, or the top of the law where that is lower.
    pub(crate) fn command(&self) -> f64 {
        match &self.law {
            Law::TorqueCurve(law) => self.stroke.command.min(oracle::top(law)),
            _ => self.stroke.command,
        }
    }

    fn accelerations(&self) -> (f64, f64) {
        match &self.law {
            Law::TorqueCurve(law) => {
                let rates = law.bands.iter().flat_map(|band| [band.accel_rev_per_s2, band.decel_rev_per_s2]);
                rates.fold((f64::INFINITY, 0.0), |(least, greatest): (f64, f64), a| (least.min(a), greatest.max(a)))
            }
            Law::SCurve(law) | Law::SCurveBetween(law, ..) => (law.acceleration, law.acceleration),
            Law::Linear(law) => (law.acceleration, law.acceleration),
            Law::TrapezoidJerk(law) => (law.acceleration, law.acceleration),
            Law::ImprovedSCurve(law, ..) => (law.acceleration, law.acceleration),
        }
    }

    pub(crate) fn plan(&self) -> Result<Profile, ProfileError> {
        match &self.law {
            Law::TorqueCurve(law) => law.plan(self.stroke),
            Law::SCurve(law) => law.plan(self.stroke),
            Law::SCurveBetween(law, start, end) => law.plan_between(self.stroke, *start, *end),
            Law::Linear(law) => law.plan(self.stroke),
            Law::TrapezoidJerk(law) => law.plan(self.stroke),
            Law::ImprovedSCurve(law, start, end) => law.plan_between(self.stroke, *start, *end),
        }
    }

    /// Whether the plan is to be the best, which whole periods are not.
    pub(crate) fn is_to_be_best(&self) -> bool {
        !matches!(&self.law, Law::TrapezoidJerk(law) if law.quantised_s.is_some())
    }

    /// The best possible stroke; none where there is none.
    pub(crate) fn best(&self) -> Option<Best> {
        let StrokeRequest { distance, command } = self.stroke;
        let (start, end) = self.end_speeds();
        if start.max(end) > self.command() {
            return None;
        }
        match &self.law {
            Law::TorqueCurve(law) => oracle::banded(law, distance, command),
            Law::SCurve(law) | Law::SCurveBetween(law, ..) => oracle::s_curve(law, distance, command, start, end),
            Law::TrapezoidJerk(law) => oracle::trapezoid_jerk(law, distance, command),
            Law::ImprovedSCurve(law, ..) => oracle::improved_s_curve(law, distance, command, start, end),
            Law::Linear(law) => {
                let band = SpeedBand {
                    to_rev_per_s: command,
                    accel_rev_per_s2: law.acceleration,
                    decel_rev_per_s2: law.acceleration,
                };
                oracle::banded(&TorqueCurveLaw::from_rest(&[band]).expect("one band"), distance, command)
            }
        }
    }

    pub(crate) fn verify(&self, profile: &Profile) -> Result<(), Violation> {
        let (start_velocity, end_velocity) = self.end_speeds();
        let task = Task { distance: self.stroke.distance, start_velocity, end_velocity, ..Task::default() };
        let (jerk, continuous_acceleration) = match &self.law {
            Law::SCurve(law) | Law::SCurveBetween(law, ..) => (law.jerk, true),
            Law::TrapezoidJerk(law) => (law.jerk, true),
            // Its jerk is a result.
            Law::ImprovedSCurve(..) => (f64::INFINITY, true),
            Law::TorqueCurve(_) | Law::Linear(_) => (f64::INFINITY, false),
        };
        let acceleration = |state: &State| match &self.law {
            Law::TorqueCurve(law) if state.acceleration < 0.0 => {
                oracle::band_limit(&law.bands, state.velocity, |band| band.decel_rev_per_s2)
            }
            Law::TorqueCurve(law) => oracle::band_limit(&law.bands, state.velocity, |band| band.accel_rev_per_s2),
            _ => self.accelerations().1,
        };
        let limits = Limits { velocity: self.command(), acceleration: &acceleration, jerk, continuous_acceleration };
        verify(profile, &task, &limits)
    }
}
