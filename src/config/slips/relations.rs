//! Keys against each other: what a motor turns, a drive moves, a spring bears.

use core::f64::consts::PI;

use super::super::keys::{BANDS, Draft};
use super::super::number::rounded;
use super::slip::Slip;
use crate::control::machine::{MachineSpec, Ramp, Takes};
use crate::control::motor::{Motor, TorqueCurve};
use crate::control::units::{MM_PER_M, RAD_PER_REV, rev_per_s_from_rpm};

/// Time in s from rest to the greatest speed with the whole motor: a high-speed spindle to a heavy lathe's.
const RUN_UP_S: [f64; 2] = [0.03, 12.0];
/// Power in W of the motors that tap.
const MOST_W: f64 = 150e3;
/// Most power over that of the plate: what a motor gives for minutes.
const OVERLOAD: f64 = 1.25;
/// Above this speed in rpm a motor whose torque does not fall is none that spindles have.
const CONSTANT_TORQUE_RPM: f64 = 4000.0;
/// Most of the motor's torque at the greatest speed that friction takes.
const MOST_FRICTION: f64 = 0.2;
/// Z's force over what its acceleration and friction take.
const FORCE_RATIO: [f64; 2] = [1.0, 12.0];
/// Z's Coulomb friction over its weight: linear guides with few seals to sliding ways.
const FRICTION_NUMBER: [f64; 2] = [0.002, 0.6];
/// A velocity loop's gain over the resonance, in rad/s: above it the loop rings.
const MOST_GAIN_RATIO: f64 = 1.2;
/// A position loop's gain over that of the velocity loop inside it.
const MOST_CASCADE_RATIO: f64 = 0.5;
/// Least share of the motor that a band is meant to use.
const LEAST_BAND_SHARE: f64 = 0.05;
/// Tap drill over major diameter: the usual ones have 0.75 to 0.95.
const LEAST_DRILL_RATIO: f64 = 0.7;
/// Lines that encoders of spindles have; as counts they would make a coarse one.
const USUAL_LINES: [f64; 8] = [500.0, 512.0, 1000.0, 1024.0, 2000.0, 2048.0, 2500.0, 4096.0];
/// Standard gravity in m/s².
const GRAVITY: f64 = 9.806_65;

type Given<'a> = &'a dyn Fn(&str) -> bool;

/// Reports what does not go together. Of keys in contradiction the file's own is named, and none that is `odd` already.
pub(super) fn find(draft: &Draft, given: Given<'_>, odd: &dyn Fn(&str) -> bool, report: &mut dyn FnMut(Slip)) {
    let spec = &draft.spec;
    let sane = |key: &str| given(key) && !odd(key);
    if !odd("spindle.max_rpm") {
        run_up(spec, &sane, report);
    }
    torque_curve(draft, given, report);
    spindle_friction(spec, &sane, report);
    counts(draft, given, report);
    force(spec, &sane, odd, report);
    z_friction(spec, &sane, report);
    gains(spec, &sane, report);
    bands(spec, given, report);
    tap(spec, given, report);
}

fn motor(spec: &MachineSpec) -> Option<Motor> {
    let curve = TorqueCurve::new(&spec.spindle.torque_curve).ok()?;
    Some(Motor { curve, inertia_kg_m2: spec.spindle.inertia_kg_m2 })
}

