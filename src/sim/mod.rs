//! The simulated machine: plant models with their own parameters, assembled as a [`Port`](crate::control::port::Port).
//!
//! Inside, efforts are N·m and N, motion is rad and m; outside rev and mm. Linear parts are discretised exactly, the rest
//! (friction, backlash, limits) is an input held over one plant step of at most 25 µs. X and Y follow their commands
//! ideally: they rest while a thread is cut. The standard plant has the effects of the machine file; those of the hard
//! spread come with keys of `[actual]`, and [faults](Fault) with a time.

mod actual;
mod actual_values;
mod drawn;
mod effects;
mod effort_delay;
mod encoder;
mod fault;
mod friction;
mod gap;
mod hard_spread;
mod host;
mod inertias;
mod injector;
mod interpolator;
mod plant;
mod screw;
mod spindle;
mod spread;
mod transmission;
mod wave;
mod work_piece;
mod z_axis;

pub use actual::Actual;
pub use actual_values::{ACTUAL_VALUES, ActualValue};
pub use drawn::{Drawn, FrictionModels};
pub use effects::{Effect, Effects};
pub use fault::{Axis, AxisFault, Fault, Injection};
pub use friction::FrictionModel;
pub use hard_spread::HardSpread;
pub use injector::MOST_FAULTS;
pub use plant::{Plant, PlantOptions};
pub use spread::Spread;
