//! The simulated machine: plant models with their own parameters, assembled as a [`Port`](crate::control::port::Port).
//!
//! Inside, efforts are N·m and N, motion is rad and m; outside rev and mm. Linear parts are discretised exactly, the rest
//! (friction, backlash, limits) is an input held over one plant step of at most 25 µs. X and Y follow their commands
//! ideally: they rest while a thread is cut. Z's weight is taken to be balanced, and a tap does not pull Z along.

mod actual;
mod effects;
mod encoder;
mod inertias;
mod interpolator;
mod plant;
mod spindle;
mod spread;
mod wave;
mod work_piece;
mod z_axis;

pub use actual::Actual;
pub use effects::{Effect, Effects};
pub use plant::{Plant, PlantOptions};
pub use spread::Spread;

/// Longest plant step: a fortieth of a period of the highest default resonance.
const MAX_STEP_S: f64 = 25e-6;
