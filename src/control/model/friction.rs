//! Friction with a Stribeck level and a pre-sliding state, stable at any speed and step.

use crate::control::math::exp;

/// Parameters of one sliding contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stribeck {
    /// Coulomb level, N or N·m.
    pub coulomb: f64,
    /// Breakaway over Coulomb level, 1 or more.
    pub static_ratio: f64,
    /// Speed over which the level falls from static to Coulomb; same unit as the speed given.
    pub stribeck_speed: f64,
    /// Travel over which friction builds up after a reversal.
    pub presliding: f64,
}

/// Beyond this many Stribeck speeds the exponential is below 1e-7 and is not worth its time.
const DECAYED: f64 = 4.0;

impl Stribeck {
    /// Friction level at a speed, always positive.
    #[must_use]
    pub fn level(&self, speed: f64) -> f64 {
        if speed.abs() > DECAYED * self.stribeck_speed {
            return self.coulomb;
        }
        let ratio = speed / self.stribeck_speed;
        self.coulomb * (1.0 + (self.static_ratio - 1.0) * exp(-ratio * ratio))
    }

    /// The pre-sliding state, −1…1, after a step of `step_s` at a speed.
    ///
    /// Implicit: the explicit form of the same equation, ż = v − |v|·z/z_max, blows up where v·Δt passes z_max.
    ///
    /// ```
    /// use rigidtap::control::model::friction::Stribeck;
    /// let contact = Stribeck { coulomb: 150.0, static_ratio: 1.3, stribeck_speed: 2.0, presliding: 0.005 };
    /// assert_eq!(contact.preslide(0.0, 0.0, 1e-3), 0.0);
    /// let sliding = (0..100).fold(0.0, |state, _| contact.preslide(state, 500.0, 1e-3));
    /// assert!((sliding - 1.0).abs() < 1e-9);
    /// ```
    #[must_use]
    pub fn preslide(&self, state: f64, speed: f64, step_s: f64) -> f64 {
        preslide(state, speed * step_s / self.presliding)
    }
}

/// The pre-sliding state after a travel, which is given over [`Stribeck::presliding`].
#[must_use]
pub fn preslide(state: f64, travel_ratio: f64) -> f64 {
    (state + travel_ratio) / (1.0 + travel_ratio.abs())
}

/// The same, exact, after a travel of any length one way: the steps of [`preslide`] made infinitely short.
#[must_use]
pub fn preslide_one_way(state: f64, travel_ratio: f64) -> f64 {
    let end = 1f64.copysign(travel_ratio);
    end + (state - end) * exp(-travel_ratio.abs())
}
