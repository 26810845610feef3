//! `machine` and `tune --gains`: the machine file's own keys.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

use crate::control::machine::LongestStop;

/// The tables of the machine file in use, as `rigidtap machine` prints them.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct MachineAnswer {
    /// Table by name.
    #[serde(flatten)]
    tables: Map<String, Value>,
    /// The longest synchronous stop, for the timer of the drives' safe stop 1.
    longest_stop: LongestStopAnswer,
}

#[derive(Clone, Copy, Debug, JsonSchema, PartialEq, Serialize)]
struct LongestStopAnswer {
    /// From top speed to rest.
    time_s: f64,
    /// Revolutions on the way.
    angle_rev: f64,
}

/// The `[sync]` table that the rules give.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct GainsAnswer {
    /// Value by key.
    #[serde(flatten)]
    keys: Map<String, Value>,
}

impl MachineAnswer {
    /// Of a machine file's text, whose comments are for people, and what follows from it.
    #[must_use]
    pub fn new(text: &str, stop: &LongestStop) -> Self {
        let longest_stop = LongestStopAnswer { time_s: stop.time_s, angle_rev: stop.angle_rev };
        Self { tables: object(text), longest_stop }
    }
}

impl GainsAnswer {
    /// Of a text with a `[sync]` table.
    #[must_use]
    pub fn of_toml(text: &str) -> Self {
        let keys = match object(text).remove("sync") {
            Some(Value::Object(keys)) => keys,
            _ => Map::new(),
        };
        Self { keys }
    }
}

/// Text that was written as TOML just before.
fn object(text: &str) -> Map<String, Value> {
    toml::from_str(text).unwrap_or_default()
}
