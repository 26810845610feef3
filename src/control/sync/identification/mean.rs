//! Exponentially weighted means: older holes count less.

/// Share of older values' weight that each new hole leaves.
pub(super) const KEPT_BY_HOLE: f64 = 0.7;

/// A mean of values that count alike within a hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Mean {
    pub(super) sum: f64,
    pub(super) weight: f64,
}

impl Mean {
    pub(super) fn add(&mut self, value: f64) {
        self.sum += value;
        self.weight += 1.0;
    }

    pub(super) fn mean(&self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.sum / self.weight)
    }

    /// The mean with a prior value that counts as one more.
    pub(super) fn with_prior(&self, prior: f64) -> f64 {
        (self.sum + prior) / (self.weight + 1.0)
    }

    pub(super) fn decay(&mut self) {
        self.sum *= KEPT_BY_HOLE;
        self.weight *= KEPT_BY_HOLE;
    }
}
