//! What the control knows of the plant: first what the machine file says, then what identification measured.

use core::f64::consts::TAU;

use crate::control::cycle::CyclePlan;
use crate::control::machine::{Machine, Takes};
use crate::control::math::{cos, sin};
use crate::control::model::closed_loop::ClosedLoop;
use crate::control::model::cutting::engagement;
use crate::control::model::friction::Stribeck;
use crate::control::model::two_mass::TwoMass;
use crate::control::units::{MM_PER_M, m_from_mm, mm_from_um};

use super::frame::sees_deflection;

/// Speed above which friction is sliding friction, in Stribeck speeds.
const SLIDING_STRIBECK: f64 = 4.0;
/// Force on the screw, as a share of the load's friction, at which it stands halfway to a flank.
const FLANK_SHARE: f64 = 0.2;

/// What was measured of the spindle, against what its file says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentifiedSpindle {
    /// Inertia per torque constant, over the file's.
    pub inertia_ratio: f64,
    /// The motor's torque limit, over the file's curve.
    pub torque_limit_ratio: f64,
    /// Torque against the turning beyond the file's friction, N·m.
    pub drag_nm: f64,
}

impl IdentifiedSpindle {
    /// As the file says.
    pub const NOMINAL: Self = Self { inertia_ratio: 1.0, torque_limit_ratio: 1.0, drag_nm: 0.0 };
}

/// What was measured of Z, or else its file says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentifiedZ {
    /// Coulomb friction, mean of both directions, N.
    pub friction_n: f64,
    /// Viscous friction beside it, N·s/mm.
    pub viscous_n_s_per_mm: f64,
    /// Force that holds Z up at constant speed in both directions: weight that nothing balances, N.
    pub weight_n: f64,
    /// Lost motion in mm: motor less load at constant speed into the hole, less the same out of it. It is backlash and what
    /// friction winds up the screw; the reversal value of ISO 230-2, measured between two encoders.
    pub lost_motion_mm: f64,
    /// The screw's compliance, over the file's: its resonance falls with the root.
    pub compliance_ratio: f64,
    /// Motor–load deflection in the middle of the lost motion in mm, positive into the hole; none until Z moved both ways.
    pub deflection_middle_mm: Option<f64>,
    /// What the screw's pitch error adds to that deflection along the way.
    pub pitch_error: PitchError,
    /// With which the tap draws Z along.
    pub axial: AxialForce,
}

/// Force of a fully engaged tap along its travel, N: positive draws it in, and out on the way out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxialForce {
    /// On the way in.
    pub in_n: f64,
    /// On the way out.
    pub out_n: f64,
}

impl AxialForce {
    /// As the machine's file says: on the way out less, as the torque is.
    #[must_use]
    pub fn told(machine: &Machine) -> Self {
        let tap = &machine.spec().tap;
        Self { in_n: tap.axial_n, out_n: tap.out_torque_ratio * tap.axial_n }
    }

    /// On Z, positive into the hole, where the tap is on its way into it: −1 out of it, 1 into it, and between them at a reversal.
    pub(super) fn on_z_n(&self, inwards: f64, engagement: f64) -> f64 {
        0.5 * engagement * ((1.0 + inwards) * self.in_n - (1.0 - inwards) * self.out_n)
    }
}

/// Where a tap cuts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// Place of the work piece's surface.
    pub(super) surface_mm: f64,
    /// Travel over which the tap comes to cut whole.
    pub(super) chamfer_mm: f64,
    /// Torque on the way out over that on the way in.
    pub(super) out_ratio: f64,
}

impl Cut {
    /// In a hole whose R plane is at a place, positive into the hole.
    pub(super) fn of(plan: &CyclePlan, r_plane_mm: f64) -> Self {
        let tap = &plan.machine().spec().tap;
        let chamfer_mm = tap.ramp_pitches * plan.thread().pitch_mm;
        Self { surface_mm: r_plane_mm + tap.surface_below_r_mm, chamfer_mm, out_ratio: tap.out_torque_ratio }
    }

    /// Share of the tap that cuts with its tip at a place.
    pub(super) fn engagement_at(&self, tip_mm: f64) -> f64 {
        engagement(tip_mm - self.surface_mm, self.chamfer_mm)
    }
}

