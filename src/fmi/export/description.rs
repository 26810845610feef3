//! The model description of an FMU of ours.

use super::numbers::{FIRST, TOLD};
use crate::fmi::variables::{INPUTS, Kind, OUTPUTS, PARAMETERS, Variable};

/// Which of the two.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Which {
    Plant,
    Control,
}

impl Which {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Plant => "rigidtap_plant",
            Self::Control => "rigidtap_control",
        }
    }
}

/// By version and form: another version's library is another model.
pub(super) fn guid(which: Which) -> String {
    format!("{{{}-{}-1}}", which.name(), env!("CARGO_PKG_VERSION"))
}

const UNITS: [(&str, &str); 12] = [
    ("rev", r#"rad="1" factor="6.283185307179586""#),
    ("rev/s", r#"rad="1" s="-1" factor="6.283185307179586""#),
    ("rev/s2", r#"rad="1" s="-2" factor="6.283185307179586""#),
    ("rev/s3", r#"rad="1" s="-3" factor="6.283185307179586""#),
    ("mm", r#"m="1" factor="0.001""#),
    ("mm/s", r#"m="1" s="-1" factor="0.001""#),
    ("mm/s2", r#"m="1" s="-2" factor="0.001""#),
    ("mm/s3", r#"m="1" s="-3" factor="0.001""#),
    ("um", r#"m="1" factor="1e-6""#),
    ("N.m", r#"kg="1" m="2" s="-2""#),
    ("N", r#"kg="1" m="1" s="-2""#),
    ("rpm", r#"rad="1" s="-1" factor="0.10471975511965977""#),
];

pub(super) fn description(which: Which, period_s: f64, z_start_mm: f64) -> String {
    let (mut variables, mut outputs, mut index) = (String::new(), Vec::new(), 0);
    let mut add = |set: &[Variable], first: u32, causality: &str, left_out: &[&str]| {
        for (number, variable) in (first..).zip(set) {
            let Variable { name, unit, kind, meaning, .. } = *variable;
            if left_out.contains(&name) {
                continue;
            }
            index += 1;
            let is_parameter = causality == "parameter";
            let variability = match (is_parameter, kind) {
                (true, _) => "fixed",
                (false, Kind::Real) => "continuous",
                (false, _) => "discrete",
            };
            // What is set has a start; what comes out has none of its own.
            let start = match name {
                _ if causality == "output" => None,
                "set_power_on" | "hole_hand" | "hole_pitch_mm" | "seed" => Some(1.0),
                "spindle_sample_valid" | "z_sample_valid" | "spindle_ready" | "z_ready" => Some(1.0),
                "set_z_mm" | "z_start_mm" => Some(z_start_mm),
                _ => Some(0.0),
            };
            let unit = unit.map_or_else(String::new, |unit| format!(r#" unit="{unit}""#));
            let typed = if kind == Kind::Switch {
                let start = start.map_or_else(String::new, |start| format!(r#" start="{}""#, start != 0.0));
                format!("<Boolean{start}/>")
            } else {
                // A count as Real is exact up to 2⁵³: an Integer of FMI 2 has 32 bits alone.
                let start = start.map_or_else(String::new, |start| format!(r#" start="{start}""#));
                format!("<Real{unit}{start}/>")
            };
            variables += &format!(
                "    <ScalarVariable name=\"{name}\" valueReference=\"{number}\" causality=\"{causality}\" \
                 variability=\"{variability}\" description=\"{meaning}\">{typed}</ScalarVariable>\n"
            );
            if causality == "output" {
                outputs.push(index);
            }
        }
    };
    let about = match which {
        Which::Plant => {
            add(&INPUTS, FIRST[0], "input", &[]);
            add(&OUTPUTS, FIRST[1], "output", &[]);
            add(&PARAMETERS, FIRST[2], "parameter", &[]);
            "Spindle and Z axis of a machine that taps rigidly, with drives, cutting and encoders"
        }
        Which::Control => {
            let truth = OUTPUTS.map(|variable| if variable.name.starts_with("true_") { variable.name } else { "" });
            add(&OUTPUTS, FIRST[1], "input", &truth);
            add(&INPUTS, FIRST[0], "output", &[]);
            add(&TOLD, FIRST[3], "output", &[]);
            "Synchronizer of spindle and Z in rigid tapping, with the program that it runs"
        }
    };
    let listed: String = outputs.iter().map(|index| format!("      <Unknown index=\"{index}\"/>\n")).collect();
    let seconds = ("s", r#"s="1""#);
    let units = UNITS.iter().chain(std::iter::once(&seconds));
    let units: String =
        units.map(|(name, base)| format!("    <Unit name=\"{name}\"><BaseUnit {base}/></Unit>\n")).collect();
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<fmiModelDescription fmiVersion="2.0" modelName="{name}" guid="{guid}" description="{about}"
    generationTool="rigidtap {version}" variableNamingConvention="flat">
  <CoSimulation modelIdentifier="{name}" canHandleVariableCommunicationStepSize="false"/>
  <UnitDefinitions>
{units}  </UnitDefinitions>
  <DefaultExperiment startTime="0" stepSize="{period_s}"/>
  <ModelVariables>
{variables}  </ModelVariables>
  <ModelStructure>
    <Outputs>
{listed}    </Outputs>
    <InitialUnknowns>
{listed}    </InitialUnknowns>
  </ModelStructure>
</fmiModelDescription>
"#,
        name = which.name(),
        guid = guid(which),
        version = env!("CARGO_PKG_VERSION"),
    )
}
