//! [`MachineFile`] → commented TOML, from which a user starts a file of his own.

use core::fmt::Write;

use super::drawn::{drawn_to_toml, models_to_toml};
use super::implied;
use super::keys::{self, Draft, Key, Slot, Table};
use super::machine_file::MachineFile;
use super::number::{exact, rounded};
use crate::control::machine::{BandSpec, Ramp};
use crate::control::motor::TorquePoint;

const HEADER: &str = "\
# Machine file of rigidtap. A comment says the unit, what the key is, and why the reference machine has its value.
# A key that is left out keeps the reference machine's value, so a file of your own may shrink to what differs.
# The reference machine stands for a BT30 drilling-tapping centre; it is no machine's datasheet.
";

/// Comments start in this column where the values leave room, and end before `WIDTH`.
const COMMENT_COLUMN: usize = 36;
const WIDTH: usize = 120;
/// A longer setting has its comment below.
const LONG_SETTING: usize = 50;

impl MachineFile {
    /// The whole file as commented TOML: [`MachineFile::read`] gives the same machine from it, to the bit.
    ///
    /// Keys without a value and the keys of `[actual]` at their defaults stand as comments.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut out = HEADER.to_owned();
        let mut draft = self.draft();
        let mut implied = implied::implied(&draft);
        for table in keys::TABLES {
            out.push('\n');
            whole_table(&mut out, table, &mut draft, implied.as_mut());
        }
        out
    }

    /// `[sync]` alone, as [`MachineFile::to_toml`] writes it, ready to paste into a machine file.
    ///
    /// ```
    /// let file = rigidtap::config::MachineFile::reference();
    /// assert!(file.to_toml().contains(&file.sync_to_toml()));
    /// assert!(file.sync_to_toml().contains("[sync]\nbacklash_crossing_s = 0.004"));
    /// ```
    #[must_use]
    pub fn sync_to_toml(&self) -> String {
        let mut out = String::new();
        let mut draft = self.draft();
        keys::TABLES
            .iter()
            .filter(|table| table.path == "sync")
            .for_each(|table| whole_table(&mut out, table, &mut draft, None));
        out
    }

    pub(super) fn draft(&self) -> Draft {
        Draft {
            spec: self.machine.spec().clone(),
            actual: self.actual,
            spread: self.spread,
            hard: self.hard,
            gcode: self.gcode.clone(),
            data_sheet: self.data_sheet,
        }
    }
}

/// One table; laws are commented out where they are what is `implied` without them.
fn whole_table(out: &mut String, table: &Table, draft: &mut Draft, mut implied: Option<&mut Draft>) {
    let mut reference = Draft::reference();
    header(out, table);
    for key in keys::of_table(table.path) {
        let mut is_implied = || implied.as_deref_mut().is_some_and(|implied| value(key, implied) == value(key, draft));
        let rule = keys::rule(key.path).filter(|_| is_implied());
        entry(out, key, draft, &mut reference, rule);
    }
}

/// A key's measured value, with the words that say how it was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredKey {
    /// Table and name, `z.coulomb_n`.
    pub path: &'static str,
    /// Its value in the file's unit.
    pub value: f64,
    /// How it was measured.
    pub how: String,
}

/// Measured keys of one table as TOML, ready to paste into a machine file: four digits each, with the unit, what the key
/// is and how it was measured. Empty without any.
///
/// ```
/// use rigidtap::config::{MeasuredKey, measured_to_toml};
/// let found = MeasuredKey { path: "z.backlash_um", value: 3.14159, how: "both ways compared".into() };
/// let toml = measured_to_toml(&[found]);
/// assert!(toml.starts_with("[z]\nbacklash_um = 3.142 "));
/// assert!(toml.ends_with("# µm: backlash between motor and table. Measured: both ways compared\n"));
/// assert_eq!(measured_to_toml(&[]), "");
/// ```
#[must_use]
pub fn measured_to_toml(measured: &[MeasuredKey]) -> String {
    let mut out = String::new();
    for found in measured {
        if out.is_empty() {
            let _ = writeln!(out, "[{}]", keys::parent(found.path));
        }
        let what = keys::find(found.path).map_or("", |key| key.meaning);
        let name = found.path.trim_start_matches(keys::parent(found.path)).trim_start_matches('.');
        let comment = format!("{}: {what}. Measured: {}", keys::unit(found.path), found.how);
        line(&mut out, &format!("{name} = {}", rounded(found.value)), comment.trim_start_matches(": "));
    }
    out
}

/// One key with its comment beside it.
fn line(out: &mut String, setting: &str, comment: &str) {
    let margin = format!("\n{:COMMENT_COLUMN$} # ", "");
    let length = setting.chars().count();
    if length > LONG_SETTING {
        let comment = wrapped(comment, WIDTH - COMMENT_COLUMN - 3).join(&margin);
        let _ = writeln!(out, "{setting}{margin}{comment}");
        return;
    }
    let comment = wrapped(comment, WIDTH - COMMENT_COLUMN.max(length) - 3).join(&margin);
    // Writing to a String cannot fail.
    let _ = writeln!(out, "{setting:<COMMENT_COLUMN$} # {comment}");
}