/// The pitch error of a screw, once a turn: by how much the motor leads the load, positive into the hole, at a place of Z's
/// encoder that is positive into the hole, too.
///
/// ```
/// use rigidtap::control::sync::PitchError;
/// let error = PitchError { lead_mm: 10.0, sin_mm: 0.003, cos_mm: 0.0 };
/// assert!((error.at(2.5) - 0.003).abs() < 1e-12 && (error.at(7.5) + 0.003).abs() < 1e-12);
/// assert_eq!(PitchError::NONE.at(2.5), 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PitchError {
    /// Lead of the screw, mm, above 0.
    pub lead_mm: f64,
    /// Amplitude of the sine, mm.
    pub sin_mm: f64,
    /// Amplitude of the cosine, mm.
    pub cos_mm: f64,
}

impl PitchError {
    /// No error.
    pub const NONE: Self = Self { lead_mm: 10.0, sin_mm: 0.0, cos_mm: 0.0 };

    /// At a place, mm.
    #[must_use]
    pub fn at(&self, load_mm: f64) -> f64 {
        if self.sin_mm == 0.0 && self.cos_mm == 0.0 {
            return 0.0;
        }
        let angle = TAU * load_mm / self.lead_mm;
        self.sin_mm * sin(angle) + self.cos_mm * cos(angle)
    }

    /// The mean from one place to another, mm.
    pub(super) fn mean(&self, from_mm: f64, to_mm: f64) -> f64 {
        let half_angle = TAU / 2.0 * (to_mm - from_mm) / self.lead_mm;
        let share = if half_angle.abs() > 1e-3 { sin(half_angle) / half_angle } else { 1.0 };
        share * self.at(0.5 * (from_mm + to_mm))
    }
}

impl IdentifiedZ {
    /// How far Z's motor leads the load into the hole, for their deflection; none where that is not known.
    pub(super) fn deflection_from_middle_mm(&self, deflection_mm: Option<f64>) -> Option<f64> {
        Some(deflection_mm? - self.deflection_middle_mm?)
    }
}

/// From a setpoint's period to the instant at which each drive has it in force, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentifiedLatency {
    /// The spindle's drive.
    pub spindle_s: f64,
    /// Z's drive.
    pub z_s: f64,
}

impl IdentifiedLatency {
    /// As the machine's file says.
    #[must_use]
    pub fn nominal(machine: &Machine) -> Self {
        let spec = machine.spec();
        let told_s = spec.drive.latency_periods * spec.control.period_s;
        Self { spindle_s: told_s, z_s: told_s }
    }
}

/// The loops of both drives. They are as the machine's file says where a drive is told velocity or torque, too: little of what it
/// does hangs on them then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentifiedDrives {
    /// The spindle's, in rev.
    pub spindle: ClosedLoop,
    /// Z's, in mm.
    pub z: ClosedLoop,
}

impl IdentifiedDrives {
    /// As the machine's file says.
    #[must_use]
    pub fn nominal(machine: &Machine) -> Self {
        let drive = &machine.spec().drive;
        Self { spindle: ClosedLoop::of_spindle(drive), z: ClosedLoop::of_z(drive) }
    }
}

/// What was measured of a machine in place of what its file says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identified {
    /// Of the spindle.
    pub spindle: IdentifiedSpindle,
    /// Of Z.
    pub z: IdentifiedZ,
    /// Of the bus and both drives.
    pub latency: IdentifiedLatency,
    /// Of both drives' loops, where they take a position alone.
    pub drives: IdentifiedDrives,
}

impl Identified {
    /// What the machine's file says.
    ///
    /// ```
    /// use rigidtap::control::{machine::Machine, sync::Identified};
    /// let nominal = Identified::nominal(&Machine::reference());
    /// assert_eq!((nominal.z.friction_n, nominal.spindle.inertia_ratio), (300.0, 1.0));
    /// ```
    #[must_use]
    pub fn nominal(machine: &Machine) -> Self {
        let (model, friction_n) = (ZModel::new(machine), machine.spec().z_axis.coulomb_n);
        Self {
            spindle: IdentifiedSpindle::NOMINAL,
            z: IdentifiedZ {
                friction_n,
                viscous_n_s_per_mm: 0.0,
                weight_n: 0.0,
                lost_motion_mm: model.backlash_mm + model.friction_deflection_mm(friction_n),
                compliance_ratio: 1.0,
                deflection_middle_mm: None,
                pitch_error: PitchError::NONE,
                axial: AxialForce::told(machine),
            },
            latency: IdentifiedLatency::nominal(machine),
            drives: IdentifiedDrives::nominal(machine),
        }
    }
}

