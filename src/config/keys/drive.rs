//! `[control]`, `[drive]`

use super::key::{Key, Slot};
use crate::control::machine::Takes;

#[rustfmt::skip]
pub(super) const CONTROL: &[Key] = &[
    Key::number("control.period_s", "s", "interpolation period T",
        "the usual servo period of a CNC kernel, and the papers'", |d| &mut d.spec.control.period_s),
];

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    Key::number("drive.period_s", "s", "period of the position and velocity loops, a whole part of control.period_s",
        "8 kHz, usual for a digital drive", |d| &mut d.spec.drive.period_s),
    Key::number("drive.latency_periods", "periods", "interpolation periods by which a setpoint acts late",
        "one bus cycle; the drive interpolates between setpoints", |d| &mut d.spec.drive.latency_periods),
    Key {
        path: "drive.spindle_takes", unit: "",
        meaning: "what the spindle's drive takes of a setpoint: \"speed\" alone, without a position loop, \"position\" \
                  alone, \"velocity\" too, \"torque\" and acceleration too",
        reason: "a servo on a field bus with offsets, CiA 402's cyclic synchronous position",
        slot: Slot::Word {
            known: &["speed", "position", "velocity", "torque"],
            get: |d| d.spec.drive.spindle_takes.name(),
            set: |d, word| d.spec.drive.spindle_takes = takes(word),
        },
    },
    Key {
        path: "drive.z_takes", unit: "", meaning: "the same of Z's drive, which has a position loop in any case",
        reason: "as the spindle's",
        slot: Slot::Word {
            known: &["position", "velocity", "torque"],
            get: |d| d.spec.drive.z_takes.name(),
            set: |d, word| d.spec.drive.z_takes = takes(word),
        },
    },
    Key::number("drive.spindle_position_gain_per_s", "1/s", "spindle's position gain Kv",
        "equal to Z's, or the axes lag differently", |d| &mut d.spec.drive.spindle_position_gain_per_s),
    Key::number("drive.spindle_velocity_gain_per_s", "1/s", "spindle's velocity gain, per its inertia",
        "velocity loop of 32 Hz, well below the resonance; fixed for every figure",
        |d| &mut d.spec.drive.spindle_velocity_gain_per_s),
    Key::number("drive.spindle_integral_s", "s", "integral time of the spindle's velocity loop",
        "four times the loop's time constant", |d| &mut d.spec.drive.spindle_integral_s),
    Key::number("drive.z_position_gain_per_s", "1/s", "Z's position gain Kv",
        "2.4 m/min per mm of lag, commissioned with margin", |d| &mut d.spec.drive.z_position_gain_per_s),
    Key::number("drive.z_velocity_gain_per_s", "1/s", "Z's velocity gain, per its mass",
        "velocity loop of 80 Hz, on the motor; fixed for every figure: raising it is not a result",
        |d| &mut d.spec.drive.z_velocity_gain_per_s),
    Key::number("drive.z_integral_s", "s", "integral time of Z's velocity loop",
        "five times the loop's time constant", |d| &mut d.spec.drive.z_integral_s),
    Key::number("drive.velocity_filter_s", "s", "time constant of the filter on measured velocity",
        "two drive periods, against the encoders' quantisation", |d| &mut d.spec.drive.velocity_filter_s),
    Key::number("drive.encoder_latency_s", "s", "age of an encoder reading when it is latched",
        "serial encoder protocol", |d| &mut d.spec.drive.encoder_latency_s),
    Key::number("drive.encoder_jitter_s", "s", "greatest deviation of the latching instant, either way",
        "latching by software in the drive's interrupt", |d| &mut d.spec.drive.encoder_jitter_s),
    Key::number("drive.spindle_interpolation_counts", "counts", "amplitude of the spindle encoder's interpolation error",
        "sine signals with offset and phase error", |d| &mut d.spec.drive.spindle_interpolation_counts),
    Key::number("drive.z_interpolation_um", "µm", "amplitude of Z's interpolation error",
        "an optical scale of 20 µm signal period", |d| &mut d.spec.drive.z_interpolation_um),
];

/// One of the known words.
fn takes(word: &str) -> Takes {
    Takes::ALL.into_iter().find(|takes| takes.name() == word).unwrap_or_default()
}
