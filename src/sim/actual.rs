//! How the real machine differs from its file. Read by the plant alone: never by the planner or the synchronizer.

use super::effects::{Effect, Effects};
use super::friction::FrictionModel;

/// `[actual]`: factors on what the file says, values in place of it, and effects that no machine file speaks of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Actual {
    /// Factor on the spindle's inertia, both sides.
    pub inertia: f64,
    /// Factor on the torque–speed curve.
    pub torque_limit: f64,
    /// Factor on torque per current: the drive commands as if it were 1.
    pub torque_constant: f64,
    /// Factor on Z's and the spindle's friction.
    pub friction: f64,
    /// Factor on the spindle's torsional resonance.
    pub spindle_resonance: f64,
    /// Factor on Z's axial resonance.
    pub z_resonance: f64,
    /// Factor on the tapping torque.
    pub cutting_torque: f64,
    /// Factor on the encoders' interpolation errors and jitter.
    pub encoder_error: f64,
    /// Factor on Z's backlash.
    pub backlash: f64,
    /// Factor on the age of an encoder reading.
    pub encoder_latency: f64,
    /// Z's backlash in place of the file's and the factor.
    pub backlash_um: Option<f64>,
    /// Age of an encoder reading in place of the file's and the factor.
    pub encoder_latency_s: Option<f64>,
    /// What of the screw's damping is left while the table is free in the backlash: 1 all of it, 0 none, as of the
    /// stiffness.
    pub backlash_damping: f64,
    /// How much later than `drive.latency_periods` says setpoints act; negative is earlier.
    pub setpoint_latency_s: f64,
    /// The same in interpolation periods, for a bus that is a whole cycle later.
    pub setpoint_latency_periods: f64,
    /// Greatest deviation of the host's period from its beat, either way.
    pub host_jitter_s: f64,
    /// Weight of the head that nothing balances; positive pulls Z down.
    pub z_weight_n: f64,
    /// Viscous friction of Z, of motor's and table's side as the Coulomb friction's share.
    pub z_viscous_n_per_mm_s: f64,
    /// Z's friction upwards less that downwards, as a share of their mean, beside `z.friction_direction`.
    pub z_friction_asymmetry: f64,
    /// Law of Z's friction.
    pub z_friction_model: FrictionModel,
    /// Amplitude of the screw's pitch error, once in each lead.
    pub screw_error_um: f64,
    /// Lead of the screw.
    pub screw_lead_mm: f64,
    /// Second axial resonance: 40 % of the table on a spring of their own; none without it.
    pub z_second_resonance_hz: Option<f64>,
    /// Axial force of a fully engaged tap on Z along its travel: positive draws the tap in, and out on the way out.
    pub tap_axial_n: f64,
    /// Eccentricity of the spindle's encoder, amplitude in seconds of arc once a revolution.
    pub spindle_eccentricity_arcsec: f64,
    /// What of the torque per current is lost at `spindle.max_rpm`, linear in speed.
    pub torque_constant_fall: f64,
    /// Readings a hole that come a second time in place of a fresh one, in the mean.
    pub stale_samples_per_hole: f64,
    /// Periods a hole that the host misses, in the mean.
    pub missed_periods_per_hole: f64,
    /// Factor on the gains of both drives' loops.
    pub drive_gain: f64,
    /// Drive periods from measuring to the effort that answers to it.
    pub drive_delay_periods: f64,
    /// How fast the screw grows as it warms.
    pub thermal_um_per_s: f64,
    /// Step of the efforts that the drives report, as a share of what they have at most; 0 for none.
    pub effort_resolution: f64,
    /// The drives report their efforts.
    pub reports_effort: bool,
}

