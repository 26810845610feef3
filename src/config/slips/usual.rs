//! Each key by itself: what machines have, and the units that people write instead.

use core::f64::consts::PI;

use super::super::keys::{self, Draft, Slot};
use super::super::number::rounded;
use super::slip::Slip;
use crate::control::units::{MM_PER_M, MS_PER_S, S_PER_MIN, UM_PER_MM, mm_per_s_from_mm_per_min};

/// Another unit that people write a key in, with what makes the key's own of it.
type Unit = (&'static str, fn(f64) -> f64);

/// What machines have of a quantity, and the other units it is known by.
struct Usual {
    keys: &'static [&'static str],
    low: f64,
    high: f64,
    units: &'static [Unit],
}

const MILLISECONDS: Unit = ("ms", |ms| ms / MS_PER_S);
const MICROSECONDS: Unit = ("µs", |us| us / (MS_PER_S * MS_PER_S));
const MILLIMETRES: Unit = ("mm", |mm| mm * UM_PER_MM);
const MICROMETRES: Unit = ("µm", |um| um / UM_PER_MM);
const PER_CENT: Unit = ("%", |percent| percent / 100.0);
const RAD_PER_S: Unit = ("rad/s", |rad_per_s| rad_per_s / (2.0 * PI));
const TIMES: &[Unit] = &[MILLISECONDS, MICROSECONDS];
/// One g in mm/s².
const STANDARD_GRAVITY: f64 = 9806.65;

/// Wide enough for every machine that taps: from a belt-driven knee mill to a centre with linear motors.
#[rustfmt::skip]
const USUAL: &[Usual] = &[
    Usual { keys: &["control.period_s"], low: 5e-5, high: 0.02, units: TIMES },
    Usual { keys: &["drive.period_s"], low: 1e-5, high: 0.005, units: TIMES },
    Usual { keys: &["spindle.max_rpm"], low: 1000.0, high: 80_000.0,
        units: &[("rev/s", |rev_per_s| rev_per_s * S_PER_MIN), ("rad/s", |rad_per_s| rad_per_s * S_PER_MIN / (2.0 * PI))] },
    Usual { keys: &["spindle.resonance_hz"], low: 10.0, high: 1500.0, units: &[RAD_PER_S] },
    Usual { keys: &["z.resonance_hz"], low: 8.0, high: 350.0, units: &[RAD_PER_S] },
    Usual { keys: &["spindle.damping_ratio", "z.damping_ratio"], low: 0.002, high: 0.3, units: &[PER_CENT] },
    Usual { keys: &["spindle.torque_lag_s", "z.torque_lag_s"], low: 2e-5, high: 0.02, units: TIMES },
    Usual { keys: &["x.max_mm_per_s", "y.max_mm_per_s", "z.max_mm_per_s"], low: 60.0, high: 2500.0,
        units: &[("m/min", |m| mm_per_s_from_mm_per_min(m * MM_PER_M)), ("mm/min", mm_per_s_from_mm_per_min), ("m/s", |m| m * MM_PER_M)] },
    Usual { keys: &["x.max_mm_per_s2", "y.max_mm_per_s2", "z.max_mm_per_s2"], low: 100.0, high: 60_000.0,
        units: &[("m/s²", |m| m * MM_PER_M), ("g", |g| g * STANDARD_GRAVITY)] },
    Usual { keys: &["x.max_mm_per_s3", "y.max_mm_per_s3", "z.max_mm_per_s3"], low: 2000.0, high: 2e7, units: &[("m/s³", |m| m * MM_PER_M)] },
    Usual { keys: &["z.backlash_um"], low: 0.1, high: 200.0, units: &[MILLIMETRES] },
    Usual { keys: &["z.presliding_um"], low: 0.2, high: 100.0, units: &[MILLIMETRES] },
    Usual { keys: &["z.encoder_counts_per_mm", "z.motor_counts_per_mm"], low: 100.0, high: 1e7,
        units: &[("µm a count", |um| UM_PER_MM / um), ("nm a count", |nm| UM_PER_MM * UM_PER_MM / nm)] },
    Usual { keys: &["drive.spindle_position_gain_per_s", "drive.z_position_gain_per_s"], low: 8.0, high: 400.0,
        units: &[("m/min/mm", |gain| mm_per_s_from_mm_per_min(gain * MM_PER_M))] },
    Usual { keys: &["drive.spindle_integral_s", "drive.z_integral_s"], low: 0.001, high: 2.0, units: TIMES },
    Usual { keys: &["drive.velocity_filter_s"], low: 5e-6, high: 0.01, units: TIMES },
    Usual { keys: &["drive.encoder_latency_s"], low: 1e-7, high: 0.001, units: &[MICROSECONDS, MILLISECONDS] },
    Usual { keys: &["drive.encoder_jitter_s"], low: 1e-9, high: 0.0001, units: &[MICROSECONDS] },
    Usual { keys: &["spindle.supply_sag_s"], low: 0.001, high: 1.0, units: TIMES },
    Usual { keys: &["law.motor_share", "spindle.torque_ripple", "spindle.supply_sag_ratio"], low: 0.002, high: 1.0, units: &[PER_CENT] },
    Usual { keys: &["tap.bottom_clearance_mm"], low: 0.02, high: 20.0, units: &[MICROMETRES] },
    Usual { keys: &["tolerance.error_um"], low: 2.0, high: 1000.0, units: &[MILLIMETRES] },
];

