//! The built-in reference machine: representative of a BT30 drilling-tapping centre, not a datasheet.

use arrayvec::ArrayVec;

use super::Machine;
use super::law_spec::{
    BandSpec, ImprovedSCurveLawSpec, LawSpec, LinearLawSpec, Ramp, SCurveLawSpec, TorqueCurveLawSpec,
    TorqueCurveSmoothLawSpec, TrapezoidJerkLawSpec,
};
use super::spec::{
    AxisSpec, ControlSpec, DriveSpec, MachineSpec, SpindleEncoderAt, SpindleSpec, SupervisionSpec, SyncSpec, Takes,
    TapSpec, ToleranceSpec, ZEncoderAt, ZSpec,
};
use crate::control::motor::TorquePoint;

/// X, Y and Z alike: a light drilling-tapping centre's rapids of 30 m/min and 1 g.
const AXIS: AxisSpec = AxisSpec { max_mm_per_s: 500.0, max_mm_per_s2: 10_000.0, max_mm_per_s3: 500_000.0 };

fn fixed<T: Copy, const N: usize>(items: &[T]) -> ArrayVec<T, N> {
    ArrayVec::try_from(items).unwrap_or_default()
}

const fn band(to_rpm: f64, seconds: f64) -> BandSpec {
    BandSpec { to_rpm, ramp: Ramp::Time { accel_s: seconds, decel_s: seconds } }
}

impl MachineSpec {
    /// The reference machine's data. The machine file that `rigidtap machine` prints says of each key why it stands as it does.
    #[must_use]
    pub fn reference() -> Self {
        let mut spec = Self::data();
        spec.sync = SyncSpec::by_rules(&spec);
        spec
    }

    fn data() -> Self {
        let point = |speed_rpm, torque_nm| TorquePoint { speed_rpm, torque_nm };
        Self {
            control: ControlSpec { period_s: 0.001 },
            spindle: SpindleSpec {
                max_rpm: 8000.0,
                inertia_kg_m2: 0.004,
                tool_inertia_kg_m2: 0.0012,
                resonance_hz: 400.0,
                damping_ratio: 0.03,
                torque_lag_s: 0.000_65,
                coulomb_nm: 0.3,
                viscous_nm_per_rpm: 0.3 / 8000.0,
                torque_ripple: 0.01,
                supply_sag_ratio: 0.05,
                supply_sag_s: 0.02,
                encoder_at: SpindleEncoderAt::Motor,
                encoder_counts_per_rev: 16_384.0,
                torque_curve: fixed(&[point(0.0, 20.0), point(3000.0, 20.0), point(8000.0, 7.5)]),
            },
            x: AXIS,
            y: AXIS,
            z: AXIS,
            z_axis: ZSpec {
                mass_kg: 600.0,
                table_share: 1.0 / 3.0,
                resonance_hz: 100.0,
                damping_ratio: 0.04,
                torque_lag_s: 0.0004,
                force_limit_n: 8829.0,
                coulomb_n: 300.0,
                static_ratio: 1.3,
                stribeck_mm_per_s: 2.0,
                presliding_um: 5.0,
                friction_ripple: 0.10,
                friction_direction: 0.05,
                friction_hole_spread: 0.03,
                friction_table_share: 0.5,
                backlash_um: 2.0,
                encoder_at: ZEncoderAt::Table,
                encoder_counts_per_mm: 10_000.0,
                motor_counts_per_mm: 10_000.0,
            },
            drive: DriveSpec {
                period_s: 0.000_125,
                latency_periods: 1.0,
                spindle_takes: Takes::Torque,
                z_takes: Takes::Torque,
                spindle_position_gain_per_s: 40.0,
                spindle_velocity_gain_per_s: 200.0,
                spindle_integral_s: 0.02,
                z_position_gain_per_s: 40.0,
                z_velocity_gain_per_s: 500.0,
                z_integral_s: 0.01,
                velocity_filter_s: 0.000_25,
                encoder_latency_s: 0.000_05,
                encoder_jitter_s: 0.000_002,
                spindle_interpolation_counts: 1.0,
                z_interpolation_um: 0.1,
            },
            sync: SyncSpec::default(),
            supervision: SupervisionSpec::default(),
            law: LawSpec {
                motor_share: 0.8,
                torque_curve: TorqueCurveLawSpec {
                    start_rpm: 0.0,
                    end_rpm: 0.0,
                    bands: fixed(&[
                        band(3000.0, 0.0785),
                        band(4200.0, 0.0440),
                        band(5600.0, 0.0684),
                        band(8000.0, 0.1675),
                    ]),
                },
                s_curve: SCurveLawSpec { accel_rpm_per_s: 38_197.0, jerk_rpm_per_s2: 1_273_233.0 },
                linear: LinearLawSpec { accel_rpm_per_s: 38_197.0 },
                torque_curve_smooth: TorqueCurveSmoothLawSpec { jerk_rpm_per_s2: 6.4e6 },
                trapezoid_jerk: TrapezoidJerkLawSpec {
                    accel_rpm_per_s: 38_197.0,
                    jerk_rpm_per_s2: 1_909_850.0,
                    snap_rpm_per_s3: 190_985_000.0,
                    quantised: false,
                },
                improved_s_curve: ImprovedSCurveLawSpec { accel_rpm_per_s: 38_197.0 },
            },
            tap: TapSpec {
                pitch_mm: None,
                major_mm: None,
                hole_mm: None,
                kc_n_per_mm2: 1300.0,
                tool_factor: 1.05,
                surface_below_r_mm: 2.0,
                ramp_pitches: 4.0,
                chip_noise_ratio: 0.2,
                out_torque_ratio: 0.3,
                axial_n: 0.0,
                bottom_clearance_mm: None,
            },
            tolerance: ToleranceSpec { error_um: None },
        }
    }
}

impl Machine {
    /// The reference machine, checked.
    ///
    /// ```
    /// assert_eq!(rigidtap::control::machine::Machine::reference().spec().spindle.max_rpm, 8000.0);
    /// ```
    #[must_use]
    pub fn reference() -> Self {
        Self::derive(MachineSpec::reference())
    }
}
