//! The values of [`Actual`] one after the other, for reports.

use super::actual::Actual;

/// One value of [`Actual`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ActualValue {
    /// A number; none where the machine has nothing of it.
    Number(Option<f64>),
    /// A word.
    Word(&'static str),
    /// Yes or no.
    Switch(bool),
}

/// How many values there are.
pub const ACTUAL_VALUES: usize = 33;

impl Actual {
    /// Every value with its key, those of the hard spread last.
    #[must_use]
    pub fn values(&self) -> [(&'static str, ActualValue); ACTUAL_VALUES] {
        let number = |value: f64| ActualValue::Number(Some(value));
        [
            ("inertia", number(self.inertia)),
            ("torque_limit", number(self.torque_limit)),
            ("torque_constant", number(self.torque_constant)),
            ("friction", number(self.friction)),
            ("spindle_resonance", number(self.spindle_resonance)),
            ("z_resonance", number(self.z_resonance)),
            ("cutting_torque", number(self.cutting_torque)),
            ("encoder_error", number(self.encoder_error)),
            ("backlash", number(self.backlash)),
            ("encoder_latency", number(self.encoder_latency)),
            ("backlash_um", ActualValue::Number(self.backlash_um)),
            ("encoder_latency_s", ActualValue::Number(self.encoder_latency_s)),
            ("backlash_damping", number(self.backlash_damping)),
            ("setpoint_latency_s", number(self.setpoint_latency_s)),
            ("setpoint_latency_periods", number(self.setpoint_latency_periods)),
            ("host_jitter_s", number(self.host_jitter_s)),
            ("z_weight_n", number(self.z_weight_n)),
            ("z_viscous_n_per_mm_s", number(self.z_viscous_n_per_mm_s)),
            ("z_friction_asymmetry", number(self.z_friction_asymmetry)),
            ("z_friction_model", ActualValue::Word(self.z_friction_model.name())),
            ("screw_error_um", number(self.screw_error_um)),
            ("screw_lead_mm", number(self.screw_lead_mm)),
            ("z_second_resonance_hz", ActualValue::Number(self.z_second_resonance_hz)),
            ("tap_axial_n", number(self.tap_axial_n)),
            ("spindle_eccentricity_arcsec", number(self.spindle_eccentricity_arcsec)),
            ("torque_constant_fall", number(self.torque_constant_fall)),
            ("stale_samples_per_hole", number(self.stale_samples_per_hole)),
            ("missed_periods_per_hole", number(self.missed_periods_per_hole)),
            ("drive_gain", number(self.drive_gain)),
            ("drive_delay_periods", number(self.drive_delay_periods)),
            ("thermal_um_per_s", number(self.thermal_um_per_s)),
            ("effort_resolution", number(self.effort_resolution)),
            ("reports_effort", ActualValue::Switch(self.reports_effort)),
        ]
    }

    /// With the value of this key as another machine has it; as it is where there is no such key.
    ///
    /// ```
    /// use rigidtap::sim::Actual;
    /// let other = Actual { friction: 2.0, reports_effort: false, ..Actual::default() };
    /// let found = other.values().iter().fold(Actual::default(), |actual, (key, _)| actual.with(key, &other));
    /// assert_eq!(found, other);
    /// assert_eq!(Actual::default().with("friction", &other).friction, 2.0);
    /// ```
    #[must_use]
    pub fn with(mut self, key: &str, other: &Self) -> Self {
        match key {
            "inertia" => self.inertia = other.inertia,
            "torque_limit" => self.torque_limit = other.torque_limit,
            "torque_constant" => self.torque_constant = other.torque_constant,
            "friction" => self.friction = other.friction,
            "spindle_resonance" => self.spindle_resonance = other.spindle_resonance,
            "z_resonance" => self.z_resonance = other.z_resonance,
            "cutting_torque" => self.cutting_torque = other.cutting_torque,
            "encoder_error" => self.encoder_error = other.encoder_error,
            "backlash" => self.backlash = other.backlash,
            "encoder_latency" => self.encoder_latency = other.encoder_latency,
            "backlash_um" => self.backlash_um = other.backlash_um,
            "encoder_latency_s" => self.encoder_latency_s = other.encoder_latency_s,
            "backlash_damping" => self.backlash_damping = other.backlash_damping,
            "setpoint_latency_s" => self.setpoint_latency_s = other.setpoint_latency_s,
            "setpoint_latency_periods" => self.setpoint_latency_periods = other.setpoint_latency_periods,
            "host_jitter_s" => self.host_jitter_s = other.host_jitter_s,
            "z_weight_n" => self.z_weight_n = other.z_weight_n,
            "z_viscous_n_per_mm_s" => self.z_viscous_n_per_mm_s = other.z_viscous_n_per_mm_s,
            "z_friction_asymmetry" => self.z_friction_asymmetry = other.z_friction_asymmetry,
            "z_friction_model" => self.z_friction_model = other.z_friction_model,
            "screw_error_um" => self.screw_error_um = other.screw_error_um,
            "screw_lead_mm" => self.screw_lead_mm = other.screw_lead_mm,
            "z_second_resonance_hz" => self.z_second_resonance_hz = other.z_second_resonance_hz,
            "tap_axial_n" => self.tap_axial_n = other.tap_axial_n,
            "spindle_eccentricity_arcsec" => self.spindle_eccentricity_arcsec = other.spindle_eccentricity_arcsec,
            "torque_constant_fall" => self.torque_constant_fall = other.torque_constant_fall,
            "stale_samples_per_hole" => self.stale_samples_per_hole = other.stale_samples_per_hole,
            "missed_periods_per_hole" => self.missed_periods_per_hole = other.missed_periods_per_hole,
            "drive_gain" => self.drive_gain = other.drive_gain,
            "drive_delay_periods" => self.drive_delay_periods = other.drive_delay_periods,
            "thermal_um_per_s" => self.thermal_um_per_s = other.thermal_um_per_s,
            "effort_resolution" => self.effort_resolution = other.effort_resolution,
            "reports_effort" => self.reports_effort = other.reports_effort,
            _ => {}
        }
        self
    }
}
