//! What a machine shows of itself, against what its plant was made with.

use rigidtap::control::model::cutting::Material;
use rigidtap::sim::Actual;

use super::bench::Bench;

#[test]
fn inertia_friction_and_lost_motion_are_found() {
    let bench = Bench::of(Material::AlSi, 7000.0).dry();
    let nominal_lost_mm = bench.tap(1).1.z.lost_motion_mm;
    for (inertia, friction, backlash_um) in [(0.8, 0.5, 0.0), (1.0, 1.0, 2.0), (1.1, 1.5, 5.0), (1.2, 2.0, 3.0)] {
        let mut other = bench.clone();
        other.actual = Actual { inertia, friction, backlash_um: Some(backlash_um), ..Actual::default() };
        let known = other.tap(1).1;
        assert!((known.spindle.inertia_ratio / inertia - 1.0).abs() < 0.03, "inertia {inertia}: {known:?}");
        let friction_n = friction * bench.machine.spec().z_axis.coulomb_n;
        assert!((known.z.friction_n / friction_n - 1.0).abs() < 0.08, "friction {friction_n}: {known:?}");
        // Backlash, and the twist of the screw under the table's half of the friction.
        let twist_um = 1000.0 * nominal_lost_mm - 2.0;
        let lost_um = backlash_um + friction * twist_um;
        assert!((1000.0 * known.z.lost_motion_mm - lost_um).abs() < 0.6, "lost motion {lost_um}: {known:?}");
    }
}

#[test]
fn nothing_is_taken_over_where_that_is_not_wanted() {
    let mut bench = Bench::of(Material::AlSi, 7000.0);
    bench.actual.friction = 2.0;
    let by_approach_um = bench.first_um();
    let not_at_all_um = bench.with_sync(|sync| sync.identify = false).first_um();
    assert!(by_approach_um < 0.7 * not_at_all_um, "{by_approach_um} {not_at_all_um}");
}
