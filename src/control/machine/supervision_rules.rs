//! The rules that the limits of supervision follow from the rest of the machine file.

use super::Machine;
use super::spec::{MachineSpec, SupervisionSpec};
use super::supervision_limits::{LongestStop, SupervisionLimits};
use crate::control::units::{m_from_mm, rev_per_s_from_rpm, um_from_mm};

/// Tolerance of e(k) of a thread outside the tables, as a share of the pitch: M6 has 0.05.
const TOLERANCE_SHARE: f64 = 0.05;
/// Bottom clearance as a share of the pitch.
const CLEARANCE_SHARE: f64 = 0.5;
/// How far beyond its drive's saturation the spindle may fall behind.
const TRACKING_SHARE: f64 = 10.0;
/// Radians of a revolution.
const RAD_PER_REV: f64 = core::f64::consts::TAU;

impl SupervisionSpec {
    /// Ten times the tracking error at which the position loop alone asks for all of the motor's torque, in rev. A motor that
    /// is weaker than its file falls behind beyond that, until time scaling has slowed the path to what it gives; meanwhile
    /// Z goes with it.
    ///
    /// ```
    /// use rigidtap::control::machine::{MachineSpec, SupervisionSpec};
    /// // 20 N·m turn 0.004 kg·m² by 796 rev/s², and the gains are 40 1/s and 200 1/s.
    /// let limit_rev = SupervisionSpec::spindle_rule_rev(&MachineSpec::reference());
    /// assert!((limit_rev - 10.0 * 796.0 / 8000.0).abs() < 1e-2);
    /// ```
    #[must_use]
    pub fn spindle_rule_rev(spec: &MachineSpec) -> f64 {
        let rated_nm = spec.spindle.torque_curve.iter().map(|point| point.torque_nm).fold(0.0, f64::max);
        let drive = &spec.drive;
        TRACKING_SHARE * rated_nm
            / (RAD_PER_REV * spec.spindle.inertia_kg_m2)
            / (drive.spindle_position_gain_per_s * drive.spindle_velocity_gain_per_s)
    }

    /// Following error at which Z's position loop alone asks for all of its force, in µm.
    ///
    /// ```
    /// use rigidtap::control::machine::{MachineSpec, SupervisionSpec};
    /// // 8829 N move 600 kg by 14 715 mm/s², and the gains are 40 1/s and 500 1/s.
    /// let limit_um = SupervisionSpec::z_rule_um(&MachineSpec::reference());
    /// assert!((limit_um - 735.75).abs() < 1e-6);
    /// ```
    #[must_use]
    pub fn z_rule_um(spec: &MachineSpec) -> f64 {
        let (z, drive) = (&spec.z_axis, &spec.drive);
        let stiffness_n_per_mm = z.mass_kg * m_from_mm(drive.z_position_gain_per_s * drive.z_velocity_gain_per_s);
        um_from_mm(z.force_limit_n / stiffness_n_per_mm)
    }
}

impl Machine {
    /// The limits of supervision in force for a pitch in mm: the file's, else those of the rules.
    #[must_use]
    pub fn supervision(&self, pitch_mm: f64) -> SupervisionLimits {
        let (spec, given) = (self.spec(), &self.spec().supervision);
        let tolerance_um = || self.sync_tolerance_um(pitch_mm).unwrap_or(um_from_mm(TOLERANCE_SHARE * pitch_mm));
        SupervisionLimits {
            // Checked to be a number of 1 to 50.
            bridge_periods: given.bridge_periods as u32,
            error_um: given.error_limit_um.unwrap_or_else(tolerance_um),
            spindle_rev: given.spindle_limit_rev.unwrap_or_else(|| SupervisionSpec::spindle_rule_rev(spec)),
            z_um: given.z_limit_um.unwrap_or_else(|| SupervisionSpec::z_rule_um(spec)),
            scale_ratio: given.scale_ratio,
            bottom_clearance_mm: self.bottom_clearance_mm(pitch_mm),
        }
    }

    /// How far the tip may go below the programmed bottom, mm: `tap.bottom_clearance_mm`, else half a pitch.
    #[must_use]
    pub fn bottom_clearance_mm(&self, pitch_mm: f64) -> f64 {
        self.spec().tap.bottom_clearance_mm.unwrap_or(CLEARANCE_SHARE * pitch_mm)
    }

    /// The longest synchronous stop: from the spindle's top speed, at the law's torque utilisation.
    ///
    /// ```
    /// use rigidtap::control::machine::Machine;
    /// let stop = Machine::reference().longest_stop();
    /// assert!(stop.time_s > 0.3 && stop.time_s < 0.4 && stop.angle_rev > 20.0);
    /// ```
    #[must_use]
    pub fn longest_stop(&self) -> LongestStop {
        let top = rev_per_s_from_rpm(self.spec().spindle.max_rpm);
        self.torque_limit().brake(top, f64::INFINITY).map_or(LongestStop { time_s: 0.0, angle_rev: 0.0 }, |braking| {
            LongestStop { time_s: braking.duration_s(), angle_rev: braking.distance() }
        })
    }
}
