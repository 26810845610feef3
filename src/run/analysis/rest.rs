//! Whether an axis is at rest, by its counts. A real axis creeps and rings there for a while.

use std::collections::VecDeque;

/// Speeds are taken over this time.
pub(super) const CHORD_S: f64 = 0.004;
/// Many more samples than any line's rate makes of that.
const MOST_IN_CHORD: usize = 4096;
/// Rest has to last this long to count as one.
const REST_S: f64 = 0.004;
/// Over this time, a little less than a millisecond so that one of a 1 kHz line is enough, a still axis shows no speed.
pub(super) const STILL_S: f64 = 0.9e-3;
/// Over this time the slow beginning of a movement is told from rest.
pub(super) const CREEP_S: f64 = 1.9e-3;
/// And so long it may last.
pub(super) const CREEPS_S: f64 = 10e-3;
/// An encoder at rest flickers by so many counts.
pub(super) const FLICKER_COUNTS: f64 = 1.0;

/// An axis that stays slow is at rest.
#[derive(Clone, Debug)]
pub(super) struct Rest {
    /// Per second: at rest up to this, no longer from twice that; still, up to half.
    slow_counts: f64,
    chord: VecDeque<(f64, f64)>,
    slow_since_s: Option<f64>,
    now_s: f64,
    left_s: f64,
}

impl Rest {
    pub(super) fn of_spindle(counts_per_rev: f64) -> Self {
        Self::below(0.25 * counts_per_rev)
    }

    pub(super) fn of_z(counts_per_mm: f64) -> Self {
        Self::below(0.5 * counts_per_mm)
    }

    fn below(slow_counts: f64) -> Self {
        Self { slow_counts, chord: VecDeque::new(), slow_since_s: None, now_s: 0.0, left_s: 0.0 }
    }

    pub(super) fn forget(&mut self) {
        self.chord.clear();
        self.slow_since_s = None;
    }

    /// Takes a position; true where the axis just left a rest.
    pub(super) fn update(&mut self, counts: f64, now_s: f64) -> bool {
        self.now_s = now_s;
        self.chord.push_back((now_s, counts));
        // The newest that is old enough stays first.
        while self.chord.get(1).is_some_and(|(then_s, _)| now_s - then_s >= CHORD_S) {
            self.chord.pop_front();
        }
        // A clock that stands still must not fill the memory.
        if self.chord.len() > MOST_IN_CHORD {
            self.chord.pop_front();
        }
        let Some((then_s, then)) = self.chord.front().copied().filter(|(then_s, _)| now_s - then_s >= CHORD_S) else {
            return false;
        };
        let way = (counts - then).abs();
        let allowed = |factor: f64| factor * self.slow_counts * (now_s - then_s) + FLICKER_COUNTS;
        match self.slow_since_s {
            None if way <= allowed(1.0) => self.slow_since_s = Some(then_s),
            Some(since_s) if way > allowed(2.0) => {
                self.slow_since_s = None;
                self.left_s = now_s;
                return now_s - since_s >= CHORD_S + REST_S;
            }
            _ => {}
        }
        false
    }

    /// True where a way in such a time is that of an axis at rest.
    pub(super) fn is_still(&self, way_counts: f64, seconds: f64) -> bool {
        way_counts.abs() <= 0.5 * self.slow_counts * seconds + FLICKER_COUNTS
    }

    pub(super) fn is_at_rest(&self) -> bool {
        self.slow_since_s.is_some()
    }

    /// How long it has been at rest.
    pub(super) fn lasted_s(&self) -> f64 {
        self.slow_since_s.map_or(0.0, |since_s| self.now_s - since_s)
    }

    /// How long it has been moving.
    pub(super) fn moving_s(&self) -> f64 {
        if self.is_at_rest() { 0.0 } else { self.now_s - self.left_s }
    }

    /// When it came to rest.
    pub(super) fn since_s(&self) -> f64 {
        self.slow_since_s.unwrap_or(self.now_s)
    }
}
