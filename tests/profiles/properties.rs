//! What must hold between strokes: none is slower than the best, time runs both ways, more takes longer.

use rigidtap::control::profile::{SpeedBand, TorqueCurveLaw};

use crate::cases::{Case, Law};

const STROKES: u64 = 10_000;
/// Seeds of their own: the strokes differ from those of `random`.
const FIRST_SEED: u64 = 1_000_000_000;

fn cases() -> impl Iterator<Item = (u64, Case)> {
    (FIRST_SEED..FIRST_SEED + STROKES).map(|seed| (seed, Case::of_seed(seed)))
}

#[test]
fn no_stroke_is_slower_than_the_best() {
    for (seed, case) in cases().filter(|(_, case)| case.is_to_be_best()) {
        let (Ok(profile), Some(best)) = (case.plan(), case.best()) else { continue };
        let ratio = profile.duration_s() / best.duration_s;
        assert!((ratio - 1.0).abs() < 1e-9, "seed {seed}: {ratio} times the best {best:?}\n{case:#?}");
        let peak_ratio = profile.peak_velocity() / best.peak;
        assert!((peak_ratio - 1.0).abs() < 1e-6, "seed {seed}: peak {peak_ratio} times that of {best:?}\n{case:#?}");
    }
}

fn reversed(case: &Case) -> Case {
    let law = match &case.law {
        Law::TorqueCurve(law) => Law::TorqueCurve(TorqueCurveLaw {
            start_rev_per_s: law.end_rev_per_s,
            end_rev_per_s: law.start_rev_per_s,
            bands: law
                .bands
                .iter()
                .map(|band| SpeedBand {
                    accel_rev_per_s2: band.decel_rev_per_s2,
                    decel_rev_per_s2: band.accel_rev_per_s2,
                    ..*band
                })
                .collect(),
        }),
        Law::SCurveBetween(law, start, end) => Law::SCurveBetween(*law, *end, *start),
        Law::ImprovedSCurve(law, start, end) => Law::ImprovedSCurve(*law, *end, *start),
        same => same.clone(),
    };
    Case { law, ..case.clone() }
}

/// A stroke with its ends and its flanks exchanged is the same stroke, filmed and played backwards.
#[test]
fn a_reversed_stroke_is_the_stroke_reversed() {
    for (seed, case) in cases() {
        let (forth, back) = (case.plan(), reversed(&case).plan());
        assert_eq!(forth.is_ok(), back.is_ok(), "seed {seed}\n{case:#?}");
        let (Ok(forth), Ok(back)) = (forth, back) else { continue };
        let total_s = forth.duration_s();
        assert!((back.duration_s() / total_s - 1.0).abs() < 1e-9, "seed {seed}\n{case:#?}");
        for step in 0..=32 {
            let time_s = total_s * f64::from(step) / 32.0;
            let sum = forth.at(time_s).position + back.at(total_s - time_s).position;
            let apart = sum - case.stroke.distance;
            assert!(apart.abs() < 1e-9, "seed {seed}: {apart} apart at {time_s} s\n{case:#?}");
        }
    }
}

#[test]
fn a_longer_stroke_takes_longer_and_a_faster_command_does_not() {
    for (seed, case) in cases().filter(|(_, case)| case.is_to_be_best()) {
        let Ok(profile) = case.plan() else { continue };
        let (mut longer, mut faster) = (case.clone(), case.clone());
        longer.stroke.distance *= 1.0 + 10f64.powi(-((seed % 6) as i32));
        faster.stroke.command *= 1.0 + 10f64.powi(-((seed % 6) as i32));
        let duration_s = |case: &Case| case.plan().map(|profile| profile.duration_s());
        assert!(duration_s(&longer).is_ok_and(|s| s > profile.duration_s()), "seed {seed}\n{case:#?}");
        let rounding = 1.0 + 1e-12;
        assert!(duration_s(&faster).is_ok_and(|s| s <= rounding * profile.duration_s()), "seed {seed}\n{case:#?}");
    }
}
