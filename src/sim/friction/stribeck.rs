//! Stribeck's level with a pre-sliding state: Dahl's model with exponent 1.

use super::contact_spec::ContactSpec;

/// The pre-sliding state, −1…1, after a travel, which is given over the pre-sliding travel.
///
/// Implicit: the explicit form of the same equation, ż = v − |v|·z/z_max, blows up where v·Δt passes z_max.
#[inline(always)]
pub(in crate::sim) fn preslide(state: f64, travel_ratio: f64) -> f64 {
    (state + travel_ratio) / (1.0 + travel_ratio.abs())
}

/// The contact with its state.
#[derive(Clone, Debug)]
pub(crate) struct Presliding {
    spec: ContactSpec,
    /// Share of the pre-sliding travel that one step at 1 m/s covers.
    step_per_presliding: f64,
    state: f64,
}

impl Presliding {
    pub(super) fn new(spec: ContactSpec, step_s: f64) -> Self {
        Self { spec, step_per_presliding: step_s / spec.presliding, state: 0.0 }
    }

    #[inline(always)]
    pub(crate) fn force(&mut self, speed: f64, factor: f64, asymmetry: f64) -> f64 {
        self.state = preslide(self.state, speed * self.step_per_presliding);
        let directed = self.state * (1.0 + asymmetry / 2.0 * self.state.signum());
        self.spec.level(speed) * factor * directed
    }
}
