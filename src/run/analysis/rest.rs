//! Whether an axis is at rest, by its counts.

/// An encoder at rest may flicker by so many counts.
pub(super) const STILL_COUNTS: f64 = 1.0;
/// Rest has to last this long to count as one.
const REST_S: f64 = 0.004;
/// At least so many samples belong to a rest.
const REST_SAMPLES: u32 = 3;

/// An axis that stays within a few counts is at rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rest {
    window_counts: f64,
    at: Option<(f64, f64)>,
    now_s: f64,
    samples: u32,
}

impl Rest {
    pub(super) fn of_spindle(counts_per_rev: f64) -> Self {
        Self::within(2e-4 * counts_per_rev)
    }

    pub(super) fn of_z(counts_per_mm: f64) -> Self {
        Self::within(5e-4 * counts_per_mm)
    }

    fn within(counts: f64) -> Self {
        Self { window_counts: counts.max(3.0 * STILL_COUNTS), at: None, now_s: 0.0, samples: 0 }
    }

    pub(super) fn forget(&mut self) {
        self.at = None;
    }

    /// Takes a position; where the axis just left a rest, the position it rested at.
    pub(super) fn update(&mut self, counts: f64, now_s: f64) -> Option<f64> {
        if let Some((at, _)) = self.at
            && (counts - at).abs() <= self.window_counts
        {
            self.now_s = now_s;
            self.samples = self.samples.saturating_add(1);
            return None;
        }
        let left = self.at.filter(|_| self.is_at_rest()).map(|(at, _)| at);
        (self.at, self.now_s, self.samples) = (Some((counts, now_s)), now_s, 1);
        left
    }

    pub(super) fn is_at_rest(&self) -> bool {
        self.samples >= REST_SAMPLES && self.lasted_s() >= REST_S
    }

    /// How long it has been at rest.
    pub(super) fn lasted_s(&self) -> f64 {
        self.at.map_or(0.0, |(_, since_s)| self.now_s - since_s)
    }

    /// Since when.
    pub(super) fn since_s(&self) -> f64 {
        self.at.map_or(self.now_s, |(_, since_s)| since_s)
    }
}