impl Default for Actual {
    /// The machine is as its file says.
    fn default() -> Self {
        Self {
            inertia: 1.0,
            torque_limit: 1.0,
            torque_constant: 1.0,
            friction: 1.0,
            spindle_resonance: 1.0,
            z_resonance: 1.0,
            cutting_torque: 1.0,
            encoder_error: 1.0,
            backlash: 1.0,
            encoder_latency: 1.0,
            backlash_um: None,
            encoder_latency_s: None,
            backlash_damping: 1.0,
            setpoint_latency_s: 0.0,
            setpoint_latency_periods: 0.0,
            host_jitter_s: 0.0,
            z_weight_n: 0.0,
            z_viscous_n_per_mm_s: 0.0,
            z_friction_asymmetry: 0.0,
            z_friction_model: FrictionModel::Stribeck,
            screw_error_um: 0.0,
            screw_lead_mm: 10.0,
            z_second_resonance_hz: None,
            tap_axial_n: 0.0,
            spindle_eccentricity_arcsec: 0.0,
            torque_constant_fall: 0.0,
            stale_samples_per_hole: 0.0,
            missed_periods_per_hole: 0.0,
            drive_gain: 1.0,
            drive_delay_periods: 0.0,
            thermal_um_per_s: 0.0,
            effort_resolution: 0.0,
            reports_effort: true,
        }
    }
}

impl Actual {
    /// Z's backlash on a machine whose file says `file_um`.
    #[must_use]
    pub fn backlash_of_um(&self, file_um: f64) -> f64 {
        self.backlash_um.unwrap_or(self.backlash * file_um)
    }

    /// Age of an encoder reading on a machine whose file says `file_s`.
    #[must_use]
    pub fn encoder_latency_of_s(&self, file_s: f64) -> f64 {
        self.encoder_latency_s.unwrap_or(self.encoder_latency * file_s)
    }

    /// Without what an effect of the hard spread adds; the effects of the standard plant are no part of this.
    #[must_use]
    pub fn without(mut self, effect: Effect) -> Self {
        let none = Self::default();
        match effect {
            Effect::BacklashDamping => self.backlash_damping = none.backlash_damping,
            Effect::SetpointLatency => {
                self.setpoint_latency_s = none.setpoint_latency_s;
                self.setpoint_latency_periods = none.setpoint_latency_periods;
            }
            Effect::HostJitter => self.host_jitter_s = none.host_jitter_s,
            Effect::ZWeight => self.z_weight_n = none.z_weight_n,
            Effect::ZViscous => self.z_viscous_n_per_mm_s = none.z_viscous_n_per_mm_s,
            Effect::FrictionAsymmetry => self.z_friction_asymmetry = none.z_friction_asymmetry,
            Effect::FrictionModel => self.z_friction_model = none.z_friction_model,
            Effect::ScrewError => self.screw_error_um = none.screw_error_um,
            Effect::SecondResonance => self.z_second_resonance_hz = none.z_second_resonance_hz,
            Effect::TapAxial => self.tap_axial_n = none.tap_axial_n,
            Effect::Eccentricity => self.spindle_eccentricity_arcsec = none.spindle_eccentricity_arcsec,
            Effect::TorqueConstantFall => self.torque_constant_fall = none.torque_constant_fall,
            Effect::StaleSamples => self.stale_samples_per_hole = none.stale_samples_per_hole,
            Effect::MissedPeriods => self.missed_periods_per_hole = none.missed_periods_per_hole,
            Effect::DriveGain => self.drive_gain = none.drive_gain,
            Effect::DriveDelay => self.drive_delay_periods = none.drive_delay_periods,
            Effect::ThermalGrowth => self.thermal_um_per_s = none.thermal_um_per_s,
            Effect::QuantisedEffort => self.effort_resolution = none.effort_resolution,
            Effect::AbsentEffort => self.reports_effort = none.reports_effort,
            _ => {}
        }
        self
    }

    /// With only those effects of the hard spread that are on.
    #[must_use]
    pub fn under(self, effects: Effects) -> Self {
        effects.off().fold(self, Self::without)
    }

    /// Whether the plant can have an effect: those of the hard spread only where a key asks for them.
    ///
    /// ```
    /// use rigidtap::sim::{Actual, Effect};
    /// assert!(Actual::default().has(Effect::Backlash) && !Actual::default().has(Effect::ZWeight));
    /// assert!(Actual { z_weight_n: 800.0, ..Actual::default() }.has(Effect::ZWeight));
    /// ```
    #[must_use]
    pub fn has(&self, effect: Effect) -> bool {
        effect.is_standard() || self.without(effect) != *self
    }
}