/// Inertia against torque, by the time that they make of a run-up.
fn run_up(spec: &MachineSpec, given: Given<'_>, report: &mut dyn FnMut(Slip)) {
    let Some(motor) = motor(spec) else { return };
    let [low, high] = RUN_UP_S;
    let max_rpm = spec.spindle.max_rpm;
    let run_up_s = motor.run_up_s(rev_per_s_from_rpm(max_rpm), 1.0);
    let usual = |factor: f64| (low..=high).contains(&(run_up_s * factor));
    if usual(1.0) {
        return;
    }
    let inertia_kg_m2 = spec.spindle.inertia_kg_m2;
    let odd = format!(
        "spindle.inertia_kg_m2 = {} and spindle.torque_curve make a run-up to {} rpm of {} s: machines take {low} to \
         {high} s",
        rounded(inertia_kg_m2),
        rounded(max_rpm),
        rounded(run_up_s)
    );
    let range = format!(
        "with this motor a usual spindle has {} to {} kg·m²: look at the decimal point",
        rounded(inertia_kg_m2 * low / run_up_s),
        rounded(inertia_kg_m2 * high / run_up_s)
    );
    let torque = spec.spindle.torque_curve.first().map_or(0.0, |point| point.torque_nm);
    if given("spindle.torque_curve") && (!given("spindle.inertia_kg_m2") || most_power_w(spec).0 > MOST_W) {
        // Torque counts the other way round.
        let units = [("N·cm", 0.01), ("N·mm", 0.001), ("kgf·m", GRAVITY)];
        let likely = meant(torque, "N·m", &units, &|factor| usual(1.0 / factor));
        report(Slip::new("spindle.torque_curve", odd, likely.unwrap_or(range)));
    } else if given("spindle.inertia_kg_m2") {
        let units = [("kg·cm²", 1e-4), ("kg·mm²", 1e-6), ("g·m²", 1e-3)];
        let likely = meant(inertia_kg_m2, "kg·m²", &units, &usual);
        report(Slip::new("spindle.inertia_kg_m2", odd, likely.unwrap_or(range)));
    } else if given("spindle.max_rpm") {
        report(Slip::new("spindle.max_rpm", odd, range));
    }
}

/// "40 kg·cm² would be 0.004 kg·m²", of the first unit that makes sense.
fn meant(value: f64, own: &str, units: &[(&str, f64)], sense: &dyn Fn(f64) -> bool) -> Option<String> {
    let (name, factor) = units.iter().find(|(_, factor)| sense(*factor))?;
    Some(format!("{} {name} would be {} {own}", rounded(value), rounded(value * factor)))
}

/// Greatest power in W of the curve's points up to the greatest speed, and at which rpm.
fn most_power_w(spec: &MachineSpec) -> (f64, f64) {
    let power = |rpm: f64, torque_nm: f64| (torque_nm * RAD_PER_REV * rev_per_s_from_rpm(rpm), rpm);
    let points = spec.spindle.torque_curve.iter().map(|point| power(point.speed_rpm, point.torque_nm));
    points.fold((0.0, 0.0), |most, next| if next.0 > most.0 { next } else { most })
}

/// Torque over speed: it neither rises nor stays to the end, and its power is the plate's.
fn torque_curve(draft: &Draft, given: Given<'_>, report: &mut dyn FnMut(Slip)) {
    let points = &draft.spec.spindle.torque_curve;
    let key = "spindle.torque_curve";
    let (Some(first), Some(last)) = (points.first(), points.last()) else { return };
    if given(key) {
        let rises =
            points.windows(2).position(|pair| matches!(pair, [left, right] if right.torque_nm > left.torque_nm));
        let flat = last.torque_nm >= 0.98 * first.torque_nm && last.speed_rpm >= CONSTANT_TORQUE_RPM;
        let nm = last.torque_nm * 1000.0 / (RAD_PER_REV * rev_per_s_from_rpm(last.speed_rpm));
        let (kw, rpm) = (rounded(last.torque_nm), rounded(last.speed_rpm));
        let likely = format!("was power written in kW? {kw} kW at {rpm} rpm are {} N·m", rounded(nm));
        if let Some(point) = rises {
            let odd =
                format!("{key}, point {}: the torque rises with the speed, as no spindle motor's does", point + 2);
            report(Slip { index: Some(point + 1), ..Slip::new(key, odd, likely) });
        } else if flat {
            let odd = format!("{key}: the torque does not fall up to {rpm} rpm, as a spindle motor's does");
            report(Slip::new(key, odd, likely));
        }
    }
    let (most_w, rpm) = most_power_w(&draft.spec);
    let Some(plate_kw) = draft.data_sheet.plate_kw.filter(|_| given("spindle.plate_kw")) else { return };
    if most_w > OVERLOAD * 1000.0 * plate_kw {
        let (most_kw, rpm) = (rounded(most_w / 1000.0), rounded(rpm));
        let odd = format!("{key} gives {most_kw} kW at {rpm} rpm, where spindle.plate_kw = {}", rounded(plate_kw));
        let likely = format!(
            "was the torque of some seconds taken for what it gives all day? law.motor_share = {} would keep to the plate",
            rounded(1000.0 * plate_kw / most_w)
        );
        report(Slip::new(if given(key) { key } else { "spindle.plate_kw" }, odd, likely));
    }
}

