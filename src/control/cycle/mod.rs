//! One tapped hole: what a program asks for, and the plan of its synchronous strokes.

mod hole;
mod pecks;
mod plan;

pub use hole::{Hand, Retract, TapCycle};
pub use pecks::{MAX_LEGS, MAX_PECKS};
pub use plan::{CycleError, CyclePlan, Leg, LegKind, LegState};
