//! All laws of a machine as they follow from its motor and its springs.

use crate::control::machine::{
    ImprovedSCurveLawSpec, LawSpec, LinearLawSpec, MachineSpec, SCurveLawSpec, TorqueCurveLawSpec,
    TorqueCurveSmoothLawSpec, TrapezoidJerkLawSpec,
};
use crate::control::motor::{Motor, TorqueCurve};
use crate::control::units::rpm_from_rev_per_s;

use super::error::TuneError;
use super::task::{STROKES_REV, TuneTask};

/// Bands that a machine without its own gets: as many as the papers use.
const BANDS: usize = 4;
/// Periods of the slowest resonance over which an acceleration grows: whole ones excite it least. On the reference machine
/// these are the papers' 30 ms.
const RAMP_PERIODS: f64 = 3.0;
/// The same of `torque-curve-smooth`, whose corners are the motor's own: 6 ms on the reference machine.
const SMOOTH_PERIODS: f64 = 0.6;
/// Phases of a ramp of `trapezoid-jerk`, as long as each other: jerk up, constant jerk, jerk down.
const JERK_PHASES: f64 = 3.0;
/// Digits that a person would enter.
const DIGITS: i32 = 4;

/// Every law of a machine's motor at `law.motor_share`, its speeds of start and end kept.
///
/// Accelerations are what the share leaves at rest; bands are the best four for [`STROKES_REV`]; jerks reach the
/// acceleration in 3 periods of the slower of both resonances. Numbers are rounded down to four digits, so that rounding
/// never asks for more than the share.
///
/// # Errors
/// [`TuneError`] for a motor or share that no machine has.
///
/// ```
/// use rigidtap::{control::machine::MachineSpec, laws::laws_of};
/// let mut spec = MachineSpec::reference();
/// spec.spindle.inertia_kg_m2 *= 2.0;
/// let laws = laws_of(&spec).unwrap();
/// assert_eq!(laws.linear.accel_rpm_per_s, 19090.0); // 0.8 × 20 N·m / 0.008 kg·m²
/// assert_eq!((laws.torque_curve.bands.len(), laws.torque_curve.bands[0].to_rpm), (4, 3000.0));
/// ```
pub fn laws_of(spec: &MachineSpec) -> Result<LawSpec, TuneError> {
    let curve = TorqueCurve::new(&spec.spindle.torque_curve).map_err(|_| TuneError::Tops)?;
    let motor = Motor { curve, inertia_kg_m2: spec.spindle.inertia_kg_m2 };
    let share = spec.law.motor_share;
    let at_rest = rpm_from_rev_per_s(motor.acceleration_rev_per_s2(0.0, share));
    let bands = TuneTask::new(motor, spec.spindle.max_rpm, share, &STROKES_REV)?.best(BANDS)?;
    let accel_rpm_per_s = rounded_down(at_rest);
    let resonance_hz = spec.spindle.resonance_hz.min(spec.z_axis.resonance_hz);
    let ramp_s = RAMP_PERIODS / resonance_hz;
    let phase_s = ramp_s / JERK_PHASES;
    // Three phases as long reach the acceleration: the jerk is that of two of them.
    let trapezoid_jerk = accel_rpm_per_s / (2.0 * phase_s);
    let TorqueCurveLawSpec { start_rpm, end_rpm, .. } = spec.law.torque_curve;
    Ok(LawSpec {
        motor_share: share,
        torque_curve: TorqueCurveLawSpec {
            start_rpm,
            end_rpm,
            bands: bands.time_constants(start_rpm, end_rpm).into_iter().collect(),
        },
        s_curve: SCurveLawSpec { accel_rpm_per_s, jerk_rpm_per_s2: rounded_down(accel_rpm_per_s / ramp_s) },
        linear: LinearLawSpec { accel_rpm_per_s },
        torque_curve_smooth: TorqueCurveSmoothLawSpec {
            jerk_rpm_per_s2: rounded_down(accel_rpm_per_s * resonance_hz / SMOOTH_PERIODS),
        },
        trapezoid_jerk: TrapezoidJerkLawSpec {
            accel_rpm_per_s,
            jerk_rpm_per_s2: rounded_down(trapezoid_jerk),
            snap_rpm_per_s3: rounded_down(trapezoid_jerk / phase_s),
            quantised: spec.law.trapezoid_jerk.quantised,
        },
        improved_s_curve: ImprovedSCurveLawSpec { accel_rpm_per_s },
    })
}

/// The next number down with [`DIGITS`] digits.
fn rounded_down(value: f64) -> f64 {
    let scale = 10f64.powi(DIGITS - 1 - value.log10().floor() as i32);
    (value * scale * (1.0 + 1e-12)).floor() / scale
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::machine::Machine;

    /// The reference machine's own laws are those of the papers, within their rounding.
    #[test]
    fn of_the_reference_machine() {
        let spec = MachineSpec::reference();
        let (laws, own) = (laws_of(&spec).unwrap(), &spec.law);
        for (derived, own) in [
            (laws.s_curve.accel_rpm_per_s, own.s_curve.accel_rpm_per_s),
            (laws.s_curve.jerk_rpm_per_s2, own.s_curve.jerk_rpm_per_s2),
            (laws.linear.accel_rpm_per_s, own.linear.accel_rpm_per_s),
            (laws.torque_curve_smooth.jerk_rpm_per_s2, own.torque_curve_smooth.jerk_rpm_per_s2),
            (laws.trapezoid_jerk.jerk_rpm_per_s2, own.trapezoid_jerk.jerk_rpm_per_s2),
            (laws.trapezoid_jerk.snap_rpm_per_s3, own.trapezoid_jerk.snap_rpm_per_s3),
            (laws.improved_s_curve.accel_rpm_per_s, own.improved_s_curve.accel_rpm_per_s),
        ] {
            assert!((derived / own - 1.0).abs() < 0.01, "{derived} {own}");
        }
    }

    /// No derived law asks more than its motor has, whatever the motor.
    #[test]
    fn never_above_the_motor() {
        for (factor, share) in [(0.3, 0.5), (1.0, 1.0), (7.0, 0.8)] {
            let mut spec = MachineSpec::reference();
            spec.spindle.torque_curve.iter_mut().for_each(|point| point.torque_nm *= factor);
            spec.law.motor_share = share;
            spec.law = laws_of(&spec).unwrap();
            let mut warnings = Vec::new();
            Machine::check(spec).unwrap().warnings(&mut |warning| warnings.push(warning));
            assert_eq!(warnings, []);
        }
    }
}
