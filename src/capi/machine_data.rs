//! The machine's data, laid out as the header says.

use crate::control::machine::{MachineSpec, Takes, ZEncoderAt};
use crate::control::motor::MAX_POINTS;
use crate::control::profile::MAX_BANDS;

/// `rigidtap_torque_point` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct RigidtapTorquePoint {
    /// Speed.
    pub speed_rpm: f64,
    /// Greatest torque there.
    pub torque_nm: f64,
}

/// `rigidtap_speed_band` of the header.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default)]
pub struct RigidtapSpeedBand {
    /// Top of the band.
    pub to_rpm: f64,
    /// Time in which it is crossed speeding up.
    pub accel_s: f64,
    /// The same slowing down.
    pub decel_s: f64,
}

/// The keys of a machine file that the control uses, each with its field of `rigidtap_machine_data`. Both directions are made
/// of this one list.
macro_rules! machine_fields {
    ($apply:ident) => {
        $apply! {
            period_s: control.period_s,
            latency_periods: drive.latency_periods,
            spindle_max_rpm: spindle.max_rpm,
            spindle_inertia_kg_m2: spindle.inertia_kg_m2,
            spindle_tool_inertia_kg_m2: spindle.tool_inertia_kg_m2,
            spindle_coulomb_nm: spindle.coulomb_nm,
            spindle_viscous_nm_per_rpm: spindle.viscous_nm_per_rpm,
            spindle_supply_sag_ratio: spindle.supply_sag_ratio,
            spindle_torque_lag_s: spindle.torque_lag_s,
            spindle_counts_per_rev: spindle.encoder_counts_per_rev,
            motor_share: law.motor_share,
            jerk_rpm_per_s2: law.torque_curve_smooth.jerk_rpm_per_s2,
            s_curve_accel_rpm_per_s: law.s_curve.accel_rpm_per_s,
            s_curve_jerk_rpm_per_s2: law.s_curve.jerk_rpm_per_s2,
            linear_accel_rpm_per_s: law.linear.accel_rpm_per_s,
            trapezoid_accel_rpm_per_s: law.trapezoid_jerk.accel_rpm_per_s,
            trapezoid_jerk_rpm_per_s2: law.trapezoid_jerk.jerk_rpm_per_s2,
            trapezoid_snap_rpm_per_s3: law.trapezoid_jerk.snap_rpm_per_s3,
            improved_accel_rpm_per_s: law.improved_s_curve.accel_rpm_per_s,
            x_max_mm_per_s: x.max_mm_per_s,
            x_max_mm_per_s2: x.max_mm_per_s2,
            x_max_mm_per_s3: x.max_mm_per_s3,
            y_max_mm_per_s: y.max_mm_per_s,
            y_max_mm_per_s2: y.max_mm_per_s2,
            y_max_mm_per_s3: y.max_mm_per_s3,
            z_max_mm_per_s: z.max_mm_per_s,
            z_max_mm_per_s2: z.max_mm_per_s2,
            z_max_mm_per_s3: z.max_mm_per_s3,
            z_counts_per_mm: z_axis.encoder_counts_per_mm,
            z_motor_counts_per_mm: z_axis.motor_counts_per_mm,
            z_mass_kg: z_axis.mass_kg,
            z_table_share: z_axis.table_share,
            z_resonance_hz: z_axis.resonance_hz,
            z_torque_lag_s: z_axis.torque_lag_s,
            z_force_limit_n: z_axis.force_limit_n,
            z_coulomb_n: z_axis.coulomb_n,
            z_static_ratio: z_axis.static_ratio,
            z_stribeck_mm_per_s: z_axis.stribeck_mm_per_s,
            z_presliding_um: z_axis.presliding_um,
            z_friction_table_share: z_axis.friction_table_share,
            z_backlash_um: z_axis.backlash_um,
            drive_period_s: drive.period_s,
            spindle_position_gain_per_s: drive.spindle_position_gain_per_s,
            spindle_velocity_gain_per_s: drive.spindle_velocity_gain_per_s,
            spindle_integral_s: drive.spindle_integral_s,
            z_position_gain_per_s: drive.z_position_gain_per_s,
            z_velocity_gain_per_s: drive.z_velocity_gain_per_s,
            z_integral_s: drive.z_integral_s,
            velocity_filter_s: drive.velocity_filter_s,
            encoder_latency_s: drive.encoder_latency_s,
            encoder_jitter_s: drive.encoder_jitter_s,
            tap_kc_n_per_mm2: tap.kc_n_per_mm2,
            tap_tool_factor: tap.tool_factor,
            tap_surface_below_r_mm: tap.surface_below_r_mm,
            tap_ramp_pitches: tap.ramp_pitches,
            tap_out_torque_ratio: tap.out_torque_ratio,
            tap_axial_n: tap.axial_n,
            supervision_bridge_periods: supervision.bridge_periods,
            supervision_scale_ratio: supervision.scale_ratio,
        }
    };
}

