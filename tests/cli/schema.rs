//! JSON held against a JSON Schema: the part of draft 2020-12 that our schemas use; any other word in one is a panic. (The
//! usual crate for it takes longer to build than all the rest of the tests.)

use serde_json::{Map, Value};

/// Every place where a value is not as a schema says.
pub(super) fn faults(value: &Value, schema: &Value) -> Vec<String> {
    let mut found = Vec::new();
    Check { root: schema }.value(value, schema, "", &mut found);
    found
}

struct Check<'a> {
    root: &'a Value,
}

impl Check<'_> {
    fn value(&self, value: &Value, schema: &Value, place: &str, found: &mut Vec<String>) {
        let Value::Object(schema) = schema else {
            assert_eq!(schema, &Value::Bool(true), "a schema is an object, or true");
            return;
        };
        for (word, argument) in schema {
            match word.as_str() {
                "$schema" | "$defs" | "title" | "description" | "format" | "default" => {}
                "$ref" => {
                    let path = argument.as_str().and_then(|path| path.strip_prefix('#')).expect("a local reference");
                    let part = self.root.pointer(path).unwrap_or_else(|| panic!("{path} is not in the schema"));
                    self.value(value, part, place, found);
                }
                "type" if !is_of(value, argument) => found.push(format!("{place}: not a {argument}")),
                "enum" if !list(argument).contains(value) => found.push(format!("{place}: not one of {argument}")),
                "const" if value != argument => found.push(format!("{place}: not {argument}")),
                "minimum" if value.as_f64() < argument.as_f64() && value.is_number() => {
                    found.push(format!("{place}: below {argument}"));
                }
                "minItems" | "maxItems" => {
                    let (length, limit) = (value.as_array().map(Vec::len), argument.as_u64().unwrap() as usize);
                    let wrong = |length: usize| if word == "minItems" { length < limit } else { length > limit };
                    if length.is_some_and(wrong) {
                        found.push(format!("{place}: {word} is {limit}"));
                    }
                }
                "anyOf" | "oneOf" => self.alternatives(value, word, list(argument), place, found),
                "items" => {
                    for (index, item) in value.as_array().into_iter().flatten().enumerate() {
                        self.value(item, argument, &format!("{place}/{index}"), found);
                    }
                }
                "properties" | "required" | "additionalProperties" => {
                    if let Value::Object(object) = value {
                        self.members(object, word, argument, schema, place, found);
                    }
                }
                "type" | "enum" | "const" | "minimum" => {}
                other => panic!("{other} is no word that is checked here"),
            }
        }
    }

    fn alternatives(&self, value: &Value, word: &str, parts: &[Value], place: &str, found: &mut Vec<String>) {
        let fitting = parts.iter().filter(|part| {
            let mut faults = Vec::new();
            self.value(value, part, place, &mut faults);
            faults.is_empty()
        });
        let count = fitting.count();
        if count == 0 || (word == "oneOf" && count > 1) {
            found.push(format!("{place}: fits {count} of {} alternatives", parts.len()));
        }
    }

    fn members(
        &self,
        object: &Map<String, Value>,
        word: &str,
        argument: &Value,
        schema: &Map<String, Value>,
        place: &str,
        found: &mut Vec<String>,
    ) {
        let known = |name: &str| schema.get("properties").is_some_and(|known| known.get(name).is_some());
        match word {
            "required" => {
                for name in list(argument).iter().filter_map(Value::as_str).filter(|name| !object.contains_key(*name)) {
                    found.push(format!("{place}: {name} is missing"));
                }
            }
            "properties" => {
                for (name, schema) in argument.as_object().expect("properties are an object") {
                    if let Some(member) = object.get(name) {
                        self.value(member, schema, &format!("{place}/{name}"), found);
                    }
                }
            }
            _ => {
                for (name, member) in object.iter().filter(|(name, _)| !known(name)) {
                    self.value(member, argument, &format!("{place}/{name}"), found);
                }
            }
        }
    }
}

fn list(value: &Value) -> &[Value] {
    value.as_array().expect("a list")
}

/// Whether a value is of a type, or of one of several.
fn is_of(value: &Value, names: &Value) -> bool {
    let is = |name: &str| match name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        other => panic!("{other} is no type"),
    };
    match names {
        Value::String(name) => is(name),
        names => list(names).iter().filter_map(Value::as_str).any(is),
    }
}
