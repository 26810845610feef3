//! `[x]`, `[y]`, `[z]`

use super::key::{Key, Slot};
use crate::control::machine::ZEncoderAt;

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    Key::number("x.max_mm_per_s", "mm/s", "greatest speed", "rapids of 30 m/min", |d| &mut d.spec.x.max_mm_per_s),
    Key::number("x.max_mm_per_s2", "mm/s²", "greatest acceleration", "1 g", |d| &mut d.spec.x.max_mm_per_s2),
    Key::number("x.max_mm_per_s3", "mm/s³", "greatest jerk", "1 g in 20 ms", |d| &mut d.spec.x.max_mm_per_s3),
    Key::number("y.max_mm_per_s", "mm/s", "greatest speed", "as X", |d| &mut d.spec.y.max_mm_per_s),
    Key::number("y.max_mm_per_s2", "mm/s²", "greatest acceleration", "as X", |d| &mut d.spec.y.max_mm_per_s2),
    Key::number("y.max_mm_per_s3", "mm/s³", "greatest jerk", "as X", |d| &mut d.spec.y.max_mm_per_s3),
    Key::number("z.max_mm_per_s", "mm/s", "greatest speed", "as X", |d| &mut d.spec.z.max_mm_per_s),
    Key::number("z.max_mm_per_s2", "mm/s²", "greatest acceleration", "as X", |d| &mut d.spec.z.max_mm_per_s2),
    Key::number("z.max_mm_per_s3", "mm/s³", "greatest jerk", "as X", |d| &mut d.spec.z.max_mm_per_s3),
    Key::number("z.mass_kg", "kg", "moving mass and the rotating parts' equivalent",
        "200 kg of head, twice that of motor and screw", |d| &mut d.spec.z_axis.mass_kg),
    Key::number("z.table_share", "", "the table's side of the axial spring, share of the mass",
        "the head; motor and screw are the rest", |d| &mut d.spec.z_axis.table_share),
    Key::number("z.resonance_hz", "Hz", "axial resonance of the table with the motor's side held",
        "ball screw, nut and thrust bearing in series", |d| &mut d.spec.z_axis.resonance_hz),
    Key::number("z.damping_ratio", "", "damping ratio of that resonance",
        "ball screw on linear guides", |d| &mut d.spec.z_axis.damping_ratio),
    Key::number("z.torque_lag_s", "s", "time constant of the current loop",
        "current loop of about 400 Hz, faster than the larger spindle's", |d| &mut d.spec.z_axis.torque_lag_s),
    Key::number("z.force_limit_n", "N", "greatest force of the drive",
        "1.5 g of the equivalent mass", |d| &mut d.spec.z_axis.force_limit_n),
    Key::number("z.coulomb_n", "N", "Coulomb friction, motor's and table's side together",
        "preloaded nut, guides and wipers", |d| &mut d.spec.z_axis.coulomb_n),
    Key::number("z.static_ratio", "", "breakaway over Coulomb friction",
        "rolling guides; sliding ways reach 2", |d| &mut d.spec.z_axis.static_ratio),
    Key::number("z.stribeck_mm_per_s", "mm/s", "speed over which the Stribeck effect decays",
        "oil film builds up early on rolling guides", |d| &mut d.spec.z_axis.stribeck_mm_per_s),
    Key::number("z.presliding_um", "µm", "travel over which friction builds up after a reversal",
        "elastic contact of balls, a few µm", |d| &mut d.spec.z_axis.presliding_um),
    Key::number("z.friction_ripple", "", "amplitude of friction's change over position, share",
        "ball return and screw lead", |d| &mut d.spec.z_axis.friction_ripple),
    Key::number("z.friction_direction", "", "difference of friction between the directions, share",
        "gravity and its counterbalance do not cancel", |d| &mut d.spec.z_axis.friction_direction),
    Key::number("z.friction_hole_spread", "", "half-width of friction's change from hole to hole, share",
        "lubrication pulses, temperature", |d| &mut d.spec.z_axis.friction_hole_spread),
    Key::number("z.friction_table_share", "", "the table side's share of the friction",
        "half guides, half nut and bearings", |d| &mut d.spec.z_axis.friction_table_share),
    Key::number("z.backlash_um", "µm", "backlash between motor and table",
        "preloaded ball screw with some wear", |d| &mut d.spec.z_axis.backlash_um),
    Key {
        path: "z.encoder_at", unit: "", meaning: "\"table\" or \"motor\": where the position encoder sits",
        reason: "a linear scale: it sees backlash and screw",
        slot: Slot::Word {
            known: &["table", "motor"],
            get: |d| match d.spec.z_axis.encoder_at {
                ZEncoderAt::Table => "table",
                ZEncoderAt::Motor => "motor",
            },
            set: |d, word| {
                d.spec.z_axis.encoder_at = if word == "motor" { ZEncoderAt::Motor } else { ZEncoderAt::Table };
            },
        },
    },
    Key::number("z.encoder_counts_per_mm", "counts/mm", "the position encoder",
        "0.1 µm a count", |d| &mut d.spec.z_axis.encoder_counts_per_mm),
    Key::number("z.motor_counts_per_mm", "counts/mm", "the motor's encoder, per mm of Z",
        "100 000 counts a turn on a 10 mm screw", |d| &mut d.spec.z_axis.motor_counts_per_mm),
];
