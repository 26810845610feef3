//! Each special case by name, with numbers worked out by hand from errata.md, and the published ones of figures.md.

use rigidtap::control::machine::{Law, Machine, Ramp};
use rigidtap::control::profile::{
    LinearLaw, Profile, ProfileError, SCurveLaw, SpeedBand, StrokeRequest, TorqueCurveLaw,
};

/// Bands whose flanks meet with (A·B)/(A + B) = 4, 3, 2, 1 rev/s²: filled, they take 12.5, 62.5, 187.5, 537.5 rev.
fn law(start_rev_per_s: f64, end_rev_per_s: f64) -> TorqueCurveLaw {
    let band = |to_rev_per_s, accel_rev_per_s2, decel_rev_per_s2| SpeedBand {
        to_rev_per_s,
        accel_rev_per_s2,
        decel_rev_per_s2,
    };
    let bands = [band(10.0, 20.0, 5.0), band(20.0, 12.0, 4.0), band(30.0, 6.0, 3.0), band(40.0, 2.0, 2.0)];
    TorqueCurveLaw { start_rev_per_s, end_rev_per_s, ..TorqueCurveLaw::from_rest(&bands).unwrap() }
}

fn near(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1.0), "found {found}, expected {expected}");
}

/// Durations and accelerations of the segments, with the whole's peak and time.
fn check(profile: &Profile, peak: f64, segments: &[(f64, f64)]) {
    near(profile.peak_velocity(), peak);
    near(profile.duration_s(), segments.iter().map(|(duration_s, _)| duration_s).sum());
    assert_eq!(profile.segments().len(), segments.len(), "{:#?}", profile.segments());
    for (segment, (duration_s, acceleration)) in profile.segments().iter().zip(segments) {
        near(segment.duration_s, *duration_s);
        assert_eq!(segment.start.acceleration, *acceleration);
    }
}

fn stroke(distance: f64, command: f64) -> StrokeRequest {
    StrokeRequest { distance, command }
}

#[test]
fn peak_in_band_1() {
    // Vm² = 2·4·2
    check(&law(0.0, 0.0).plan(stroke(2.0, 40.0)).unwrap(), 4.0, &[(0.2, 20.0), (0.8, -5.0)]);
}

#[test]
fn peak_in_band_2() {
    // Vm² = 10² + 2·3·(38.5 − 12.5)
    let profile = law(0.0, 0.0).plan(stroke(38.5, 40.0)).unwrap();
    check(&profile, 16.0, &[(0.5, 20.0), (0.5, 12.0), (1.5, -4.0), (2.0, -5.0)]);
}

/// Eq. 11 as printed would give 20² + 2·(9/18)·69 = 21.6² here.
#[test]
fn peak_in_band_3() {
    // Vm² = 20² + 2·2·(131.5 − 62.5)
    let profile = law(0.0, 0.0).plan(stroke(131.5, 40.0)).unwrap();
    let up = [(0.5, 20.0), (10.0 / 12.0, 12.0), (1.0, 6.0)];
    check(&profile, 26.0, &[&up[..], &[(2.0, -3.0), (2.5, -4.0), (2.0, -5.0)]].concat());
}

#[test]
fn peak_in_band_4() {
    // Vm² = 30² + 2·1·(249.5 − 187.5)
    let profile = law(0.0, 0.0).plan(stroke(249.5, 40.0)).unwrap();
    let up = [(0.5, 20.0), (10.0 / 12.0, 12.0), (10.0 / 6.0, 6.0), (1.0, 2.0)];
    check(&profile, 32.0, &[&up[..], &[(1.0, -2.0), (10.0 / 3.0, -3.0), (2.5, -4.0), (2.0, -5.0)]].concat());
}

