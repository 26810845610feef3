//! Studies: programs against simulated machines, one by one and side by side; and the law tuned for the machine.

mod compare;
mod simulation;
mod timeline;
mod tune;

pub use compare::{CompareError, Comparison, Summary, Variant, compare};
pub use simulation::{ErrorPoint, ErrorSeries, Simulation};
pub use timeline::{TimelineEntry, TimelineKind, timeline};
pub use tune::{
    RunUp, RunUpError, RunUpFault, STROKES_REV, Staircase, TuneError, TuneTask, TunedBand, Tuning, retuned,
};
