//! A sweep's machines as CSV: what was drawn, the seed, what came of it.

use crate::control::machine::Machine;
use crate::study::{HoleErrors, Sweep, SweptMachine};

/// The columns, in order. Empty is none; `inf` is a hole that an alarm kept from being begun.
pub const COLUMNS: [&str; 22] = [
    "run",
    "seed",
    "inertia",
    "torque_limit",
    "torque_constant",
    "friction",
    "spindle_resonance",
    "z_resonance",
    "cutting_torque",
    "encoder_error",
    "backlash_um",
    "encoder_latency_s",
    "error_um",
    "true_error_um",
    "worst_um",
    "bottom_overshoot_um",
    "last_worst_um",
    "last_bottom_overshoot_um",
    "worst_growth_ratio",
    "saturated",
    "unstable",
    "alarm",
];

/// All machines in the order of their numbers, every number with the digits that tell it from its neighbours.
#[must_use]
pub fn sweep_csv(sweep: &Sweep, machine: &Machine) -> String {
    let mut text = COLUMNS.join(",") + "\n";
    for found in &sweep.machines {
        text += &fields(found, machine).join(",");
        text.push('\n');
    }
    text
}

fn fields(found: &SweptMachine, machine: &Machine) -> [String; COLUMNS.len()] {
    let SweptMachine { run, seed, actual, first, last, worst_growth_ratio, saturated, unstable, alarm } = found;
    let HoleErrors { error_um, true_error_um, worst_um, bottom_overshoot_um } = first;
    let spec = machine.spec();
    let flag = |on: bool| u8::from(on).to_string();
    [
        run.to_string(),
        seed.to_string(),
        actual.inertia.to_string(),
        actual.torque_limit.to_string(),
        actual.torque_constant.to_string(),
        actual.friction.to_string(),
        actual.spindle_resonance.to_string(),
        actual.z_resonance.to_string(),
        actual.cutting_torque.to_string(),
        actual.encoder_error.to_string(),
        actual.backlash_um.unwrap_or(spec.z_axis.backlash_um).to_string(),
        actual.encoder_latency_s.unwrap_or(spec.drive.encoder_latency_s).to_string(),
        error_um.to_string(),
        true_error_um.to_string(),
        worst_um.to_string(),
        bottom_overshoot_um.to_string(),
        last.worst_um.to_string(),
        last.bottom_overshoot_um.to_string(),
        worst_growth_ratio.map_or_else(String::new, |ratio| ratio.to_string()),
        flag(*saturated),
        flag(*unstable),
        flag(alarm.is_some()),
    ]
}
