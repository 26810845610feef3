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
        // Bands that ask too much are one mistake: the worst of them stands for all.
        let (mut worst, mut count) = (None, 0);
        for (index, (band, raw)) in torque_curve.bands.iter().zip(&spec.law.torque_curve.bands).enumerate() {
            let rate = band.accel_rev_per_s2.max(band.decel_rev_per_s2);
            let Some(lack) = above_motor(motor, rate, raw.to_rpm) else { continue };
            count += 1;
            if worst.is_none_or(|(_, worst): (usize, Lack)| lack.ratio() > worst.ratio()) {
                worst = Some((index, lack));
            }
        }
        if let Some((index, lack)) = worst {
            report(MachineWarning { key: "law.torque_curve.bands", index: Some(index), kind: lack.kind(count) });
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
            if let Some(lack) = above_motor(motor, rate, 0.0) {
                report(MachineWarning { key, index: None, kind: lack.kind(1) });
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

/// Torque that a law asks and the motor has not.
#[derive(Clone, Copy)]
struct Lack {
    speed_rpm: f64,
    needed_nm: f64,
    available_nm: f64,
}

impl Lack {
    fn ratio(self) -> f64 {
        self.needed_nm / self.available_nm
    }

    fn kind(self, count: usize) -> MachineWarningKind {
        let Self { speed_rpm, needed_nm, available_nm } = self;
        MachineWarningKind::AboveMotor { speed_rpm, needed_nm, available_nm, count }
    }
}

/// A law's acceleration that takes more than the motor has, beyond what rounding of a time constant can explain.
fn above_motor(motor: &Motor, rate_rev_per_s2: f64, speed_rpm: f64) -> Option<Lack> {
    const ROUNDING: f64 = 1.002;
    let (needed_nm, available_nm) = (motor.torque_for_nm(rate_rev_per_s2), motor.curve.torque_nm(speed_rpm));
    (needed_nm > ROUNDING * available_nm).then_some(Lack { speed_rpm, needed_nm, available_nm })
}
