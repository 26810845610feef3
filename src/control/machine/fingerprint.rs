//! A number that tells machines apart: the CRC-64 of all their data.

use crc::{CRC_64_XZ, Crc, Digest, NoTable};

use super::law_spec::{
    BandSpec, ImprovedSCurveLawSpec, LawSpec, LinearLawSpec, Ramp, SCurveLawSpec, TorqueCurveLawSpec,
    TorqueCurveSmoothLawSpec, TrapezoidJerkLawSpec,
};
use super::spec::{
    AxisSpec, ControlSpec, DriveSpec, MachineSpec, SpindleEncoderAt, SpindleSpec, SupervisionSpec, SyncSpec, Takes,
    TapSpec, ToleranceSpec, ZEncoderAt, ZSpec,
};
use crate::control::motor::TorquePoint;

/// It takes no table: it is computed once for a machine.
static CRC: Crc<u64, NoTable> = Crc::<u64, NoTable>::new(&CRC_64_XZ);

/// The CRC-64/XZ of a machine's data, in the order of their declaration, each number as its eight bytes, low one first.
pub(super) fn of_all(spec: &MachineSpec) -> u64 {
    sum(&[spec])
}

/// The same of what moves and how it is synchronised.
pub(super) fn of_motion(spec: &MachineSpec) -> u64 {
    let MachineSpec {
        control,
        spindle,
        x: _,
        y: _,
        z,
        z_axis,
        drive,
        sync,
        supervision: _,
        law: _,
        tap: _,
        tolerance: _,
    } = spec;
    sum(&[control, spindle, z, z_axis, drive, sync])
}

/// The same of tap and material.
pub(super) fn of_tap(spec: &MachineSpec) -> u64 {
    sum(&[&spec.tap])
}

fn sum(parts: &[&dyn Feed]) -> u64 {
    let mut digest = CRC.digest();
    parts.iter().for_each(|part| part.feed(&mut digest));
    digest.finalize()
}

