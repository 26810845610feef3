//! Linear interpolation of several axes: the paper's recurrence against the closed form, and each axis's own limits.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rigidtap::control::coupling::Line;
use rigidtap::control::math::poly::State;
use rigidtap::control::profile::{Profile, SCurveLaw, StrokeRequest};

const LIMIT_MM_PER_S: [f64; 3] = [500.0, 400.0, 250.0];
const LIMIT_MM_PER_S2: [f64; 3] = [10_000.0, 8_000.0, 5_000.0];
const LIMIT_MM_PER_S3: [f64; 3] = [500_000.0, 300_000.0, 200_000.0];

struct Move {
    start: [f64; 3],
    end: [f64; 3],
    path: Line<3>,
    law: SCurveLaw,
    profile: Profile,
}

fn plan(start: [f64; 3], end: [f64; 3]) -> Move {
    let path = Line::new(start, end);
    let law = SCurveLaw { acceleration: path.path_limit(LIMIT_MM_PER_S2), jerk: path.path_limit(LIMIT_MM_PER_S3) };
    let request = StrokeRequest { distance: path.length_mm(), command: path.path_limit(LIMIT_MM_PER_S) };
    Move { start, end, path, law, profile: law.plan(request).expect("a line with a length") }
}

/// Lines of 1 µm to 1 m, some of them along one axis or in a plane.
fn moves() -> impl Iterator<Item = (u64, Move)> {
    (0..2000).map(|seed| {
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let size = 10f64.powf(random.random_range(-3.0..3.0));
        let mut delta =
            [0.0; 3].map(|_: f64| if random.random_bool(0.3) { 0.0 } else { random.random_range(-size..size) });
        if delta == [0.0; 3] {
            delta[(seed % 3) as usize] = size;
        }
        let start = [0.0; 3].map(|_: f64| random.random_range(-300.0..300.0));
        (seed, plan(start, [0, 1, 2].map(|axis| start[axis] + delta[axis])))
    })
}

/// Eq. 8 to 13 as errata.md corrects them: a' and v' compress one period's increment, the state advances by itself.
///
/// The jerk changes within periods, where a phase ends; each period is cut there.
fn recurrence(law: &SCurveLaw, phases: &[f64; 7], period_s: f64) -> Vec<f64> {
    let jerks = [law.jerk, 0.0, -law.jerk, 0.0, -law.jerk, 0.0, law.jerk];
    let total_s: f64 = phases.iter().sum();
    let (mut velocity, mut acceleration, mut position, mut now_s) = (0.0, 0.0, 0.0, 0.0);
    let (mut phase, mut left_s) = (0, phases[0]);
    let mut positions = Vec::new();
    while now_s < total_s && phase < 7 {
        let mut period_left_s = period_s;
        while period_left_s > 0.0 && phase < 7 {
            let (t, jerk) = (period_left_s.min(left_s), jerks[phase]);
            let compressed_acceleration = acceleration + jerk * t / 3.0;
            let compressed_velocity = velocity + compressed_acceleration * t / 2.0;
            position += compressed_velocity * t;
            velocity += acceleration * t + jerk * t * t / 2.0;
            acceleration += jerk * t;
            period_left_s -= t;
            left_s -= t;
            if left_s <= 0.0 {
                phase += 1;
                left_s = phases.get(phase).copied().unwrap_or(0.0);
            }
        }
        now_s += period_s;
        positions.push(position);
    }
    positions
}

/// Eq. 14 to 17: the phases' durations for a peak that is reached or not, from distance and limits alone.
fn phases(law: &SCurveLaw, distance: f64, command: f64) -> [f64; 7] {
    let SCurveLaw { acceleration: a, jerk: j } = *law;
    let ramp = |v: f64| if v * j > a * a { (a / j, v / a - a / j) } else { ((v / j).sqrt(), 0.0) };
    let ramps_distance = |v: f64| v * (2.0 * ramp(v).0 + ramp(v).1);
    let (mut low, mut high) = (0.0, command);
    if ramps_distance(command) > distance {
        for _ in 0..200 {
            let middle = f64::midpoint(low, high);
            if ramps_distance(middle) > distance { high = middle } else { low = middle }
        }
    } else {
        low = command;
    }
    let (jerk_s, constant_s) = ramp(low);
    let cruise_s = (distance - ramps_distance(low)).max(0.0) / low;
    [jerk_s, constant_s, jerk_s, cruise_s, jerk_s, constant_s, jerk_s]
}

