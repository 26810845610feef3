//! Studies: programs against simulated machines, one by one and side by side, on many machines; the law tuned for the
//! machine; and the machine identified by its own motion.

mod advise;
mod compare;
mod identify;
mod other_plant;
mod parallel;
mod simulation;
mod sweep;
mod timeline;
mod tune;

pub use advise::{
    Advice, AdviseError, AdviseSettings, Alternative, HoleKind, KindAdvice, Limit, Trial, advise, advise_steps,
};
pub use compare::{CompareError, Comparison, Summary, Variant, compare};
pub use identify::{DryCycleError, Findings, dry_cycle, dry_cycle_for_linuxcnc, identify, run_dry_cycle};
pub use other_plant::PlantSource;
pub use simulation::{ErrorPoint, ErrorSeries, Simulation};
pub use sweep::{
    Counts, HoleErrors, MergeFault, PartFault, PartFile, PartLabels, Percentiles, Shard, Sweep, SweepError,
    SweepSettings, SweepSummary, SweptMachine, TailShift, WorstEffect, WorstMachine, merge, sweep, sweep_part,
    worst_machine,
};
pub use timeline::{TimelineEntry, TimelineKind, timeline};
pub use tune::{RunUp, RunUpError, RunUpFault, Tuning};
