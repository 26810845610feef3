//! Values on the command line: numbers in their range, and the library's own names.

use std::num::{NonZeroU32, NonZeroUsize};
use std::path::PathBuf;

use clap::ValueEnum;

use crate::control::cycle::StrokeKind;
use crate::control::machine::Law;
use crate::control::model::cutting::Material;
use crate::control::profile::MAX_BANDS;
use crate::control::sync::{Compensation, Mode};
use crate::report::advice::Control;
use crate::run::PowerCut;
use crate::sim::{Effect, Fault, Injection, MOST_FAULTS};

/// An effect, or each of them in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::cli) enum Without {
    Each,
    Effect(Effect),
}

impl std::str::FromStr for Without {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if text == "each" {
            return Ok(Self::Each);
        }
        Effect::from_str(text, false).map(Self::Effect).map_err(|_| {
            let names: Vec<_> = Effect::ALL.iter().map(|effect| effect.name()).collect();
            format!("expected each, or one of {}", names.join(", "))
        })
    }
}

/// A motor share, by the machine file's own range.
pub(super) fn share(text: &str) -> Result<f64, String> {
    within(text, 0.0, 1.0).map_err(|_| "expected a share above 0 up to 1, such as 0.8 for 80 %".into())
}

/// A share of tolerance and clearance.
pub(super) fn margin(text: &str) -> Result<f64, String> {
    within(text, 0.0, 1.0).map_err(|_| "expected a share of the tolerance above 0 up to 1, such as 0.5".into())
}

pub(super) fn positive(text: &str) -> Result<f64, String> {
    within(text, 0.0, 1e9)
}

pub(super) fn runs(text: &str) -> Result<NonZeroU32, String> {
    count_to(text, 100_000_000)
}

pub(super) fn holes(text: &str) -> Result<NonZeroU32, String> {
    count_to(text, 10_000)
}

pub(super) fn jobs(text: &str) -> Result<NonZeroUsize, String> {
    count_to(text, 1024)?.try_into().map_err(|_| "expected a smaller number".to_owned())
}

fn count_to(text: &str, most: u32) -> Result<NonZeroU32, String> {
    let count = text.parse().ok().filter(|count: &NonZeroU32| count.get() <= most);
    count.ok_or_else(|| format!("expected a whole number from 1 to {most}"))
}

pub(super) fn band_count(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MAX_BANDS).contains(count));
    count.ok_or_else(|| format!("expected a whole number from 1 to {MAX_BANDS}"))
}

pub(super) fn pitch(text: &str) -> Result<f64, String> {
    within(text, 0.0, 100.0)
}

pub(super) fn rate(text: &str) -> Result<f64, String> {
    within(text, 9.0, 10_000.0)
}

pub(super) fn override_to_100(text: &str) -> Result<f64, String> {
    within(text, 0.0, 100.0)
}

pub(super) fn override_to_200(text: &str) -> Result<f64, String> {
    within(text, 0.0, 200.0)
}

/// A picture's path, whose name says that it is SVG.
pub(super) fn svg(path: PathBuf) -> Result<PathBuf, String> {
    let named = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"));
    if named { Ok(path) } else { Err("expected a name that ends in .svg: pictures are SVG".into()) }
}

/// A page's path, whose name says that it is HTML.
pub(super) fn html(path: PathBuf) -> Result<PathBuf, String> {
    let named = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("html"));
    if named { Ok(path) } else { Err("expected a name that ends in .html: reports are pages for a browser".into()) }
}

fn within(text: &str, above: f64, high: f64) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > above && value <= high => Ok(value),
        _ => Err(format!("expected a number above {above} up to {high}")),
    }
}

/// Makes an enumeration of the library a word of the command line, by the names it already has.
macro_rules! named_values {
    ($($kind:ty),*) => {$(
        impl ValueEnum for $kind {
            fn value_variants<'a>() -> &'a [Self] {
                &Self::ALL
            }

            fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
                Some(clap::builder::PossibleValue::new(self.name()))
            }
        }
    )*};
}
named_values!(Law, Mode, Compensation, Material, Effect, Control, StrokeKind);

/// The long help of `--fault`.
pub(super) fn fault_help() -> String {
    let names: Vec<_> = Fault::all().map(|fault| fault.to_string()).collect();
    format!(
        "Let this go wrong at a time from the program's start, NAME@SECONDS, or NAME@SECONDS+DURATION; up to \
         {MOST_FAULTS} of them\n\nNames: {}",
        names.join(", ")
    )
}

/// When the power is lost, and of what.
pub(super) fn power_cut(text: &str) -> Result<PowerCut, String> {
    text.parse()
}

/// A fault of a simulated machine or its host.
pub(super) fn injection(text: &str) -> Result<Injection, String> {
    text.parse()
}
