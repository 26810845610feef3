//! The one set of variables of a plant. Units are the base units of the rest: mm, rev, s.

/// What kind of value a variable has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A number with a unit.
    Real,
    /// A whole number: Real, Integer, or any integer type of FMI 3; 64 bits where the FMU has them.
    Whole,
    /// Yes or no.
    Switch,
}

/// One variable of the set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Variable {
    /// Its name.
    pub name: &'static str,
    /// Its unit; none for counts and switches.
    pub unit: Option<&'static str>,
    /// What kind of value it has.
    pub kind: Kind,
    /// An FMU without it is no plant.
    pub required: bool,
    /// What it says.
    pub meaning: &'static str,
}

const fn real(name: &'static str, unit: &'static str, required: bool, meaning: &'static str) -> Variable {
    Variable { name, unit: Some(unit), kind: Kind::Real, required, meaning }
}

const fn whole(name: &'static str, required: bool, meaning: &'static str) -> Variable {
    Variable { name, unit: None, kind: Kind::Whole, required, meaning }
}

const fn switch(name: &'static str, meaning: &'static str) -> Variable {
    Variable { name, unit: None, kind: Kind::Switch, required: false, meaning }
}

/// Inputs of the plant: the setpoint that is in force from the step's beginning, and the hole that is tapped.
pub const INPUTS: [Variable; 18] = [
    real("set_spindle_rev", "rev", true, "spindle angle, positive as M03 turns"),
    real("set_spindle_rev_per_s", "rev/s", false, "its velocity"),
    real("set_spindle_rev_per_s2", "rev/s2", false, "its acceleration"),
    real("set_spindle_rev_per_s3", "rev/s3", false, "its jerk"),
    real("set_z_mm", "mm", true, "Z, positive upwards"),
    real("set_z_mm_per_s", "mm/s", false, "its velocity"),
    real("set_z_mm_per_s2", "mm/s2", false, "its acceleration"),
    real("set_z_mm_per_s3", "mm/s3", false, "its jerk"),
    real("set_x_mm", "mm", false, "X"),
    real("set_y_mm", "mm", false, "Y"),
    real("set_spindle_torque_nm", "N.m", false, "torque feedforward beyond the nominal inertia's"),
    real("set_z_force_n", "N", false, "force feedforward beyond the nominal mass's, positive upwards"),
    switch("set_power_on", "the drives have power"),
    whole("hole", false, "number of the hole that is tapped or was tapped last, 0 before the first"),
    real("hole_pitch_mm", "mm", false, "its pitch"),
    real("hole_r_plane_mm", "mm", false, "its R plane"),
    real("hole_bottom_mm", "mm", false, "its bottom"),
    whole("hole_hand", false, "1 for a right-hand thread, -1 for a left-hand one"),
];

/// How many inputs there are.
pub(super) const INPUT_COUNT: usize = INPUTS.len();

/// Places of inputs in the set.
pub(super) const POWER_ON: usize = 12;
pub(super) const HOLE: usize = 13;
pub(super) const PITCH: usize = 14;
pub(super) const R_PLANE: usize = 15;
pub(super) const BOTTOM: usize = 16;
pub(super) const HAND: usize = 17;

/// Outputs of the plant: what the control is told, and where the axes truly are.
pub const OUTPUTS: [Variable; 17] = [
    whole("spindle_counts", true, "spindle encoder, signed and unwrapped"),
    whole("z_counts", true, "encoder that closes Z's position loop, signed and unwrapped"),
    whole("z_motor_counts", false, "encoder on Z's motor"),
    real("spindle_torque_nm", "N.m", false, "mean torque over the last step as the drive knows it"),
    real("z_force_n", "N", false, "mean force likewise, positive upwards"),
    switch("spindle_sample_valid", "the spindle's counts are a new sample"),
    switch("z_sample_valid", "Z's counts are a new sample"),
    switch("spindle_ready", "the spindle's drive is enabled"),
    switch("z_ready", "Z's drive is enabled"),
    switch("spindle_saturated", "the spindle's torque stood at its limit in the last step"),
    switch("z_saturated", "Z's force stood at its limit in the last step"),
    real("true_spindle_rev", "rev", false, "spindle angle at the tool"),
    real("true_z_mm", "mm", false, "tool tip"),
    real("true_spindle_rpm", "rpm", false, "spindle speed at the motor"),
    real("true_spindle_torque_nm", "N.m", false, "torque of the spindle motor"),
    real("true_z_force_n", "N", false, "force of Z's drive"),
    real("host_clock_s", "s", false, "what the host's clock shows, later where the host missed steps"),
];

/// How many outputs there are.
pub(super) const OUTPUT_COUNT: usize = OUTPUTS.len();

/// Parameters that are set before the first step where the FMU has them. Beside these, every key of `[actual]` that a sweep
/// draws as a number.
pub const PARAMETERS: [Variable; 2] =
    [whole("seed", false, "seed of everything random"), real("z_start_mm", "mm", false, "where Z stands at first")];

/// Other ways to write a unit of the set.
pub(super) fn same_unit(expected: &str, found: &str) -> bool {
    let plain: String = found.chars().filter(|c| !matches!(c, ' ' | '^' | '(' | ')')).collect();
    let others: &[&str] = match expected {
        "rev" => &["r", "turn"],
        "rev/s" => &["r/s"],
        "rev/s2" => &["r/s2"],
        "rev/s3" => &["r/s3"],
        "N.m" => &["N*m", "Nm", "N·m"],
        "rpm" => &["r/min", "rev/min"],
        _ => &[],
    };
    plain == expected || others.contains(&plain.as_str())
}
