//! `[spindle]`

use super::key::{Key, Slot};
use crate::control::machine::SpindleEncoderAt;

#[rustfmt::skip]
pub(super) const KEYS: &[Key] = &[
    Key::number("spindle.max_rpm", "rpm", "greatest speed",
        "usual for a BT30 drilling-tapping centre", |d| &mut d.spec.spindle.max_rpm),
    Key::number("spindle.inertia_kg_m2", "kg·m²", "motor, shaft, chuck and tool together",
        "5000 rad/s² at 20 N·m: a built-in motor with its shaft", |d| &mut d.spec.spindle.inertia_kg_m2),
    Key::number("spindle.tool_inertia_kg_m2", "kg·m²", "the tool's side of the torsional spring, part of the total",
        "30 % of the total: shaft nose, holder, chuck", |d| &mut d.spec.spindle.tool_inertia_kg_m2),
    Key::number("spindle.resonance_hz", "Hz", "torsional resonance, both sides free",
        "a direct drive's short shaft; belts lie far lower", |d| &mut d.spec.spindle.resonance_hz),
    Key::number("spindle.damping_ratio", "", "damping ratio of that resonance",
        "steel shaft with clamped joints", |d| &mut d.spec.spindle.damping_ratio),
    Key::number("spindle.torque_lag_s", "s", "time constant of the current loop",
        "current loop of about 250 Hz", |d| &mut d.spec.spindle.torque_lag_s),
    Key::number("spindle.coulomb_nm", "N·m", "Coulomb friction",
        "bearings and seals, 1.5 % of the motor", |d| &mut d.spec.spindle.coulomb_nm),
    Key::number("spindle.viscous_nm_per_rpm", "N·m/rpm", "viscous friction",
        "0.3 N·m at 8000 rpm: grease", |d| &mut d.spec.spindle.viscous_nm_per_rpm),
    Key::number("spindle.torque_ripple", "", "amplitude of the torque ripple, share of the torque",
        "cogging and current offset of a good servo motor", |d| &mut d.spec.spindle.torque_ripple),
    Key::number("spindle.supply_sag_ratio", "", "share of the power limit that the supply loses at full power",
        "DC link under full load", |d| &mut d.spec.spindle.supply_sag_ratio),
    Key::number("spindle.supply_sag_s", "s", "time constant of that loss",
        "one mains period: the link capacitor", |d| &mut d.spec.spindle.supply_sag_s),
    Key {
        path: "spindle.encoder_at", unit: "", meaning: "where the encoder sits, \"motor\" or \"tool\"",
        reason: "in the motor: it does not see how far the shaft winds up",
        slot: Slot::Word {
            known: &["motor", "tool"],
            get: |d| match d.spec.spindle.encoder_at {
                SpindleEncoderAt::Motor => "motor",
                SpindleEncoderAt::Tool => "tool",
            },
            set: |d, word| {
                d.spec.spindle.encoder_at =
                    if word == "tool" { SpindleEncoderAt::Tool } else { SpindleEncoderAt::Motor };
            },
        },
    },
    Key::number("spindle.encoder_counts_per_rev", "counts/rev", "after multiplication",
        "4096 lines, four counts each", |d| &mut d.spec.spindle.encoder_counts_per_rev),
    Key {
        path: "spindle.encoder_lines_per_rev", unit: "lines/rev",
        meaning: "before multiplication, a quarter of the counts; only checks encoder_counts_per_rev",
        reason: "not checked",
        slot: Slot::Optional { at: |d| &mut d.data_sheet.encoder_lines_per_rev, example: 4096.0 },
    },
    Key {
        path: "spindle.torque_curve", unit: "[rpm, N·m]",
        meaning: "torque over speed; power is linear in speed between points, the last point reaches max_rpm",
        reason: "constant torque to 3000 rpm, then 6.3 kW: figure 2 of the torque-curve paper",
        slot: Slot::TorqueCurve,
    },
    Key {
        path: "spindle.plate_kw", unit: "kW", meaning: "continuous power on the motor's plate; only checks torque_curve",
        reason: "not checked",
        slot: Slot::Optional { at: |d| &mut d.data_sheet.plate_kw, example: 6.3 },
    },
];
