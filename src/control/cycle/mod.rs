//! One tapped hole: what a program asks for, and the plan of its synchronous strokes.

mod hole;

pub use hole::{Hand, Retract, TapCycle};
