//! Sizes, tolerances and designations of standard threads.

use rigidtap::control::thread::{PITCHES, Series, StandardPitch, StandardThread, ThreadError};

fn thread(name: &str) -> StandardThread {
    StandardThread::by_name(name).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn designations_are_read_as_people_write_them() {
    for (written, name) in [
        ("m6", "M6"),
        ("M6x1", "M6"),
        ("M6 x 1.0", "M6"),
        ("M10x1.25", "M10x1.25"),
        ("M10X1.250", "M10x1.25"),
        ("M 12 * 1.5", "M12x1.5"),
        ("M64x4", "M64x4"),
        ("1/4-28", "1/4-28 UNF"),
        ("1/4-20", "1/4-20 UNC"),
        ("UNF 1/4-28", "1/4-28 UNF"),
        ("1/4-32unef", "1/4-32 UNEF"),
        ("#10-32", "10-32 UNF"),
        ("10 - 24 UNC", "10-24 UNC"),
        ("0-80", "0-80 UNF"),
        ("1-1/8-7", "1 1/8-7 UNC"),
        ("1 1/8-7 UNC", "1 1/8-7 UNC"),
        ("2-4.5", "2-4.5 UNC"),
        ("1/4 BSW", "1/4-20 BSW"),
        ("BSW 1/4", "1/4-20 BSW"),
        ("1/2-12 BSW", "1/2-12 BSW"),
        ("G1/8", "G1/8"),
        ("g 1 1/4", "G1 1/4"),
        ("BSPP 1/2", "G1/2"),
    ] {
        assert_eq!(thread(written).name, name, "{written}");
    }
}

#[test]
fn what_is_no_cylindrical_thread_is_told() {
    for written in ["1/8-27 NPT", "NPT 1/4", "NPTF1/8", "1/2 NPTF", "R1/2", "Rc 3/8", "BSPT 1/4"] {
        assert_eq!(StandardThread::by_name(written), Err(ThreadError::Tapered), "{written}");
    }
    for written in
        ["", "M", "M6.5", "M6x1.1", "M99", "1/4", "1/4-21", "1/5-20", "6", "G", "G9", "x", "M6x", "\u{2300}6", "M1e0"]
    {
        assert_eq!(StandardThread::by_name(written), Err(ThreadError::Unknown), "{written}");
    }
}

#[test]
fn every_size_is_found_by_its_own_name_and_has_a_drill_and_a_tolerance() {
    for size in StandardThread::all() {
        assert_eq!(thread(size.name), size);
        assert!(size.hole_mm > 0.0 && size.hole_mm < size.major_mm, "{size:?}");
        assert!((10.0..300.0).contains(&size.sync_tolerance_um()), "{size:?}");
        assert!(StandardPitch::of(size.pitch_mm).is_some(), "{size:?}");
    }
    let count = |series| StandardThread::all().filter(|size| size.series == series).count();
    let series = [
        Series::MetricCoarse,
        Series::MetricFine,
        Series::Unc,
        Series::Unf,
        Series::Unef,
        Series::Whitworth,
        Series::Pipe,
    ];
    assert_eq!(series.map(count), [39, 123, 33, 24, 25, 26, 24]);
    assert!(PITCHES.iter().all(|pitch| pitch.pitch_mm > 0.0));
}

/// ISO 965-1 makes its table of a formula and rounds to the series R 40: 1.32 · 90 · P^0.4 · d^0.1 µm, d the geometric mean
/// of the diameter range.
#[test]
fn metric_tolerances_are_what_their_formula_gives() {
    const RANGES_MM: [(f64, f64); 7] =
        [(0.99, 1.4), (1.4, 2.8), (2.8, 5.6), (5.6, 11.2), (11.2, 22.4), (22.4, 45.0), (45.0, 90.0)];
    for size in StandardThread::all().filter(|size| size.tolerance_class == "6H") {
        let (low, high) = RANGES_MM.into_iter().find(|(_, high)| size.major_mm <= *high).expect("a range");
        let formula_um = 1.32 * 90.0 * size.pitch_mm.powf(0.4) * (low * high).sqrt().powf(0.1);
        let ratio = size.pitch_diameter_tolerance_um / formula_um;
        assert!((0.94..1.06).contains(&ratio), "{}: {ratio}", size.name);
    }
}

/// Limits of the pitch diameter as handbooks print ASME B1.1: 1/4-20 UNC-2B 0.2175 to 0.2224, 1/4-28 UNF-2B 0.2268 to
/// 0.2311, 10-32 UNF-2B 0.1697 to 0.1736, 1-8 UNC-2B 0.9188 to 0.9276 inch.
#[test]
fn unified_tolerances_are_those_of_the_tables() {
    for (name, tolerance_in) in [("1/4-20", 0.0049), ("1/4-28", 0.0043), ("10-32", 0.0039), ("1-8", 0.0088)] {
        let found_in = thread(name).pitch_diameter_tolerance_um / 25_400.0;
        assert!((found_in - tolerance_in).abs() < 0.000_1, "{name}: {found_in}");
    }
}

/// The usual tap drills of ISO 2306.
#[test]
fn drills_are_the_usual_ones() {
    for (name, hole_mm) in [
        ("M3", 2.5),
        ("M4", 3.3),
        ("M5", 4.2),
        ("M6", 5.0),
        ("M8", 6.8),
        ("M10", 8.5),
        ("M12", 10.2),
        ("M16", 14.0),
        ("M20", 17.5),
        ("M24", 21.0),
        ("M10x1.25", 8.8),
        ("M12x1.5", 10.5),
        ("M8x1", 7.0),
    ] {
        assert!((thread(name).hole_mm - hole_mm).abs() < 1e-9, "{name}: {}", thread(name).hole_mm);
    }
    assert!((thread("1/4-20").hole_mm - 5.1).abs() < 0.05, "a No. 7 drill");
    assert!((thread("G1/4").hole_mm - 11.8).abs() < 0.05);
}

/// What class ISO 2 leaves of 6H.
#[test]
fn the_errors_that_threads_bear() {
    let rounded = |name| thread(name).sync_tolerance_um().round();
    assert_eq!(["M3", "M4", "M5", "M6", "M8", "M10", "M12"].map(rounded), [35.0, 41.0, 43.0, 53.0, 56.0, 64.0, 69.0]);
    assert!(thread("1/4-20").sync_tolerance_um() < thread("M8").sync_tolerance_um());
}

#[test]
fn a_pitch_has_the_size_that_is_usual_for_it() {
    for (pitch_mm, name) in
        [(0.25, "M1"), (1.0, "M6"), (2.0, "M16"), (6.0, "M64"), (25.4 / 20.0, "1/4-20 UNC"), (25.4 / 32.0, "6-32 UNC")]
    {
        assert_eq!(StandardThread::by_pitch(pitch_mm).map(|size| size.name), Some(name));
    }
    let between = StandardThread::by_pitch(1.1).expect("between M6 and M8");
    assert!(between.major_mm > 6.0 && between.major_mm < 8.0);
    assert_eq!(StandardThread::by_pitch(0.1), None);
    assert!(StandardPitch::of(25.4 / 27.0).is_some_and(|pitch| pitch.is_tapered()));
}