fn spindle_friction(spec: &MachineSpec, given: Given<'_>, report: &mut dyn FnMut(Slip)) {
    let spindle = &spec.spindle;
    let Some(motor) = motor(spec) else { return };
    let (viscous, max_rpm) = (spindle.viscous_nm_per_rpm, spindle.max_rpm);
    let share = |nm: f64, rpm: f64| nm / motor.curve.torque_nm(rpm);
    let taken = share(viscous * max_rpm, max_rpm);
    let key = "spindle.viscous_nm_per_rpm";
    if given(key) && taken > MOST_FRICTION {
        let odd = format!(
            "{key} = {} takes {:.0} % of the motor at {} rpm",
            rounded(viscous),
            100.0 * taken,
            rounded(max_rpm)
        );
        let units = [("N·m·s/rad", RAD_PER_REV / 60.0), ("N·m at the greatest speed", 1.0 / max_rpm)];
        let likely = meant(viscous, "N·m/rpm", &units, &|factor| taken * factor <= MOST_FRICTION);
        report(Slip::new(key, odd, likely.unwrap_or_else(|| "look at the decimal point".into())));
    }
    let (key, coulomb_nm) = ("spindle.coulomb_nm", spindle.coulomb_nm);
    let taken = share(coulomb_nm, 0.0);
    if given(key) && taken > MOST_FRICTION {
        let odd = format!("{key} = {} takes {:.0} % of the motor", rounded(coulomb_nm), 100.0 * taken);
        let likely = meant(coulomb_nm, "N·m", &[("N·cm", 0.01)], &|factor| taken * factor <= MOST_FRICTION);
        report(Slip::new(key, odd, likely.unwrap_or_else(|| "look at the decimal point".into())));
    }
}

/// Encoders have a power of two or a round number of lines; four counts a line, and a gear between, make multiples.
fn counts(draft: &Draft, given: Given<'_>, report: &mut dyn FnMut(Slip)) {
    let (key, counts) = ("spindle.encoder_counts_per_rev", draft.spec.spindle.encoder_counts_per_rev);
    let multiple = |of: f64| counts % of == 0.0;
    let lines = draft.data_sheet.encoder_lines_per_rev;
    let (odd, likely) = if let Some(lines) = lines
        && ![1.0, 2.0, 4.0].contains(&(counts / lines))
    {
        let odd =
            format!("{key} = {counts} is no multiple of spindle.encoder_lines_per_rev = {lines} that counters make");
        (odd, format!("four counts a line would be {}", 4.0 * lines))
    } else if !multiple(1.0) {
        (format!("{key} = {counts} is no whole number"), "counts of a whole turn, after multiplication".into())
    } else if !(multiple(10.0) || multiple(64.0)) {
        let odd = format!("{key} = {counts}: encoders have a power of two, or a multiple of ten");
        (odd, "counts after multiplication by four: 4096 lines are 16384, 2500 lines 10000".into())
    } else if lines.is_none() && USUAL_LINES.contains(&counts) {
        let odd = format!("{key} = {counts} is a usual number of lines, of which each makes four counts");
        let quarter = counts / 4.0;
        let likely = format!(
            "{counts} lines would be {} counts; if it counts {counts}, say so by encoder_lines_per_rev = {quarter}",
            4.0 * counts
        );
        (odd, likely)
    } else {
        return;
    };
    if given(key) || given("spindle.encoder_lines_per_rev") {
        report(Slip::new(key, odd, likely));
    }
}

