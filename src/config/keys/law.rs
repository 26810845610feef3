//! `[law]` and its tables

use super::bands::BANDS;
use super::key::{Key, Slot};

/// Keys that follow from the motor and the resonances where a file leaves them out, with the rule.
pub(in crate::config) const DERIVED: [(&str, &str); 9] = [
    (BANDS, "the best four for strokes of 5, 10, 25 and 50 rev"),
    ("law.s_curve.accel_rpm_per_s", AT_REST),
    ("law.s_curve.jerk_rpm_per_s2", "the acceleration is reached in 3 periods of the slower resonance"),
    ("law.linear.accel_rpm_per_s", AT_REST),
    ("law.torque_curve_smooth.jerk_rpm_per_s2", "that of rest is reached in 0.6 periods of the slower resonance"),
    ("law.trapezoid_jerk.accel_rpm_per_s", AT_REST),
    ("law.trapezoid_jerk.jerk_rpm_per_s2", "the acceleration is reached in 3 periods of the slower resonance"),
    ("law.trapezoid_jerk.snap_rpm_per_s3", "a third of these each for jerk up, constant jerk, jerk down"),
    ("law.improved_s_curve.accel_rpm_per_s", AT_REST),
];
const AT_REST: &str = "motor_share of the motor at rest";

/// The rule that a key follows where it is left out.
pub(in crate::config) fn rule(path: &str) -> Option<&'static str> {
    DERIVED.iter().find(|(key, _)| *key == path).map(|(_, rule)| *rule)
}

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    Key::number("law.motor_share", "", "share of the motor's torque that tuned laws may use",
        "leaves 20 % for friction, cutting and the drive's corrections", |d| &mut d.spec.law.motor_share),
    Key::number("law.torque_curve.start_rpm", "rpm", "start speed Vs",
        "a stroke starts from rest", |d| &mut d.spec.law.torque_curve.start_rpm),
    Key::number("law.torque_curve.end_rpm", "rpm", "end speed Ve",
        "a stroke ends at rest", |d| &mut d.spec.law.torque_curve.end_rpm),
    Key {
        path: BANDS, unit: "",
        meaning: "the speeds from the top of the band below to to_rpm, crossed in accel_s upwards and decel_s downwards, or \
                  with accel_rpm_per_s and decel_rpm_per_s; up to 16 bands, the papers use 4",
        reason: "80 % of the motor at each band's top, both directions",
        slot: Slot::Bands,
    },
    Key::number("law.s_curve.accel_rpm_per_s", "rpm/s", "greatest acceleration A",
        "that of the torque curve's first band", |d| &mut d.spec.law.s_curve.accel_rpm_per_s),
    Key::number("law.s_curve.jerk_rpm_per_s2", "rpm/s²", "jerk J",
        "the acceleration is reached in 30 ms", |d| &mut d.spec.law.s_curve.jerk_rpm_per_s2),
    Key::number("law.linear.accel_rpm_per_s", "rpm/s", "the one acceleration",
        "that of the torque curve's first band", |d| &mut d.spec.law.linear.accel_rpm_per_s),
    Key::number("law.torque_curve_smooth.jerk_rpm_per_s2", "rpm/s²", "greatest jerk j",
        "80 % of the motor at rest is reached in 6 ms", |d| &mut d.spec.law.torque_curve_smooth.jerk_rpm_per_s2),
    Key::number("law.trapezoid_jerk.accel_rpm_per_s", "rpm/s", "greatest acceleration a_max",
        "that of the torque curve's first band", |d| &mut d.spec.law.trapezoid_jerk.accel_rpm_per_s),
    Key::number("law.trapezoid_jerk.jerk_rpm_per_s2", "rpm/s²", "greatest jerk j_max",
        "the acceleration is reached in 30 ms, as by the S-curve", |d| &mut d.spec.law.trapezoid_jerk.jerk_rpm_per_s2),
    Key::number("law.trapezoid_jerk.snap_rpm_per_s3", "rpm/s³", "slope l of the jerk",
        "a third of these 30 ms each for jerk up, constant jerk, jerk down", |d| &mut d.spec.law.trapezoid_jerk.snap_rpm_per_s3),
    Key {
        path: "law.trapezoid_jerk.quantised", unit: "",
        meaning: "whether each phase takes a whole number of interpolation periods",
        reason: "the stroke that is not is a few periods shorter",
        slot: Slot::Switch(|d| &mut d.spec.law.trapezoid_jerk.quantised),
    },
    Key::number("law.improved_s_curve.accel_rpm_per_s", "rpm/s", "acceleration a_max that each change of speed peaks at",
        "that of the torque curve's first band", |d| &mut d.spec.law.improved_s_curve.accel_rpm_per_s),
];
