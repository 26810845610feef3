//! The checks of a machine's data. Each range stands here once, beside the key it holds for.

use super::law_spec::Ramp;
use super::spec::MachineSpec;
use crate::control::motor::{TorqueCurve, TorqueCurveError};

/// A fault in a machine's data, with the key it stands at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineError {
    /// The machine file's key, `spindle.max_rpm`.
    pub key: &'static str,
    /// Element of the list at that key, from 0.
    pub index: Option<usize>,
    /// What is wrong.
    pub fault: MachineFault,
}

/// What can be wrong with a machine's data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MachineFault {
    /// A value outside its range, or not a number.
    OutOfRange {
        /// Value found.
        value: f64,
        /// Least value allowed.
        low: f64,
        /// Greatest value allowed.
        high: f64,
    },
    /// The points make no torque curve.
    TorqueCurve(TorqueCurveError),
    /// The torque curve does not end at `spindle.max_rpm`.
    TorqueCurveEnd {
        /// Speed of its last point.
        last_rpm: f64,
        /// The spindle's greatest speed.
        max_rpm: f64,
    },
    /// A part of a whole is not smaller than the whole: the tool's inertia and the spindle's.
    PartNotBelowWhole {
        /// The part's value.
        part: f64,
        /// The whole's value.
        whole: f64,
    },
    /// Band tops do not rise.
    BandOrder {
        /// Top of the offending band.
        to_rpm: f64,
        /// Top of the band before it.
        previous_rpm: f64,
    },
    /// A law without bands.
    NoBands,
    /// Start or end speed above the last band.
    SpeedAboveBands {
        /// The speed.
        speed_rpm: f64,
        /// Top of the last band.
        last_rpm: f64,
    },
    /// The drive's period is not a whole part of the interpolation period.
    PeriodsDisagree {
        /// Drive period.
        drive_s: f64,
        /// Interpolation period.
        interpolation_s: f64,
    },
    /// The tap drill is not smaller than the thread.
    HoleNotBelowMajor {
        /// Tap-drill diameter.
        hole_mm: f64,
        /// Major diameter.
        major_mm: f64,
    },
    /// Only one of the two diameters of the tap is given.
    TapIncomplete,
    /// An encoder so coarse that one count is more than a tenth of the tolerance of M3, the finest thread usually tapped by machine.
    EncoderTooCoarse {
        /// One count.
        count_um: f64,
        /// Most that it may be.
        limit_um: f64,
    },
}

/// What runs but is unwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineWarning {
    /// The machine file's key.
    pub key: &'static str,
    /// Element of the list at that key, from 0.
    pub index: Option<usize>,
    /// What is unwise.
    pub kind: MachineWarningKind,
}

/// What can be unwise in a machine's data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MachineWarningKind {
    /// A law asks more torque than the motor has.
    AboveMotor {
        /// Speed at which it does.
        speed_rpm: f64,
        /// Torque asked, friction not included.
        needed_nm: f64,
        /// Torque there is.
        available_nm: f64,
        /// How many bands do; this is the one that lacks most. 1 where the law has none.
        count: usize,
    },
    /// The bands end below the spindle's greatest speed, which therefore is not reached.
    EndsBelowMax {
        /// Top of the last band.
        last_rpm: f64,
        /// The spindle's greatest speed.
        max_rpm: f64,
    },
    /// At the spindle's greatest speed Z could not follow even the pitch of M3.
    ZSlowForSpindle {
        /// Speed that Z would need.
        needed_mm_per_s: f64,
        /// Z's greatest speed.
        limit_mm_per_s: f64,
    },
}

const FINEST_TOLERANCE_SHARE: f64 = 0.1;
/// Pitch of M3, the finest thread that is usually tapped by machine.
pub(super) const FINEST_MM: f64 = 0.5;
/// What M3 bears: 100 µm of TD2 less 40 µm of the tap, over 1.732.
const FINEST_TOLERANCE_UM: f64 = 60.0 / 1.732;
/// Zero excluded: the least value that still divides.
const POSITIVE: f64 = 1e-9;

impl MachineSpec {
    /// Reports every fault, in the order of the file's tables.
    pub fn faults(&self, report: &mut dyn FnMut(MachineError)) {
        for (key, value, low, high) in self.ranges() {
            if !(value >= low && value <= high) {
                report(MachineError { key, index: None, fault: MachineFault::OutOfRange { value, low, high } });
            }
        }
        self.torque_curve_faults(report);
        self.band_faults(report);
        self.cross_faults(report);
    }

