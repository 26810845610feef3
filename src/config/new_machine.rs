//! A machine file from what data sheets say. What they do not say is guessed, and marked so.

use core::fmt::Write;

use super::number::rounded;
use crate::control::motor::{Motor, TorqueCurve, TorquePoint};
use crate::control::units::{MM_PER_M, RAD_PER_REV, UM_PER_MM, mm_per_s_from_mm_per_min, rev_per_s_from_rpm};
use crate::gcode::AUTO;

/// How much the spindle turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SheetInertia {
    /// Its inertia.
    KgM2(f64),
    /// Time from rest to the greatest speed.
    RunUpS(f64),
}

/// What data sheets of a machine, its spindle motor and its control say.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetValues {
    /// Power of the spindle motor.
    pub power_kw: f64,
    /// Up to which speed its torque is constant.
    pub rated_rpm: f64,
    /// Greatest speed.
    pub max_rpm: f64,
    /// Inertia or run-up.
    pub inertia: SheetInertia,
    /// Rapid of the axes.
    pub rapid_m_per_min: f64,
    /// Their acceleration.
    pub accel_m_per_s2: f64,
    /// Lead of Z's screw.
    pub screw_lead_mm: Option<f64>,
    /// Lines of the spindle's encoder.
    pub encoder_lines_per_rev: Option<f64>,
    /// Step of the scale at the table; none where Z has the motor's encoder alone.
    pub scale_um: Option<f64>,
    /// A belt drives the spindle.
    pub belt: bool,
    /// Dialect of the control.
    pub dialect: Option<String>,
}

/// Z's equivalent mass in kg: that of the reference machine, heavier for a stronger spindle.
fn mass_kg(power_kw: f64) -> f64 {
    600.0 * (power_kw / 6.3).sqrt().clamp(0.5, 3.0)
}

