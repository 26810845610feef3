//! `tune --identify`: as a table with TOML to paste.

use crate::config::{MeasuredKey, measured_to_toml};
use crate::control::machine::Machine;
use crate::study::{DryCycleError, Findings};

use super::alarm;
use super::table::Layout;
use super::table::columns::{Columns, number, text};
use super::table::layout::Page;

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

/// One quantity: what it is called, its value, the file's, and what motion it is measured by.
struct Quantity {
    name: &'static str,
    unit: &'static str,
    measured: Option<f64>,
    file: Option<f64>,
    measured_by: &'static str,
}

fn quantities(found: &Findings, machine: &Machine) -> [Quantity; 10] {
    let z = &machine.spec().z_axis;
    let quantity = |name, unit, measured, file, measured_by| Quantity { name, unit, measured, file, measured_by };
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
            "reversal value (lost motion)",
            "µm",
            found.lost_motion_um,
            None,
            "Z sliding both ways, with z_motor_counts beside a scale at the table",
        ),
        quantity("backlash", "µm", found.backlash_um, Some(z.backlash_um), "reversal value and friction"),
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

/// The findings against the machine file, what was not measured, and the keys of `[z]` ready to paste.
#[must_use]
pub fn table(layout: Layout, found: &Findings, machine: &Machine, source: &Source) -> String {
    let quantities = quantities(found, machine);
    let mut table =
        Columns::new(&[text("quantity", 0), number("measured", 0), number("machine file", 0), text("unit", 0)]);
    let digits = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.3}"));
    for quantity in quantities.iter().filter(|quantity| quantity.measured.is_some()) {
        table.row(vec![quantity.name.into(), digits(quantity.measured), digits(quantity.file), quantity.unit.into()]);
    }
    let mut page = Page::new(layout);
    page.say(format!("{}: {} periods", source.name, source.periods));
    if source.left_out > 0 {
        page.say(format!("{} more readings are left out: they are beyond a gap or a restart", source.left_out));
    }
    if quantities.iter().any(|quantity| quantity.measured.is_some()) {
        page.blank().table(&table);
    }
    for quantity in quantities.iter().filter(|quantity| quantity.measured.is_none()) {
        page.say(format!("not measured: {}; it takes {}", quantity.name, quantity.measured_by));
    }
    let toml = measured_to_toml(&keys(found, machine));
    if toml.is_empty() {
        page.say("no key of the machine file follows from this");
    } else {
        page.blank().verbatim(&toml);
    }
    page.finish()
}

/// The keys of a machine file that follow from the findings.
#[must_use]
pub fn keys(found: &Findings, machine: &Machine) -> Vec<MeasuredKey> {
    let key = |path, value: Option<f64>, how: String| value.map(|value| MeasuredKey { path, value, how });
    let deflection = found.lost_motion_um.zip(found.backlash_um).map_or_else(String::new, |(lost_um, backlash_um)| {
        format!(
            "motor less scale both ways, {lost_um:.2} µm, less {:.2} µm of wind-up by friction on a screw of {:.1} Hz",
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
        key("z.backlash_um", found.backlash_um, deflection),
        key("z.resonance_hz", found.resonance_hz, "how far the table's acceleration stretches the screw".into()),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Why the dry cycle gave nothing.
#[must_use]
pub fn dry_cycle_error(error: &DryCycleError) -> String {
    match error {
        DryCycleError::Refused(error) => format!("the machine cannot run the dry cycle: {error}"),
        DryCycleError::Fault(fault) => format!("the dry cycle ended: {}", alarm::sentence(fault)),
    }
}
