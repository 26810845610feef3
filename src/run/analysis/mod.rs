//! The monitor of real encoders: finds the synchronous strokes in two streams of counts and judges each hole.
//!
//! A hole begins where the spindle leaves rest and Z follows it in the ratio of the pitch, or where Z leaves rest and
//! takes up the ratio to a spindle that turns already (LinuxCNC). It ends where the spindle comes to rest with Z back at
//! its start, or, with a spindle that turns on, where Z is back. The zero of e(k) is the last sample before that
//! movement. e(k) is [`synchronisation_error_mm`](crate::control::sync::synchronisation_error_mm) of these travels and
//! nothing else: nothing is fitted, averaged or taken off. What is estimated from the data stands apart, in [`Estimates`].

mod candidate;
mod estimate;
mod hole;
mod listener;
mod pitch;
mod point;
mod rest;
mod row;
mod settings;
mod stroke;
mod travel;

use std::collections::VecDeque;

pub use estimate::Estimates;
pub use hole::{InOutOffset, Judgement, LeadIn, MeasuredHole, Reversal};
pub use listener::{AnalysisListener, Cutting};
pub use pitch::PitchFinder;
pub use row::MeasuredRow;
pub use settings::AnalysisSettings;
pub use stroke::MeasuredStroke;

use crate::link::sample::{Gap, Sample};

use candidate::{Candidate, Next};
use rest::Rest;

/// Samples kept before a movement, to find its beginning: the zero lies among them.
const RECENT: usize = 512;

/// Takes samples in their order.
#[derive(Clone, Debug)]
pub struct Analysis {
    settings: AnalysisSettings,
    spindle: Rest,
    z: Rest,
    recent: VecDeque<Sample>,
    last: Option<Sample>,
    candidate: Option<Candidate>,
    holes: u32,
}

impl Analysis {
    /// Before the first sample.
    #[must_use]
    pub fn new(settings: AnalysisSettings) -> Self {
        Self {
            settings,
            spindle: Rest::of_spindle(settings.scale.counts_per_rev),
            z: Rest::of_z(settings.scale.counts_per_mm),
            recent: VecDeque::with_capacity(RECENT + 1),
            last: None,
            candidate: None,
            holes: 0,
        }
    }

    /// True while a hole is under way.
    #[must_use]
    pub fn is_cutting(&self) -> bool {
        self.candidate.as_ref().is_some_and(Candidate::is_hole)
    }

    /// Takes one sample.
    pub fn push(&mut self, mut sample: Sample, listener: &mut dyn AnalysisListener) {
        if let Some(last) = self.last
            && sample.k != last.k.wrapping_add(1)
        {
            sample.gap = sample.gap.max(Gap::Readings);
        }
        self.last = Some(sample);
        if sample.gap == Gap::Origin {
            self.end(listener, Next::Broken);
            self.flush(listener);
            self.spindle.forget();
            self.z.forget();
        }
        let spindle_left = self.spindle.update(sample.spindle_counts, sample.time_s);
        let z_left = self.z.update(sample.z_counts, sample.time_s);
        match &mut self.candidate {
            Some(candidate) => {
                let next = candidate.push(sample, &self.spindle, &self.z, self.holes + 1, listener);
                if next != Next::Go {
                    self.end(listener, next);
                }
            }
            None => {
                self.recent.push_back(sample);
                // Z sets off while the spindle turns, and towards the hole.
                let running = z_left && !self.spindle.is_at_rest() && self.z_falls();
                if spindle_left || running {
                    self.begin(!spindle_left, listener);
                } else if self.recent.len() > RECENT {
                    self.recent.pop_front().into_iter().for_each(|sample| listener.row(&outside(sample)));
                }
            }
        }
    }

    /// No more samples come.
    pub fn finish(&mut self, listener: &mut dyn AnalysisListener) {
        self.end(listener, Next::Broken);
        self.flush(listener);
    }

    fn z_falls(&self) -> bool {
        let back = self.recent.len().saturating_sub(3);
        matches!((self.recent.get(back), self.recent.back()), (Some(then), Some(now)) if now.z_counts < then.z_counts)
    }

    /// A movement began: its zero is where the axis was last still.
    fn begin(&mut self, running: bool, listener: &mut dyn AnalysisListener) {
        // The last millisecond without speed, and its beginning: at its end the axis may have crept off already.
        let still_since = |last: usize| {
            let to = self.recent.get(last)?;
            let first = self.recent.range(..last).rposition(|from| to.time_s - from.time_s >= rest::STILL_S)?;
            let from = self.recent.get(first)?;
            let seconds = to.time_s - from.time_s;
            let still = if running {
                self.z.is_still(to.z_counts - from.z_counts, seconds)
            } else {
                self.spindle.is_still(to.spindle_counts - from.spindle_counts, seconds)
            };
            // A turning spindle goes on in that millisecond: there its end is the better beginning.
            still.then_some(if running { last } else { first })
        };
        let zero = (1..self.recent.len()).rev().find_map(still_since).unwrap_or(0);
        let zero = if running { zero } else { self.slowest_before(zero) };
        self.recent.drain(..zero).for_each(|sample| listener.row(&outside(sample)));
        let mut candidate = Candidate::new(self.settings, running);
        let mut next = Next::Go;
        for sample in self.recent.drain(..) {
            next = candidate.push(sample, &self.spindle, &self.z, self.holes + 1, listener);
        }
        self.candidate = Some(candidate);
        if next != Next::Go {
            self.end(listener, next);
        }
    }

    /// A smooth law creeps off by some counts before it shows a speed, and a spindle that just came to rest creeps on:
    /// in between, at most some milliseconds before, it was slowest.
    fn slowest_before(&self, from: usize) -> usize {
        let way = |index: usize| {
            let to = self.recent.get(index)?;
            let before = self.recent.range(..index).rfind(|then| to.time_s - then.time_s >= rest::CREEP_S)?;
            Some((to.spindle_counts - before.spindle_counts).abs())
        };
        let Some(latest_s) = self.recent.get(from).map(|sample| sample.time_s) else { return from };
        let (mut slowest, mut least) = (from, f64::INFINITY);
        for index in (0..=from).rev() {
            let near = self.recent.get(index).is_some_and(|sample| latest_s - sample.time_s <= rest::CREEPS_S);
            let Some(way) = way(index).filter(|way| near && *way <= least + rest::FLICKER_COUNTS) else { break };
            if way < least {
                (slowest, least) = (index, way);
            }
            if way == 0.0 {
                break;
            }
        }
        slowest
    }

    /// Ends the movement under way: a hole is judged, anything else was none.
    fn end(&mut self, listener: &mut dyn AnalysisListener, next: Next) {
        let Some(candidate) = self.candidate.take() else { return };
        let number = self.holes + 1;
        let samples = match candidate.finish(next, number) {
            Ok((hole, rows, rest)) => {
                self.holes = number;
                rows.iter().for_each(|row| listener.row(row));
                listener.hole(&hole);
                rest
            }
            Err(samples) => samples,
        };
        // What came after a hole may already be the beginning of the next.
        let skipped = samples.len().saturating_sub(RECENT);
        for (index, sample) in samples.into_iter().enumerate() {
            if index < skipped {
                listener.row(&outside(sample));
            } else {
                self.recent.push_back(sample);
            }
        }
    }

    fn flush(&mut self, listener: &mut dyn AnalysisListener) {
        self.recent.drain(..).for_each(|sample| listener.row(&outside(sample)));
    }
}

const fn outside(sample: Sample) -> MeasuredRow {
    MeasuredRow { sample, hole: 0, kind: None, error_um: None }
}
