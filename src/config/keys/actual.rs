//! `[actual]` and `[spread]`

use super::{Key, Slot};

const AS_FILE: &str = "as this file says";

#[rustfmt::skip]
pub(super) const ACTUAL: &[Key] = &[
    Key::number("actual.inertia", "", "factor on the spindle's inertia, both sides",
        AS_FILE, |d| &mut d.actual.inertia),
    Key::number("actual.torque_limit", "", "factor on the torque–speed curve",
        AS_FILE, |d| &mut d.actual.torque_limit),
    Key::number("actual.torque_constant", "", "factor on torque per current: the drive commands as if it were 1",
        AS_FILE, |d| &mut d.actual.torque_constant),
    Key::number("actual.friction", "", "factor on Z's and the spindle's friction",
        AS_FILE, |d| &mut d.actual.friction),
    Key::number("actual.spindle_resonance", "", "factor on the spindle's torsional resonance",
        AS_FILE, |d| &mut d.actual.spindle_resonance),
    Key::number("actual.z_resonance", "", "factor on Z's axial resonance",
        AS_FILE, |d| &mut d.actual.z_resonance),
    Key::number("actual.cutting_torque", "", "factor on the tapping torque",
        AS_FILE, |d| &mut d.actual.cutting_torque),
    Key::number("actual.encoder_error", "", "factor on the encoders' interpolation errors and jitter",
        AS_FILE, |d| &mut d.actual.encoder_error),
    Key {
        path: "actual.backlash_um", unit: "µm", meaning: "Z's backlash, in place of z.backlash_um", reason: AS_FILE,
        slot: Slot::Optional { at: |d| &mut d.actual.backlash_um, example: 2.0 },
    },
    Key {
        path: "actual.encoder_latency_s", unit: "s", meaning: "age of a reading, in place of drive.encoder_latency_s",
        reason: AS_FILE,
        slot: Slot::Optional { at: |d| &mut d.actual.encoder_latency_s, example: 0.000_05 },
    },
];

#[rustfmt::skip]
pub(super) const SPREAD: &[Key] = &[
    Key::range("spread.inertia", "", "factor on the spindle's inertia",
        "chucks and tools of one taper differ by a fifth of the total", |d| &mut d.spread.inertia),
    Key::range("spread.torque_limit", "", "factor on the torque–speed curve",
        "a warm motor, a low supply", |d| &mut d.spread.torque_limit),
    Key::range("spread.torque_constant", "", "factor on torque per current",
        "magnets lose some of it when warm", |d| &mut d.spread.torque_constant),
    Key::range("spread.friction", "", "factor on Z's and the spindle's friction",
        "cold grease and tight gibs to well run in", |d| &mut d.spread.friction),
    Key::range("spread.spindle_resonance", "", "factor on the spindle's torsional resonance",
        "tool and clamping", |d| &mut d.spread.spindle_resonance),
    Key::range("spread.z_resonance", "", "factor on Z's axial resonance",
        "position of the head, preload of the screw", |d| &mut d.spread.z_resonance),
    Key::range("spread.cutting_torque", "", "factor on the tapping torque",
        "air to a worn tap", |d| &mut d.spread.cutting_torque),
    Key::range("spread.encoder_error", "", "factor on the encoders' interpolation errors and jitter",
        "none to twice the usual", |d| &mut d.spread.encoder_error),
    Key::range("spread.backlash_um", "µm", "Z's backlash",
        "preloaded to worn", |d| &mut d.spread.backlash_um),
    Key::range("spread.encoder_latency_s", "s", "age of a reading",
        "a direct counter to a slow serial encoder", |d| &mut d.spread.encoder_latency_s),
];
