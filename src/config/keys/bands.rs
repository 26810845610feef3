//! The bands of the torque-curve law: a list of tables.

/// Path of the list of bands, and the keys of one band with their units.
pub(in crate::config) const BANDS: &str = "law.torque_curve.bands";
pub(in crate::config) const BAND_KEYS: [(&str, &str); 5] =
    [("to_rpm", "rpm"), ("accel_s", "s"), ("decel_s", "s"), ("accel_rpm_per_s", "rpm/s"), ("decel_rpm_per_s", "rpm/s")];