/// Z's force against the mass that it speeds up and the friction that it overcomes.
fn force(spec: &MachineSpec, given: Given<'_>, odd: &dyn Fn(&str) -> bool, report: &mut dyn FnMut(Slip)) {
    let (z, z_axis) = (&spec.z, &spec.z_axis);
    let keys = ["z.force_limit_n", "z.mass_kg", "z.max_mm_per_s2"];
    if keys.into_iter().any(odd) {
        return;
    }
    let [low, high] = FORCE_RATIO;
    let (mass_kg, limit_n) = (z_axis.mass_kg, z_axis.force_limit_n);
    let needed_n = |mass_kg: f64| mass_kg * z.max_mm_per_s2 / MM_PER_M + z_axis.coulomb_n;
    let usual = |ratio: f64| (low..=high).contains(&ratio);
    let ratio = limit_n / needed_n(mass_kg);
    let Some(key) = keys.into_iter().find(|key| given(key)).filter(|_| !usual(ratio)) else { return };
    let odd = format!(
        "z.force_limit_n = {} against the {} N that z.mass_kg = {} takes for z.max_mm_per_s2 = {} and friction: machines \
         have {low} to {high} times as much",
        rounded(limit_n),
        rounded(needed_n(mass_kg)),
        rounded(mass_kg),
        rounded(z.max_mm_per_s2)
    );
    let of_force = meant(limit_n, "N", &[("kN", 1000.0), ("daN", 10.0)], &|factor| usual(ratio * factor));
    let of_mass =
        meant(mass_kg, "kg", &[("g", 0.001), ("t", 1000.0)], &|factor| usual(limit_n / needed_n(mass_kg * factor)));
    let likely = of_force.filter(|_| given("z.force_limit_n")).map(|likely| ("z.force_limit_n", likely));
    let likely = likely.or_else(|| of_mass.filter(|_| given("z.mass_kg")).map(|likely| ("z.mass_kg", likely)));
    let masses =
        [high, low].map(|ratio| rounded(((limit_n / ratio) - z_axis.coulomb_n).max(0.0) * MM_PER_M / z.max_mm_per_s2));
    let range =
        format!("this force moves {} to {} kg so fast: look at the units and decimal points", masses[0], masses[1]);
    let (key, likely) = likely.unwrap_or((key, range));
    report(Slip::new(key, odd, likely));
}

fn z_friction(spec: &MachineSpec, given: Given<'_>, report: &mut dyn FnMut(Slip)) {
    let (key, coulomb_n) = ("z.coulomb_n", spec.z_axis.coulomb_n);
    let number = coulomb_n / (spec.z_axis.mass_kg * GRAVITY);
    let [low, high] = FRICTION_NUMBER;
    let usual = |factor: f64| (low..=high).contains(&(number * factor));
    if given(key) && coulomb_n > 0.0 && !usual(1.0) {
        let weight = rounded(100.0 * number);
        let odd = format!(
            "{key} = {} is {weight} % of the weight of z.mass_kg: machines have {} to {} %",
            rounded(coulomb_n),
            rounded(100.0 * low),
            rounded(100.0 * high)
        );
        let likely = meant(coulomb_n, "N", &[("kN", 1000.0), ("daN", 10.0)], &usual);
        report(Slip::new(key, odd, likely.unwrap_or_else(|| "look at the decimal point, and at z.mass_kg".into())));
    }
}

