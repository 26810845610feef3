//! A sweep's machines as CSV: what was drawn, the seed, what came of it.

use std::io::{self, Write};

use crate::control::machine::Machine;
use crate::sim::{ACTUAL_VALUES, ActualValue};
use crate::study::{HoleErrors, Sweep, SweptMachine};

/// Columns of the standard plant, and of what only the hard spread has, at the end.
const STANDARD: usize = 22;
const HARD: usize = 21;

/// The columns, in order. Empty is none; `inf` is a hole that an alarm kept from being begun.
pub const COLUMNS: [&str; STANDARD + 2 + HARD] = [
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
    "stroke_over_bound",
    "verdict",
    "backlash_damping",
    "setpoint_latency_s",
    "setpoint_latency_periods",
    "host_jitter_s",
    "z_weight_n",
    "z_viscous_n_per_mm_s",
    "z_friction_asymmetry",
    "z_friction_model",
    "screw_error_um",
    "screw_lead_mm",
    "z_second_resonance_hz",
    "tap_axial_n",
    "spindle_eccentricity_arcsec",
    "torque_constant_fall",
    "stale_samples_per_hole",
    "missed_periods_per_hole",
    "drive_gain",
    "drive_delay_periods",
    "thermal_um_per_s",
    "effort_resolution",
    "reports_effort",
];

/// All machines in the order of their numbers, every number with the digits that tell it from its neighbours.
///
/// # Errors
/// Where the machines cannot be read, or the text cannot be written.
pub fn sweep_csv(sweep: &mut Sweep, machine: &Machine, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "{}", COLUMNS.join(","))?;
    let mut written = Ok(());
    sweep.each(&mut |found| {
        if written.is_ok() {
            written = writeln!(to, "{}", fields(found, machine).join(","));
        }
    })?;
    written
}

fn fields(found: &SweptMachine, machine: &Machine) -> Vec<String> {
    let SweptMachine { run, seed, actual, first, last, worst_growth_ratio, saturated, unstable, alarm } = found;
    let HoleErrors { error_um, true_error_um, worst_um, bottom_overshoot_um, stroke_over_bound, verdict, .. } = first;
    let spec = machine.spec();
    let flag = |on: bool| u8::from(on).to_string();
    let mut fields = vec![
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
        actual.backlash_of_um(spec.z_axis.backlash_um).to_string(),
        actual.encoder_latency_of_s(spec.drive.encoder_latency_s).to_string(),
        error_um.to_string(),
        true_error_um.to_string(),
        worst_um.to_string(),
        bottom_overshoot_um.to_string(),
        last.worst_um.to_string(),
        last.bottom_overshoot_um.to_string(),
        worst_growth_ratio.map_or_else(String::new, |ratio| ratio.to_string()),
        flag(*saturated),
        flag(*unstable),
        alarm.unwrap_or(0).to_string(),
        stroke_over_bound.to_string(),
        verdict.name().to_owned(),
    ];
    fields.extend(actual.values().into_iter().skip(ACTUAL_VALUES - HARD).map(|(_, value)| match value {
        ActualValue::Number(number) => number.map_or_else(String::new, |number| number.to_string()),
        ActualValue::Word(word) => word.to_owned(),
        ActualValue::Switch(on) => flag(on),
    }));
    fields
}
