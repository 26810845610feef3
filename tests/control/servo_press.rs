//! The servo press of the fourth paper: its key points, its manipulator, its slide, its strokes per minute.
//!
//! The slide is differentiated numerically and the crank integrated numerically; no formula is the planner's.

use std::f64::consts::TAU;

use rigidtap::control::coupling::SliderCrank;
use rigidtap::control::math::poly::State;
use rigidtap::control::profile::press::{PressError, PressStroke, PressTask};
use rigidtap::control::profile::verify::{Limits, Task, verify};

const CRANK_MM: f64 = 450.0;
const ROD_MM: f64 = 1200.0;
const KEY_DEGREES: [f64; 4] = [66.0, 131.5, 190.0, 294.0];
const FORMING_RPM: f64 = 6.7;

fn task() -> PressTask {
    let [closing_rev, forming_start_rev, forming_end_rev, opening_rev] = KEY_DEGREES.map(|degrees| degrees / 360.0);
    PressTask {
        slide: SliderCrank::new(CRANK_MM, ROD_MM).unwrap(),
        closing_rev,
        forming_start_rev,
        forming_end_rev,
        opening_rev,
        forming_rev_per_s: FORMING_RPM / 60.0,
        transfer_s: 2.0,
        slide_mm_per_s2: 3500.0,
    }
}

fn stroke() -> PressStroke {
    task().plan().unwrap()
}

/// Height above bottom dead centre by the triangle of crank and rod alone.
fn height_mm(crank_rev: f64) -> f64 {
    let (sin, cos) = (TAU * crank_rev).sin_cos();
    let pin_mm = CRANK_MM * cos - (ROD_MM * ROD_MM - (CRANK_MM * sin).powi(2)).sqrt();
    pin_mm + CRANK_MM + ROD_MM
}

#[test]
fn the_slide_follows_the_triangle() {
    let slide = task().slide;
    for degrees in -720..=720 {
        let crank = State { position: f64::from(degrees) / 360.0, velocity: 0.3, acceleration: 0.7, jerk: -2.0 };
        let found = slide.follow(&crank);
        // A crank that moves with this jerk: differences of its slide's height over steps of h.
        let at = |t: f64| height_mm(crank.after(t, 0.0).position);
        let h = 1e-3;
        let first = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
        let second = (16.0 * (at(h) + at(-h)) - (at(2.0 * h) + at(-2.0 * h)) - 30.0 * at(0.0)) / (12.0 * h * h);
        let third = (at(2.0 * h) - at(-2.0 * h) - 2.0 * (at(h) - at(-h))) / (2.0 * h * h * h);
        assert!((found.position - at(0.0)).abs() < 1e-9, "{degrees}°");
        assert!((found.velocity - first).abs() < 1e-4, "{degrees}°: {} {first}", found.velocity);
        assert!((found.acceleration - second).abs() < 1e-2, "{degrees}°: {} {second}", found.acceleration);
        assert!((found.jerk - third).abs() < 1.0, "{degrees}°: {} {third}", found.jerk);
    }
    assert!(SliderCrank::new(450.0, 450.0).is_none() && SliderCrank::new(0.0, 1.0).is_none());
}

#[test]
fn heights_and_speeds_of_the_paper() {
    let slide = task().slide;
    // The paper prints 705.7 for the first: errata.md.
    for (degrees, height_mm) in [(66.0, 705.6), (131.5, 200.1), (190.0, 9.4), (294.0, 705.6)] {
        assert!((slide.height_mm(degrees / 360.0) - height_mm).abs() < 0.05, "{degrees}°");
    }
    // θ2 downwards and θ3, past bottom dead centre, upwards.
    for (degrees, mm_per_s) in [(131.5, -297.7), (190.0, 75.1)] {
        let crank = State { position: degrees / 360.0, velocity: FORMING_RPM / 60.0, ..State::default() };
        assert!((slide.follow(&crank).velocity - mm_per_s).abs() < 0.05, "{degrees}°");
    }
}

#[test]
fn the_crank_passes_its_key_points_at_their_speeds() {
    let stroke = stroke();
    let slide = task().slide;
    for (time_s, degrees) in stroke.key_points_s.into_iter().zip(KEY_DEGREES) {
        let found = 360.0 * stroke.profile.at(time_s).position;
        assert!((found - degrees).abs() < 1e-9, "{found}° of {degrees}°");
    }
    let at = |point: usize| slide.follow(&stroke.profile.at(stroke.key_points_s[point]));
    assert!((at(1).velocity + 297.7).abs() < 0.05 && (at(2).velocity - 75.1).abs() < 0.05);
    // 66° fall in about the first second: errata.md.
    assert!((stroke.key_points_s[0] - 1.0).abs() < 0.01, "{:?}", stroke.key_points_s);
    // While it forms, the crank keeps its speed.
    let [_, start_s, end_s, _] = stroke.key_points_s;
    for step in 0..=1000 {
        let state = stroke.profile.at(start_s + (end_s - start_s) * f64::from(step) / 1000.0);
        assert!((60.0 * state.velocity - FORMING_RPM).abs() < 1e-9 && state.acceleration.abs() < 1e-9);
    }
}

