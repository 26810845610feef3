//! Parameters of a contact, and Stribeck's level, which all laws share.

use crate::control::math::exp;

/// Beyond this many Stribeck speeds the exponential is below 1e-7 and is not worth its time.
const DECAYED: f64 = 4.0;

/// The friction level at a speed, always positive.
#[inline(always)]
fn level(coulomb: f64, static_ratio: f64, stribeck_speed: f64, speed: f64) -> f64 {
    if speed.abs() > DECAYED * stribeck_speed {
        return coulomb;
    }
    let ratio = speed / stribeck_speed;
    coulomb * (1.0 + (static_ratio - 1.0) * exp(-ratio * ratio))
}

/// Parameters of a contact, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ContactSpec {
    /// Coulomb level Fc.
    pub(crate) coulomb: f64,
    /// Static over Coulomb level s, 1 or more.
    pub(crate) static_ratio: f64,
    /// Stribeck speed v_s.
    pub(crate) stribeck_speed: f64,
    /// Travel over which friction builds up.
    pub(crate) presliding: f64,
    /// Mass that rests on the contact.
    pub(crate) mass: f64,
}

impl ContactSpec {
    /// The level g at a speed.
    #[inline]
    pub(super) fn level(&self, speed: f64) -> f64 {
        level(self.coulomb, self.static_ratio, self.stribeck_speed, speed)
    }
}