    /// Every plain number with its range.
    #[rustfmt::skip]
    fn ranges(&self) -> impl Iterator<Item = (&'static str, f64, f64, f64)> {
        let Self { control, spindle, x, y, z, z_axis, drive, sync, supervision, law, tap, tolerance } = self;
        [
            ("control.period_s", control.period_s, 1e-5, 0.1),
            ("spindle.max_rpm", spindle.max_rpm, 1.0, 200_000.0),
            ("spindle.inertia_kg_m2", spindle.inertia_kg_m2, POSITIVE, 1000.0),
            ("spindle.tool_inertia_kg_m2", spindle.tool_inertia_kg_m2, POSITIVE, 1000.0),
            ("spindle.resonance_hz", spindle.resonance_hz, 10.0, 10_000.0),
            ("spindle.damping_ratio", spindle.damping_ratio, 0.0, 1.0),
            ("spindle.torque_lag_s", spindle.torque_lag_s, 0.0, 0.1),
            ("spindle.coulomb_nm", spindle.coulomb_nm, 0.0, 1000.0),
            ("spindle.viscous_nm_per_rpm", spindle.viscous_nm_per_rpm, 0.0, 1.0),
            ("spindle.torque_ripple", spindle.torque_ripple, 0.0, 0.5),
            ("spindle.supply_sag_ratio", spindle.supply_sag_ratio, 0.0, 0.9),
            ("spindle.supply_sag_s", spindle.supply_sag_s, 0.0001, 10.0),
            ("spindle.encoder_counts_per_rev", spindle.encoder_counts_per_rev, 4.0, 1e9),
            ("x.max_mm_per_s", x.max_mm_per_s, 0.1, 1e5),
            ("x.max_mm_per_s2", x.max_mm_per_s2, 1.0, 1e7),
            ("x.max_mm_per_s3", x.max_mm_per_s3, 1.0, 1e10),
            ("y.max_mm_per_s", y.max_mm_per_s, 0.1, 1e5),
            ("y.max_mm_per_s2", y.max_mm_per_s2, 1.0, 1e7),
            ("y.max_mm_per_s3", y.max_mm_per_s3, 1.0, 1e10),
            ("z.max_mm_per_s", z.max_mm_per_s, 0.1, 1e5),
            ("z.max_mm_per_s2", z.max_mm_per_s2, 1.0, 1e7),
            ("z.max_mm_per_s3", z.max_mm_per_s3, 1.0, 1e10),
            ("z.mass_kg", z_axis.mass_kg, 0.01, 1e6),
            ("z.table_share", z_axis.table_share, 0.01, 0.99),
            ("z.resonance_hz", z_axis.resonance_hz, 5.0, 10_000.0),
            ("z.damping_ratio", z_axis.damping_ratio, 0.0, 1.0),
            ("z.torque_lag_s", z_axis.torque_lag_s, 0.0, 0.1),
            ("z.force_limit_n", z_axis.force_limit_n, 1.0, 1e7),
            ("z.coulomb_n", z_axis.coulomb_n, 0.0, 1e6),
            ("z.static_ratio", z_axis.static_ratio, 1.0, 10.0),
            ("z.stribeck_mm_per_s", z_axis.stribeck_mm_per_s, 0.01, 1000.0),
            ("z.presliding_um", z_axis.presliding_um, 0.01, 1000.0),
            ("z.friction_ripple", z_axis.friction_ripple, 0.0, 0.9),
            ("z.friction_direction", z_axis.friction_direction, 0.0, 0.9),
            ("z.friction_hole_spread", z_axis.friction_hole_spread, 0.0, 0.9),
            ("z.friction_table_share", z_axis.friction_table_share, 0.0, 1.0),
            ("z.backlash_um", z_axis.backlash_um, 0.0, 1000.0),
            ("z.encoder_counts_per_mm", z_axis.encoder_counts_per_mm, 1.0, 1e9),
            ("z.motor_counts_per_mm", z_axis.motor_counts_per_mm, 1.0, 1e9),
            ("drive.period_s", drive.period_s, 1e-6, 0.01),
            ("drive.latency_periods", drive.latency_periods, 0.0, 8.0),
            ("drive.spindle_position_gain_per_s", drive.spindle_position_gain_per_s, 0.1, 1000.0),
            ("drive.spindle_velocity_gain_per_s", drive.spindle_velocity_gain_per_s, 1.0, 10_000.0),
            ("drive.spindle_integral_s", drive.spindle_integral_s, 0.0005, 10.0),
            ("drive.z_position_gain_per_s", drive.z_position_gain_per_s, 0.1, 1000.0),
            ("drive.z_velocity_gain_per_s", drive.z_velocity_gain_per_s, 1.0, 10_000.0),
            ("drive.z_integral_s", drive.z_integral_s, 0.0005, 10.0),
            ("drive.velocity_filter_s", drive.velocity_filter_s, 0.0, 0.1),
            ("drive.encoder_latency_s", drive.encoder_latency_s, 0.0, 0.001),
            ("drive.encoder_jitter_s", drive.encoder_jitter_s, 0.0, 0.0005),
            ("drive.spindle_interpolation_counts", drive.spindle_interpolation_counts, 0.0, 1000.0),
            ("drive.z_interpolation_um", drive.z_interpolation_um, 0.0, 100.0),
            ("sync.backlash_crossing_s", sync.backlash_crossing_s, 1e-4, 1.0),
            ("sync.observer_rad_per_s", sync.observer_rad_per_s, 1.0, 1e5),
            ("sync.dead_zone_um", sync.dead_zone_um, 0.0, 1000.0),
            ("sync.governor_per_s", sync.governor_per_s, 0.0, 100.0),
            ("sync.learning_gain", sync.learning_gain, 0.0, 1.0),
            ("sync.learning_forgetting", sync.learning_forgetting, 0.0, 1.0),
            ("sync.learning_smoothing_s", sync.learning_smoothing_s, 0.0, 0.02),
            ("sync.learning_lead_s", sync.learning_lead_s, 0.0, 0.1),
            ("sync.learning_taper_s", sync.learning_taper_s, 1e-4, 1.0),
            ("supervision.bridge_periods", supervision.bridge_periods, 1.0, 50.0),
            ("supervision.error_limit_um", supervision.error_limit_um.unwrap_or(1.0), 0.01, 1e6),
            ("supervision.spindle_limit_rev", supervision.spindle_limit_rev.unwrap_or(1.0), 1e-4, 100.0),
            ("supervision.z_limit_um", supervision.z_limit_um.unwrap_or(1.0), 0.1, 1e6),
            ("supervision.scale_ratio", supervision.scale_ratio, 1e-4, 0.5),
            ("law.motor_share", law.motor_share, 0.01, 1.0),
            ("law.torque_curve.start_rpm", law.torque_curve.start_rpm, 0.0, 200_000.0),
            ("law.torque_curve.end_rpm", law.torque_curve.end_rpm, 0.0, 200_000.0),
            ("law.s_curve.accel_rpm_per_s", law.s_curve.accel_rpm_per_s, 1.0, 1e8),
            ("law.s_curve.jerk_rpm_per_s2", law.s_curve.jerk_rpm_per_s2, 1.0, 1e12),
            ("law.linear.accel_rpm_per_s", law.linear.accel_rpm_per_s, 1.0, 1e8),
            ("law.torque_curve_smooth.jerk_rpm_per_s2", law.torque_curve_smooth.jerk_rpm_per_s2, 1.0, 1e12),
            ("law.trapezoid_jerk.accel_rpm_per_s", law.trapezoid_jerk.accel_rpm_per_s, 1.0, 1e8),
            ("law.trapezoid_jerk.jerk_rpm_per_s2", law.trapezoid_jerk.jerk_rpm_per_s2, 1.0, 1e12),
            ("law.trapezoid_jerk.snap_rpm_per_s3", law.trapezoid_jerk.snap_rpm_per_s3, 1.0, 1e16),
            ("law.improved_s_curve.accel_rpm_per_s", law.improved_s_curve.accel_rpm_per_s, 1.0, 1e8),
            ("tap.pitch_mm", tap.pitch_mm.unwrap_or(1.0), 0.05, 50.0),
            ("tap.major_mm", tap.major_mm.unwrap_or(1.0), 0.1, 500.0),
            ("tap.hole_mm", tap.hole_mm.unwrap_or(1.0), 0.1, 500.0),
            ("tap.kc_n_per_mm2", tap.kc_n_per_mm2, 0.0, 20_000.0),
            ("tap.tool_factor", tap.tool_factor, 0.1, 10.0),
            ("tap.surface_below_r_mm", tap.surface_below_r_mm, 0.0, 1000.0),
            ("tap.ramp_pitches", tap.ramp_pitches, 0.0, 50.0),
            ("tap.chip_noise_ratio", tap.chip_noise_ratio, 0.0, 2.0),
            ("tap.out_torque_ratio", tap.out_torque_ratio, 0.0, 2.0),
            ("tap.axial_n", tap.axial_n, -5000.0, 5000.0),
            ("tap.bottom_clearance_mm", tap.bottom_clearance_mm.unwrap_or(1.0), 0.0, 100.0),
            ("tolerance.error_um", tolerance.error_um.unwrap_or(1.0), 0.01, 10_000.0),
        ]
        .into_iter()
    }

