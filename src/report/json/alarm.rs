//! The alarm that ended a run.

use schemars::JsonSchema;
use serde::Serialize;

use crate::control::sync::Alarm;
use crate::report::alarm::sentence;
use crate::run::Fault;

/// An alarm with its period and its values.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct AlarmAnswer {
    /// Which alarm.
    pub code: &'static str,
    /// Axis that it concerns; null where both do.
    pub axis: Option<&'static str>,
    /// Measured value, in the unit of `limit`; here the seconds waited.
    pub value: Option<f64>,
    /// Limit that it passed; null where the alarm has none.
    pub limit: Option<f64>,
    /// Period, from 0 at the program's start.
    pub k: u64,
    /// Time of that period.
    pub time_s: f64,
    /// Hole, from 1.
    pub hole: u32,
    /// The same as a sentence.
    pub message: String,
}

impl From<&Fault> for AlarmAnswer {
    fn from(fault: &Fault) -> Self {
        let (code, value) = match fault.alarm {
            Alarm::NotInPosition { waited_s, .. } => ("not-in-position", waited_s),
        };
        Self {
            code,
            axis: None,
            value: Some(value),
            limit: None,
            k: fault.k,
            time_s: fault.time_s,
            hole: fault.hole,
            message: sentence(fault),
        }
    }
}
