//! Z's sliding friction and its weight, from the force of its drive less what accelerates it.

use super::mean::Mean;

/// Windows in each direction from which on a pair of means tells weight from friction.
const BOTH_DIRECTIONS_WINDOWS: f64 = 8.0;

/// Friction and weight, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Forces {
    /// Force that holds Z up in both directions.
    pub(super) weight_n: f64,
    pub(super) friction_n: f64,
}

/// A bidirectional mean: force on a Z that slides into the hole, and out of it; positive into the hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct FrictionFit {
    inwards: Mean,
    outwards: Mean,
}

impl FrictionFit {
    /// A window in a direction, 1 into the hole or −1, with its mean force less the inertial one.
    pub(super) fn add(&mut self, direction: f64, force_n: f64) {
        if direction > 0.0 { self.inwards.add(force_n) } else { self.outwards.add(force_n) }
    }

    pub(super) fn decay(&mut self) {
        self.inwards.decay();
        self.outwards.decay();
    }

    /// What fits best by now, with the file's friction as prior.
    pub(super) fn identified(&self, file_n: f64) -> Forces {
        let Self { inwards, outwards } = self;
        let weight_n = match inwards.mean().zip(outwards.mean()) {
            Some((in_n, out_n)) if inwards.weight.min(outwards.weight) >= BOTH_DIRECTIONS_WINDOWS => {
                -0.5 * (in_n + out_n)
            }
            _ => 0.0,
        };
        let friction = Mean {
            sum: inwards.sum - outwards.sum - weight_n * (outwards.weight - inwards.weight),
            weight: outwards.weight + inwards.weight,
        };
        Forces { weight_n, friction_n: friction.with_prior(file_n) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Forces, FrictionFit};

    fn after(windows: u32) -> Forces {
        let mut fit = FrictionFit::default();
        for _ in 0..windows {
            // 250 N of friction, and 100 N that hold Z up.
            fit.add(1.0, 250.0 - 100.0);
            fit.add(-1.0, -250.0 - 100.0);
        }
        fit.identified(300.0)
    }

    #[test]
    fn both_directions_tell_weight_from_friction() {
        let Forces { weight_n, friction_n } = after(500);
        assert!((weight_n - 100.0).abs() < 1e-9 && (friction_n - 250.0).abs() < 0.06, "{weight_n} {friction_n}");
    }

    #[test]
    fn few_windows_tell_no_weight_and_none_tell_nothing() {
        assert_eq!(after(7).weight_n, 0.0);
        assert_eq!(after(0), Forces { weight_n: 0.0, friction_n: 300.0 });
    }
}