    fn torque_curve_faults(&self, report: &mut dyn FnMut(MachineError)) {
        let spindle = &self.spindle;
        let key = "spindle.torque_curve";
        if let Err(error) = TorqueCurve::new(&spindle.torque_curve) {
            let index = match error {
                TorqueCurveError::SpeedOrder { point, .. } | TorqueCurveError::Torque { point, .. } => Some(point),
                TorqueCurveError::FirstSpeed { .. } => Some(0),
                TorqueCurveError::StandstillTorque { .. } => Some(1),
                TorqueCurveError::Count { .. } => None,
            };
            report(MachineError { key, index, fault: MachineFault::TorqueCurve(error) });
        } else if let Some(last) = spindle.torque_curve.last()
            && last.speed_rpm < spindle.max_rpm
        {
            let fault = MachineFault::TorqueCurveEnd { last_rpm: last.speed_rpm, max_rpm: spindle.max_rpm };
            report(MachineError { key, index: Some(spindle.torque_curve.len() - 1), fault });
        }
    }

    fn band_faults(&self, report: &mut dyn FnMut(MachineError)) {
        let law = &self.law.torque_curve;
        let key = "law.torque_curve.bands";
        let Some(last) = law.bands.last() else {
            return report(MachineError { key, index: None, fault: MachineFault::NoBands });
        };
        let mut previous_rpm = 0.0;
        for (index, band) in law.bands.iter().enumerate() {
            let mut fault = |key, fault| report(MachineError { key, index: Some(index), fault });
            let to_rpm = band.to_rpm;
            if !to_rpm.is_finite() || to_rpm > 200_000.0 {
                let fault_of_top = MachineFault::OutOfRange { value: to_rpm, low: 0.0, high: 200_000.0 };
                fault("law.torque_curve.bands.to_rpm", fault_of_top);
            } else if !(to_rpm > previous_rpm) {
                fault(key, MachineFault::BandOrder { to_rpm, previous_rpm });
            }
            let (pair, low, high) = match band.ramp {
                Ramp::Time { accel_s, decel_s } => (
                    [("law.torque_curve.bands.accel_s", accel_s), ("law.torque_curve.bands.decel_s", decel_s)],
                    1e-6,
                    1000.0,
                ),
                Ramp::Rate { accel_rpm_per_s, decel_rpm_per_s } => (
                    [
                        ("law.torque_curve.bands.accel_rpm_per_s", accel_rpm_per_s),
                        ("law.torque_curve.bands.decel_rpm_per_s", decel_rpm_per_s),
                    ],
                    1.0,
                    1e8,
                ),
            };
            for (key, value) in pair {
                if !(value >= low && value <= high) {
                    fault(key, MachineFault::OutOfRange { value, low, high });
                }
            }
            previous_rpm = to_rpm;
        }
        for (key, speed_rpm) in
            [("law.torque_curve.start_rpm", law.start_rpm), ("law.torque_curve.end_rpm", law.end_rpm)]
        {
            if speed_rpm >= last.to_rpm {
                let fault = MachineFault::SpeedAboveBands { speed_rpm, last_rpm: last.to_rpm };
                report(MachineError { key, index: None, fault });
            }
        }
    }

