//! 100,000 random strokes, and as many refusals as come with them, through the independent checker.
//!
//! `STROKES=5000000 cargo test --release --test profiles` tries as many,
//! and beside them in `motors.rs` three tenths of that for each law that follows a motor.

use rigidtap::control::profile::ProfileError;

use crate::cases::{Case, Law, count_asked};

/// Unless the environment asks for another number.
const STROKES: u32 = 100_000;
/// Rounding decides between planned and refused only this close to the boundary.
const BOUNDARY: f64 = 1e-12;

/// How often each special case came up; a generator that misses one would prove nothing.
#[derive(Debug, Default)]
struct Seen {
    planned: [u32; 6],
    refused_too_short: u32,
    refused_above_command: u32,
    clamped: u32,
    cruised: u32,
    /// By band of the peak, where the distance set it.
    peak_in_band: [u32; 4],
    start_above_first_band: u32,
    end_on_band_top: u32,
    most_segments: usize,
}

#[test]
fn random_strokes_keep_their_contract() {
    let mut seen = Seen::default();
    let strokes = count_asked().unwrap_or(STROKES);
    for seed in 0.. {
        if seen.planned.iter().sum::<u32>() == strokes {
            break;
        }
        let case = Case::of_seed(seed);
        match case.plan() {
            Ok(profile) => {
                if let Err(violation) = case.verify(&profile) {
                    panic!("seed {seed}: {violation:?}\n{case:#?}\n{:#?}", profile.segments());
                }
                seen.count(&case, profile.peak_velocity(), profile.segments().len());
                let cruise = profile.segments().iter().any(|segment| segment.start.acceleration == 0.0);
                seen.cruised += u32::from(cruise && matches!(case.law, Law::TorqueCurve(_)));
            }
            Err(error) => {
                assert!(justified(&case, error), "seed {seed}: refused without a reason: {error:?}\n{case:#?}");
                seen.refused_too_short += u32::from(matches!(error, ProfileError::TooShort { .. }));
                seen.refused_above_command += u32::from(matches!(error, ProfileError::EndsAboveCommand { .. }));
            }
        }
    }
    seen.check();
}

/// Whether the oracle, too, finds no stroke, or only one at the very edge.
fn justified(case: &Case, error: ProfileError) -> bool {
    let (start, end) = case.end_speeds();
    match error {
        ProfileError::EndsAboveCommand { speed, command } => {
            speed == start.max(end) && command == case.command() && speed > command
        }
        ProfileError::TooShort { distance, needed } => {
            let mut shorter = case.clone();
            shorter.stroke.distance *= 1.0 - BOUNDARY;
            distance == case.stroke.distance && needed > distance && shorter.best().is_none()
        }
        _ => false,
    }
}

impl Seen {
    fn count(&mut self, case: &Case, peak: f64, segments: usize) {
        self.most_segments = self.most_segments.max(segments);
        let Law::TorqueCurve(law) = &case.law else {
            let index = match case.law {
                Law::TorqueCurve(_) => 0,
                Law::SCurve(_) => 1,
                Law::SCurveBetween(..) => 2,
                Law::Linear(_) => 3,
                Law::TrapezoidJerk(_) => 4,
                Law::ImprovedSCurve(..) => 5,
            };
            self.planned[index] += 1;
            return;
        };
        self.planned[0] += 1;
        self.clamped += u32::from(case.stroke.command > case.command());
        let first_top = law.bands[0].to_rev_per_s;
        self.start_above_first_band += u32::from(law.start_rev_per_s > first_top);
        self.end_on_band_top += u32::from(law.bands.iter().any(|band| band.to_rev_per_s == law.end_rev_per_s));
        if peak < case.command() * (1.0 - 1e-9) {
            let band = law.bands.iter().position(|band| peak <= band.to_rev_per_s).unwrap_or(0);
            self.peak_in_band[band.min(3)] += 1;
        }
    }

    fn check(&self) {
        let often = [
            &self.planned[..],
            &self.peak_in_band,
            &[self.refused_too_short, self.refused_above_command, self.clamped, self.cruised],
            &[self.start_above_first_band, self.end_on_band_top],
        ];
        assert!(often.concat().iter().all(|count| *count >= 500), "too rare to prove anything: {self:#?}");
        assert_eq!(self.most_segments, 33, "both flanks of 16 bands and a cruise: {self:#?}");
    }
}
