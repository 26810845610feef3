//! Unit legend, and every conversion between units.
//!
//! Base units are mm, rev and s, so that Z = pitch × spindle needs no 2π. The unit is the suffix of a name:
//! `depth_mm`, `peak_rpm`, `jerk_rev_per_s3`. rpm and mm/min appear only at the edges (G-code, files, reports),
//! radians only inside plant models.

/// Radians in one revolution.
pub const RAD_PER_REV: f64 = 2.0 * core::f64::consts::PI;
/// Degrees in one revolution.
pub const DEG_PER_REV: f64 = 360.0;
/// Seconds in one minute.
pub const S_PER_MIN: f64 = 60.0;
/// Milliseconds in one second.
pub const MS_PER_S: f64 = 1000.0;
/// Seconds in one hour.
pub const S_PER_HOUR: f64 = 3600.0;
/// Micrometres in one millimetre.
pub const UM_PER_MM: f64 = 1000.0;
/// Millimetres in one inch, exactly.
pub const MM_PER_INCH: f64 = 25.4;
/// Millimetres in one metre.
pub const MM_PER_M: f64 = 1000.0;

/// Rotary speed in rev/s of one in rpm. Serves acceleration and jerk too: rpm/s → rev/s², rpm/s² → rev/s³.
///
/// ```
/// assert_eq!(rigidtap::control::units::rev_per_s_from_rpm(3000.0), 50.0);
/// ```
#[must_use]
pub const fn rev_per_s_from_rpm(rpm: f64) -> f64 {
    rpm / S_PER_MIN
}

/// Rotary speed in rpm of one in rev/s; the inverse of [`rev_per_s_from_rpm`].
#[must_use]
pub const fn rpm_from_rev_per_s(rev_per_s: f64) -> f64 {
    rev_per_s * S_PER_MIN
}

/// Linear speed in mm/s of one in mm/min.
#[must_use]
pub const fn mm_per_s_from_mm_per_min(mm_per_min: f64) -> f64 {
    mm_per_min / S_PER_MIN
}

/// Linear speed in mm/min of one in mm/s.
#[must_use]
pub const fn mm_per_min_from_mm_per_s(mm_per_s: f64) -> f64 {
    mm_per_s * S_PER_MIN
}

/// Angle in revolutions of one in radians; speeds and accelerations likewise.
#[must_use]
pub const fn rev_from_rad(rad: f64) -> f64 {
    rad / RAD_PER_REV
}

/// Angle in revolutions of one in degrees.
#[must_use]
pub const fn rev_from_deg(deg: f64) -> f64 {
    deg / DEG_PER_REV
}

/// Angle in degrees of one in revolutions.
#[must_use]
pub const fn deg_from_rev(rev: f64) -> f64 {
    rev * DEG_PER_REV
}

/// Micrometres of a length in mm.
#[must_use]
pub const fn um_from_mm(mm: f64) -> f64 {
    mm * UM_PER_MM
}

/// Millimetres of a length in µm.
#[must_use]
pub const fn mm_from_um(um: f64) -> f64 {
    um / UM_PER_MM
}

/// Millimetres of a length in metres.
#[must_use]
pub const fn mm_from_m(m: f64) -> f64 {
    m * MM_PER_M
}

/// Metres of a length in mm.
#[must_use]
pub const fn m_from_mm(mm: f64) -> f64 {
    mm / MM_PER_M
}
