//! `tune --identify`: as a table with TOML to paste, and as JSON.

use serde_json::{Value, json};

use crate::config::{MeasuredKey, measured_to_toml};
use crate::control::machine::Machine;
use crate::study::{DryCycleError, Findings};

use super::alarm;
use super::table::columns::Columns;

/// Where the findings come from.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Its name: the dry cycle, or a file's.
    pub name: String,
    /// Periods that were used.
    pub periods: usize,
    /// Readings that were recorded but are not part of the longest unbroken stretch.
    pub left_out: usize,
}

/// One quantity: what it is called, its value, the file's, and what it takes for a motion to show it.
struct Quantity {
    name: &'static str,
    unit: &'static str,
    measured: Option<f64>,
    file: Option<f64>,
    shown_by: &'static str,
}

fn quantities(found: &Findings, machine: &Machine) -> [Quantity; 10] {
    let z = &machine.spec().z_axis;
    let quantity = |name, unit, measured, file, shown_by| Quantity { name, unit, measured, file, shown_by };
    [
        quantity("friction", "N", found.friction_n, Some(z.coulomb_n), "Z sliding both ways, with z_force_n"),
        quantity("static ratio", "", found.static_ratio, Some(z.static_ratio), "slow strokes of Z at several speeds"),
        quantity(
            "Stribeck speed",
            "mm/s",
            found.stribeck_mm_per_s,
            Some(z.stribeck_mm_per_s),
            "slow strokes of Z at several speeds; without breakaway friction there is none",
        ),
        quantity(
            "pre-sliding travel",
            "µm",
            found.presliding_um,
            Some(z.presliding_um),
            "slow reversals of Z, with z_motor_counts beside a scale at the table",
        ),
        quantity(
            "lost motion",
            "µm",
            found.lost_motion_um,
            None,
            "Z sliding both ways, with z_motor_counts beside a scale at the table",
        ),
        quantity("backlash", "µm", found.backlash_um, Some(z.backlash_um), "lost motion and friction"),
        quantity(
            "resonance on the screw",
            "Hz",
            found.resonance_hz,
            Some(z.resonance_hz),
            "Z speeding up both ways, with z_motor_counts beside a scale at the table",
        ),
        quantity(
            "inertia per torque constant, over the file's",
            "",
            found.inertia_ratio,
            Some(1.0),
            "the spindle changing its speed, with spindle_torque_nm",
        ),
        quantity(
            "torque limit, over the file's",
            "",
            found.torque_limit_ratio,
            Some(1.0),
            "a drive that stands at its limit, with torque_saturated",
        ),
        quantity(
            "drag beyond the file's",
            "N·m",
            found.spindle_drag_nm,
            Some(0.0),
            "the spindle turning, with spindle_torque_nm",
        ),
    ]
}

/// The findings against the machine file, what was not shown, and the keys of `[z]` ready to paste.
#[must_use]
pub fn table(found: &Findings, machine: &Machine, source: &Source) -> String {
    let quantities = quantities(found, machine);
    let mut table = Columns::new(&["quantity", "unit", "measured", "machine file"], 2);
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.3}"));
    for quantity in quantities.iter().filter(|quantity| quantity.measured.is_some()) {
        table.row(vec![quantity.name.into(), quantity.unit.into(), number(quantity.measured), number(quantity.file)]);
    }
    let mut out = format!("{}: {} periods\n", source.name, source.periods);
    if source.left_out > 0 {
        out += &format!("{} more readings are left out: they stand beyond a gap or a restart\n", source.left_out);
    }
    if quantities.iter().any(|quantity| quantity.measured.is_some()) {
        out += &table.to_string();
    }
    for quantity in quantities.iter().filter(|quantity| quantity.measured.is_none()) {
        out += &format!("not shown: {}; it takes {}\n", quantity.name, quantity.shown_by);
    }
    let toml = measured_to_toml(&keys(found, machine));
    if toml.is_empty() { out + "no key of the machine file follows from this\n" } else { out + "\n" + &toml }
}

fn keys(found: &Findings, machine: &Machine) -> Vec<MeasuredKey> {
    let key = |path, value: Option<f64>, how: String| value.map(|value| MeasuredKey { path, value, how });
    let twist = found.lost_motion_um.zip(found.backlash_um).map_or_else(String::new, |(lost_um, backlash_um)| {
        format!(
            "motor less scale both ways, {lost_um:.2} µm, less {:.2} µm that friction twists a screw of {:.1} Hz",
            lost_um - backlash_um,
            found.resonance_hz.unwrap_or(machine.spec().z_axis.resonance_hz)
        )
    });
    let balance = |how: &str| format!("force less inertia, {how}");
    [
        key(
            "z.coulomb_n",
            found.friction_n,
            balance("mean of both ways over the whole travel, above the Stribeck speed"),
        ),
        key("z.static_ratio", found.static_ratio, balance("its level over speed carried on to standstill")),
        key("z.stribeck_mm_per_s", found.stribeck_mm_per_s, balance("fall of its level over speed")),
        key("z.presliding_um", found.presliding_um, balance("its rise over the travel after reversals")),
        key("z.backlash_um", found.backlash_um, twist),
        key("z.resonance_hz", found.resonance_hz, "how far the table's acceleration stretches the screw".into()),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// The same as JSON; what was not shown is null.
#[must_use]
pub fn json(found: &Findings, source: &Source) -> Value {
    json!({
        "friction_n": found.friction_n,
        "static_ratio": found.static_ratio,
        "stribeck_mm_per_s": found.stribeck_mm_per_s,
        "presliding_um": found.presliding_um,
        "lost_motion_um": found.lost_motion_um,
        "backlash_um": found.backlash_um,
        "resonance_hz": found.resonance_hz,
        "inertia_ratio": found.inertia_ratio,
        "torque_limit_ratio": found.torque_limit_ratio,
        "spindle_drag_nm": found.spindle_drag_nm,
        "source": source.name,
        "periods": source.periods,
        "readings_left_out": source.left_out,
    })
}

/// Why the dry cycle told nothing.
#[must_use]
pub fn dry_cycle_error(error: &DryCycleError) -> String {
    match error {
        DryCycleError::Refused(error) => format!("the machine cannot run the dry cycle: {error}"),
        DryCycleError::Fault(fault) => format!("the dry cycle ended: {}", alarm::sentence(fault)),
    }
}
