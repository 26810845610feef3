//! Tables for people, as wide as there is room: [`Layout`].

mod advise;
pub(super) mod columns;
mod compare;
mod holes;
pub(super) mod layout;
mod plan;
mod simulate;
mod sweep;
mod sweep_worst;
mod tune;
mod words;

pub use advise::advised;
pub use compare::compared;
pub use holes::{HoleGroups, holes};
pub use layout::{Layout, USUAL_WIDTH};
pub use plan::{TimelinePages, stroke_plan};
pub use simulate::{program_summary, simulated_program};
pub use sweep::{swept_part, swept_program};
pub use sweep_worst::worst_machine;
pub use tune::tuning;
