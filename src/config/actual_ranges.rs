//! The ranges of `[actual]`, wide enough for any machine that still moves, and of `[spread]` with them; and of `[gcode]`.

use super::keys::Draft;
use crate::control::machine::{MachineError, MachineFault};
use crate::sim::Drawn;

/// A key of `[actual]` with its value and range, and the key of `[spread]` or `[spread.hard]` that draws it.
type Row = (&'static str, Option<f64>, &'static str, Option<Drawn>, [f64; 2]);

/// Reports every value out of its range.
pub(super) fn faults(draft: &Draft, report: &mut dyn FnMut(MachineError)) {
    let mut check = |key, index, value: f64, [low, high]: [f64; 2]| {
        if !(value >= low && value <= high) {
            report(MachineError { key, index, fault: MachineFault::OutOfRange { value, low, high } });
        }
    };
    for (actual_key, value, spread_key, drawn, range) in rows(draft) {
        if let Some(value) = value {
            check(actual_key, None, value, range);
        }
        for (index, bound) in drawn.iter().flat_map(Drawn::bounds).enumerate() {
            check(spread_key, Some(index), bound, range);
        }
    }
    check("spread.hard.reports_effort", None, draft.hard.reports_effort, [0.0, 1.0]);
    if let Some(angle_deg) = draft.gcode.start_angle_deg {
        check("gcode.start_angle_deg", None, angle_deg, [-360.0, 360.0]);
    }
    check("gcode.peck_back_mm", None, draft.gcode.peck_back_mm, [0.001, 100.0]);
}

#[rustfmt::skip]
fn rows(draft: &Draft) -> [Row; 31] {
    let (a, s, h) = (&draft.actual, &draft.spread, &draft.hard);
    [
        ("actual.inertia", Some(a.inertia), "spread.inertia", Some(s.inertia), [0.1, 10.0]),
        ("actual.torque_limit", Some(a.torque_limit), "spread.torque_limit", Some(s.torque_limit), [0.1, 10.0]),
        ("actual.torque_constant", Some(a.torque_constant), "spread.torque_constant", Some(s.torque_constant), [0.1, 10.0]),
        ("actual.friction", Some(a.friction), "spread.friction", Some(s.friction), [0.0, 10.0]),
        ("actual.spindle_resonance", Some(a.spindle_resonance), "spread.spindle_resonance", Some(s.spindle_resonance), [0.1, 10.0]),
        ("actual.z_resonance", Some(a.z_resonance), "spread.z_resonance", Some(s.z_resonance), [0.1, 10.0]),
        ("actual.cutting_torque", Some(a.cutting_torque), "spread.cutting_torque", Some(s.cutting_torque), [0.0, 10.0]),
        ("actual.encoder_error", Some(a.encoder_error), "spread.encoder_error", Some(s.encoder_error), [0.0, 100.0]),
        ("actual.backlash", Some(a.backlash), "spread.backlash", Some(s.backlash), [0.0, 100.0]),
        ("actual.encoder_latency", Some(a.encoder_latency), "spread.encoder_latency", Some(s.encoder_latency), [0.0, 20.0]),
        ("actual.backlash_um", a.backlash_um, "spread.backlash_um", s.backlash_um, [0.0, 1000.0]),
        ("actual.encoder_latency_s", a.encoder_latency_s, "spread.encoder_latency_s", s.encoder_latency_s, [0.0, 0.001]),
        ("actual.backlash_damping", Some(a.backlash_damping), "spread.hard.backlash_damping", Some(h.backlash_damping), [0.0, 1.0]),
        ("actual.setpoint_latency_s", Some(a.setpoint_latency_s), "spread.hard.setpoint_latency_s", Some(h.setpoint_latency_s), [-0.001, 0.001]),
        ("actual.setpoint_latency_periods", Some(a.setpoint_latency_periods), "spread.hard.setpoint_latency_periods", Some(h.setpoint_latency_periods), [0.0, 4.0]),
        ("actual.host_jitter_s", Some(a.host_jitter_s), "spread.hard.host_jitter_s", Some(h.host_jitter_s), [0.0, 0.0001]),
        ("actual.z_weight_n", Some(a.z_weight_n), "spread.hard.z_weight_n", Some(h.z_weight_n), [-20000.0, 20000.0]),
        ("actual.z_viscous_n_per_mm_s", Some(a.z_viscous_n_per_mm_s), "spread.hard.z_viscous_n_per_mm_s", Some(h.z_viscous_n_per_mm_s), [0.0, 50.0]),
        ("actual.z_friction_asymmetry", Some(a.z_friction_asymmetry), "spread.hard.z_friction_asymmetry", Some(h.z_friction_asymmetry), [-1.0, 1.0]),
        ("actual.screw_error_um", Some(a.screw_error_um), "spread.hard.screw_error_um", Some(h.screw_error_um), [0.0, 100.0]),
        ("actual.screw_lead_mm", Some(a.screw_lead_mm), "spread.hard.screw_lead_mm", Some(h.screw_lead_mm), [0.5, 100.0]),
        ("actual.z_second_resonance_hz", a.z_second_resonance_hz, "spread.hard.z_second_resonance_hz", Some(h.z_second_resonance_hz), [20.0, 2000.0]),
        ("actual.tap_axial_n", Some(a.tap_axial_n), "spread.hard.tap_axial_n", Some(h.tap_axial_n), [-5000.0, 5000.0]),
        ("actual.spindle_eccentricity_arcsec", Some(a.spindle_eccentricity_arcsec), "spread.hard.spindle_eccentricity_arcsec", Some(h.spindle_eccentricity_arcsec), [0.0, 3600.0]),
        ("actual.torque_constant_fall", Some(a.torque_constant_fall), "spread.hard.torque_constant_fall", Some(h.torque_constant_fall), [0.0, 0.9]),
        ("actual.stale_samples_per_hole", Some(a.stale_samples_per_hole), "spread.hard.stale_samples_per_hole", Some(h.stale_samples_per_hole), [0.0, 32.0]),
        ("actual.missed_periods_per_hole", Some(a.missed_periods_per_hole), "spread.hard.missed_periods_per_hole", Some(h.missed_periods_per_hole), [0.0, 32.0]),
        ("actual.drive_gain", Some(a.drive_gain), "spread.hard.drive_gain", Some(h.drive_gain), [0.1, 3.0]),
        ("actual.drive_delay_periods", Some(a.drive_delay_periods), "spread.hard.drive_delay_periods", Some(h.drive_delay_periods), [0.0, 8.0]),
        ("actual.thermal_um_per_s", Some(a.thermal_um_per_s), "spread.hard.thermal_um_per_s", Some(h.thermal_um_per_s), [-10.0, 10.0]),
        ("actual.effort_resolution", Some(a.effort_resolution), "spread.hard.effort_resolution", Some(h.effort_resolution), [0.0, 0.5]),
    ]
}