#[test]
fn cruise_at_the_command() {
    // 131.5 rev of flanks, 52 rev at 26 rev/s.
    let profile = law(0.0, 0.0).plan(stroke(183.5, 26.0)).unwrap();
    let up = [(0.5, 20.0), (10.0 / 12.0, 12.0), (1.0, 6.0)];
    check(&profile, 26.0, &[&up[..], &[(2.0, 0.0), (2.0, -3.0), (2.5, -4.0), (2.0, -5.0)]].concat());
}

#[test]
fn command_on_a_band_top_without_cruise() {
    let profile = law(0.0, 0.0).plan(stroke(62.5, 20.0)).unwrap();
    check(&profile, 20.0, &[(0.5, 20.0), (10.0 / 12.0, 12.0), (2.5, -4.0), (2.0, -5.0)]);
}

#[test]
fn command_above_the_last_band_is_clamped() {
    let profile = law(0.0, 0.0).plan(stroke(577.5, 60.0)).unwrap();
    assert_eq!(profile.peak_velocity(), 40.0);
    assert_eq!(profile.segments()[4].start.acceleration, 0.0);
    near(profile.segments()[4].duration_s, 1.0);
    near(profile.duration_s(), 0.5 + 10.0 / 12.0 + 10.0 / 6.0 + 5.0 + 1.0 + 5.0 + 10.0 / 3.0 + 2.5 + 2.0);
}

#[test]
fn start_and_end_speed_differ() {
    // Up from 4: 2.1 + 12.5 + 23 rev; down to 8: 46 + 37.5 + 3.6 rev.
    let law = law(4.0, 8.0);
    let segments = [(0.3, 20.0), (10.0 / 12.0, 12.0), (1.0, 6.0), (2.0, -3.0), (2.5, -4.0), (2.0 / 5.0, -5.0)].to_vec();
    check(&law.plan(stroke(124.7, 40.0)).unwrap(), 26.0, &segments);
    let mut cruising = segments;
    cruising.insert(3, (0.5, 0.0));
    check(&law.plan(stroke(124.7 + 13.0, 26.0)).unwrap(), 26.0, &cruising);
}

#[test]
fn start_speed_above_band_1_skips_it() {
    // From 15: 175/24 + 23 rev; down to rest: 46 + 37.5 + 10 rev.
    let profile = law(15.0, 0.0).plan(stroke(175.0 / 24.0 + 116.5, 40.0)).unwrap();
    check(&profile, 26.0, &[(5.0 / 12.0, 12.0), (1.0, 6.0), (2.0, -3.0), (2.5, -4.0), (2.0, -5.0)]);
}

#[test]
fn end_speed_above_band_1_skips_it() {
    // Up to 26: 100/40 + 300/24 + 276/12 rev; down to 25: 51/6 rev.
    let profile = law(0.0, 25.0).plan(stroke(2.5 + 12.5 + 23.0 + 8.5, 40.0)).unwrap();
    check(&profile, 26.0, &[(0.5, 20.0), (10.0 / 12.0, 12.0), (1.0, 6.0), (1.0 / 3.0, -3.0)]);
}

#[test]
fn start_on_a_band_top_belongs_to_the_band_above() {
    let profile = law(20.0, 20.0).plan(stroke(69.0, 40.0)).unwrap();
    check(&profile, 26.0, &[(1.0, 6.0), (2.0, -3.0)]);
    let cruise = law(20.0, 20.0).plan(stroke(69.0, 20.0)).unwrap();
    check(&cruise, 20.0, &[(69.0 / 20.0, 0.0)]);
}

#[test]
fn too_short_for_start_to_end_is_an_error() {
    // (8² − 4²)/2/20 up, (8² − 4²)/2/5 down.
    assert_eq!(law(4.0, 8.0).plan(stroke(1.1, 40.0)), Err(ProfileError::TooShort { distance: 1.1, needed: 1.2 }));
    assert_eq!(law(8.0, 4.0).plan(stroke(4.7, 40.0)), Err(ProfileError::TooShort { distance: 4.7, needed: 4.8 }));
    check(&law(4.0, 8.0).plan(stroke(1.2, 40.0)).unwrap(), 8.0, &[(0.2, 20.0)]);
    check(&law(8.0, 4.0).plan(stroke(4.8, 40.0)).unwrap(), 8.0, &[(0.8, -5.0)]);
}

