//! `machine` and `tune --gains`: the machine file's own keys.

use schemars::JsonSchema;
use serde::Serialize;
use serde_json::{Map, Value};

/// The tables of the machine file in use, as `rigidtap machine` prints them.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct MachineAnswer {
    /// Table by name.
    #[serde(flatten)]
    tables: Map<String, Value>,
}

/// The `[sync]` table that the rules give.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct GainsAnswer {
    /// Value by key.
    #[serde(flatten)]
    keys: Map<String, Value>,
}

impl MachineAnswer {
    /// Of a machine file's text, whose comments are for people.
    #[must_use]
    pub fn of_toml(text: &str) -> Self {
        Self { tables: object(text) }
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
