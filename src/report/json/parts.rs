//! What several answers have in them.

use schemars::JsonSchema;
use serde::Serialize;

use crate::control::cycle::Hand;
use crate::control::machine::Law;
use crate::control::sync::{ErrorBand, Settings};
use crate::sim::ActualValue;

/// How a hole is tapped.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
pub(super) struct MethodAnswer {
    /// Time law of the strokes, by the command line's name.
    law: &'static str,
    /// What Z follows, by the command line's name.
    sync: &'static str,
    /// Compensation of Z, by the command line's name.
    compensation: &'static str,
}

impl MethodAnswer {
    pub(super) const fn new(law: Law, settings: &Settings) -> Self {
        Self { law: law.name(), sync: settings.mode.name(), compensation: settings.compensation.name() }
    }
}

/// The band that an error stays in.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
pub struct Band {
    /// Least value.
    min: Option<f64>,
    /// Greatest value.
    max: Option<f64>,
    /// Greatest less least value.
    peak_to_peak: Option<f64>,
    /// Root mean square about zero.
    rms: Option<f64>,
}

impl From<&ErrorBand> for Band {
    fn from(band: &ErrorBand) -> Self {
        Self {
            min: finite(band.min()),
            max: finite(band.max()),
            peak_to_peak: finite(band.peak_to_peak()),
            rms: finite(band.rms()),
        }
    }
}

/// JSON has no other numbers.
pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

/// Direction of a thread or of the spindle, seen from the spindle.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum HandName {
    /// Clockwise, M03.
    Right,
    /// Counter-clockwise, M04.
    Left,
}

impl From<Hand> for HandName {
    fn from(hand: Hand) -> Self {
        match hand {
            Hand::Right => Self::Right,
            Hand::Left => Self::Left,
        }
    }
}

/// A value of `[actual]`.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
#[serde(untagged)]
pub(super) enum ActualAnswer {
    /// Null where it is as the file says.
    Number(Option<f64>),
    Word(&'static str),
    Switch(bool),
}

impl From<ActualValue> for ActualAnswer {
    fn from(value: ActualValue) -> Self {
        match value {
            ActualValue::Number(number) => Self::Number(number),
            ActualValue::Word(word) => Self::Word(word),
            ActualValue::Switch(on) => Self::Switch(on),
        }
    }
}