#[test]
fn ends_above_the_command_are_an_error() {
    let error = |speed, command| Err(ProfileError::EndsAboveCommand { speed, command });
    assert_eq!(law(4.0, 8.0).plan(stroke(10.0, 7.0)), error(8.0, 7.0));
    assert_eq!(law(50.0, 8.0).plan(stroke(1e4, 60.0)), error(50.0, 40.0));
}

#[test]
fn what_is_no_number_is_an_error() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for request in [stroke(bad, 1.0), stroke(1.0, bad)] {
            assert!(matches!(law(0.0, 0.0).plan(request), Err(ProfileError::Invalid { .. })), "{request:?}");
            let (s_curve, linear) = (SCurveLaw { acceleration: 1.0, jerk: 1.0 }, LinearLaw { acceleration: 1.0 });
            assert!(matches!(s_curve.plan(request), Err(ProfileError::Invalid { .. })), "{request:?}");
            assert!(matches!(linear.plan(request), Err(ProfileError::Invalid { .. })), "{request:?}");
        }
        let mut broken = law(0.0, 0.0);
        broken.bands[2].decel_rev_per_s2 = bad;
        assert!(matches!(broken.plan(stroke(1.0, 1.0)), Err(ProfileError::Invalid { .. })));
        let broken = SCurveLaw { acceleration: 1.0, jerk: bad };
        assert!(matches!(broken.plan(stroke(1.0, 1.0)), Err(ProfileError::Invalid { .. })));
    }
    let mut unordered = law(0.0, 0.0);
    unordered.bands[2].to_rev_per_s = 20.0;
    assert_eq!(unordered.plan(stroke(1.0, 1.0)), Err(ProfileError::Invalid { value: 0.0 }));
    assert!(TorqueCurveLaw::from_rest(&[]).unwrap().plan(stroke(1.0, 1.0)).is_err());
}

/// Eq. 4: only the first band is crossed from Vs; with Vs above it, its constant counts from rest.
#[test]
fn time_constants_become_accelerations() {
    let bands = |start_rpm: f64, end_rpm: f64| {
        let machine = Machine::reference().with(|spec| {
            spec.law.torque_curve.start_rpm = start_rpm;
            spec.law.torque_curve.end_rpm = end_rpm;
            for (band, seconds) in spec.law.torque_curve.bands.iter_mut().zip([0.1, 0.05, 0.1, 0.2]) {
                band.ramp = Ramp::Time { accel_s: seconds, decel_s: 2.0 * seconds };
            }
        });
        let bands = machine.unwrap().torque_curve().bands.clone();
        bands.iter().map(|band| (band.accel_rev_per_s2 * 60.0, band.decel_rev_per_s2 * 60.0)).collect::<Vec<_>>()
    };
    let expect = |found: Vec<(f64, f64)>, expected: [(f64, f64); 4]| {
        for (found, expected) in found.into_iter().zip(expected) {
            near(found.0, expected.0);
            near(found.1, expected.1);
        }
    };
    let above = [(24_000.0, 12_000.0), (14_000.0, 7_000.0), (12_000.0, 6_000.0)];
    let all = |first| [first, above[0], above[1], above[2]];
    expect(bands(0.0, 0.0), all((30_000.0, 15_000.0)));
    expect(bands(600.0, 1200.0), all((24_000.0, 9_000.0)));
    expect(bands(3500.0, 0.0), all((30_000.0, 15_000.0)));
}