#[test]
fn the_recurrence_agrees_with_the_closed_form_along_a_line() {
    const PERIOD_S: f64 = 0.001;
    for (seed, line) in moves() {
        let durations = phases(&line.law, line.path.length_mm(), line.path.path_limit(LIMIT_MM_PER_S));
        let positions = recurrence(&line.law, &durations, PERIOD_S);
        let total_s: f64 = durations.iter().sum();
        assert!((total_s - line.profile.duration_s()).abs() < 1e-9, "seed {seed}: {total_s} s");
        for (period, position) in positions.iter().enumerate() {
            let now_s = PERIOD_S * (period + 1) as f64;
            let closed = line.path.follow(&line.profile.at(now_s));
            let stepped = line.path.follow(&State { position: *position, ..State::default() });
            for axis in 0..3 {
                let apart_mm = closed[axis].position - stepped[axis].position;
                assert!(apart_mm.abs() < 1e-9, "seed {seed}: axis {axis} {apart_mm} mm apart at {now_s} s");
            }
        }
    }
}

/// Errata: with a' and v' fed back as the state, as the paper prints, the recurrence drifts far beyond rounding.
#[test]
fn the_recurrence_as_printed_would_drift() {
    let (law, t) = (SCurveLaw { acceleration: 10_000.0, jerk: 500_000.0 }, 0.001);
    let (mut velocity, mut acceleration, mut position) = (0.0, 0.0, 0.0);
    for _ in 0..20 {
        acceleration += law.jerk * t / 3.0;
        velocity += acceleration * t / 2.0;
        position += velocity * t;
    }
    let exact = law.jerk * 0.02f64.powi(3) / 6.0;
    assert!((position - exact).abs() > 0.1, "{position} mm against {exact} mm");
}

#[test]
fn every_axis_keeps_its_limits_and_one_reaches_them() {
    for (seed, line) in moves() {
        let mut most = [[0.0_f64; 3]; 3];
        let samples = 400;
        for sample in 0..samples {
            let path = line.profile.at(line.profile.duration_s() * f64::from(sample) / f64::from(samples));
            for (axis, state) in line.path.follow(&path).into_iter().enumerate() {
                for (order, value) in [state.velocity, state.acceleration, state.jerk].into_iter().enumerate() {
                    most[order][axis] = most[order][axis].max(value.abs());
                }
            }
        }
        let limits = [LIMIT_MM_PER_S, LIMIT_MM_PER_S2, LIMIT_MM_PER_S3];
        for order in 0..3 {
            for axis in 0..3 {
                let (found, limit) = (most[order][axis], limits[order][axis]);
                assert!(found <= limit * (1.0 + 1e-9), "seed {seed}: axis {axis}, order {}: {found}", order + 1);
            }
        }
        // The jerk limit is always reached, by the axis that it binds first.
        let used = (0..3).map(|axis| most[2][axis] / limits[2][axis]).fold(0.0, f64::max);
        assert!((used - 1.0).abs() < 1e-9, "seed {seed}: jerk limit used to {used}");
    }
}

#[test]
fn every_axis_ends_on_its_programmed_end_to_the_last_bit() {
    for (seed, line) in moves() {
        let at = |t_s: f64| line.path.follow(&line.profile.at(t_s)).map(|axis| axis.position);
        assert_eq!(at(0.0), line.start, "seed {seed}");
        for after_s in [0.0, 1e-12, 1.0, 1e9] {
            assert_eq!(at(line.profile.duration_s() + after_s), line.end, "seed {seed}");
        }
        for axis in line.path.follow(&line.profile.at(1e9)) {
            assert_eq!((axis.velocity, axis.acceleration), (0.0, 0.0), "seed {seed}");
        }
    }
}

/// No axis passes its end or turns back on the way: the last period lands on the end, not beyond it.
#[test]
fn no_axis_overshoots() {
    for (seed, line) in moves() {
        let mut last = line.start;
        for sample in 0..=1000 {
            let path = line.profile.at(line.profile.duration_s() * f64::from(sample) / 1000.0);
            let now = line.path.follow(&path).map(|axis| axis.position);
            for axis in 0..3 {
                let way = (line.end[axis] - line.start[axis]).signum();
                let rounding_mm = 1e-12;
                assert!(way * (now[axis] - last[axis]) >= -rounding_mm, "seed {seed}: axis {axis} turns back");
                assert!(way * (line.end[axis] - now[axis]) >= -rounding_mm, "seed {seed}: axis {axis} passes its end");
            }
            last = now;
        }
    }
}
