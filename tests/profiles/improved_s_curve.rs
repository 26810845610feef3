//! The improved S-curve: its closed form against its acceleration, integrated.

use rigidtap::control::profile::{ImprovedSCurveLaw, Profile, StrokeRequest, TenPhases};

use crate::oracle;

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "found {found}, expected {expected}");
}

/// Speed and position at every sample, from the acceleration alone, by the trapezoidal rule on a fine grid.
fn holds_when_integrated(profile: &Profile) {
    const STEPS: u32 = 200_000;
    let step_s = profile.duration_s() / f64::from(STEPS);
    let mut state = profile.at(0.0);
    for step in 1..=STEPS {
        let next = profile.at(f64::from(step) * step_s);
        let velocity = state.velocity + (state.acceleration + next.acceleration) / 2.0 * step_s;
        state.position += (state.velocity + velocity) / 2.0 * step_s;
        state.velocity = velocity;
        state.acceleration = next.acceleration;
        assert!((state.velocity - next.velocity).abs() < 1e-8, "{} s", f64::from(step) * step_s);
        assert!((state.position - next.position).abs() < 1e-8, "{} s", f64::from(step) * step_s);
    }
}

/// Eq. 11 to 21 of a run with v_s ≠ v_e and one J, each quantity by its own equation.
#[test]
fn ten_phases() {
    let run = TenPhases { start: 2.0, peak: 13.0, end: 5.0, acceleration: 18.0, duration_s: 4.0 };
    let profile = run.plan().unwrap();
    let [vs, vmax, ve, amax, tf] = [run.start, run.peak, run.end, run.acceleration, run.duration_s];
    let (j, amin) = (run.jerk(), run.deceleration());
    let (t2, t6) = (9.0 * (vmax - vs) / (22.0 * amax), -9.0 * (vmax - ve) / (22.0 * amin));
    near(j, 44.0 * amax * amax / (27.0 * (vmax - vs)));
    near(j, 44.0 * amin * amin / (27.0 * (vmax - ve)));
    near(amin, -t6 / t2 * amax);
    near(vmax, vs + 11.0 / 3.0 * j * t2 * t2);
    near(ve, vs + 11.0 / 3.0 * j * (t2 * t2 - t6 * t6));
    near(amax, 1.5 * j * t2);
    let t1 = tf / 2.0 - 2.0 * (amax - amin) * t2 / amax;
    let durations: Vec<_> = profile.segments().iter().map(|segment| segment.duration_s).collect();
    for (found, expected) in durations.iter().zip([t1, t2, t2, t2, t2, t6, t6, t6, t6, t1]) {
        near(*found, expected);
    }
    assert_eq!(durations.len(), 10);
    // Eq. 12 at the phases' ends, over J.
    let (a, b) = (t2 * t2 * j, t6 * t6 * j);
    let speeds = [
        vs,
        vs,
        vs + a / 2.0,
        vs + 11.0 / 6.0 * a,
        vs + 19.0 / 6.0 * a,
        vs + 11.0 / 3.0 * a,
        vs + 11.0 / 3.0 * a - b / 2.0,
        vs + 11.0 / 3.0 * a - 11.0 / 6.0 * b,
        vs + 11.0 / 3.0 * a - 19.0 / 6.0 * b,
        ve,
    ];
    for (segment, speed) in profile.segments().iter().zip(speeds) {
        near(segment.start.velocity, speed);
    }
    near(profile.duration_s(), tf);
    holds_when_integrated(&profile);
}

#[test]
fn ten_phases_that_cannot_be_are_refused() {
    let run = TenPhases { start: 2.0, peak: 13.0, end: 5.0, acceleration: 18.0, duration_s: 4.0 };
    for wrong in [
        TenPhases { peak: 5.0, ..run },
        TenPhases { start: -1.0, ..run },
        TenPhases { end: f64::NAN, ..run },
        TenPhases { acceleration: 0.0, ..run },
        TenPhases { duration_s: 1.0, ..run },
    ] {
        assert!(wrong.plan().is_err(), "{wrong:?}");
    }
}

#[test]
fn strokes() {
    let law = ImprovedSCurveLaw { acceleration: 18.0 };
    let plan = |distance, command, start, end| law.plan_between(StrokeRequest { distance, command }, start, end);
    // A cruise: 5.5 rev/s takes 0.5 s either way.
    let cruising = plan(10.0, 5.5, 0.0, 0.0).unwrap();
    near(cruising.duration_s(), 10.0 / 5.5 + 0.5);
    assert_eq!(cruising.segments().len(), 9);
    // Too short for the command: v²/11 = S at v = 11.
    let short = plan(11.0, 50.0, 0.0, 0.0).unwrap();
    near(short.peak_velocity(), 11.0);
    near(short.duration_s(), 2.0);
    assert_eq!(short.segments().len(), 8);
    // From 2.2 to 8.8 over a peak of 13.2: (1 s · 7.7) + (0.4 s · 11)
    let between = plan(7.7 + 4.4, 50.0, 2.2, 8.8).unwrap();
    near(between.peak_velocity(), 13.2);
    near(between.duration_s(), 1.4);
    // One change alone: 2.2 → 8.8 in 0.6 s.
    near(plan(3.3 + 1e-13, 50.0, 2.2, 8.8).unwrap().peak_velocity(), 8.8);
    assert!(plan(3.29, 50.0, 2.2, 8.8).is_err());
    for profile in [cruising, short, between] {
        holds_when_integrated(&profile);
        let greatest = profile.segments().iter().map(|piece| piece.start.acceleration.abs()).fold(0.0, f64::max);
        near(greatest, 18.0);
    }
}

#[test]
fn a_change_takes_what_its_acceleration_integrates_to() {
    let law = ImprovedSCurveLaw { acceleration: 7.0 };
    let (time_s, distance) = oracle::cusp_ramp(&law, 2.0, 9.0);
    near(time_s, 18.0 / 11.0);
    near(distance, 5.5 * time_s);
}