    fn cross_faults(&self, report: &mut dyn FnMut(MachineError)) {
        let Self { control, spindle, z_axis, drive, tap, .. } = self;
        let mut fault = |key, fault| report(MachineError { key, index: None, fault });
        if spindle.tool_inertia_kg_m2 >= spindle.inertia_kg_m2 {
            let (part, whole) = (spindle.tool_inertia_kg_m2, spindle.inertia_kg_m2);
            fault("spindle.tool_inertia_kg_m2", MachineFault::PartNotBelowWhole { part, whole });
        }
        let ratio = control.period_s / drive.period_s;
        if (ratio - crate::control::math::round(ratio)).abs() > 1e-6 || ratio < 0.5 {
            let (drive_s, interpolation_s) = (drive.period_s, control.period_s);
            fault("drive.period_s", MachineFault::PeriodsDisagree { drive_s, interpolation_s });
        }
        let limit_um = FINEST_TOLERANCE_SHARE * FINEST_TOLERANCE_UM;
        for (key, count_um) in [
            ("spindle.encoder_counts_per_rev", 1000.0 * FINEST_MM / spindle.encoder_counts_per_rev),
            ("z.encoder_counts_per_mm", 1000.0 / z_axis.encoder_counts_per_mm),
        ] {
            if count_um > limit_um {
                fault(key, MachineFault::EncoderTooCoarse { count_um, limit_um });
            }
        }
        match (tap.major_mm, tap.hole_mm) {
            (Some(major_mm), Some(hole_mm)) if hole_mm >= major_mm => {
                fault("tap.hole_mm", MachineFault::HoleNotBelowMajor { hole_mm, major_mm });
            }
            (Some(_), None) => fault("tap.major_mm", MachineFault::TapIncomplete),
            (None, Some(_)) => fault("tap.hole_mm", MachineFault::TapIncomplete),
            _ => {}
        }
    }
}