/// `[law.torque_curve]` with these bands, ready to paste into a machine file.
///
/// ```
/// use rigidtap::control::machine::{BandSpec, Ramp};
/// let band = BandSpec { to_rpm: 3000.0, ramp: Ramp::Time { accel_s: 0.0785, decel_s: 0.0785 } };
/// assert_eq!(
///     rigidtap::config::bands_to_toml(&[band]),
///     "[law.torque_curve]\nbands = [\n  { to_rpm = 3000, accel_s = 0.0785, decel_s = 0.0785 },\n]\n"
/// );
/// ```
#[must_use]
pub fn bands_to_toml(bands: &[BandSpec]) -> String {
    format!("[law.torque_curve]\nbands = {}\n", band_list(bands))
}

fn header(out: &mut String, table: &Table) {
    let _ = writeln!(out, "{}[{}]", comment_lines(table.about), table.path);
}

fn entry(out: &mut String, key: &Key, draft: &mut Draft, reference: &mut Draft, rule: Option<&str>) {
    let standard = value(key, reference);
    let mine = value(key, draft);
    let changed = mine != standard;
    let comment = comment(key, changed.then_some(standard.as_deref()).flatten(), rule);
    match mine {
        Some(list) if matches!(key.slot, Slot::TorqueCurve | Slot::Bands) => {
            let list = format!("{} = {list}", key.name());
            let list = if rule.is_some() { comment_lines(&list) } else { list + "\n" };
            out.push_str(&comment_lines(&wrapped(&comment, WIDTH - 2).join("\n")));
            out.push_str(&list);
        }
        mine => {
            let replaced = keys::EITHER.iter().any(|(absolute, factor)| {
                *factor == key.path && keys::find(absolute).is_some_and(|key| value(key, draft).is_some())
            });
            let off = mine.is_none() || rule.is_some() || replaced || (key.table() == "actual" && !changed);
            let off = if off { "# " } else { "" };
            let shown = mine.unwrap_or_else(|| example(key, draft));
            line(out, &format!("{off}{} = {shown}", key.name()), &comment);
        }
    }
}

/// The text in lines of at most `width` characters, as far as its words allow.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.is_empty() => line.push_str(word),
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The value as TOML; none where an optional key is absent.
fn value(key: &Key, draft: &mut Draft) -> Option<String> {
    Some(match &key.slot {
        Slot::Number(at) => exact(*at(draft)),
        Slot::Optional { at, .. } | Slot::Ruled { at, .. } => exact((*at(draft))?),
        Slot::Switch(at) => at(draft).to_string(),
        Slot::Word { get, .. } => toml::Value::from(get(draft)).to_string(),
        Slot::Range(at) => drawn_to_toml(at(draft)),
        Slot::OptionalRange { at, .. } => drawn_to_toml(&(*at(draft))?),
        Slot::Models(at) => models_to_toml(at(draft)),
        Slot::TorqueCurve => point_list(&draft.spec.spindle.torque_curve),
        Slot::Bands => band_list(&draft.spec.law.torque_curve.bands),
    })
}

fn example(key: &Key, draft: &Draft) -> String {
    match key.slot {
        Slot::Optional { example, .. } => exact(example),
        // Four digits: it shows what is in force, and is no value to keep.
        Slot::Ruled { rule, .. } => format!("{:.4}", rule(&draft.spec)),
        Slot::OptionalRange { example, .. } => drawn_to_toml(&example.into()),
        _ => String::new(),
    }
}

/// Unit, meaning, reason, or the `rule` of a value that follows where it is left out. A reason speaks of the reference machine's value, so a changed value is told which one that is.
fn comment(key: &Key, standard: Option<&str>, rule: Option<&str>) -> String {
    let Key { unit, meaning, reason, .. } = key;
    let unit = if unit.is_empty() { String::new() } else { format!("{unit}: ") };
    if let Some(rule) = rule {
        return format!("{unit}{meaning}. Left out: {rule}");
    }
    match standard {
        Some(standard) if standard.contains('\n') => format!("{unit}{meaning}"),
        Some(standard) => format!("{unit}{meaning}. Reference machine: {standard} ({reason})"),
        None if matches!(key.slot, Slot::Optional { .. } | Slot::Ruled { .. } | Slot::OptionalRange { .. }) => {
            format!("{unit}{meaning}. Left out: {reason}")
        }
        None => format!("{unit}{meaning}. {}", capital(reason)),
    }
}

fn capital(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |first| first.to_uppercase().collect::<String>() + chars.as_str())
}

fn comment_lines(text: &str) -> String {
    text.lines().map(|line| format!("# {line}\n")).collect()
}

fn point_list(points: &[TorquePoint]) -> String {
    let points: Vec<_> =
        points.iter().map(|point| format!("[{}, {}]", exact(point.speed_rpm), exact(point.torque_nm))).collect();
    let line = format!("[{}]", points.join(", "));
    if line.len() < WIDTH / 2 { line } else { format!("[\n  {},\n]", points.join(",\n  ")) }
}

/// Each band in the form it was given in.
fn band_list(bands: &[BandSpec]) -> String {
    let line = |band: &BandSpec| {
        let (suffix, accel, decel) = match band.ramp {
            Ramp::Time { accel_s, decel_s } => ("s", accel_s, decel_s),
            Ramp::Rate { accel_rpm_per_s, decel_rpm_per_s } => ("rpm_per_s", accel_rpm_per_s, decel_rpm_per_s),
        };
        let [to_rpm, accel, decel] = [band.to_rpm, accel, decel].map(exact);
        format!("  {{ to_rpm = {to_rpm}, accel_{suffix} = {accel}, decel_{suffix} = {decel} }},\n")
    };
    format!("[\n{}]", bands.iter().map(line).collect::<String>())
}
