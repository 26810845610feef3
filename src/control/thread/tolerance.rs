//! Tolerances of the pitch diameter of internal threads.
//!
//! Held against public text: 6H and 5H of M1 to M5 (a tap catalogue of 2021, p. 657), the rest of the metric table by ISO
//! 965-1's formula; 2B of 1/4-20, 1/4-28, 10-32 and 1-8 by handbooks' limits, and that it is 1.3 times 2A. BS 84's formula
//! by BS 84:2007 and Machinery's Handbook as quoted in FusionThreadsGenerator, docs/WHITWORTH_SPEC.md; that its medium class
//! has the whole of it, close two thirds and free three halves there and in the Sutton catalogue, p. 456, figure 6.
//! From memory: the five values of ISO 228-1.

use crate::control::math::{cbrt, sqrt};
use crate::control::units::MM_PER_INCH;

const UM_PER_INCH: f64 = 1000.0 * MM_PER_INCH;
/// Upper limit of a class 2 (ISO 2) tap as a share of TD2 of grade 5 (ISO 2857, DIN EN 22857: 0.5·t).
const TAP_SHARE_OF_5H: f64 = 0.5;
/// The same as a share of a tolerance whose standard has no such tap: 0.5·TD2(5)/TD2(6), the grades being 1.06 and 1.32.
const TAP_SHARE: f64 = 0.4;
/// The grade is not standardised for this pitch.
const NONE: f64 = 0.0;

/// Pitch in mm, TD2 of grades 5 and 6 in µm.
type Pitches = &'static [(f64, f64, f64)];

/// TD2 of grades 5 and 6 in µm by diameter range (its end, mm) and pitch (ISO 965-1, table of TD2).
#[rustfmt::skip]
const METRIC_UM: [(f64, Pitches); 7] = [
    (1.4, &[(0.2, 45.0, NONE), (0.25, 56.0, NONE), (0.3, 60.0, 75.0)]),
    (2.8, &[(0.2, 48.0, NONE), (0.25, 60.0, NONE), (0.35, 67.0, 85.0), (0.4, 71.0, 90.0), (0.45, 75.0, 95.0)]),
    (5.6, &[(0.35, 71.0, 90.0), (0.5, 80.0, 100.0), (0.6, 90.0, 112.0), (0.7, 95.0, 118.0), (0.75, 95.0, 118.0), (0.8, 100.0, 125.0)]),
    (11.2, &[(0.75, 106.0, 132.0), (1.0, 118.0, 150.0), (1.25, 125.0, 160.0), (1.5, 140.0, 180.0)]),
    (22.4, &[(1.0, 125.0, 160.0), (1.25, 140.0, 180.0), (1.5, 150.0, 190.0), (1.75, 160.0, 200.0), (2.0, 170.0, 212.0), (2.5, 180.0, 224.0)]),
    (45.0, &[(1.0, 132.0, 170.0), (1.5, 160.0, 200.0), (2.0, 180.0, 224.0), (3.0, 212.0, 265.0), (3.5, 224.0, 280.0), (4.0, 236.0, 300.0), (4.5, 250.0, 315.0)]),
    (90.0, &[(1.5, 170.0, 212.0), (2.0, 190.0, 236.0), (3.0, 224.0, 280.0), (4.0, 250.0, 315.0), (5.0, 265.0, 335.0), (5.5, 280.0, 355.0), (6.0, 300.0, 375.0)]),
];

/// A tolerance with its class, and what a tap at its upper limit takes of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tolerance {
    pub(super) class: &'static str,
    pub(super) pitch_diameter_um: f64,
    pub(super) tap_upper_limit_um: f64,
}

/// 6H of ISO 965-1; 5H where the pitch is too fine for it.
pub(super) fn metric(major_mm: f64, pitch_mm: f64) -> Tolerance {
    let of_range = METRIC_UM.iter().find(|(to_mm, _)| major_mm <= *to_mm);
    let found = of_range.and_then(|(_, pitches)| pitches.iter().find(|(known_mm, ..)| *known_mm == pitch_mm));
    let (grade_5_um, grade_6_um) = found.map_or((NONE, NONE), |&(_, grade_5_um, grade_6_um)| (grade_5_um, grade_6_um));
    let (class, pitch_diameter_um) = if grade_6_um > NONE { ("6H", grade_6_um) } else { ("5H", grade_5_um) };
    Tolerance { class, pitch_diameter_um, tap_upper_limit_um: TAP_SHARE_OF_5H * grade_5_um }
}

/// 2B of ASME B1.1: 1.3 times the tolerance of 2A, 0.0015·∛D + 0.0015·√LE + 0.015·P^⅔ inch. The length of engagement LE is
/// D for UNC and UNF, and nine pitches for UNEF.
pub(super) fn unified(major_mm: f64, pitch_mm: f64, nine_pitches: bool) -> Tolerance {
    let (major, pitch) = (major_mm / MM_PER_INCH, pitch_mm / MM_PER_INCH);
    let engagement = if nine_pitches { 9.0 * pitch } else { major };
    let external = 0.0015 * cbrt(major) + 0.0015 * sqrt(engagement) + 0.015 * cbrt(pitch * pitch);
    of("2B", 1.3 * external * UM_PER_INCH)
}

/// Medium class of BS 84: 0.002·∛D + 0.003·√L + 0.005·√P inch, with D as the length of engagement L.
pub(super) fn whitworth(major_mm: f64, pitch_mm: f64) -> Tolerance {
    let (major, pitch) = (major_mm / MM_PER_INCH, pitch_mm / MM_PER_INCH);
    of("medium", (0.002 * cbrt(major) + 0.003 * sqrt(major) + 0.005 * sqrt(pitch)) * UM_PER_INCH)
}

/// ISO 228-1 has one class for internal threads.
pub(super) const fn pipe(tolerance_um: f64) -> Tolerance {
    of("G", tolerance_um)
}

const fn of(class: &'static str, pitch_diameter_um: f64) -> Tolerance {
    Tolerance { class, pitch_diameter_um, tap_upper_limit_um: TAP_SHARE * pitch_diameter_um }
}
