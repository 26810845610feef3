//! [`MachineFile`] → parameters of the LinuxCNC component, as a HAL file sets them.

use core::fmt::Write;

use super::keys::{self, Draft, Slot};
use super::machine_file::MachineFile;
use super::number::exact;
use crate::control::machine::ZEncoderAt;

/// The keys that the component has a parameter for: those that the control uses.
const PARAMETERS: [&str; 66] = [
    "control.period_s",
    "drive.latency_periods",
    "spindle.max_rpm",
    "spindle.inertia_kg_m2",
    "spindle.tool_inertia_kg_m2",
    "spindle.coulomb_nm",
    "spindle.viscous_nm_per_rpm",
    "spindle.supply_sag_ratio",
    "spindle.torque_lag_s",
    "spindle.encoder_counts_per_rev",
    "law.motor_share",
    "law.torque_curve_smooth.jerk_rpm_per_s2",
    "law.s_curve.accel_rpm_per_s",
    "law.s_curve.jerk_rpm_per_s2",
    "law.linear.accel_rpm_per_s",
    "law.trapezoid_jerk.accel_rpm_per_s",
    "law.trapezoid_jerk.jerk_rpm_per_s2",
    "law.trapezoid_jerk.snap_rpm_per_s3",
    "law.improved_s_curve.accel_rpm_per_s",
    "x.max_mm_per_s",
    "x.max_mm_per_s2",
    "x.max_mm_per_s3",
    "y.max_mm_per_s",
    "y.max_mm_per_s2",
    "y.max_mm_per_s3",
    "z.max_mm_per_s",
    "z.max_mm_per_s2",
    "z.max_mm_per_s3",
    "z.encoder_counts_per_mm",
    "z.motor_counts_per_mm",
    "z.mass_kg",
    "z.table_share",
    "z.resonance_hz",
    "z.torque_lag_s",
    "z.force_limit_n",
    "z.coulomb_n",
    "z.static_ratio",
    "z.stribeck_mm_per_s",
    "z.presliding_um",
    "z.friction_table_share",
    "z.backlash_um",
    "drive.period_s",
    "drive.spindle_position_gain_per_s",
    "drive.spindle_velocity_gain_per_s",
    "drive.spindle_integral_s",
    "drive.z_position_gain_per_s",
    "drive.z_velocity_gain_per_s",
    "drive.z_integral_s",
    "drive.velocity_filter_s",
    "drive.encoder_latency_s",
    "drive.encoder_jitter_s",
    "tap.kc_n_per_mm2",
    "tap.tool_factor",
    "tap.surface_below_r_mm",
    "tap.ramp_pitches",
    "tap.out_torque_ratio",
    "tap.axial_n",
    "supervision.bridge_periods",
    "supervision.scale_ratio",
    "tap.major_mm",
    "tap.hole_mm",
    "tap.bottom_clearance_mm",
    "supervision.error_limit_um",
    "supervision.spindle_limit_rev",
    "supervision.z_limit_um",
    "tolerance.error_um",
];

/// A key's parameter: HAL writes minus for underscore, and has no room for the law's table.
fn parameter(path: &str) -> String {
    path.strip_prefix("law.").unwrap_or(path).replace('_', "-")
}

/// A key's value as the component takes it: 0 where the rest of the file says it.
fn value(path: &str, draft: &mut Draft) -> Option<f64> {
    match &keys::find(path)?.slot {
        Slot::Number(at) => Some(*at(draft)),
        Slot::Optional { at, .. } | Slot::Ruled { at, .. } => Some(at(draft).unwrap_or(0.0)),
        _ => None,
    }
}

impl MachineFile {
    /// The `setp` lines that tell the component `rigidtap.0` of LinuxCNC this machine: all that the control knows of it.
    ///
    /// ```
    /// let hal = rigidtap::config::MachineFile::reference().to_hal();
    /// assert!(hal.contains("setp rigidtap.0.spindle.max-rpm 8000\n"));
    /// assert!(hal.contains("setp rigidtap.0.spindle.torque-curve.01.nm 20\n"));
    /// ```
    #[must_use]
    pub fn to_hal(&self) -> String {
        let mut draft = self.draft();
        let mut out =
            "# Machine data of rigidtap.0 in LinuxCNC, written by `rigidtap machine --hal`: source it after loadrt.\n"
                .to_owned();
        let mut set = |name: &str, value: &str| {
            // Writing to a String cannot fail.
            let _ = writeln!(out, "setp rigidtap.0.{name} {value}");
        };
        for path in PARAMETERS {
            if let Some(value) = value(path, &mut draft) {
                set(&parameter(path), &exact(value));
            }
        }
        let (spec, count) = (&draft.spec, |count: usize| count.to_string());
        set("spindle.torque-curve.points", &count(spec.spindle.torque_curve.len()));
        for (n, point) in spec.spindle.torque_curve.iter().enumerate() {
            set(&format!("spindle.torque-curve.{n:02}.rpm"), &exact(point.speed_rpm));
            set(&format!("spindle.torque-curve.{n:02}.nm"), &exact(point.torque_nm));
        }
        set("torque-curve.bands", &count(spec.law.torque_curve.bands.len()));
        let mut bottom_rpm = 0.0;
        for (n, band) in spec.law.torque_curve.bands.iter().enumerate() {
            let (accel_s, decel_s) = band.times_s(bottom_rpm);
            bottom_rpm = band.to_rpm;
            set(&format!("torque-curve.{n:02}.to-rpm"), &exact(band.to_rpm));
            set(&format!("torque-curve.{n:02}.accel-s"), &exact(accel_s));
            set(&format!("torque-curve.{n:02}.decel-s"), &exact(decel_s));
        }
        set("z.encoder-at-motor", if spec.z_axis.encoder_at == ZEncoderAt::Motor { "1" } else { "0" });
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::MachineFile;

    #[test]
    fn every_parameter_is_a_key_with_a_number_and_has_room_in_hal() {
        let mut draft = Draft::reference();
        for path in PARAMETERS {
            assert!(value(path, &mut draft).is_some(), "{path}");
            // HAL_NAME_LEN of LinuxCNC 2.9.
            assert!("rigidtap.0.".len() + parameter(path).len() <= 47, "{path}");
        }
    }

    #[test]
    fn what_differs_and_what_a_rule_gives_are_told() {
        let file = MachineFile::read(b"[z]\nencoder_at = \"motor\"\nbacklash_um = 7.5\n").expect("a good file");
        let hal = file.to_hal();
        for line in [".z.encoder-at-motor 1", ".z.backlash-um 7.5", ".supervision.error-limit-um 0"] {
            assert!(hal.contains(&format!("setp rigidtap.0{line}\n")), "{line}: {hal}");
        }
    }
}
