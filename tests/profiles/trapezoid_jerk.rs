//! The trapezoid-jerk law: its eight cases by name, and its strokes in whole periods.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rigidtap::control::profile::{Profile, StrokeRequest, TrapezoidJerkLaw};

use crate::cases::{Case, Law};
use crate::oracle;

const SEEDS: u64 = 20_000;
const FIRST_SEED: u64 = 2_000_000_000;

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "found {found}, expected {expected}");
}

fn law(snap: f64) -> TrapezoidJerkLaw {
    TrapezoidJerkLaw { acceleration: 10.0, jerk: 100.0, snap, quantised_s: None }
}

/// Greatest magnitudes of speed, acceleration, jerk and snap, by sampling.
fn greatest(profile: &Profile) -> [f64; 4] {
    let mut greatest = [0.0_f64; 4];
    for segment in profile.segments() {
        for share in 0..=16 {
            let state = segment.start.after(segment.duration_s * f64::from(share) / 16.0, segment.snap);
            for (most, value) in greatest.iter_mut().zip([state.velocity, state.acceleration, state.jerk, segment.snap])
            {
                *most = most.max(value.abs());
            }
        }
    }
    greatest
}

/// A stroke with the limits it reaches, and time and segments worked out by hand.
struct Expected {
    snap: f64,
    distance: f64,
    command: f64,
    reached: [bool; 3],
    duration_s: f64,
    segments: usize,
}

fn check(expected: &Expected) {
    let Expected { snap, distance, command, reached, duration_s, segments } = *expected;
    let law = law(snap);
    let profile = law.plan(StrokeRequest { distance, command }).unwrap();
    near(profile.duration_s(), duration_s);
    assert_eq!(profile.segments().len(), segments, "{profile:#?}");
    let found = greatest(&profile);
    for ((found, limit), reached) in found.into_iter().zip([command, law.acceleration, law.jerk]).zip(reached) {
        assert!(found <= limit * (1.0 + 1e-12), "{found} above {limit}");
        assert_eq!(found >= limit * (1.0 - 1e-12), reached, "{found} of {limit}");
    }
    near(found[3], snap);
}

// t_j = 0.05 s for l = 2000: jerk is full after it, acceleration after 0.15 s, having made 2.5 rev/s (and 0.75 rev
// without cruise). For l = 250, √(a/l) = 0.2 s replaces it; acceleration is full after 0.4 s, having made 4 rev/s.

#[test]
fn speed_acceleration_and_jerk_reached() {
    // S/V + V/a + a/j + j/l
    check(&Expected {
        snap: 2000.0,
        distance: 10.0,
        command: 5.0,
        reached: [true, true, true],
        duration_s: 2.0 + 0.5 + 0.1 + 0.05,
        segments: 15,
    });
}

#[test]
fn acceleration_and_jerk_reached() {
    // v²/a + v·0.15 = 1 at v = 2.5
    let distance = 4.0 * 4.0 / 10.0 + 4.0 * 0.15;
    let duration_s = 2.0 * (0.4 + 0.15);
    let reached = [false, true, true];
    check(&Expected { snap: 2000.0, distance, command: 9.0, reached, duration_s, segments: 14 });
}

#[test]
fn speed_and_jerk_reached() {
    // v = j·u·(u + t_j) at u = 0.08: 1.04; a change takes 2·(u + t_j).
    let speed = 100.0 * 0.08 * 0.13;
    check(&Expected {
        snap: 2000.0,
        distance: speed * 1.26,
        command: speed,
        reached: [true, false, true],
        duration_s: 0.26 + 1.26,
        segments: 13,
    });
}

#[test]
fn jerk_reached() {
    // S = 2·j·u·(u + t_j)²
    let distance = 200.0 * 0.08 * 0.13 * 0.13;
    let reached = [false, false, true];
    check(&Expected { snap: 2000.0, distance, command: 9.0, reached, duration_s: 0.52, segments: 12 });
}

#[test]
fn speed_and_acceleration_reached() {
    // S/V + V/a + 2·√(a/l)
    check(&Expected {
        snap: 250.0,
        distance: 10.0,
        command: 5.0,
        reached: [true, true, false],
        duration_s: 2.0 + 0.5 + 0.4,
        segments: 11,
    });
}

#[test]
fn acceleration_reached() {
    // v²/a + 2·v·√(a/l) = S at v = 6
    let reached = [false, true, false];
    check(&Expected { snap: 250.0, distance: 6.0, command: 9.0, reached, duration_s: 2.0, segments: 10 });
}

#[test]
fn speed_reached() {
    // v = 2·l·t³ at t = 0.1
    check(&Expected {
        snap: 250.0,
        distance: 1.0,
        command: 0.5,
        reached: [true, false, false],
        duration_s: 2.0 + 0.4,
        segments: 9,
    });
}

