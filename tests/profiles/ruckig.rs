//! rsruckig as oracle of the S-curve: another's planner, another's mathematics, the same time-optimal strokes.
//!
//! `RIGIDTAP_RUCKIG=1000000 cargo test --test profiles ruckig` tries as many problems.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rigidtap::control::profile::{SCurveLaw, StrokeRequest};
use rsruckig::prelude::{InputParameter, Ruckig, ThrowErrorHandler, Trajectory};

const PROBLEMS: u32 = 100_000;
/// Of the duration, or of a second where that is longer.
const TOLERANCE: f64 = 1e-9;

#[test]
fn the_same_durations_as_rsruckig() {
    let problems = std::env::var("RIGIDTAP_RUCKIG").map_or(PROBLEMS, |count| count.parse().expect("a number"));
    let mut random = Pcg64Mcg::seed_from_u64(3);
    let mut other = Ruckig::<1, ThrowErrorHandler>::new(None, 0.001);
    let mut trajectory = Trajectory::new(None);
    let mut input = InputParameter::<1>::new(None);
    let mut any = |low: f64, high: f64| (low.ln() + random.random_range(0.0..1.0) * (high / low).ln()).exp();
    let (mut worst, mut refused) = (0.0_f64, 0);
    for problem in 0..problems {
        let law = SCurveLaw { acceleration: any(1.0, 1e4), jerk: any(10.0, 1e6) };
        let stroke = StrokeRequest { distance: any(0.01, 1e3), command: any(0.1, 1e3) };
        let ours = law.plan(stroke).unwrap().duration_s();
        input.target_position[0] = stroke.distance;
        input.max_velocity[0] = stroke.command;
        input.max_acceleration[0] = law.acceleration;
        input.max_jerk[0] = law.jerk;
        if let Err(error) = other.calculate(&input, &mut trajectory) {
            refused += 1;
            assert!(refused < problems / 1000, "{error:?} on {law:?} {stroke:?}");
            continue;
        }
        let off = (ours - trajectory.get_duration()).abs() / ours.max(1.0);
        assert!(off <= TOLERANCE, "problem {problem}: {off} on {law:?} {stroke:?}");
        worst = worst.max(off);
    }
    assert_eq!(refused, 0, "durations within {worst:e}");
}
