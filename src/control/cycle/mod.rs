//! One tapped hole: what a program asks for, the plan of its synchronous strokes, and what may interrupt them.

mod controlled_stop;
mod error;
mod hole;
mod interruption;
mod orientation;
mod pecks;
mod plan;
mod positioning;
mod stroke;

pub use error::CycleError;
pub use hole::{Hand, Retract, TapCycle};
pub use interruption::{Interrupted, InterruptionError};
pub use orientation::Orientation;
pub use pecks::{MAX_PECKS, MAX_STROKES};
pub use plan::CyclePlan;
pub use positioning::Positioning;
pub use stroke::{Stroke, StrokeKind, StrokeState};
