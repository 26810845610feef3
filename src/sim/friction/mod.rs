//! Friction of one contact under several published laws. Written from their papers: nothing here is shared with the
//! control, whose own model must not be flattered by a plant that is built like it.
//!
//! All laws have the level g(v) = Fc·(1 + (s − 1)·exp(−(v/v_s)²)) of Stribeck and start from rest without force.

mod contact_spec;
mod gms;
mod lugre;
mod stribeck;

pub(crate) use contact_spec::ContactSpec;
use gms::Gms;
use lugre::LuGre;
pub(super) use stribeck::{Presliding, preslide};

/// How friction answers to motion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FrictionModel {
    /// Stribeck's level times a pre-sliding state that follows the travel (Dahl 1968).
    #[default]
    Stribeck,
    /// Bristles with an inner damping (Canudas de Wit, Olsson, Åström and Lischinsky 1995).
    LuGre,
    /// Generalised Maxwell slip: elements in parallel that stick or slip, with a memory of the turning points
    /// (Al-Bender, Lampaert and Swevers 2005).
    Gms,
    /// Dry friction: no pre-sliding at all; it holds whatever is below its static level (Karnopp 1985).
    Stick,
}

impl FrictionModel {
    /// Every law, in the order of documentation.
    pub const ALL: [Self; 4] = [Self::Stribeck, Self::LuGre, Self::Gms, Self::Stick];

    /// Name in machine files and reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Stribeck => "stribeck",
            Self::LuGre => "lugre",
            Self::Gms => "gms",
            Self::Stick => "stick",
        }
    }

    /// The law of a name.
    #[must_use]
    pub fn by_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.name() == name)
    }
}

/// One contact with its state.
#[derive(Clone, Debug)]
pub(crate) enum Contact {
    Stribeck(Presliding),
    LuGre(LuGre),
    Gms(Gms),
    Stick(ContactSpec),
}

impl Contact {
    pub(crate) fn new(model: FrictionModel, spec: ContactSpec, step_s: f64) -> Self {
        // Without any level there is nothing to tell the laws apart, and nothing to divide by.
        match model {
            _ if spec.coulomb <= 0.0 => Self::Stribeck(Presliding::new(spec, step_s)),
            FrictionModel::Stribeck => Self::Stribeck(Presliding::new(spec, step_s)),
            FrictionModel::LuGre => Self::LuGre(LuGre::new(spec, step_s)),
            FrictionModel::Gms => Self::Gms(Gms::new(spec, step_s)),
            FrictionModel::Stick => Self::Stick(spec),
        }
    }

    /// The force against the motion over the next step: `speed` at its start, `factor` on the level, and
    /// `asymmetry`, the difference of the level between the directions as a share. `stopping` is the force that would
    /// bring the contact to rest by the end of the step; dry friction alone asks for it.
    #[inline]
    pub(crate) fn force(&mut self, speed: f64, factor: f64, asymmetry: f64, stopping: impl FnOnce() -> f64) -> f64 {
        let uneven = |force: f64| force * (1.0 + asymmetry / 2.0 * force.signum());
        match self {
            Self::Stribeck(contact) => contact.force(speed, factor, asymmetry),
            Self::LuGre(contact) => factor * uneven(contact.force(speed)),
            Self::Gms(contact) => factor * uneven(contact.force(speed)),
            Self::Stick(spec) => {
                let stopping = stopping();
                let most = factor * uneven(spec.level(speed).copysign(stopping)).abs();
                // Implicit: the force that stops it where friction can give that, else all that friction has.
                stopping.clamp(-most, most)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    pub(super) const STEP_S: f64 = 25e-6;
    /// Half of the reference machine's friction on its motor's side.
    pub(super) const SPEC: ContactSpec =
        ContactSpec { coulomb: 150.0, static_ratio: 1.3, stribeck_speed: 0.002, presliding: 5e-6, mass: 400.0 };

    /// Positions and forces of one slow stroke forth and back between ±`amplitude`, after a first one that forgets the start.
    pub(super) fn travel(amplitude: f64, speed: f64, mut force: impl FnMut(f64) -> f64) -> Vec<(f64, f64)> {
        let steps = (2.0 * amplitude / (speed * STEP_S)) as u32;
        let mut x = -amplitude;
        let mut points = Vec::new();
        for stroke in 0..4 {
            let speed = if stroke % 2 == 0 { speed } else { -speed };
            for _ in 0..steps {
                x += speed * STEP_S;
                let found = force(speed);
                if stroke > 1 {
                    points.push((x, found));
                }
            }
        }
        points
    }

    /// A mass on dry friction under a rising force: it does not move at all below the static level, and from there on
    /// the level falls with speed.
    #[test]
    fn stick_holds_up_to_its_static_level() {
        let mut contact = Contact::new(FrictionModel::Stick, SPEC, STEP_S);
        let (mut speed, mut broke_at) = (0.0, None);
        for step in 0..100_000 {
            let applied = 0.01 * f64::from(step);
            let stopping = SPEC.mass * speed / STEP_S + applied;
            let friction = contact.force(speed, 1.0, 0.0, || stopping);
            speed += (applied - friction) / SPEC.mass * STEP_S;
            if applied < 1.3 * SPEC.coulomb {
                assert!(speed.abs() < 1e-15, "{speed} m/s under {applied} N");
            } else {
                broke_at = broke_at.or((speed > 1e-6).then_some(applied));
            }
        }
        let broke_at = broke_at.expect("breaks away");
        assert!((broke_at / (1.3 * SPEC.coulomb) - 1.0).abs() < 0.01, "{broke_at} N");
        let sliding = contact.force(0.1, 1.0, 0.0, || 1e9);
        assert!((sliding - SPEC.coulomb).abs() < 1e-9, "{sliding} N");
    }

    /// The difference of the directions over their mean is the asymmetry, under every law.
    #[test]
    fn asymmetry_is_the_difference_of_the_directions() {
        for model in FrictionModel::ALL {
            let steady = |speed: f64| {
                let mut contact = Contact::new(model, SPEC, STEP_S);
                (0..20_000).map(|_| contact.force(speed, 1.1, 0.2, || 1e9_f64.copysign(speed))).last().unwrap()
            };
            let (up, down) = (steady(0.1), -steady(-0.1));
            assert!(((up - down) / ((up + down) / 2.0) - 0.2).abs() < 1e-6, "{}: {up} and {down} N", model.name());
            assert!((up + down) / 2.0 - 1.1 * SPEC.coulomb < 1e-6);
        }
    }
}
