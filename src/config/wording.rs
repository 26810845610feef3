//! The one place where faults of a machine become words.

use core::fmt;

use super::fault::{ConfigFault, Expected};
use super::keys;
use super::number::{exact, rounded};
use super::slips;
use super::suggest::nearest;
use crate::control::machine::{MachineError, MachineFault, MachineWarning, MachineWarningKind};
use crate::control::motor::{MAX_POINTS, TorqueCurveError};
use crate::control::profile::MAX_BANDS;
use crate::control::thread::StandardThread;

impl fmt::Display for ConfigFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong { bytes, limit } => {
                write!(f, "the file has {bytes} bytes: expected a machine file, at most {limit} bytes")
            }
            Self::NotUtf8 { byte } => write!(f, "byte 0x{byte:02X} is not UTF-8: expected a text file"),
            Self::Syntax { message } => write!(f, "not TOML: {message}"),
            Self::Duplicate { name } => write!(f, "`{}` stands twice", name.escape_debug()),
            Self::UnknownKey { table: "", name } => write!(f, "unknown table or key `{}`", name.escape_debug()),
            Self::UnknownKey { table, name } => write!(f, "unknown key `{}` in [{table}]", name.escape_debug()),
            Self::Renamed { old, new: Some(new) } => write!(f, "{old} is now {new}"),
            Self::Renamed { old, new: None } => write!(f, "{old} is not needed any more and not read"),
            Self::WrongType { key, expected, found } => {
                let space = if found.text.is_empty() { "" } else { " " };
                write!(f, "{key}: found {}{space}{}, expected {expected}", found.kind, found.text)
            }
            Self::UnknownWord { key, word, known } => {
                write!(f, "{key}: found \"{}\", expected {}", word.escape_debug(), Expected::Word(known))
            }
            Self::RangeOrder { key, low, high } => {
                write!(f, "{key}: {} is above {}, expected [low, high]", exact(*low), exact(*high))
            }
            Self::BandIncomplete { index, missing } => write!(f, "band {} has no {missing}", index + 1),
            Self::BandMixed { index } => {
                write!(f, "band {} mixes a time (_s) with an acceleration (_rpm_per_s)", index + 1)
            }
            Self::TooManyBands { count } => {
                write!(f, "{}: the number of bands is {count}, expected 1 to {MAX_BANDS}", keys::BANDS)
            }
            Self::Value(error) => error.fmt(f),
            Self::Ratio { key, ratio } => {
                write!(f, "{key}: ratio = {} is out of range: expected 0 to 1, a share of the machines", exact(*ratio))
            }
            Self::Both { key, other } => write!(f, "{key} and {other} stand side by side: expected one of them"),
            Self::Unwise(warning) => warning.fmt(f),
            Self::Slip(slip) => f.write_str(&slip.odd),
            Self::More { count } => write!(f, "{count} further faults are not shown"),
        }
    }
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Number => "a number",
            Self::Switch => "true or false",
            Self::Range => "a range [low, high], { any = [low, high], ratio = x } or { one_of = [a, b] }",
            Self::Choices => "a list of 1 to 8 values",
            Self::Words => "a choice { one_of = [\"a\", \"b\"] }",
            Self::Table => "a table",
            Self::Points => "a list of points [rpm, N·m]",
            Self::Point => "a point [rpm, N·m]",
            Self::Bands => "a list of bands",
            Self::Band => "a band { to_rpm, accel_s, decel_s }",
            Self::Word(known) => {
                return f.write_str(&known.iter().map(|word| format!("\"{word}\"")).collect::<Vec<_>>().join(" or "));
            }
        })
    }
}

