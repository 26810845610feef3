//! What runs but is unwise.

use super::Machine;
use super::check::{FINEST_MM, MachineWarning, MachineWarningKind};
use crate::control::motor::Motor;
use crate::control::units::rev_per_s_from_rpm;

impl Machine {
    /// Reports what runs but is unwise.
    pub fn warnings(&self, report: &mut dyn FnMut(MachineWarning)) {
        let Self { spec, motor, torque_curve, s_curve, linear, trapezoid_jerk, improved_s_curve, .. } = self;
        let last_rpm = spec.law.torque_curve.bands.last().map_or(0.0, |band| band.to_rpm);
        let max_rpm = spec.spindle.max_rpm;
        for (index, (band, raw)) in torque_curve.bands.iter().zip(&spec.law.torque_curve.bands).enumerate() {
            let rate = band.accel_rev_per_s2.max(band.decel_rev_per_s2);
            if let Some(kind) = above_motor(motor, rate, raw.to_rpm) {
                report(MachineWarning { key: "law.torque_curve.bands", index: Some(index), kind });
            }
        }
        if last_rpm < max_rpm {
            let kind = MachineWarningKind::EndsBelowMax { last_rpm, max_rpm };
            report(MachineWarning { key: "law.torque_curve.bands", index: None, kind });
        }
        // Only from standstill: above the rated speed a single acceleration asks too much by nature, which is the papers' point.
        for (key, rate) in [
            ("law.s_curve.accel_rpm_per_s", s_curve.acceleration),
            ("law.linear.accel_rpm_per_s", linear.acceleration),
            ("law.trapezoid_jerk.accel_rpm_per_s", trapezoid_jerk.acceleration),
            ("law.improved_s_curve.accel_rpm_per_s", improved_s_curve.acceleration),
        ] {
            if let Some(kind) = above_motor(motor, rate, 0.0) {
                report(MachineWarning { key, index: None, kind });
            }
        }
        let needed_mm_per_s = FINEST_MM * rev_per_s_from_rpm(max_rpm);
        let limit_mm_per_s = spec.z.max_mm_per_s;
        if needed_mm_per_s > limit_mm_per_s {
            let kind = MachineWarningKind::ZSlowForSpindle { needed_mm_per_s, limit_mm_per_s };
            report(MachineWarning { key: "z.max_mm_per_s", index: None, kind });
        }
    }
}

/// A law's acceleration that takes more than the motor has, beyond what rounding of a time constant can explain.
fn above_motor(motor: &Motor, rate_rev_per_s2: f64, speed_rpm: f64) -> Option<MachineWarningKind> {
    const ROUNDING: f64 = 1.002;
    let (needed_nm, available_nm) = (motor.torque_for_nm(rate_rev_per_s2), motor.curve.torque_nm(speed_rpm));
    (needed_nm > ROUNDING * available_nm).then_some(MachineWarningKind::AboveMotor {
        speed_rpm,
        needed_nm,
        available_nm,
    })
}
