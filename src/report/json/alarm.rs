//! The alarm that ended a run.

use schemars::JsonSchema;
use serde::Serialize;

use crate::report::alarm::sentence;
use crate::run::Fault;

/// An alarm with its period and its values.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct AlarmAnswer {
    /// Which alarm, `A112`: `rigidtap check --explain` tells it.
    pub code: String,
    /// Axis that it is of, `spindle` or `z`.
    pub axis: &'static str,
    /// Measured value, in the unit of `limit`.
    pub value: f64,
    /// Limit that it passed.
    pub limit: f64,
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
        let (value, limit) = fault.alarm.value_and_limit();
        Self {
            code: format!("A{}", fault.alarm.code()),
            axis: fault.alarm.axis().name(),
            value,
            limit,
            k: fault.k,
            time_s: fault.time_s,
            hole: fault.hole,
            message: sentence(fault),
        }
    }
}