#[test]
fn the_manipulator_has_its_time() {
    let stroke = stroke();
    let [closing_s, .., opening_s] = stroke.key_points_s;
    let transfer_s = stroke.profile.duration_s() - opening_s + closing_s;
    assert!((transfer_s - 2.0).abs() < 1e-9, "{transfer_s} s");
    // Nowhere outside it is the slide lower than at the key points, up to their rounding.
    for step in 0..=1000 {
        let time_s = closing_s * f64::from(step) / 1000.0;
        assert!(height_mm(stroke.profile.at(time_s).position) >= height_mm(KEY_DEGREES[0] / 360.0) - 1e-6);
    }
}

#[test]
fn one_revolution_without_a_step() {
    let stroke = stroke();
    let end = stroke.profile.end();
    let task = Task { distance: 1.0, start_velocity: end.velocity, end_velocity: end.velocity, ..Task::default() };
    let limits = Limits { velocity: 1.0, acceleration: &|_| 3.0, jerk: f64::INFINITY, continuous_acceleration: true };
    verify(&stroke.profile, &task, &limits).unwrap();
    // The next stroke goes on where this one ended.
    assert!((stroke.profile.at(0.0).velocity - end.velocity).abs() < 1e-15);
    assert_eq!((stroke.profile.at(0.0).acceleration, end.acceleration), (0.0, 0.0));
    let [a, b, c, d] = stroke.jerks_rev_per_s3;
    assert!(a != b && b != c && c != d, "a J of its own for each change: {:?}", stroke.jerks_rev_per_s3);
}

/// From the crank's acceleration alone: integrated to its angle, put through the triangle, differentiated twice.
#[test]
fn the_slide_is_spared() {
    let stroke = stroke();
    const STEPS: usize = 200_000;
    let step_s = stroke.profile.duration_s() / STEPS as f64;
    let mut crank = stroke.profile.at(0.0);
    let mut heights = vec![height_mm(crank.position)];
    for step in 1..=STEPS {
        let acceleration = stroke.profile.at(step as f64 * step_s).acceleration;
        let velocity = crank.velocity + (crank.acceleration + acceleration) / 2.0 * step_s;
        crank.position += (crank.velocity + velocity) / 2.0 * step_s;
        (crank.velocity, crank.acceleration) = (velocity, acceleration);
        heights.push(height_mm(crank.position));
    }
    assert!((crank.position - 1.0).abs() < 1e-8, "{}", crank.position);
    // Over forty steps each way: heights rounded to 1e-13 mm give accelerations to 1e-6.
    const SPAN: usize = 40;
    let wide_s = SPAN as f64 * step_s;
    let greatest = (SPAN..=STEPS - SPAN)
        .map(|at| (heights[at + SPAN] + heights[at - SPAN] - 2.0 * heights[at]) / (wide_s * wide_s))
        .fold(0.0, |greatest: f64, found| greatest.max(found.abs()));
    assert!(greatest < 3500.0 && greatest > 3490.0, "{greatest} mm/s²");
    let sampled = (0..=STEPS)
        .map(|step| task().slide.follow(&stroke.profile.at(step as f64 * step_s)).acceleration.abs())
        .fold(0.0, f64::max);
    assert!(sampled < 3500.0, "{sampled} mm/s²");
}

#[test]
fn strokes_per_minute() {
    let rate = 60.0 / stroke().profile.duration_s();
    assert!(rate >= 11.7, "{rate}");
    // errata.md: a search found 11.78.
    assert!((rate - 11.78).abs() < 0.01, "{rate}");
}

#[test]
fn a_stricter_slide_is_slower_and_a_harder_task_is_refused() {
    let rate =
        |slide_mm_per_s2: f64| 60.0 / PressTask { slide_mm_per_s2, ..task() }.plan().unwrap().profile.duration_s();
    assert!(rate(3000.0) < rate(3500.0) && rate(3500.0) < rate(4000.0));
    let refused = PressTask { slide_mm_per_s2: 100.0, ..task() }.plan();
    assert!(matches!(refused, Err(PressError::SlideLimit { .. })), "{refused:?}");
    let disordered = PressTask { forming_end_rev: 0.3, ..task() }.plan();
    assert!(matches!(disordered, Err(PressError::Invalid { .. })), "{disordered:?}");
}