/// What goes into the number.
trait Feed {
    fn feed(&self, digest: &mut Digest<'_, u64, NoTable>);
}

impl Feed for f64 {
    fn feed(&self, digest: &mut Digest<'_, u64, NoTable>) {
        digest.update(&self.to_bits().to_le_bytes());
    }
}

impl Feed for u8 {
    fn feed(&self, digest: &mut Digest<'_, u64, NoTable>) {
        digest.update(&[*self]);
    }
}

impl Feed for bool {
    fn feed(&self, digest: &mut Digest<'_, u64, NoTable>) {
        u8::from(*self).feed(digest);
    }
}

impl<T: Feed> Feed for Option<T> {
    fn feed(&self, digest: &mut Digest<'_, u64, NoTable>) {
        self.is_some().feed(digest);
        if let Some(value) = self {
            value.feed(digest);
        }
    }
}

impl<T: Feed, const MOST: usize> Feed for arrayvec::ArrayVec<T, MOST> {
    fn feed(&self, digest: &mut Digest<'_, u64, NoTable>) {
        for value in self {
            true.feed(digest);
            value.feed(digest);
        }
        false.feed(digest);
    }
}

impl Feed for Ramp {
    fn feed(&self, digest: &mut Digest<'_, u64, NoTable>) {
        let (kind, up, down) = match self {
            Self::Time { accel_s, decel_s } => (0_u8, accel_s, decel_s),
            Self::Rate { accel_rpm_per_s, decel_rpm_per_s } => (1, accel_rpm_per_s, decel_rpm_per_s),
        };
        kind.feed(digest);
        up.feed(digest);
        down.feed(digest);
    }
}

/// Choices without data, by their number.
macro_rules! choices {
    ($($kind:ident),*) => {$(
        impl Feed for $kind {
            fn feed(&self, digest: &mut Digest<'_, u64, NoTable>) {
                (*self as u8).feed(digest);
            }
        }
    )*};
}
choices!(SpindleEncoderAt, ZEncoderAt, Takes);

/// All fields of a table: one that is forgotten here does not compile.
macro_rules! tables {
    ($($kind:ident { $($field:ident),* })*) => {$(
        impl Feed for $kind {
            fn feed(&self, digest: &mut Digest<'_, u64, NoTable>) {
                let Self { $($field),* } = self;
                $($field.feed(digest);)*
            }
        }
    )*};
}
tables! {
    MachineSpec { control, spindle, x, y, z, z_axis, drive, sync, supervision, law, tap, tolerance }
    ControlSpec { period_s }
    SpindleSpec {
        max_rpm, inertia_kg_m2, tool_inertia_kg_m2, resonance_hz, damping_ratio, torque_lag_s, coulomb_nm,
        viscous_nm_per_rpm, torque_ripple, supply_sag_ratio, supply_sag_s, encoder_at, encoder_counts_per_rev,
        torque_curve
    }
    AxisSpec { max_mm_per_s, max_mm_per_s2, max_mm_per_s3 }
    ZSpec {
        mass_kg, table_share, resonance_hz, damping_ratio, torque_lag_s, force_limit_n, coulomb_n, static_ratio,
        stribeck_mm_per_s, presliding_um, friction_ripple, friction_direction, friction_hole_spread,
        friction_table_share, backlash_um, encoder_at, encoder_counts_per_mm, motor_counts_per_mm
    }
    DriveSpec {
        period_s, latency_periods, spindle_takes, z_takes, spindle_position_gain_per_s, spindle_velocity_gain_per_s,
        spindle_integral_s, z_position_gain_per_s, z_velocity_gain_per_s, z_integral_s, velocity_filter_s,
        encoder_latency_s, encoder_jitter_s, spindle_interpolation_counts, z_interpolation_um
    }
    SyncSpec {
        backlash_crossing_s, observer_rad_per_s, dead_zone_um, governor_per_s, learning_gain, learning_forgetting,
        learning_smoothing_s, learning_lead_s, learning_taper_s
    }
    SupervisionSpec { bridge_periods, error_limit_um, spindle_limit_rev, z_limit_um, scale_ratio }
    TapSpec {
        pitch_mm, major_mm, hole_mm, kc_n_per_mm2, tool_factor, surface_below_r_mm, ramp_pitches, chip_noise_ratio,
        out_torque_ratio, axial_n, bottom_clearance_mm
    }
    ToleranceSpec { error_um }
    BandSpec { to_rpm, ramp }
    LawSpec { motor_share, torque_curve, s_curve, linear, torque_curve_smooth, trapezoid_jerk, improved_s_curve }
    TorqueCurveLawSpec { start_rpm, end_rpm, bands }
    SCurveLawSpec { accel_rpm_per_s, jerk_rpm_per_s2 }
    LinearLawSpec { accel_rpm_per_s }
    TorqueCurveSmoothLawSpec { jerk_rpm_per_s2 }
    TrapezoidJerkLawSpec { accel_rpm_per_s, jerk_rpm_per_s2, snap_rpm_per_s3, quantised }
    ImprovedSCurveLawSpec { accel_rpm_per_s }
    TorquePoint { speed_rpm, torque_nm }
}

#[cfg(test)]
mod tests {
    use crate::control::machine::Machine;

    #[test]
    fn machines_differ_by_any_of_their_data() {
        let machine = Machine::reference();
        assert_eq!(machine.fingerprint(), Machine::reference().fingerprint());
        let others = [
            machine.with(|spec| spec.z_axis.encoder_counts_per_mm *= 2.0).unwrap(),
            machine.with(|spec| spec.supervision.error_limit_um = Some(0.5)).unwrap(),
            machine.with(|spec| spec.drive.z_takes = crate::control::machine::Takes::Velocity).unwrap(),
        ];
        assert!(others.iter().all(|other| other.fingerprint() != machine.fingerprint()));
        // What does not move is no part of what moves.
        let [resolution, limit, takes] = others.map(|other| other.motion_fingerprint() != machine.motion_fingerprint());
        assert_eq!((resolution, limit, takes), (true, false, true));
        let steel = machine.with(|spec| spec.tap.kc_n_per_mm2 *= 3.0).unwrap();
        assert!(steel.tap_fingerprint() != machine.tap_fingerprint());
        assert_eq!(steel.motion_fingerprint(), machine.motion_fingerprint());
    }
}
