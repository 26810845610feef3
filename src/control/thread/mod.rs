//! Standard threads: sizes, tap drills, what synchronisation error each thread bears; and the pitches of the usual series, to
//! tell a pitch from one that is nearly it.

mod designation;
mod lookup;
mod pitch;
mod size;
mod sizes;
mod standard;
mod tolerance;

pub use lookup::COARSE_NAMES;
pub use pitch::{PITCHES, StandardPitch};
pub use standard::{Series, StandardThread, ThreadError};