#[test]
fn no_limit_reached() {
    // S = 8·l·t⁴ at t = 0.1
    let reached = [false; 3];
    check(&Expected { snap: 250.0, distance: 0.2, command: 9.0, reached, duration_s: 0.8, segments: 8 });
}

fn trapezoid_cases() -> impl Iterator<Item = (u64, Case, TrapezoidJerkLaw)> {
    (FIRST_SEED..).map(|seed| (seed, Case::of_seed(seed))).filter_map(|(seed, case)| match case.law {
        Law::TrapezoidJerk(law) => Some((seed, case, law)),
        _ => None,
    })
}

/// What the general checker does not know of: the snap's limit, and that jerk has no steps.
#[test]
fn jerk_is_continuous_and_snap_limited() {
    for (seed, case, law) in trapezoid_cases().take(SEEDS as usize) {
        let profile = case.plan().unwrap();
        let mut jerk = 0.0;
        for segment in profile.segments() {
            assert!(segment.snap.abs() <= law.snap * (1.0 + 1e-9), "seed {seed}: {}\n{case:#?}", segment.snap);
            let step = segment.start.jerk - jerk;
            assert!(step.abs() <= 1e-9 * law.jerk, "seed {seed}: {step}\n{case:#?}");
            jerk = segment.end().jerk;
        }
        assert!(jerk.abs() <= 1e-9 * law.jerk, "seed {seed}: {jerk}\n{case:#?}");
    }
}

#[test]
fn quantised_phases_are_whole_periods_and_cost_a_few() {
    let mut most = 0.0_f64;
    let quantised = trapezoid_cases().filter_map(|(seed, case, law)| Some((seed, case, law, law.quantised_s?)));
    for (seed, case, law, period_s) in quantised.take(SEEDS as usize / 2) {
        let profile = case.plan().unwrap();
        for segment in profile.segments() {
            let periods = segment.duration_s / period_s;
            let off = (periods - periods.round()).abs();
            assert!(off <= 1e-12 * periods.max(1.0), "seed {seed}: {periods} periods\n{case:#?}");
        }
        let free = TrapezoidJerkLaw { quantised_s: None, ..law }.plan(case.stroke).unwrap();
        let longer = (profile.duration_s() - free.duration_s()) / period_s;
        assert!(longer >= -1e-6 * free.duration_s() / period_s - 1e-6, "seed {seed}: {longer} periods\n{case:#?}");
        most = most.max(longer);
    }
    assert!(most < 8.0, "up to {most} periods longer than the fastest stroke");
}

/// Rounding the fastest stroke's phases is not the best that whole periods can do, but nearly: all of them tried.
#[test]
fn quantised_strokes_are_near_the_best_of_whole_periods() {
    let mut random = Pcg64Mcg::seed_from_u64(7);
    let mut worst = 0.0_f64;
    for _ in 0..300 {
        let period_s = 0.004;
        let law = TrapezoidJerkLaw {
            acceleration: random.random_range(5.0..50.0),
            jerk: random.random_range(200.0..2000.0),
            snap: random.random_range(2e4..4e5),
            quantised_s: Some(period_s),
        };
        let stroke = StrokeRequest { distance: random.random_range(0.01..1.0), command: random.random_range(0.5..5.0) };
        let found = (law.plan(stroke).unwrap().duration_s() / period_s).round();
        let mut best = f64::INFINITY;
        for p in 1..40 {
            for q in p..80 {
                for r in p + q..250 {
                    let (p, q, r) = (f64::from(p), f64::from(q), f64::from(r));
                    let speed = stroke.distance / period_s;
                    let w = (speed / stroke.command)
                        .max(speed / (r * period_s) / law.acceleration)
                        .max(speed / (r * q * period_s * period_s) / law.jerk)
                        .max(speed / (r * q * p * period_s.powi(3)) / law.snap);
                    best = best.min(p + q + r + w.ceil().max(p + q + r));
                }
            }
        }
        assert!(found >= best, "{found} of {best} periods: {law:?} {stroke:?}");
        worst = worst.max(found - best);
    }
    assert!(worst <= 2.0, "{worst} periods longer than the best");
}

/// The law's ramps against the ones the oracle integrates.
#[test]
fn the_oracles_ramp_is_symmetrical() {
    let law = law(2000.0);
    for speed in [0.1, 1.04, 4.0, 20.0] {
        let ramp = oracle::JerkRamp::to(&law, speed);
        near(ramp.gain, speed);
        near(ramp.distance, speed / 2.0 * ramp.duration_s);
    }
}
