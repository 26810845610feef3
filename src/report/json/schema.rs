//! The JSON Schema of each subcommand's answers.

use schemars::{JsonSchema, Schema, schema_for};

use super::advise::AdviseAnswer;
use super::answer::Answer;
use super::check::CheckAnswer;
use super::compare::CompareAnswer;
use super::identify::IdentifyAnswer;
use super::machine::{GainsAnswer, MachineAnswer};
use super::monitor::MonitorAnswer;
use super::plan::{ProgramPlan, StrokePlan};
use super::simulate::SimulateAnswer;
use super::sweep::SweepAnswer;
use super::sweep_part::SweepPartAnswer;
use super::sweep_worst::SweepWorstAnswer;
use super::tune::{DryCycleAnswer, TuneAnswer};

/// One of the subcommand's answers.
#[derive(JsonSchema)]
#[serde(untagged)]
#[expect(dead_code, reason = "its schema alone is used")]
enum Either<A, B> {
    One(A),
    Other(B),
}

/// The subcommands that answer in JSON.
pub const SUBCOMMANDS: [&str; 9] =
    ["check", "plan", "simulate", "compare", "sweep", "advise", "tune", "monitor", "machine"];

/// The JSON Schema of a subcommand's answers; none of one that has no such answer.
///
/// ```
/// use rigidtap::report::json::{SUBCOMMANDS, schema};
/// assert!(SUBCOMMANDS.iter().all(|name| schema(name).is_some()) && schema("fly").is_none());
/// ```
#[must_use]
pub fn schema(subcommand: &str) -> Option<Schema> {
    let mut schema = match subcommand {
        "check" => schema_for!(Answer<CheckAnswer<'static>>),
        "plan" => schema_for!(Either<Answer<StrokePlan>, Answer<ProgramPlan<'static>>>),
        "simulate" => schema_for!(Answer<SimulateAnswer>),
        "compare" => schema_for!(Answer<CompareAnswer>),
        "sweep" => schema_for!(Either<Answer<SweepAnswer>, Either<Answer<SweepPartAnswer>, Answer<SweepWorstAnswer>>>),
        "advise" => schema_for!(Answer<AdviseAnswer>),
        "tune" => schema_for!(
            Either<
                Either<Answer<TuneAnswer>, Answer<IdentifyAnswer>>,
                Either<Answer<GainsAnswer>, Answer<DryCycleAnswer>>,
            >
        ),
        "monitor" => schema_for!(Answer<MonitorAnswer>),
        "machine" => schema_for!(Answer<MachineAnswer>),
        _ => return None,
    };
    schema.insert("title".into(), format!("rigidtap {subcommand} --format json").into());
    Some(schema)
}
