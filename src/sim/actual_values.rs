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
}
