//! Studies: programs against simulated machines, one by one and side by side.

mod compare;
mod simulation;
mod timeline;

pub use compare::{CompareError, Comparison, Summary, Variant, compare};
pub use simulation::{ErrorPoint, ErrorSeries, Simulation};
pub use timeline::{TimelineEntry, TimelineKind, timeline};