/// Loops against the springs that they drive, and against the loops inside them.
fn gains(spec: &MachineSpec, given: Given<'_>, report: &mut dyn FnMut(Slip)) {
    let drive = &spec.drive;
    for (resonance, hz, velocity, velocity_gain, position, position_gain) in [
        (
            "spindle.resonance_hz",
            spec.spindle.resonance_hz,
            "drive.spindle_velocity_gain_per_s",
            drive.spindle_velocity_gain_per_s,
            "drive.spindle_position_gain_per_s",
            drive.spindle_position_gain_per_s,
        ),
        (
            "z.resonance_hz",
            spec.z_axis.resonance_hz,
            "drive.z_velocity_gain_per_s",
            drive.z_velocity_gain_per_s,
            "drive.z_position_gain_per_s",
            drive.z_position_gain_per_s,
        ),
    ] {
        let rad_per_s = 2.0 * PI * hz;
        if let Some(key) = [velocity, resonance].into_iter().find(|key| given(key))
            && velocity_gain > MOST_GAIN_RATIO * rad_per_s
        {
            let odd = format!(
                "{velocity} = {} is above {resonance} = {}, which is {} rad/s: that loop rings",
                rounded(velocity_gain),
                rounded(hz),
                rounded(rad_per_s)
            );
            let likely = format!("a drive tuned for this spring has at most {} 1/s", rounded(rad_per_s));
            report(Slip::new(key, odd, likely));
        }
        // A drive that takes a speed alone has no position loop.
        let no_loop = position.contains("spindle") && drive.spindle_takes == Takes::Speed;
        if let Some(key) = [position, velocity].into_iter().find(|key| given(key) && !no_loop)
            && position_gain > MOST_CASCADE_RATIO * velocity_gain
        {
            let odd = format!(
                "{position} = {} is more than half of {velocity} = {}: the loop outside is the slower one",
                rounded(position_gain),
                rounded(velocity_gain)
            );
            report(Slip::new(key, odd, format!("at most {} 1/s", rounded(MOST_CASCADE_RATIO * velocity_gain))));
        }
    }
}

/// Bands that hardly use the motor.
fn bands(spec: &MachineSpec, given: Given<'_>, report: &mut dyn FnMut(Slip)) {
    let Some(motor) = motor(spec).filter(|_| given(BANDS)) else { return };
    let mut below_rpm = 0.0;
    for (index, band) in spec.law.torque_curve.bands.iter().enumerate() {
        let rise_rpm = band.to_rpm - below_rpm;
        below_rpm = band.to_rpm;
        let (rate, seconds) = match band.ramp {
            Ramp::Time { accel_s, .. } => (rise_rpm / accel_s, Some(accel_s)),
            Ramp::Rate { accel_rpm_per_s, .. } => (accel_rpm_per_s, None),
        };
        let used = motor.torque_for_nm(rev_per_s_from_rpm(rate)) / motor.curve.torque_nm(band.to_rpm);
        if used >= LEAST_BAND_SHARE {
            continue;
        }
        let odd = format!("{BANDS}, band {} uses {} % of the motor", index + 1, rounded(100.0 * used));
        let milliseconds = seconds.filter(|_| used * 1000.0 >= LEAST_BAND_SHARE);
        let likely = milliseconds.map_or_else(
            || "look at its decimal point, or leave the bands out: they then follow from the motor".to_owned(),
            |seconds| format!("{} ms would be {} s", rounded(seconds), rounded(seconds / 1000.0)),
        );
        return report(Slip { index: Some(index), ..Slip::new(BANDS, odd, likely) });
    }
}

/// A tap drill that leaves no room for a tap.
fn tap(spec: &MachineSpec, given: Given<'_>, report: &mut dyn FnMut(Slip)) {
    let (Some(major_mm), Some(hole_mm)) = (spec.tap.major_mm, spec.tap.hole_mm) else { return };
    let usual = |hole_mm: f64| hole_mm >= LEAST_DRILL_RATIO * major_mm && hole_mm < major_mm;
    if given("tap.hole_mm") && !usual(hole_mm) {
        let percent = rounded(100.0 * hole_mm / major_mm);
        let odd = format!(
            "tap.hole_mm = {} is {percent} % of tap.major_mm = {}: tap drills have 75 to 95 %",
            rounded(hole_mm),
            rounded(major_mm)
        );
        let likely = if usual(2.0 * hole_mm) {
            format!("was the radius written? The tap drill's diameter would be {}", rounded(2.0 * hole_mm))
        } else {
            "the diameter of the drilled hole, not of its core".to_owned()
        };
        report(Slip::new("tap.hole_mm", odd, likely));
    }
}