/// The machine file, each value marked as given or guessed; [`MachineFile::read`](super::MachineFile::read) checks it.
///
/// ```
/// use rigidtap::config::{MachineFile, SheetInertia, SheetValues, new_machine_toml};
/// let values = SheetValues {
///     power_kw: 7.5, rated_rpm: 3000.0, max_rpm: 12000.0, inertia: SheetInertia::RunUpS(0.6), rapid_m_per_min: 36.0,
///     accel_m_per_s2: 8.0, screw_lead_mm: None, encoder_lines_per_rev: None, scale_um: Some(0.1), belt: false,
///     dialect: None,
/// };
/// let toml = new_machine_toml(&values);
/// let file = MachineFile::read(toml.as_bytes()).unwrap();
/// assert_eq!((file.machine.spec().z.max_mm_per_s, file.warnings.len()), (600.0, 0));
/// assert!(toml.contains("# guessed"));
/// ```
#[must_use]
pub fn new_machine_toml(values: &SheetValues) -> String {
    let power_w = MM_PER_M * values.power_kw;
    let torque_nm = |rpm: f64| power_w / (RAD_PER_REV * rev_per_s_from_rpm(rpm));
    let (rated_nm, top_nm) = (torque_nm(values.rated_rpm), torque_nm(values.max_rpm));
    let point = |speed_rpm, torque_nm| TorquePoint { speed_rpm, torque_nm };
    let points = [point(0.0, rated_nm), point(values.rated_rpm, rated_nm), point(values.max_rpm, top_nm)];
    let (inertia_kg_m2, inertia_from) = match values.inertia {
        SheetInertia::KgM2(inertia_kg_m2) => (inertia_kg_m2, "given".to_owned()),
        SheetInertia::RunUpS(run_up_s) => {
            // Of 1 kg·m²; the time is proportional.
            let unit = TorqueCurve::new(&points).map(|curve| Motor { curve, inertia_kg_m2: 1.0 });
            let unit_s = unit.map_or(1.0, |motor| motor.run_up_s(rev_per_s_from_rpm(values.max_rpm), 1.0));
            (run_up_s / unit_s, format!("from the given run-up of {} s with the whole motor", rounded(run_up_s)))
        }
    };
    let mass_kg = mass_kg(values.power_kw);
    let (speed, accel) =
        (mm_per_s_from_mm_per_min(MM_PER_M * values.rapid_m_per_min), MM_PER_M * values.accel_m_per_s2);
    let coulomb_n = 0.05 * mass_kg * 9.806_65;
    let z_hz = 100.0 * (600.0 / mass_kg).sqrt();
    let mut out = "# Machine file of rigidtap from data sheets. What no data sheet said is guessed and marked: measure it\n\
                   # (`rigidtap tune --dry-cycle`, `tune --identify`, `tune --run-up`). What is left out is the reference machine's.\n"
        .to_owned();
    let mut table = |name: &str, lines: &[(&str, String, String)]| {
        let _ = write!(out, "\n[{name}]\n");
        for (key, value, why) in lines {
            let setting = format!("{key} = {value}");
            let _ = writeln!(out, "{setting:<37} # {why}");
        }
    };
    let given = || "given".to_owned();
    let guessed = |why: &str| format!("guessed: {why}");
    let curve = format!(
        "[[0, {t}], [{r}, {t}], [{m}, {e}]]",
        t = rounded(rated_nm),
        r = rounded(values.rated_rpm),
        m = rounded(values.max_rpm),
        e = rounded(top_nm)
    );
    let (resonance_hz, drive) =
        if values.belt { (90.0, "belts lie about here") } else { (400.0, "a direct drive's short shaft") };
    let lines = values.encoder_lines_per_rev.unwrap_or(1024.0);
    let lines_from = values.encoder_lines_per_rev.map_or_else(|| guessed("usual"), |_| given());
    table(
        "spindle",
        &[
            ("max_rpm", rounded(values.max_rpm), given()),
            ("plate_kw", rounded(values.power_kw), given()),
            (
                "torque_curve",
                curve,
                "from the given power: constant torque to the rated speed, constant power above".into(),
            ),
            ("inertia_kg_m2", rounded(inertia_kg_m2), inertia_from),
            ("tool_inertia_kg_m2", rounded(0.3 * inertia_kg_m2), guessed("30 % at the tool's side")),
            ("resonance_hz", rounded(resonance_hz), guessed(drive)),
            ("coulomb_nm", rounded(0.015 * rated_nm), guessed("1.5 % of the motor")),
            (
                "viscous_nm_per_rpm",
                rounded(0.015 * rated_nm / values.max_rpm),
                guessed("the same again at the greatest speed"),
            ),
            (
                "encoder_at",
                if values.belt { "\"tool\"" } else { "\"motor\"" }.into(),
                guessed("where such spindles have it"),
            ),
            ("encoder_lines_per_rev", rounded(lines), lines_from),
            ("encoder_counts_per_rev", format!("{}", 4.0 * lines), "four counts a line".into()),
        ],
    );
    let limits = [
        ("max_mm_per_s", rounded(speed), "given rapid".to_owned()),
        ("max_mm_per_s2", rounded(accel), given()),
        ("max_mm_per_s3", rounded(accel / 0.02), guessed("the acceleration is reached in 20 ms")),
    ];
    table("x", &limits);
    table("y", &limits);
    let counts = values.scale_um.map_or(10_000.0, |um| UM_PER_MM / um);
    let counts_from = values.scale_um.map_or_else(|| guessed("0.1 µm"), |_| "from the given scale".into());
    let mut z = limits.to_vec();
    z.extend([
        ("mass_kg", rounded(mass_kg), guessed("by the spindle's power, screw and motor counted as mass")),
        (
            "force_limit_n",
            rounded(1.5 * mass_kg * values.accel_m_per_s2 + coulomb_n),
            guessed("1.5 times the acceleration, and friction"),
        ),
        ("coulomb_n", rounded(coulomb_n), guessed("5 % of the weight: linear guides")),
        ("resonance_hz", rounded(z_hz), guessed("a screw of this size")),
        ("backlash_um", "2".into(), guessed("a preloaded nut")),
        (
            "encoder_at",
            if values.scale_um.is_some() { "\"table\"" } else { "\"motor\"" }.into(),
            "a given scale, else the motor's encoder".into(),
        ),
        ("encoder_counts_per_mm", format!("{counts}"), counts_from),
    ]);
    table("z", &z);
    table(
        "drive",
        &[(
            "z_velocity_gain_per_s",
            rounded(0.8 * RAD_PER_REV * z_hz),
            guessed("0.8 of the resonance, as the reference machine"),
        )],
    );
    if let Some(lead_mm) = values.screw_lead_mm {
        table("actual", &[("screw_lead_mm", rounded(lead_mm), given())]);
    }
    // Nobody's control reads the paper's dialect, which is the built-in machine's.
    let (dialect, why) = match &values.dialect {
        Some(dialect) => (dialect.as_str(), given()),
        None => (AUTO, guessed("what each program looks like; name the control's")),
    };
    table("gcode", &[("dialect", format!("\"{dialect}\""), why)]);
    out
}

#[cfg(test)]
mod tests {
    use super::super::MachineFile;
    use super::*;

    /// Whatever a data sheet of a tapping machine may say, the file is one, and improbable values are told as ever.
    #[test]
    fn every_sheet_makes_a_file_without_warning() {
        for (power_kw, rated_rpm, max_rpm, run_up_s) in
            [(1.5, 1500.0, 6000.0, 1.0), (7.5, 3000.0, 16000.0, 0.3), (22.0, 1000.0, 8000.0, 2.5)]
        {
            for (scale_um, belt, accel_m_per_s2) in [(Some(0.1), false, 10.0), (None, true, 1.5)] {
                let values = SheetValues {
                    power_kw,
                    rated_rpm,
                    max_rpm,
                    inertia: SheetInertia::RunUpS(run_up_s),
                    rapid_m_per_min: 24.0,
                    accel_m_per_s2,
                    screw_lead_mm: Some(10.0),
                    encoder_lines_per_rev: Some(2048.0),
                    scale_um,
                    belt,
                    dialect: Some("fanuc".into()),
                };
                let toml = new_machine_toml(&values);
                let file = MachineFile::read(toml.as_bytes()).unwrap_or_else(|faults| panic!("{faults:?}\n{toml}"));
                assert_eq!(file.warnings, [], "{toml}");
                let motor = file.machine.motor();
                let found_s = motor.run_up_s(rev_per_s_from_rpm(max_rpm), 1.0);
                assert!((found_s / run_up_s - 1.0).abs() < 2e-3, "{found_s}");
            }
        }
    }
}
