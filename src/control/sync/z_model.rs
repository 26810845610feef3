//! Z's mechanics as the control knows them: motor and table on a screw with play, friction on both.

use crate::control::machine::Machine;
use crate::control::model::friction::Stribeck;
use crate::control::model::two_mass::TwoMass;
use crate::control::units::{MM_PER_M, m_from_mm, mm_from_m, mm_from_um};

/// Z's mechanics as the machine file says, in mm and N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZModel {
    pub(super) mass_kg: f64,
    /// The table's side of the screw, as a share of the mass and of the friction.
    pub(super) table_mass_share: f64,
    pub(super) table_friction_share: f64,
    pub(super) stiffness_n_per_mm: f64,
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
            stiffness_n_per_mm: TwoMass::of_z(spec).stiffness / MM_PER_M,
            contact: Stribeck {
                coulomb: 1.0,
                static_ratio: spec.static_ratio,
                stribeck_speed: spec.stribeck_mm_per_s,
                presliding: mm_from_um(spec.presliding_um),
            },
        }
    }

    /// Motor less table at constant speed, one direction less the other: backlash and the friction's twist.
    pub(super) fn nominal_lost_motion_mm(machine: &Machine) -> f64 {
        let spec = &machine.spec().z_axis;
        let table_n = spec.coulomb_n * spec.friction_table_share;
        mm_from_um(spec.backlash_um) + mm_from_m(2.0 * table_n / TwoMass::of_z(spec).stiffness)
    }

    /// What is left of a lost motion for play, where the table's friction twists the screw by the rest.
    pub(super) fn play_mm(&self, lost_motion_mm: f64, friction_n: f64) -> f64 {
        (lost_motion_mm - 2.0 * self.table_friction_share * friction_n / self.stiffness_n_per_mm).max(0.0)
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
        self.table_n(acceleration_mm_per_s2) / self.stiffness_n_per_mm
    }
}