impl fmt::Display for MachineError {
    /// Key, what was found, what was expected.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let key = self.key;
        let nth = self.index.map_or(0, |index| index + 1);
        match self.fault {
            MachineFault::OutOfRange { value, low, high } => {
                write!(f, "{key} = {}", exact(value))?;
                if nth > 0 && keys::parent(key) == keys::BANDS {
                    write!(f, " in band {nth}")?;
                }
                write!(f, " is out of range: expected {} to {}", exact(low), exact(high))?;
                match keys::unit(key) {
                    "" => Ok(()),
                    unit => write!(f, " {unit}"),
                }
            }
            MachineFault::TorqueCurve(error) => write!(f, "{key}: {error}"),
            MachineFault::TorqueCurveEnd { last_rpm, max_rpm } => write!(
                f,
                "{key} ends at {} rpm: expected a last point at spindle.max_rpm = {} rpm or above",
                exact(last_rpm),
                exact(max_rpm)
            ),
            MachineFault::PartNotBelowWhole { part, whole } => write!(
                f,
                "{key} = {} is not below spindle.inertia_kg_m2 = {}: expected a part of it",
                exact(part),
                exact(whole)
            ),
            MachineFault::BandOrder { to_rpm, previous_rpm } => write!(
                f,
                "{key}: band {nth} ends at {} rpm, expected more than the {} rpm {}",
                exact(to_rpm),
                exact(previous_rpm),
                if nth > 1 { "of the band below" } else { "of standstill" }
            ),
            MachineFault::NoBands => write!(f, "{key} is empty: expected 1 to {MAX_BANDS} bands"),
            MachineFault::SpeedAboveBands { speed_rpm, last_rpm } => write!(
                f,
                "{key} = {} is not below the last band's top: expected less than {} rpm",
                exact(speed_rpm),
                exact(last_rpm)
            ),
            MachineFault::PeriodsDisagree { drive_s, interpolation_s } => write!(
                f,
                "{key} = {} is no whole part of control.period_s = {}: expected it divided by 1, 2, 3 …",
                exact(drive_s),
                exact(interpolation_s)
            ),
            MachineFault::HoleNotBelowMajor { hole_mm, major_mm } => write!(
                f,
                "{key} = {} is not below tap.major_mm = {}: expected the smaller tap drill",
                exact(hole_mm),
                exact(major_mm)
            ),
            MachineFault::TapIncomplete => {
                let other = if key == "tap.major_mm" { "tap.hole_mm" } else { "tap.major_mm" };
                write!(f, "{key} stands without {other}: expected both diameters or neither")
            }
            MachineFault::EncoderTooCoarse { count_um, limit_um } => write!(
                f,
                "{key}: one count is {} µm, expected at most {} µm, a tenth of what an M3 thread bears",
                rounded(count_um),
                rounded(limit_um)
            ),
        }
    }
}

impl fmt::Display for TorqueCurveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Count { count } => write!(f, "the number of points is {count}, expected 2 to {MAX_POINTS}"),
            Self::FirstSpeed { speed_rpm } => {
                write!(f, "the first point is at {} rpm, expected 0 rpm", exact(speed_rpm))
            }
            Self::SpeedOrder { point, speed_rpm, previous_rpm } => write!(
                f,
                "point {} is at {} rpm, expected more than the {} rpm of the point before",
                point + 1,
                exact(speed_rpm),
                exact(previous_rpm)
            ),
            Self::Torque { point, torque_nm } => {
                write!(f, "point {} has {} N·m, expected a positive torque", point + 1, exact(torque_nm))
            }
            Self::StandstillTorque { first_nm, second_nm } => write!(
                f,
                "the second point has {} N·m, expected the first one's {} N·m",
                exact(second_nm),
                exact(first_nm)
            ),
        }
    }
}

impl fmt::Display for MachineWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.kind {
            MachineWarningKind::AboveMotor { speed_rpm, needed_nm, available_nm, count } => {
                match self.index {
                    Some(index) if count > 1 => {
                        write!(f, "{}: {count} bands ask more than the motor has; band {}", self.key, index + 1)?;
                    }
                    Some(index) => write!(f, "{}, band {}", self.key, index + 1)?,
                    None => f.write_str(self.key)?,
                }
                write!(
                    f,
                    " takes {} N·m at {} rpm, where the motor has {} N·m",
                    rounded(needed_nm),
                    exact(speed_rpm),
                    rounded(available_nm)
                )
            }
            MachineWarningKind::EndsBelowMax { last_rpm, max_rpm } => write!(
                f,
                "law.torque_curve.bands: the last band ends at {} rpm, so that spindle.max_rpm = {} is never reached",
                exact(last_rpm),
                exact(max_rpm)
            ),
            MachineWarningKind::ZSlowForSpindle { needed_mm_per_s, limit_mm_per_s } => write!(
                f,
                "z.max_mm_per_s = {} is too slow for spindle.max_rpm: even pitch 0.5 mm takes {} mm/s",
                exact(limit_mm_per_s),
                rounded(needed_mm_per_s)
            ),
        }
    }
}

