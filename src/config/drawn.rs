//! What a sweep draws a value from: `[low, high]`, `{ any = [low, high], ratio = x }`, `{ one_of = [a, b] }`.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::fault::{ConfigFault, Expected};
use super::number::exact;
use super::read::Reader;
use crate::sim::{Drawn, FrictionModel, FrictionModels};

/// Names of the friction laws in the order of their list.
const MODELS: [&str; FrictionModel::ALL.len()] = ["stribeck", "lugre", "gms", "stick"];
/// Most values of a choice.
const MOST_CHOICES: usize = 8;

impl Reader<'_> {
    pub(super) fn drawn(&mut self, key: &'static str, value: &Spanned<DeValue<'_>>) -> Option<Drawn> {
        let DeValue::Table(table) = value.get_ref() else {
            return self.range(key, value).map(Drawn::Within);
        };
        if !self.has_only(key, table, &["any", "ratio", "one_of"]) {
            return None;
        }
        match (table.get("any"), table.get("ratio"), table.get("one_of")) {
            (Some(any), Some(ratio), None) => {
                let any = self.range(key, any);
                let ratio = self.ratio(key, ratio);
                Some(Drawn::Some { any: any?, ratio: ratio? })
            }
            (None, None, Some(list)) => {
                let choices = self.choices(key, list)?;
                let values: Vec<_> = choices.iter().map(|choice| self.number(key, choice)).collect();
                let values: Vec<f64> = values.into_iter().collect::<Option<_>>()?;
                for (index, choice) in choices.iter().enumerate() {
                    self.place(format!("{key}[{index}]"), choice.span());
                }
                Some(Drawn::one_of(&values))
            }
            _ => {
                self.wrong_type(key.to_owned(), Expected::Range, value);
                None
            }
        }
    }

    pub(super) fn models(&mut self, key: &'static str, value: &Spanned<DeValue<'_>>) -> Option<FrictionModels> {
        let list = match value.get_ref() {
            DeValue::Table(table) if self.has_only(key, table, &["one_of"]) => table.get("one_of"),
            DeValue::Table(_) => return None,
            _ => None,
        };
        let Some(list) = list else {
            self.wrong_type(key.to_owned(), Expected::Words, value);
            return None;
        };
        let choices = self.choices(key, list)?;
        let words: Vec<_> = choices.iter().map(|choice| self.word(key, &MODELS, choice)).collect();
        let words: Vec<_> = words.into_iter().collect::<Option<_>>()?;
        let models: Vec<_> = words.into_iter().filter_map(FrictionModel::by_name).collect();
        Some(FrictionModels::of(&models))
    }

    fn range(&mut self, key: &'static str, value: &Spanned<DeValue<'_>>) -> Option<[f64; 2]> {
        let ends = match value.get_ref() {
            DeValue::Array(pair) if pair.len() == 2 => pair,
            _ => {
                self.wrong_type(key.to_owned(), Expected::Range, value);
                return None;
            }
        };
        let mut numbers = ends.iter().map(|end| self.number(key, end)).collect::<Vec<_>>().into_iter();
        let range @ [low, high] = [numbers.next()??, numbers.next()??];
        for (index, end) in ends.iter().enumerate() {
            self.place(format!("{key}[{index}]"), end.span());
        }
        if low > high {
            self.fault(ConfigFault::RangeOrder { key, low, high }, value.span());
            return None;
        }
        Some(range)
    }

    fn ratio(&mut self, key: &'static str, value: &Spanned<DeValue<'_>>) -> Option<f64> {
        let ratio = self.number(key, value)?;
        if (0.0..=1.0).contains(&ratio) {
            return Some(ratio);
        }
        self.fault(ConfigFault::Ratio { key, ratio }, value.span());
        None
    }

    fn choices<'v>(&mut self, key: &'static str, list: &'v Spanned<DeValue<'_>>) -> Option<&'v [Spanned<DeValue<'v>>]> {
        let choices = self.list(key, Expected::Choices, list)?;
        let fits = (1..=MOST_CHOICES).contains(&choices.len());
        if !fits {
            self.wrong_type(key.to_owned(), Expected::Choices, list);
        }
        fits.then_some(choices)
    }

    fn has_only(&mut self, key: &'static str, table: &DeTable<'_>, known: &[&str]) -> bool {
        let mut good = true;
        for (name, _) in table {
            if !known.contains(&name.get_ref().as_ref()) {
                good = false;
                self.fault(ConfigFault::UnknownKey { table: key, name: name.get_ref().to_string() }, name.span());
            }
        }
        good
    }
}

/// As it is read.
pub(super) fn drawn_to_toml(drawn: &Drawn) -> String {
    let range = |range: [f64; 2]| {
        let [low, high] = range.map(exact);
        format!("[{low}, {high}]")
    };
    match *drawn {
        Drawn::Within(ends) => range(ends),
        Drawn::Some { any, ratio } => format!("{{ any = {}, ratio = {} }}", range(any), exact(ratio)),
        Drawn::OneOf(values) => {
            let values: Vec<_> = values.into_iter().flatten().map(exact).collect();
            format!("{{ one_of = [{}] }}", values.join(", "))
        }
    }
}

/// As they are read.
pub(super) fn models_to_toml(models: &FrictionModels) -> String {
    let names: Vec<_> = models.iter().map(|model| format!("\"{}\"", model.name())).collect();
    format!("{{ one_of = [{}] }}", names.join(", "))
}