/// Z's mechanics by the machine file, in mm and N: motor and load on a screw with backlash, friction on both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZModel {
    mass_kg: f64,
    friction_n: f64,
    /// The load's side of the screw, as a share of the mass and of the friction.
    pub(super) load_mass_share: f64,
    pub(super) load_friction_share: f64,
    /// Z's position encoder is the motor's: what lies behind it is led by this model, and not seen.
    pub(super) unseen: bool,
    /// Of the screw.
    pub(super) compliance_mm_per_n: f64,
    pub(super) backlash_mm: f64,
    /// Of a friction of 1.
    pub(super) contact: Stribeck,
}

impl ZModel {
    pub(super) fn new(machine: &Machine) -> Self {
        let spec = &machine.spec().z_axis;
        // A spindle that takes a speed alone is off by more than a screw, and was not brought to rest with one that is led.
        let is_led = sees_deflection(machine) || machine.spec().drive.spindle_takes != Takes::Speed;
        let led = |value: f64| if is_led { value } else { 0.0 };
        Self {
            mass_kg: spec.mass_kg,
            friction_n: spec.coulomb_n,
            load_mass_share: spec.table_share,
            load_friction_share: spec.friction_table_share,
            unseen: !sees_deflection(machine) && is_led,
            compliance_mm_per_n: led(MM_PER_M / TwoMass::of_z(spec).stiffness),
            backlash_mm: led(mm_from_um(spec.backlash_um)),
            contact: Stribeck {
                coulomb: 1.0,
                static_ratio: spec.static_ratio,
                stribeck_speed: spec.stribeck_mm_per_s,
                presliding: mm_from_um(spec.presliding_um),
            },
        }
    }

    /// The same with another screw.
    pub(super) fn with_compliance_ratio(self, ratio: f64) -> Self {
        Self { compliance_mm_per_n: ratio * self.compliance_mm_per_n, ..self }
    }

    /// Deflection of the screw by the load's friction, one direction less the other.
    pub(super) fn friction_deflection_mm(&self, friction_n: f64) -> f64 {
        2.0 * self.load_friction_share * friction_n * self.compliance_mm_per_n
    }

    /// Beyond this speed friction is sliding friction.
    pub(super) fn sliding_mm_per_s(&self) -> f64 {
        SLIDING_STRIBECK * self.contact.stribeck_speed
    }

    /// By how much the motor leads the load where the load's friction is a ratio of the file's Coulomb friction.
    pub(super) fn deflection_mm(&self, friction_ratio: f64, acceleration_mm_per_s2: f64) -> f64 {
        let friction_n = self.load_friction_share * self.friction_n;
        let screw_n = friction_ratio * friction_n + self.load_n(acceleration_mm_per_s2);
        let flank = screw_n / (screw_n.abs() + FLANK_SHARE * friction_n).max(f64::MIN_POSITIVE);
        0.5 * self.backlash_mm * flank + self.compliance_mm_per_n * screw_n
    }

    /// Force that accelerates all of Z.
    pub(super) fn inertia_n(&self, acceleration_mm_per_s2: f64) -> f64 {
        self.mass_kg * m_from_mm(acceleration_mm_per_s2)
    }

    /// Force that accelerates the load.
    pub(super) fn load_n(&self, acceleration_mm_per_s2: f64) -> f64 {
        self.load_mass_share * self.inertia_n(acceleration_mm_per_s2)
    }
}

#[cfg(test)]
mod tests {
    use super::{PitchError, ZModel};
    use crate::control::machine::Machine;

    #[test]
    fn mean_of_a_pitch_error_by_its_samples() {
        let error = PitchError { lead_mm: 16.0, sin_mm: 0.002, cos_mm: -0.001 };
        for (from_mm, to_mm) in [(-3.0, 5.0), (7.0, 7.0), (20.0, 1.0)] {
            let at = |k: i32| from_mm + (to_mm - from_mm) * (f64::from(k) + 0.5) / 1000.0;
            let mean_mm = (0..1000).map(|k| error.at(at(k))).sum::<f64>() / 1000.0;
            assert!((error.mean(from_mm, to_mm) - mean_mm).abs() < 1e-9);
        }
    }

    /// 200 kg at 100 Hz: k = m·ω², and 150 N of the load's friction either way.
    #[test]
    fn deflections_by_the_spring_constant() {
        let model = ZModel::new(&Machine::reference());
        let stiffness_n_per_mm = 0.2 * (2.0 * core::f64::consts::PI * 100.0_f64).powi(2);
        assert!((model.friction_deflection_mm(300.0) - 2.0 * 150.0 / stiffness_n_per_mm).abs() < 1e-12);
        assert!((model.inertia_n(1000.0) - 600.0).abs() < 1e-9);
    }
}
