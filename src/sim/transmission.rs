//! Z from motor to tip: screw and table, and the table in two parts where it has a second resonance.

use super::gap::Gap;
use super::inertias::{Chain, Inertias, Tip};
use crate::control::model::two_mass::TwoMass;
use crate::control::units::RAD_PER_REV;

/// Share of the table that the second mode moves: the spindle carrier on its guides.
const TIP_SHARE: f64 = 0.4;

/// Motor, table, and the tip that may swing on the table.
#[derive(Clone, Debug)]
#[allow(clippy::large_enum_variant, reason = "the large one is the standard plant's, which is stepped most")]
pub(crate) enum Transmission {
    Two(Inertias),
    Three(Box<Chain>),
}

impl Transmission {
    /// `second` is resonance with the table held, and damping ratio, of the tip on the table.
    pub(crate) fn new(
        model: TwoMass,
        second: Option<(f64, f64)>,
        gap: Gap,
        viscous: [f64; 2],
        step_s: f64,
        position: f64,
    ) -> Self {
        let Some((hz, damping_ratio)) = second else {
            return Self::Two(Inertias::new(model, gap, viscous, step_s, position));
        };
        let inertia = TIP_SHARE * model.load_inertia;
        let omega = RAD_PER_REV * hz;
        let tip = Tip { inertia, stiffness: inertia * omega * omega, damping: 2.0 * damping_ratio * inertia * omega };
        let model = TwoMass { load_inertia: model.load_inertia - inertia, ..model };
        Self::Three(Box::new(Chain::new(model, tip, gap, viscous, step_s, position)))
    }

    /// One plant step under forces on motor, table and tip.
    #[inline]
    pub(crate) fn step(&mut self, motor_n: f64, table_n: f64, tip_n: f64) {
        match self {
            Self::Two(inertias) => inertias.step(motor_n, table_n + tip_n),
            Self::Three(chain) => chain.step(motor_n, table_n, tip_n),
        }
    }

    /// The forces against motor and table that would bring each to rest by the end of a step.
    pub(crate) fn stopping(&self, motor_n: f64, table_n: f64, tip_n: f64) -> [f64; 2] {
        match self {
            Self::Two(inertias) => inertias.stopping(motor_n, table_n + tip_n),
            Self::Three(chain) => chain.stopping(motor_n, table_n, tip_n),
        }
    }

    pub(crate) fn gap(&mut self) -> &mut Gap {
        match self {
            Self::Two(inertias) => inertias.gap(),
            Self::Three(chain) => chain.gap(),
        }
    }

    #[inline]
    pub(crate) fn motor_position(&self) -> f64 {
        match self {
            Self::Two(inertias) => inertias.motor_position(),
            Self::Three(chain) => chain.motor_position(),
        }
    }

    #[inline]
    pub(crate) fn load_position(&self) -> f64 {
        match self {
            Self::Two(inertias) => inertias.load_position(),
            Self::Three(chain) => chain.load_position(),
        }
    }

    pub(crate) fn tip_position(&self) -> f64 {
        match self {
            Self::Two(inertias) => inertias.load_position(),
            Self::Three(chain) => chain.tip_position(),
        }
    }

    #[inline]
    pub(crate) fn motor_speed(&self) -> f64 {
        match self {
            Self::Two(inertias) => inertias.motor_speed(),
            Self::Three(chain) => chain.motor_speed(),
        }
    }

    #[inline]
    pub(crate) fn load_speed(&self) -> f64 {
        match self {
            Self::Two(inertias) => inertias.load_speed(),
            Self::Three(chain) => chain.load_speed(),
        }
    }
}
