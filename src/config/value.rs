//! Values of the kinds that the keys take. What cannot be read is reported, and none is returned.

use arrayvec::ArrayVec;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fault::{ConfigFault, Expected, Found};
use super::keys::{BAND_KEYS, BANDS};
use super::read::Reader;
use crate::control::machine::{BandSpec, MachineError, MachineFault, Ramp};
use crate::control::motor::{MAX_POINTS, TorqueCurveError, TorquePoint};
use crate::control::profile::MAX_BANDS;

/// Longest excerpt of the file that a message quotes, in characters.
const EXCERPT: usize = 40;

impl Reader<'_> {
    pub(super) fn number(&mut self, key: &str, value: &Spanned<DeValue<'_>>) -> Option<f64> {
        // From the text, not by way of i64: a long integer is still a number, and -0 keeps its sign.
        let number = match value.get_ref() {
            DeValue::Float(float) => float.as_str().parse().ok(),
            DeValue::Integer(integer) if integer.radix() == 10 => integer.as_str().parse().ok(),
            DeValue::Integer(integer) => u32::from_str_radix(integer.as_str(), integer.radix()).ok().map(f64::from),
            _ => None,
        };
        if number.is_none() {
            self.wrong_type(key.to_owned(), Expected::Number, value);
        }
        number
    }

    pub(super) fn switch(&mut self, key: &str, value: &Spanned<DeValue<'_>>) -> Option<bool> {
        if let DeValue::Boolean(on) = value.get_ref() {
            return Some(*on);
        }
        self.wrong_type(key.to_owned(), Expected::Switch, value);
        None
    }

    pub(super) fn word(
        &mut self,
        key: &'static str,
        known: &'static [&'static str],
        value: &Spanned<DeValue<'_>>,
    ) -> Option<&'static str> {
        let DeValue::String(word) = value.get_ref() else {
            self.wrong_type(key.to_owned(), Expected::Word(known), value);
            return None;
        };
        let found = known.iter().copied().find(|known| known == word);
        if found.is_none() {
            self.fault(ConfigFault::UnknownWord { key, word: word.to_string(), known }, value.span());
        }
        found
    }

    pub(super) fn points(
        &mut self,
        key: &'static str,
        value: &Spanned<DeValue<'_>>,
    ) -> Option<ArrayVec<TorquePoint, MAX_POINTS>> {
        let list = self.list(key, Expected::Points, value)?;
        let points: Vec<_> = list.iter().enumerate().map(|(index, point)| self.point(key, index, point)).collect();
        let points: Vec<_> = points.into_iter().collect::<Option<_>>()?;
        let stored = ArrayVec::try_from(points.as_slice()).ok();
        if stored.is_none() {
            let fault = MachineFault::TorqueCurve(TorqueCurveError::Count { count: points.len() });
            self.fault(ConfigFault::Value(MachineError { key, index: None, fault }), value.span());
        }
        stored
    }

    fn point(&mut self, key: &str, index: usize, value: &Spanned<DeValue<'_>>) -> Option<TorquePoint> {
        let name = format!("{key}, point {}", index + 1);
        match value.get_ref() {
            DeValue::Array(pair) if pair.len() == 2 => {
                let mut numbers = pair.iter().map(|number| self.number(&name, number)).collect::<Vec<_>>().into_iter();
                let (speed_rpm, torque_nm) = (numbers.next()??, numbers.next()??);
                self.place(format!("{key}[{index}]"), value.span());
                Some(TorquePoint { speed_rpm, torque_nm })
            }
            _ => {
                self.wrong_type(name, Expected::Point, value);
                None
            }
        }
    }

    pub(super) fn bands(
        &mut self,
        key: &'static str,
        value: &Spanned<DeValue<'_>>,
    ) -> Option<ArrayVec<BandSpec, MAX_BANDS>> {
        let list = self.list(key, Expected::Bands, value)?;
        let bands: Vec<_> = list.iter().enumerate().map(|(index, band)| self.band(index, band)).collect();
        let bands: Vec<_> = bands.into_iter().collect::<Option<_>>()?;
        let stored = ArrayVec::try_from(bands.as_slice()).ok();
        if stored.is_none() {
            self.fault(ConfigFault::TooManyBands { count: bands.len() }, value.span());
        }
        stored
    }

    fn band(&mut self, index: usize, value: &Spanned<DeValue<'_>>) -> Option<BandSpec> {
        let path = format!("{BANDS}[{index}]");
        let DeValue::Table(table) = value.get_ref() else {
            self.wrong_type(format!("{BANDS}, band {}", index + 1), Expected::Band, value);
            return None;
        };
        let faults_before = self.reading.faults.len();
        for (name, _) in table {
            if !BAND_KEYS.iter().any(|(known, _)| known == name.get_ref()) {
                self.fault(ConfigFault::UnknownKey { table: BANDS, name: name.get_ref().to_string() }, name.span());
            }
        }
        let [to_rpm, accel_s, decel_s, accel_rpm_per_s, decel_rpm_per_s] =
            BAND_KEYS.map(|(name, _)| self.band_number(index, table, name));
        if self.reading.faults.len() > faults_before {
            // A misspelt key is not missing as well.
            return None;
        }
        let ramp = match (accel_s, decel_s, accel_rpm_per_s, decel_rpm_per_s) {
            (Some(accel_s), Some(decel_s), None, None) => Ok(Ramp::Time { accel_s, decel_s }),
            (None, None, Some(accel_rpm_per_s), Some(decel_rpm_per_s)) => {
                Ok(Ramp::Rate { accel_rpm_per_s, decel_rpm_per_s })
            }
            (None, None, None, None) => Err("accel_s and decel_s"),
            (None, Some(_), None, None) => Err("accel_s"),
            (Some(_), None, None, None) => Err("decel_s"),
            (None, None, None, Some(_)) => Err("accel_rpm_per_s"),
            (None, None, Some(_), None) => Err("decel_rpm_per_s"),
            _ => {
                self.fault(ConfigFault::BandMixed { index }, value.span());
                return None;
            }
        };
        if to_rpm.is_none() {
            self.fault(ConfigFault::BandIncomplete { index, missing: "to_rpm" }, value.span());
        }
        if let Err(missing) = ramp {
            self.fault(ConfigFault::BandIncomplete { index, missing }, value.span());
        }
        let band = BandSpec { to_rpm: to_rpm?, ramp: ramp.ok()? };
        self.place(path, value.span());
        Some(band)
    }

    fn band_number(&mut self, index: usize, table: &DeTable<'_>, name: &str) -> Option<f64> {
        let value = table.get(name)?;
        let number = self.number(&format!("{BANDS}.{name} in band {}", index + 1), value)?;
        self.place(format!("{BANDS}[{index}].{name}"), value.span());
        Some(number)
    }

    pub(super) fn list<'v>(
        &mut self,
        key: &str,
        expected: Expected,
        value: &'v Spanned<DeValue<'_>>,
    ) -> Option<&'v [Spanned<DeValue<'v>>]> {
        if let DeValue::Array(list) = value.get_ref() {
            return Some(list);
        }
        self.wrong_type(key.to_owned(), expected, value);
        None
    }

    pub(super) fn wrong_type(&mut self, key: String, expected: Expected, value: &Spanned<DeValue<'_>>) {
        let kind = match value.get_ref() {
            DeValue::String(_) => "a string",
            DeValue::Integer(_) => "an integer",
            DeValue::Float(_) => "a number",
            DeValue::Boolean(_) => "a truth value",
            DeValue::Datetime(_) => "a date",
            DeValue::Array(_) => "a list",
            DeValue::Table(_) => "a table",
        };
        // A table made by a dotted key or a header has no text of its own.
        let text = self.excerpt(value.span());
        let text = if kind == "a table" && !text.starts_with('{') { String::new() } else { text };
        self.fault(ConfigFault::WrongType { key, expected, found: Found { kind, text } }, value.span());
    }

    fn excerpt(&self, span: core::ops::Range<usize>) -> String {
        let source = self.text.get(span).unwrap_or("");
        let line = source.lines().next().unwrap_or("");
        let mut excerpt: String = line.chars().take(EXCERPT).filter(|c| !c.is_control()).collect();
        if source.chars().nth(excerpt.chars().count()).is_some() {
            excerpt.push('…');
        }
        excerpt
    }
}