macro_rules! define_machine_data {
    ($($field:ident: $($path:ident).+,)*) => {
        /// `rigidtap_machine_data` of the header: the keys of a machine file that the control uses.
        #[repr(C)]
        #[derive(Clone, Copy, Debug)]
        #[allow(missing_docs, reason = "the header and the machine file say it")]
        pub struct RigidtapMachineData {
            $(pub $field: f64,)*
            pub tap_major_mm: f64,
            pub tap_hole_mm: f64,
            pub tap_bottom_clearance_mm: f64,
            pub supervision_error_limit_um: f64,
            pub supervision_spindle_limit_rev: f64,
            pub supervision_z_limit_um: f64,
            pub torque_curve: [RigidtapTorquePoint; MAX_POINTS],
            pub bands: [RigidtapSpeedBand; MAX_BANDS],
            pub torque_points: u32,
            pub band_count: u32,
            pub law: u32,
            pub z_encoder_at_motor: u32,
            pub spindle_takes: u32,
            pub z_takes: u32,
        }

        impl RigidtapMachineData {
            /// The numbers of a machine.
            pub(super) fn numbers_of(spec: &MachineSpec) -> Self {
                Self {
                    $($field: spec.$($path).+,)*
                    tap_major_mm: spec.tap.major_mm.unwrap_or(0.0),
                    tap_hole_mm: spec.tap.hole_mm.unwrap_or(0.0),
                    tap_bottom_clearance_mm: spec.tap.bottom_clearance_mm.unwrap_or(0.0),
                    supervision_error_limit_um: spec.supervision.error_limit_um.unwrap_or(0.0),
                    supervision_spindle_limit_rev: spec.supervision.spindle_limit_rev.unwrap_or(0.0),
                    supervision_z_limit_um: spec.supervision.z_limit_um.unwrap_or(0.0),
                    torque_curve: Default::default(),
                    bands: Default::default(),
                    torque_points: 0,
                    band_count: 0,
                    law: 0,
                    z_encoder_at_motor: u32::from(spec.z_axis.encoder_at == ZEncoderAt::Motor),
                    spindle_takes: number_of(spec.drive.spindle_takes),
                    z_takes: number_of(spec.drive.z_takes),
                }
            }

            /// Writes the numbers into a machine.
            pub(super) fn write_numbers(&self, spec: &mut MachineSpec) {
                $(spec.$($path).+ = self.$field;)*
                let given = |value: f64| (value != 0.0).then_some(value);
                (spec.tap.major_mm, spec.tap.hole_mm) = (given(self.tap_major_mm), given(self.tap_hole_mm));
                spec.tap.bottom_clearance_mm = given(self.tap_bottom_clearance_mm);
                let limits = &mut spec.supervision;
                limits.error_limit_um = given(self.supervision_error_limit_um);
                limits.spindle_limit_rev = given(self.supervision_spindle_limit_rev);
                limits.z_limit_um = given(self.supervision_z_limit_um);
                spec.z_axis.encoder_at =
                    if self.z_encoder_at_motor == 0 { ZEncoderAt::Table } else { ZEncoderAt::Motor };
            }
        }
    };
}

machine_fields!(define_machine_data);

/// `RIGIDTAP_TAKES_…` of the header, by their numbers.
const TAKES: [Takes; 4] = [Takes::Torque, Takes::Velocity, Takes::Position, Takes::Speed];

fn number_of(takes: Takes) -> u32 {
    TAKES.iter().position(|known| *known == takes).unwrap_or_default() as u32
}

/// What a drive takes, by its number; none for a number that the header has not.
pub(super) fn takes_of(number: u32) -> Option<Takes> {
    TAKES.get(number as usize).copied()
}