impl ConfigFault {
    /// What to do about it, where more can be said than what was expected.
    #[must_use]
    pub fn hint(&self) -> Option<String> {
        match self {
            Self::TooLong { .. } | Self::NotUtf8 { .. } => {
                Some("start from the output of `rigidtap machine`".to_owned())
            }
            Self::UnknownKey { table, name } => Some(unknown_key_hint(table, name)),
            Self::UnknownWord { word, known, .. } => {
                nearest(word, known).map(|word| format!("did you mean \"{word}\"?"))
            }
            Self::WrongType { expected: Expected::Number, found, .. } if found.kind == "a string" => {
                let number = found.text.trim_matches(['"', '\'']);
                number.parse::<f64>().ok().map(|_| format!("write {number} without quotes"))
            }
            Self::WrongType { key, expected: Expected::Table, .. } => Some(format!("write [{key}] above its keys")),
            Self::BandIncomplete { .. } | Self::BandMixed { .. } => Some(
                "a band is { to_rpm, accel_s, decel_s } or { to_rpm, accel_rpm_per_s, decel_rpm_per_s }".to_owned(),
            ),
            Self::Value(error) => value_hint(error),
            Self::Unwise(warning) => Some(warning_hint(warning)),
            Self::Slip(slip) => Some(slip.likely.clone()),
            Self::Renamed { new: Some(new), .. } => Some(format!("write {} instead", keys::name(new))),
            Self::Renamed { new: None, .. } => Some("leave it out".to_owned()),
            Self::Syntax { .. }
            | Self::Duplicate { .. }
            | Self::RangeOrder { .. }
            | Self::WrongType { .. }
            | Self::TooManyBands { .. }
            | Self::Ratio { .. }
            | Self::More { .. } => None,
            Self::Both { key, .. } => Some(format!("{key} is the value itself, the other a factor on the file's own")),
        }
    }
}

fn unknown_key_hint(table: &str, name: &str) -> String {
    let known = keys::names_in(table);
    let mut hint = String::new();
    if let Some(near) = nearest(name, &known) {
        hint = if table.is_empty() { format!("did you mean [{near}]? ") } else { format!("did you mean {near}? ") };
    } else {
        let homes: Vec<_> =
            keys::all().filter(|key| key.name() == name).map(|key| format!("[{}]", key.table())).collect();
        if !homes.is_empty() {
            hint = format!("{name} belongs to {}. ", homes.join(", "));
        }
    }
    if table.is_empty() {
        let tables: Vec<_> = known.iter().map(|name| format!("[{name}]")).collect();
        hint + "The tables are " + &tables.join(", ")
    } else {
        hint + &format!("[{table}] has {}", known.join(", "))
    }
}

fn value_hint(error: &MachineError) -> Option<String> {
    match error.fault {
        MachineFault::OutOfRange { value, .. } => {
            let likely = slips::likely_units(error.key, value);
            let meaning = keys::find(error.key)?.meaning;
            Some(if likely.is_empty() { meaning.to_owned() } else { format!("{meaning}; {likely}") })
        }
        MachineFault::TorqueCurveEnd { last_rpm, max_rpm } => {
            let unit = slips::likely_speed_unit(last_rpm, max_rpm);
            let unit = unit.map_or_else(String::new, |unit| format!("{unit}; "));
            Some(format!("{unit}extend the curve, or lower spindle.max_rpm to {}", exact(last_rpm)))
        }
        MachineFault::PartNotBelowWhole { whole, .. } => {
            Some(format!("30 % of it, as the reference machine has, would be {}", rounded(0.3 * whole)))
        }
        MachineFault::HoleNotBelowMajor { major_mm, .. } => {
            let usual = StandardThread::coarse().find(|size| size.major_mm == major_mm).map(|size| size.hole_mm);
            Some(usual.map_or_else(
                || "the diameter of the drilled hole, about the major diameter less the pitch".to_owned(),
                |hole_mm| format!("the usual tap drill of {} mm is {} mm", rounded(major_mm), rounded(hole_mm)),
            ))
        }
        MachineFault::TorqueCurve(TorqueCurveError::StandstillTorque { .. }) => {
            Some("power is linear in speed between points, so torque is constant from standstill".to_owned())
        }
        MachineFault::PeriodsDisagree { interpolation_s, .. } => {
            Some(format!("an eighth would be {}", exact(interpolation_s / 8.0)))
        }
        _ => None,
    }
}

fn warning_hint(warning: &MachineWarning) -> String {
    match warning.kind {
        MachineWarningKind::AboveMotor { .. } => {
            format!("leave {} out: it then follows from the motor at law.motor_share", warning.key)
        }
        MachineWarningKind::EndsBelowMax { .. } => {
            "add a band up to it, leave the bands out, or lower spindle.max_rpm".to_owned()
        }
        MachineWarningKind::ZSlowForSpindle { needed_mm_per_s, limit_mm_per_s } => {
            let share = rounded(100.0 * limit_mm_per_s / needed_mm_per_s);
            format!("with pitch 0.5 mm programs up to {share} % of spindle.max_rpm are taken, coarser ones up to less")
        }
    }
}
