//! The nominal pitch, where nobody says it.

use crate::control::thread::METRIC_COARSE;
use crate::link::sample::{Gap, Sample, Scale};

/// Chords are this long.
const CHORD_S: f64 = 0.01;
/// Slower than this a chord says little of the pitch.
const LEAST_REV_PER_S: f64 = 2.0;
/// A chord belongs to a pitch within this share.
const NEAR: f64 = 0.03;
/// So many chords make a pitch.
const LEAST_CHORDS: usize = 10;

/// Takes samples in their order, and finds the pitch of the coarse series that most of the movement has.
#[derive(Clone, Debug)]
pub struct PitchFinder {
    scale: Scale,
    votes: [usize; METRIC_COARSE.len()],
    from: Option<Sample>,
}

impl PitchFinder {
    /// Before the first sample.
    #[must_use]
    pub fn new(scale: Scale) -> Self {
        Self { scale, votes: [0; METRIC_COARSE.len()], from: None }
    }

    /// Takes one sample.
    pub fn push(&mut self, sample: &Sample) {
        if sample.gap != Gap::None {
            self.from = None;
        }
        let start = *self.from.get_or_insert(*sample);
        let seconds = sample.time_s - start.time_s;
        if seconds < CHORD_S {
            return;
        }
        self.from = Some(*sample);
        let way_rev = ((sample.spindle_counts - start.spindle_counts) / self.scale.counts_per_rev).abs();
        let way_mm = ((sample.z_counts - start.z_counts) / self.scale.counts_per_mm).abs();
        if way_rev < LEAST_REV_PER_S * seconds {
            return;
        }
        for (votes, size) in self.votes.iter_mut().zip(METRIC_COARSE) {
            *votes += usize::from((way_mm / way_rev / size.pitch_mm - 1.0).abs() <= NEAR);
        }
    }

    /// The pitch; none where none has it clearly.
    #[must_use]
    pub fn pitch_mm(&self) -> Option<f64> {
        let (votes, size) = self.votes.into_iter().zip(METRIC_COARSE).max_by_key(|(votes, _)| *votes)?;
        (votes >= LEAST_CHORDS).then_some(size.pitch_mm)
    }
}
