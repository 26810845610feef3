//! What real machines have and the standard plant leaves out: ranges for `sweep --hard`.

use rand::{Rng, RngExt};

use super::actual::Actual;
use super::drawn::{Drawn, FrictionModels};
use super::friction::FrictionModel;

/// `[spread.hard]`: what each of the further numbers of [`Actual`] is drawn from. Field names are the file's keys.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HardSpread {
    /// Damping left inside the backlash.
    pub backlash_damping: Drawn,
    /// Setpoints later or earlier than the file says.
    pub setpoint_latency_s: Drawn,
    /// Setpoints later by whole periods.
    pub setpoint_latency_periods: Drawn,
    /// Greatest deviation of the host's period.
    pub host_jitter_s: Drawn,
    /// Weight that nothing balances.
    pub z_weight_n: Drawn,
    /// Viscous friction of Z.
    pub z_viscous_n_per_mm_s: Drawn,
    /// Difference of Z's friction between up and down.
    pub z_friction_asymmetry: Drawn,
    /// Laws of Z's friction.
    pub z_friction_model: FrictionModels,
    /// Amplitude of the screw's pitch error.
    pub screw_error_um: Drawn,
    /// Lead of the screw.
    pub screw_lead_mm: Drawn,
    /// Second axial resonance.
    pub z_second_resonance_hz: Drawn,
    /// Axial force of the tap.
    pub tap_axial_n: Drawn,
    /// Eccentricity of the spindle's encoder.
    pub spindle_eccentricity_arcsec: Drawn,
    /// Torque per current lost at the greatest speed.
    pub torque_constant_fall: Drawn,
    /// Readings a hole that come twice.
    pub stale_samples_per_hole: Drawn,
    /// Periods a hole that the host misses.
    pub missed_periods_per_hole: Drawn,
    /// Factor on the drives' gains.
    pub drive_gain: Drawn,
    /// Computing delay of the drives.
    pub drive_delay_periods: Drawn,
    /// Growth of the screw.
    pub thermal_um_per_s: Drawn,
    /// Step of the reported efforts.
    pub effort_resolution: Drawn,
    /// Share of the machines whose drives report their efforts.
    pub reports_effort: f64,
}

impl Default for HardSpread {
    /// Judged from commissioning practice; the machine file gives each its reason.
    fn default() -> Self {
        Self {
            backlash_damping: Drawn::Within([0.0, 1.0]),
            setpoint_latency_s: Drawn::Within([-100e-6, 100e-6]),
            setpoint_latency_periods: Drawn::Some { any: [1.0, 1.0], ratio: 0.05 },
            host_jitter_s: Drawn::Within([0.0, 10e-6]),
            z_weight_n: Drawn::Within([-1500.0, 1500.0]),
            z_viscous_n_per_mm_s: Drawn::Within([0.0, 2.0]),
            z_friction_asymmetry: Drawn::Within([0.0, 0.2]),
            z_friction_model: FrictionModels::of(&[FrictionModel::Stribeck, FrictionModel::LuGre, FrictionModel::Gms]),
            screw_error_um: Drawn::Within([0.0, 3.0]),
            screw_lead_mm: Drawn::one_of(&[10.0, 16.0]),
            z_second_resonance_hz: Drawn::Within([160.0, 320.0]),
            tap_axial_n: Drawn::Within([-100.0, 150.0]),
            spindle_eccentricity_arcsec: Drawn::Within([0.0, 15.0]),
            torque_constant_fall: Drawn::Within([0.0, 0.15]),
            stale_samples_per_hole: Drawn::Within([0.2, 0.2]),
            missed_periods_per_hole: Drawn::Within([0.05, 0.05]),
            drive_gain: Drawn::Within([0.85, 1.15]),
            drive_delay_periods: Drawn::Within([0.0, 2.0]),
            thermal_um_per_s: Drawn::Within([0.0, 0.5]),
            effort_resolution: Drawn::Within([0.0, 0.01]),
            reports_effort: 0.9,
        }
    }
}

impl HardSpread {
    /// A machine with these effects drawn beside what it has already.
    ///
    /// ```
    /// use rand::SeedableRng;
    /// use rigidtap::sim::{Actual, HardSpread};
    /// let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(1);
    /// let base = Actual { friction: 1.5, ..Actual::default() };
    /// let actual = HardSpread::default().draw_onto(&base, &mut random);
    /// assert!(actual.friction == 1.5 && (-1500.0..=1500.0).contains(&actual.z_weight_n));
    /// ```
    pub fn draw_onto(&self, base: &Actual, random: &mut impl Rng) -> Actual {
        let none = Actual::default();
        Actual {
            backlash_damping: self.backlash_damping.draw(none.backlash_damping, random),
            setpoint_latency_s: self.setpoint_latency_s.draw(0.0, random),
            setpoint_latency_periods: self.setpoint_latency_periods.draw(0.0, random),
            host_jitter_s: self.host_jitter_s.draw(0.0, random),
            z_weight_n: self.z_weight_n.draw(0.0, random),
            z_viscous_n_per_mm_s: self.z_viscous_n_per_mm_s.draw(0.0, random),
            z_friction_asymmetry: self.z_friction_asymmetry.draw(0.0, random),
            z_friction_model: self.z_friction_model.draw(random),
            screw_error_um: self.screw_error_um.draw(0.0, random),
            screw_lead_mm: self.screw_lead_mm.draw(none.screw_lead_mm, random),
            // A resonance of 0 Hz is none.
            z_second_resonance_hz: Some(self.z_second_resonance_hz.draw(0.0, random)).filter(|hz| *hz > 0.0),
            tap_axial_n: self.tap_axial_n.draw(0.0, random),
            spindle_eccentricity_arcsec: self.spindle_eccentricity_arcsec.draw(0.0, random),
            torque_constant_fall: self.torque_constant_fall.draw(0.0, random),
            stale_samples_per_hole: self.stale_samples_per_hole.draw(0.0, random),
            missed_periods_per_hole: self.missed_periods_per_hole.draw(0.0, random),
            drive_gain: self.drive_gain.draw(none.drive_gain, random),
            drive_delay_periods: self.drive_delay_periods.draw(0.0, random),
            thermal_um_per_s: self.thermal_um_per_s.draw(0.0, random),
            effort_resolution: self.effort_resolution.draw(0.0, random),
            reports_effort: random.random::<f64>() < self.reports_effort,
            ..*base
        }
    }
}
