//! Two inertias on a spring: the spindle's torsion and Z's screw.

use crate::control::machine::ZSpec;
use crate::control::units::RAD_PER_REV;

/// A driven and a driven-off inertia, the spring and the damper between them, in one consistent set of SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwoMass {
    /// The motor's side.
    pub motor_inertia: f64,
    /// The load's side.
    pub load_inertia: f64,
    /// Spring between them.
    pub stiffness: f64,
    /// Damper between them.
    pub damping: f64,
}

impl TwoMass {
    /// From the resonance of both sides free, ω² = k·(1/J1 + 1/J2).
    #[must_use]
    pub fn free_free(motor_inertia: f64, load_inertia: f64, resonance_hz: f64, damping_ratio: f64) -> Self {
        let reduced = motor_inertia * load_inertia / (motor_inertia + load_inertia);
        Self::with_mode(motor_inertia, load_inertia, reduced, resonance_hz, damping_ratio)
    }

    /// From the resonance of the load with the motor's side held, ω² = k/J2.
    #[must_use]
    pub fn motor_held(motor_inertia: f64, load_inertia: f64, resonance_hz: f64, damping_ratio: f64) -> Self {
        Self::with_mode(motor_inertia, load_inertia, load_inertia, resonance_hz, damping_ratio)
    }

    /// Z's motor and table on its screw, as the machine file says.
    #[must_use]
    pub fn of_z(spec: &ZSpec) -> Self {
        let table_kg = spec.mass_kg * spec.table_share;
        Self::motor_held(spec.mass_kg - table_kg, table_kg, spec.resonance_hz, spec.damping_ratio)
    }

    fn with_mode(motor_inertia: f64, load_inertia: f64, modal: f64, resonance_hz: f64, damping_ratio: f64) -> Self {
        let omega = RAD_PER_REV * resonance_hz;
        Self {
            motor_inertia,
            load_inertia,
            stiffness: modal * omega * omega,
            damping: 2.0 * damping_ratio * modal * omega,
        }
    }

    /// A of ẋ = A·x + B·u with x = (deflection = motor − load, motor speed, load speed).
    #[must_use]
    pub fn state_matrix(&self) -> [[f64; 3]; 3] {
        let Self { motor_inertia: jm, load_inertia: jl, stiffness: k, damping: d } = *self;
        [[0.0, 1.0, -1.0], [-k / jm, -d / jm, d / jm], [k / jl, d / jl, -d / jl]]
    }

    /// B of the same, with u = (effort on the motor, effort on the load).
    #[must_use]
    pub fn input_matrix(&self) -> [[f64; 2]; 3] {
        [[0.0, 0.0], [1.0 / self.motor_inertia, 0.0], [0.0, 1.0 / self.load_inertia]]
    }
}
