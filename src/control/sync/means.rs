//! Means that fade from hole to hole.

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

    /// The mean, with a value known beforehand that counts as one more.
    pub(super) fn or(&self, prior: f64) -> f64 {
        (self.sum + prior) / (self.weight + 1.0)
    }

    pub(super) fn fade(&mut self) {
        self.sum *= KEPT_BY_HOLE;
        self.weight *= KEPT_BY_HOLE;
    }
}

/// The same measured while Z moves, or pushes, out of the hole and into it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct BothWays {
    pub(super) outwards: Mean,
    pub(super) inwards: Mean,
}

impl BothWays {
    /// That of a way, by the sign of Z's speed or force in machine coordinates.
    pub(super) fn of(&mut self, machine_sign: f64) -> &mut Mean {
        if machine_sign < 0.0 { &mut self.inwards } else { &mut self.outwards }
    }

    /// Outwards and inwards, where both were seen.
    pub(super) fn means(&self) -> Option<(f64, f64)> {
        self.outwards.mean().zip(self.inwards.mean())
    }

    pub(super) fn least_weight(&self) -> f64 {
        self.outwards.weight.min(self.inwards.weight)
    }

    pub(super) fn fade(&mut self) {
        self.outwards.fade();
        self.inwards.fade();
    }
}
