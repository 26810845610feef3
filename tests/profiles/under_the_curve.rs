//! The special cases of the laws that follow the motor's torque curve, by name, and the reversal at the bottom.

use rigidtap::control::cycle::{CyclePlan, StrokeKind, TapCycle};
use rigidtap::control::machine::{Law, Machine};
use rigidtap::control::math::poly::State;
use rigidtap::control::motor::{Friction, MAX_POINTS, Motor, TorqueCurve, TorquePoint};
use rigidtap::control::profile::verify::{Limits, Task, verify};
use rigidtap::control::profile::{
    Profile, ProfileError, SCurveLaw, StrokeRequest, TorqueCurveSmoothLaw, TorqueLimitLaw, Turns,
};

const JERK_REV_PER_S3: f64 = 6.4e6 / 60.0;

fn stroke(distance: f64, command_rpm: f64) -> StrokeRequest {
    StrokeRequest { distance, command: command_rpm / 60.0 }
}

fn smooth(share: f64) -> TorqueCurveSmoothLaw {
    TorqueCurveSmoothLaw::new(Machine::reference().motor(), share, JERK_REV_PER_S3)
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "found {found}, expected {expected}");
}

/// Stroke time over the bound at the same share, and over the bound at 100 %, at 25 rev from rest to rest.
#[test]
fn prices_on_the_reference_machine() {
    let expected = [
        (Law::TorqueLimit, 0.75, [(1.000, 1.037), (1.001, 1.089), (1.001, 1.131)]),
        (Law::TorqueLimit, 0.80, [(1.000, 1.028), (1.001, 1.067), (1.001, 1.100)]),
        (Law::TorqueCurveSmooth, 0.75, [(1.010, 1.047), (1.013, 1.103), (1.014, 1.146)]),
        (Law::TorqueCurveSmooth, 0.80, [(1.010, 1.039), (1.014, 1.081), (1.015, 1.116)]),
    ];
    let mut wrong = String::new();
    for (law, share, prices) in expected {
        let machine = Machine::reference().with_motor_share(share).unwrap();
        for (speed_rpm, (same, full)) in [3000.0, 5000.0, 7000.0].into_iter().zip(prices) {
            let request = stroke(25.0, speed_rpm);
            let duration_s = machine.stroke(law, request).unwrap().duration_s();
            let bound = |share| machine.motor().fastest_stroke(25.0, request.command, share).duration_s;
            let found = (duration_s / bound(share), duration_s / bound(1.0));
            if (found.0 - same).abs() >= 6e-4 || (found.1 - full).abs() >= 6e-4 {
                wrong += &format!(
                    "{law:?} at {share}, S{speed_rpm}: {found:.4?}
"
                );
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

/// Up to the knee there is nothing to follow: the law is the S-curve of its acceleration at rest.
#[test]
fn below_the_knee_it_is_the_s_curve() {
    let law = smooth(0.8);
    let s_curve = SCurveLaw { acceleration: law.acceleration_at_rest(), jerk: JERK_REV_PER_S3 };
    for command_rpm in [1.0, 50.0, 113.0, 228.0, 1000.0, 2999.0, 3000.0] {
        for distance in [1e-3, 1e-2, 0.03, 0.1, 1.0, 3.0, 25.0] {
            let (ours, theirs) = (
                law.plan(stroke(distance, command_rpm), Turns::default()),
                s_curve.plan(stroke(distance, command_rpm)),
            );
            near(ours.unwrap().duration_s(), theirs.unwrap().duration_s());
        }
    }
}

#[test]
fn an_extremely_short_stroke_is_four_jerk_ramps() {
    let profile = smooth(0.8).plan(stroke(1e-3, 8000.0), Turns::default()).unwrap();
    // Four ramps of T/4: S = 2·j·(T/4)³.
    near(profile.duration_s(), 4.0 * (1e-3 / (2.0 * JERK_REV_PER_S3)).cbrt());
    assert_eq!(profile.segments().len(), 4);
}

/// Turning at its end, the shortest stroke brakes in one ramp: as much acceleration as its jerk can build.
#[test]
fn an_extremely_short_stroke_still_turns() {
    let law = smooth(0.8);
    let request = stroke(1e-3, 8000.0);
    let turn = law.turn_acceleration(request).unwrap();
    assert!(turn > 0.0 && turn < law.acceleration_at_rest());
    let profile = law.plan(request, Turns { start: 0.0, end: turn }).unwrap();
    assert_eq!(profile.segments().len(), 3);
    // The braking ramp takes the peak in turn/j, and starts from no acceleration.
    near(profile.peak_velocity(), turn * turn / (2.0 * JERK_REV_PER_S3));
    assert!(profile.duration_s() < law.plan(request, Turns::default()).unwrap().duration_s());
}

/// A motor that loses torque faster than the jerk can follow, falls twice and recovers.
fn rugged() -> Motor {
    let point = |speed_rpm, torque_nm| TorquePoint { speed_rpm, torque_nm };
    let points = [
        point(0.0, 20.0),
        point(1000.0, 20.0),
        point(1005.0, 9.0),
        point(2000.0, 14.0),
        point(2100.0, 5.0),
        point(4000.0, 5.0),
        point(8000.0, 2.0),
    ];
    Motor { curve: TorqueCurve::new(&points).unwrap(), inertia_kg_m2: 0.004 }
}

#[test]
fn every_peak_and_command_on_smooth_and_rugged_curves() {
    for motor in [Machine::reference().motor().clone(), rugged()] {
        for jerk in [1e3, 1e4, JERK_REV_PER_S3, 1e7] {
            let law = TorqueCurveSmoothLaw::new(&motor, 0.8, jerk);
            for command_rpm in [10.0, 900.0, 1000.0, 1003.0, 1500.0, 2000.0, 2050.0, 3000.0, 5000.0, 8000.0, 9000.0] {
                for step in 0..60 {
                    let request = stroke(1e-3 * 10f64.powf(f64::from(step) / 10.0), command_rpm);
                    let turn = law.turn_acceleration(request).unwrap();
                    for turns in [Turns::default(), Turns { start: 0.0, end: turn }, Turns { start: turn, end: turn }] {
                        let profile = law.plan(request, turns).unwrap();
                        let limits = Limits {
                            velocity: command_rpm / 60.0,
                            acceleration: &|state: &State| motor.acceleration_rev_per_s2(state.velocity, 0.8),
                            jerk,
                            continuous_acceleration: true,
                        };
                        let task = Task {
                            distance: request.distance,
                            start_acceleration: turns.start,
                            end_acceleration: -turns.end,
                            ..Task::default()
                        };
                        let verified = verify(&profile, &task, &limits);
                        assert!(verified.is_ok(), "{jerk} {request:?} {turns:?}: {verified:?}");
                    }
                }
            }
        }
    }
}

/// The longest curve that there is, each piece bent, with friction that bends the first one, too.
#[test]
fn the_longest_curve_fits_a_profile() {
    let point = |index: usize| {
        let speed_rpm = 500.0 * index as f64;
        TorquePoint { speed_rpm, torque_nm: if index < 2 { 20.0 } else { 20.0 - index as f64 } }
    };
    let points: Vec<_> = (0..MAX_POINTS).map(point).collect();
    let top_rpm = points[MAX_POINTS - 1].speed_rpm;
    let motor = Motor { curve: TorqueCurve::new(&points).unwrap(), inertia_kg_m2: 0.004 };
    let friction = Friction { coulomb_nm: 0.5, viscous_nm_per_rpm: 0.5 / top_rpm };
    let limit = TorqueLimitLaw::new(&motor, friction, 1.0);
    let smooth = TorqueCurveSmoothLaw::new(&motor, 1.0, JERK_REV_PER_S3);
    near(limit.top_rev_per_s(), top_rpm / 60.0);
    near(smooth.top_rev_per_s(), top_rpm / 60.0);
    for profile in [limit.plan(stroke(100.0, top_rpm)), smooth.plan(stroke(100.0, top_rpm), Turns::default())] {
        let profile = profile.unwrap();
        near(profile.peak_velocity(), top_rpm / 60.0);
        assert!(profile.segments().len() > 56, "{}", profile.segments().len());
    }
}

fn plan(hole: TapCycle, law: Law) -> CyclePlan {
    CyclePlan::new(hole, &Machine::reference(), law).unwrap()
}

fn profile_of(plan: &CyclePlan, kind: StrokeKind) -> Profile {
    plan.strokes().find(|stroke| stroke.kind == kind).unwrap().profile
}

/// One smooth motion through the bottom: whatever the speeds and however short the strokes.
#[test]
fn acceleration_is_continuous_and_not_zero_through_the_bottom() {
    for (depth_mm, speed_rpm, out_speed_rpm) in [
        (25.0, 7000.0, 7000.0),
        (25.0, 5000.0, 8000.0),
        (25.0, 3000.0, 50.0),
        (25.0, 60.0, 7000.0),
        (0.01, 7000.0, 7000.0),
        (0.001, 10.0, 3000.0),
    ] {
        let hole = TapCycle { out_speed_rpm, ..TapCycle::right_hand(0.0, -depth_mm, 1.0, speed_rpm) };
        let plan = plan(hole, Law::TorqueCurveSmooth);
        let (into, out) = (profile_of(&plan, StrokeKind::In), profile_of(&plan, StrokeKind::Out));
        let bottom_s = into.duration_s();
        let [before, at, after] = [-1e-9, 0.0, 1e-9].map(|offset_s| plan.at(bottom_s + offset_s).spindle);
        assert!(at.acceleration < 0.0, "{hole:?}: {at:?}");
        for beside in [before, after] {
            assert!((beside.acceleration - at.acceleration).abs() < 1e-3, "{hole:?}: {beside:?} beside {at:?}");
            assert!(beside.velocity.abs() < 1e-5 && (beside.position - depth_mm).abs() < 1e-9);
        }
        assert_eq!(into.end().acceleration, -out.segments()[0].start.acceleration);
        assert_eq!((into.segments()[0].start.acceleration, out.end().acceleration), (0.0, 0.0));
    }
    let full = smooth(0.8).acceleration_at_rest();
    let deep = plan(TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0), Law::TorqueCurveSmooth);
    assert_eq!(profile_of(&deep, StrokeKind::In).end().acceleration, -full);
}

#[test]
fn a_dwell_or_another_law_comes_to_rest_at_the_bottom() {
    let hole = TapCycle::right_hand(0.0, -25.0, 1.0, 7000.0);
    for law in Law::ALL {
        let dwelling = plan(TapCycle { dwell_s: 0.1, ..hole }, law);
        let end = profile_of(&dwelling, StrokeKind::In).end();
        assert_eq!((end.velocity, end.acceleration), (0.0, 0.0), "{law:?}");
        if law != Law::TorqueCurveSmooth {
            let machine = Machine::reference();
            assert_eq!(
                profile_of(&plan(hole, law), StrokeKind::Out),
                machine.stroke(law, stroke(25.0, 7000.0)).unwrap()
            );
        }
    }
}

#[test]
fn friction_brakes_harder_than_it_lets_accelerate() {
    let motor = Machine::reference().motor().clone();
    let friction = Friction { coulomb_nm: 2.0, viscous_nm_per_rpm: 2.0 / 8000.0 };
    let profile = TorqueLimitLaw::new(&motor, friction, 0.8).plan(stroke(25.0, 1000.0)).unwrap();
    let segments = profile.segments();
    let (first, last) = (segments[0].start.acceleration, segments[segments.len() - 1].end().acceleration);
    near(motor.torque_for_nm(first), 14.0);
    near(motor.torque_for_nm(last), -18.0);
}

#[test]
fn what_cannot_be_planned_is_an_error() {
    let motor = Machine::reference().motor().clone();
    let stuck = Friction { coulomb_nm: 16.0, ..Friction::default() };
    let error = TorqueLimitLaw::new(&motor, stuck, 0.8).plan(stroke(1.0, 100.0));
    assert!(matches!(error, Err(ProfileError::Invalid { .. })), "{error:?}");
    let law = smooth(0.8);
    let full = law.acceleration_at_rest();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for request in [StrokeRequest { distance: bad, command: 1.0 }, StrokeRequest { distance: 1.0, command: bad }] {
            assert!(matches!(law.plan(request, Turns::default()), Err(ProfileError::Invalid { .. })));
            assert!(matches!(law.turn_acceleration(request), Err(ProfileError::Invalid { .. })));
        }
    }
    for bad in [-1.0, full * 1.001, f64::NAN] {
        let error = law.plan(stroke(25.0, 3000.0), Turns { start: bad, end: 0.0 });
        assert!(matches!(error, Err(ProfileError::Invalid { .. })), "{error:?}");
    }
    let short = law.plan(stroke(1e-3, 3000.0), Turns { start: 0.0, end: full });
    assert!(matches!(short, Err(ProfileError::TooShort { .. })), "{short:?}");
    let slow = law.plan(stroke(1.0, 10.0), Turns { start: 0.0, end: full });
    assert!(matches!(slow, Err(ProfileError::EndsAboveCommand { .. })), "{slow:?}");
}