fn usual(key: &str) -> Option<&'static Usual> {
    USUAL.iter().find(|usual| usual.keys.contains(&key))
}

/// "50 µs would be 0.00005 s": the units in which a value would be one that machines have; empty where there are none.
pub(in crate::config) fn likely_units(key: &str, value: f64) -> String {
    let Some(Usual { low, high, units, .. }) = usual(key) else { return String::new() };
    let own = keys::unit(key);
    let meant = units.iter().map(|(name, own)| (name, own(value)));
    let meant = meant.filter(|(_, meant)| meant >= low && meant <= high);
    let said: Vec<_> = meant
        .map(|(name, meant)| {
            format!("{} {name} would be {} {own}", rounded(value), rounded(meant)).trim_end().to_owned()
        })
        .collect();
    said.join(", ")
}

/// "838 rad/s are 8002 rpm": the unit in which a torque curve's end would be the greatest speed; none where no unit is.
pub(in crate::config) fn likely_speed_unit(last: f64, max_rpm: f64) -> Option<String> {
    /// A curve may end somewhat above the greatest speed, and numbers are rounded.
    const NEAR: core::ops::RangeInclusive<f64> = 0.97..=1.3;
    let (name, rpm) = usual("spindle.max_rpm")?.units.iter().find(|(_, rpm)| NEAR.contains(&(rpm(last) / max_rpm)))?;
    Some(format!("{} {name} are {} rpm", rounded(last), rounded(rpm(last))))
}

/// Values outside what machines have. Zero says that there is none of a thing, and is no slip.
pub(super) fn find(draft: &Draft, given: &dyn Fn(&str) -> bool, report: &mut dyn FnMut(Slip)) {
    let mut draft = draft.clone();
    for usual in USUAL {
        for &path in usual.keys.iter().filter(|path| given(path)) {
            let Some(key) = keys::find(path) else { continue };
            let value = match key.slot {
                Slot::Number(at) => *at(&mut draft),
                Slot::Optional { at, .. } => at(&mut draft).unwrap_or_default(),
                _ => continue,
            };
            if value == 0.0 || (value >= usual.low && value <= usual.high) {
                continue;
            }
            let unit = if key.unit.is_empty() { String::new() } else { format!(" {}", key.unit) };
            let (low, high) = (rounded(usual.low), rounded(usual.high));
            let odd = format!("{path} = {}{unit}: machines have {low} to {high}{unit}", rounded(value));
            let likely = likely_units(path, value);
            let likely = if likely.is_empty() { "look at its unit and its decimal point".to_owned() } else { likely };
            report(Slip::new(path, odd, likely));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::keys::Draft;

    #[test]
    fn the_reference_machine_is_usual_and_every_key_exists() {
        let mut found = Vec::new();
        find(&Draft::reference(), &|_| true, &mut |slip| found.push(slip));
        assert_eq!(found, []);
        assert!(USUAL.iter().flat_map(|usual| usual.keys).all(|key| keys::find(key).is_some()));
    }
}
