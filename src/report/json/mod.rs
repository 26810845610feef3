//! JSON for programs: one typed answer for each subcommand, one file for each answer.
//!
//! Every answer begins with the head of [`Answer`]. The fields are a contract: more may come beside them, these stay.
//! [`schema`] gives the JSON Schema of a subcommand's answers. A number that is not finite is written as `null`.

mod advise;
mod alarm;
mod answer;
mod check;
mod compare;
mod identify;
mod machine;
mod monitor;
mod parts;
mod plan;
mod schema;
mod simulate;
mod streamed;
mod sweep;
mod sweep_part;
mod sweep_worst;
mod tune;

pub use advise::AdviseAnswer;
pub use alarm::AlarmAnswer;
pub use answer::{Answer, SCHEMA};
pub use check::{CheckAnswer, CheckedFile, CommandAnswer, DiagnosticAnswer, TapAnswer};
pub use compare::{CompareAnswer, ComparedProgram};
pub use identify::IdentifyAnswer;
pub use machine::{GainsAnswer, MachineAnswer};
pub use monitor::MonitorAnswer;
pub use parts::{Band, HandName};
pub use plan::{EntryAnswer, ProgramPlan, SegmentAnswer, SpindleEntry, StrokeEntry, StrokePlan};
pub use schema::{SUBCOMMANDS, schema};
pub use simulate::{SimulateAnswer, SimulatedProgram};
pub use streamed::Streamed;
pub use sweep::SweepAnswer;
pub use sweep_part::SweepPartAnswer;
pub use sweep_worst::SweepWorstAnswer;
pub use tune::{DryCycleAnswer, TuneAnswer};