#[test]
fn s_curve_cases() {
    let law = SCurveLaw { acceleration: 10.0, jerk: 100.0 };
    let check = |distance, command, peak, duration_s| {
        let profile = law.plan(stroke(distance, command)).unwrap();
        near(profile.peak_velocity(), peak);
        near(profile.duration_s(), duration_s);
    };
    check(10.0, 5.0, 5.0, 2.6); // V and A reached: S/V + V/A + A/J
    check(0.6, 5.0, 2.0, 0.6); // A, not V: V/A·V + V·A/J = 0.6 at V = 2
    check(0.025, 5.0, 0.25, 0.2); // neither: 2·V·√(V/J) = 0.025 at V = 0.25
    check(0.275, 0.25, 0.25, 1.2); // V, not A
    check(0.2, 5.0, 1.0, 0.4); // A just reached
    check(0.2, 1.0, 1.0, 0.4); // and V with it
    // From 1 to 2 with A just reached each way: 1.5·0.2 rev; from 2 on to 3 and back: 2.5·0.2 twice.
    let between = law.plan_between(stroke(1.5 * 0.2, 9.0), 1.0, 2.0).unwrap();
    near(between.duration_s(), 0.2);
    near(law.plan_between(stroke(1.0, 9.0), 2.0, 2.0).unwrap().peak_velocity(), 3.0);
    let short = law.plan_between(stroke(0.2, 9.0), 1.0, 2.0);
    assert!(matches!(short, Err(ProfileError::TooShort { .. })), "{short:?}");
}

#[test]
fn linear_cases() {
    let law = LinearLaw { acceleration: 10.0 };
    check(&law.plan(stroke(10.0, 20.0)).unwrap(), 10.0, &[(1.0, 10.0), (1.0, -10.0)]);
    check(&law.plan(stroke(10.0, 5.0)).unwrap(), 5.0, &[(0.5, 10.0), (1.5, 0.0), (0.5, -10.0)]);
}

/// figures.md: the fastest stroke of 25 rev on the reference machine, and what the four bands take of it.
#[test]
fn published_bounds() {
    let machine = Machine::reference();
    // The file's tops, each band with exactly the acceleration that 80 % of the motor have at its top.
    let exactly = machine.with(|spec| {
        for band in &mut spec.law.torque_curve.bands {
            let rate = 60.0 * machine.motor().acceleration_rev_per_s2(band.to_rpm / 60.0, 0.8);
            band.ramp = Ramp::Rate { accel_rpm_per_s: rate, decel_rpm_per_s: rate };
        }
    });
    let exactly = exactly.unwrap();
    let per_speed = [(3000.0, 562.8, 578.5, 1.000), (5000.0, 408.4, 435.6, 1.012), (7000.0, 381.8, 419.6, 1.025)];
    for (speed_rpm, full_ms, share_ms, price) in per_speed {
        let bound = |share| machine.motor().fastest_stroke(25.0, speed_rpm / 60.0, share);
        assert!((1000.0 * bound(1.0).duration_s - full_ms).abs() <= 0.05, "S{speed_rpm}: {:?}", bound(1.0));
        assert!((1000.0 * bound(0.8).duration_s - share_ms).abs() <= 0.05, "S{speed_rpm}: {:?}", bound(0.8));
        // The file's time constants are rounded to 0.1 ms; the published price is that of bands timed exactly.
        let ratio = |machine: &Machine| {
            let banded = machine.stroke(Law::TorqueCurve, stroke(25.0, speed_rpm / 60.0)).unwrap();
            banded.duration_s() / bound(0.8).duration_s
        };
        let (exact, rounded) = (ratio(&exactly), ratio(&machine));
        assert!((exact - price).abs() <= 0.0005, "S{speed_rpm}: {exact}");
        assert!((rounded - exact).abs() <= 0.0002, "S{speed_rpm}: {rounded} from rounded time constants, {exact}");
    }
    let peak_rpm = |share| machine.motor().fastest_stroke(25.0, 7000.0 / 60.0, share).peak_rev_per_s * 60.0;
    assert!((peak_rpm(1.0) - 6759.0).abs() <= 0.5, "{}", peak_rpm(1.0));
    assert!((peak_rpm(0.8) - 6252.0).abs() <= 0.5, "{}", peak_rpm(0.8));
}
