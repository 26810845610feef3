//! Z's mechanics as the control knows them: motor and table on a screw with play, friction on both.

use crate::control::machine::{Machine, ZEncoderAt};
use crate::control::model::friction::Stribeck;
use crate::control::model::two_mass::TwoMass;
use crate::control::units::{MM_PER_M, m_from_mm, mm_from_um};

/// Speed above which friction is sliding friction, in Stribeck speeds.
const SLIDING_STRIBECK: f64 = 4.0;

/// Z's mechanics as the machine file says, in mm and N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZModel {
    mass_kg: f64,
    /// The table's side of the screw, as a share of the mass and of the friction.
    pub(super) table_mass_share: f64,
    pub(super) table_friction_share: f64,
    /// Of the screw; 0 where the only encoder is the motor's: what is lost behind it is not seen.
    pub(super) compliance_mm_per_n: f64,
    /// Of a friction of 1.
    pub(super) contact: Stribeck,
}

impl ZModel {
    pub(super) fn new(machine: &Machine) -> Self {
        let spec = &machine.spec().z_axis;
        Self {
            mass_kg: spec.mass_kg,
            table_mass_share: spec.table_share,
            table_friction_share: spec.friction_table_share,
            compliance_mm_per_n: match spec.encoder_at {
                ZEncoderAt::Table => MM_PER_M / TwoMass::of_z(spec).stiffness,
                ZEncoderAt::Motor => 0.0,
            },
            contact: Stribeck {
                coulomb: 1.0,
                static_ratio: spec.static_ratio,
                stribeck_speed: spec.stribeck_mm_per_s,
                presliding: mm_from_um(spec.presliding_um),
            },
        }
    }

    /// Backlash that can be seen.
    pub(super) fn nominal_play_mm(machine: &Machine) -> f64 {
        match machine.spec().z_axis.encoder_at {
            ZEncoderAt::Table => mm_from_um(machine.spec().z_axis.backlash_um),
            ZEncoderAt::Motor => 0.0,
        }
    }

    /// Friction's twist of the screw, one direction less the other.
    pub(super) fn twist_mm(&self, friction_n: f64) -> f64 {
        2.0 * self.table_friction_share * friction_n * self.compliance_mm_per_n
    }

    /// Beyond this speed friction is sliding friction.
    pub(super) fn sliding_mm_per_s(&self) -> f64 {
        SLIDING_STRIBECK * self.contact.stribeck_speed
    }

    /// Force that accelerates all of Z.
    pub(super) fn inertia_n(&self, acceleration_mm_per_s2: f64) -> f64 {
        self.mass_kg * m_from_mm(acceleration_mm_per_s2)
    }

    /// Force that accelerates the table.
    pub(super) fn table_n(&self, acceleration_mm_per_s2: f64) -> f64 {
        self.table_mass_share * self.inertia_n(acceleration_mm_per_s2)
    }

    /// Stretch of the screw in mm under an acceleration of the table.
    pub(super) fn stretch_mm(&self, acceleration_mm_per_s2: f64) -> f64 {
        self.table_n(acceleration_mm_per_s2) * self.compliance_mm_per_n
    }
}
