//! A model description of FMI 2.0 or 3.0, as far as a plant needs it.

use std::collections::HashMap;

use roxmltree::{Document, Node};

use super::error::FmuError;

/// Version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Version {
    Two,
    Three,
}

/// Type of a variable in the FMU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    Real,
    Float32,
    Int8,
    UInt8,
    Int16,
    UInt16,
    Int32,
    UInt32,
    Int64,
    UInt64,
    Boolean,
    Other,
}

/// A variable that an FMU has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Found {
    pub(super) causality: String,
    pub(super) value_type: Type,
    pub(super) unit: Option<String>,
    pub(super) reference: u32,
    pub(super) is_array: bool,
}

/// What an FMU says of itself.
#[derive(Clone, Debug)]
pub(super) struct Description {
    pub(super) version: Version,
    /// GUID, or instantiation token.
    pub(super) token: String,
    pub(super) model_identifier: String,
    pub(super) fixed_step_s: Option<f64>,
    pub(super) variables: HashMap<String, Found>,
}

impl Description {
    pub(super) fn read(text: &str) -> Result<Self, FmuError> {
        let wrong = |why: String| FmuError::Description(why);
        let document = Document::parse(text).map_err(|error| wrong(error.to_string()))?;
        let root = document.root_element();
        if root.tag_name().name() != "fmiModelDescription" {
            return Err(wrong(format!("its root is <{}>, expected <fmiModelDescription>", root.tag_name().name())));
        }
        let attribute = |node: Node<'_, '_>, name: &str| {
            let found = node.attribute(name).map(str::to_owned);
            found.ok_or_else(|| wrong(format!("<{}> has no {name}", node.tag_name().name())))
        };
        let version_text = attribute(root, "fmiVersion")?;
        let version = match version_text.as_str() {
            "2.0" => Version::Two,
            text if text == "3.0" || text.starts_with("3.0.") => Version::Three,
            other => return Err(wrong(format!("FMI {other} is not known: expected 2.0 or 3.0"))),
        };
        let child = |name: &str| root.children().find(|node| node.tag_name().name() == name);
        let co_simulation = child("CoSimulation")
            .ok_or_else(|| wrong("it has no <CoSimulation>: a plant is a co-simulation FMU, with its solver".into()))?;
        let token = attribute(root, if version == Version::Two { "guid" } else { "instantiationToken" })?;
        let list = child("ModelVariables").ok_or_else(|| wrong("it has no <ModelVariables>".into()))?;
        let types: HashMap<_, _> = child("TypeDefinitions").map(types).unwrap_or_default();
        let mut variables = HashMap::new();
        for node in list.children().filter(Node::is_element) {
            let (name, found) = variable(node, version, &types).ok_or_else(|| {
                wrong(format!("variable {} has no name or valueReference", node.attribute("name").unwrap_or("?")))
            })?;
            variables.insert(name, found);
        }
        let can_vary = co_simulation.attribute("canHandleVariableCommunicationStepSize") == Some("true");
        let fixed_step_s =
            if can_vary { None } else { co_simulation.attribute("fixedInternalStepSize").and_then(|s| s.parse().ok()) };
        Ok(Self {
            version,
            token,
            model_identifier: attribute(co_simulation, "modelIdentifier")?,
            fixed_step_s,
            variables,
        })
    }
}

/// Units of declared types, by the types' names.
fn types(list: Node<'_, '_>) -> HashMap<String, String> {
    let named = list.children().filter_map(|node| {
        let unit = node.attribute("unit").or_else(|| node.first_element_child()?.attribute("unit"))?;
        Some((node.attribute("name")?.to_owned(), unit.to_owned()))
    });
    named.collect()
}

fn variable(node: Node<'_, '_>, version: Version, types: &HashMap<String, String>) -> Option<(String, Found)> {
    // FMI 2 has the type inside the variable, FMI 3 the variable named by its type.
    let typed = if version == Version::Two {
        let known = ["Real", "Integer", "Boolean", "String", "Enumeration"];
        node.children().find(|child| known.contains(&child.tag_name().name()))?
    } else {
        node
    };
    let unit = typed.attribute("unit").map(str::to_owned);
    let unit = unit.or_else(|| types.get(typed.attribute("declaredType")?).cloned());
    let found = Found {
        causality: node.attribute("causality").unwrap_or("local").to_owned(),
        value_type: match typed.tag_name().name() {
            "Real" | "Float64" => Type::Real,
            "Float32" => Type::Float32,
            "Int8" => Type::Int8,
            "UInt8" => Type::UInt8,
            "Int16" => Type::Int16,
            "UInt16" => Type::UInt16,
            "Integer" | "Int32" => Type::Int32,
            "UInt32" => Type::UInt32,
            "Int64" => Type::Int64,
            "UInt64" => Type::UInt64,
            "Boolean" => Type::Boolean,
            _ => Type::Other,
        },
        unit: unit.filter(|unit| !unit.is_empty()),
        reference: node.attribute("valueReference")?.parse().ok()?,
        is_array: node.children().any(|child| child.tag_name().name() == "Dimension"),
    };
    Some((node.attribute("name")?.to_owned(), found))
}
