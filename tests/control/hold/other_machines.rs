//! Machines that are not as their file says, drawn as a sweep draws them.

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use rigidtap::control::model::cutting::Material;
use rigidtap::run::Verdict;
use rigidtap::sim::{Actual, Spread};

use super::bench::{Bench, percentile};

const MACHINES: u64 = 60;

/// The nth of many machines of one kind.
fn drawn(bench: &Bench, spread: &Spread, machine: u64) -> Bench {
    let actual = spread.draw(&mut Pcg64Mcg::seed_from_u64(machine));
    Bench { actual, seed: machine, ..bench.clone() }
}

#[test]
fn identified_by_a_dry_cycle_by_the_approach_or_not_at_all() {
    let bench = Bench::of(Material::AlSi, 7000.0);
    let strangers = bench.clone().with_sync(|sync| sync.identify = false);
    for (name, bench, p99_um) in
        [("dry cycle", bench.clone().dry(), 9.0), ("approach", bench, 9.0), ("not at all", strangers, 35.0)]
    {
        let holes = (1..=MACHINES).map(|machine| drawn(&bench, &Spread::default(), machine).tap(1).0.remove(0));
        let (mut worst_um, mut too_deep_um) = (Vec::new(), Vec::new());
        for hole in holes {
            worst_um.push(hole.worst_um());
            too_deep_um.push(hole.bottom_overshoot_um);
        }
        assert!(percentile(&mut worst_um, 0.99) < p99_um, "{name}: {worst_um:?}");
        assert!(percentile(&mut too_deep_um, 1.0) < 5.0, "{name}: {too_deep_um:?}");
    }
}

#[test]
fn tenth_hole_of_learning() {
    let bench = Bench::of(Material::AlSi, 7000.0).dry().with_sync(|sync| sync.learn = true);
    let mut tenth_um: Vec<_> =
        (1..=MACHINES / 4).map(|machine| drawn(&bench, &Spread::default(), machine).tap(10).0[9].worst_um()).collect();
    assert!(percentile(&mut tenth_um, 1.0) < 6.0, "{tenth_um:?}");
}

/// Braking takes as much force as such a table's friction: it floats in its play, and a crossing from elsewhere than where the
/// motor stands throws it too deep.
#[test]
fn tables_that_float_in_their_play() {
    let bench = Bench::of(Material::AlSi, 7000.0);
    let spread = Spread { friction: [0.6, 0.9].into(), backlash_um: Some([4.0, 5.0].into()), ..Spread::default() };
    let mut too_deep_um: Vec<_> =
        (1..=MACHINES).map(|machine| drawn(&bench, &spread, machine).tap(1).0[0].bottom_overshoot_um).collect();
    for (share, limit_um) in [(0.5, 0.45), (0.9, 1.65)] {
        assert!(percentile(&mut too_deep_um, share) < limit_um, "{share}: {too_deep_um:?}");
    }
}

/// A motor that is too weak for its plan takes the path in more time, and the thread is held.
#[test]
fn a_weak_motor_slows_the_path() {
    let mut bench = Bench::of(Material::AlSi, 7000.0);
    let planned_s = bench.tap(1).0[0].strokes[0].duration_s;
    bench.actual = Actual { inertia: 1.2, torque_limit: 0.85, torque_constant: 0.85, ..Actual::default() };
    let (holes, known) = bench.tap(3);
    assert!(holes[0].saturated, "the first hole does not know yet");
    for hole in &holes {
        let slower = hole.strokes[0].duration_s / planned_s;
        assert!((1.02..1.5).contains(&slower), "{slower}");
        assert!(hole.worst_um() < 12.0 && hole.verdict() == Verdict::Ok, "{}", hole.worst_um());
        assert!(hole.bottom_overshoot_um < 5.0, "{}", hole.bottom_overshoot_um);
    }
    assert!((known.spindle.inertia_ratio - 1.2 / 0.85).abs() < 0.03, "{known:?}");
}
