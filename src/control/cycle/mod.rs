//! One tapped hole: what a program asks for, the plan of its synchronous strokes, and what may interrupt them.

mod hole;
mod interruption;
mod pecks;
mod plan;
mod positioning;

pub use hole::{Hand, Retract, TapCycle};
pub use interruption::{Interrupted, InterruptionError};
pub use pecks::{MAX_LEGS, MAX_PECKS};
pub use plan::{CycleError, CyclePlan, Leg, LegKind, LegState};
pub use positioning::Positioning;
