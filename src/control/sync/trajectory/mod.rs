//! Where spindle and Z are to be: the plan, how fast its time runs, and what was commanded of late.
//!
//! A plan that was stopped, retracted or resumed says nothing of the time before. So the past is what was commanded, kept by
//! [`CommandedMotion`]; of the plan it is read only as far back as the plan has not changed.

mod commanded_motion;
mod plan;
mod time_scaling;

pub(super) use commanded_motion::CommandedMotion;
pub(super) use plan::Trajectory;
pub(super) use time_scaling::{TimeScaling, TorqueDemand};
