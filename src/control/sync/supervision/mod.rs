//! Supervision: samples are checked before they are used, axes are watched, faults become typed alarms, and what leaves a step
//! is bounded whatever went before.
//!
//! ```text
//!  now_s ──►┌───────┐ periods        Feedback ──►┌────────┐ Feedback to go by        wanted ──►┌────────┐ Setpoint
//!           │ clock │────────────┐               │ sample │──────────────►  …  ──►             │ bounds │──────────►
//!           └───────┘            ▼               │ effort │   (bridged)                        └───▲────┘    │
//!               │           a period made        └───▲────┘                       ┌───────────────┐│         │
//!               │ alarm     up by the model          │ expected              ────►│ followed_stop ├┘         │
//!               ▼                                ┌───┴────┐                       └───────────────┘          │
//!           ┌───────────┐  alarm                 │  sent  │◄─────────────────────────────────────────────────┘
//!           │ following ├──────► Alarm, latched  └────────┘
//!           └───────────┘        Reaction
//! ```
//!
//! The reaction is chosen by what can still be trusted: see `reaction`.

pub(super) mod alarm;
mod bounds;
mod clock;
mod effort;
mod explanation;
mod followed_stop;
mod following;
mod limits;
mod reaction;
mod rest;
mod sample;
#[cfg(test)]
mod sample_tests;
mod sent;
mod travel;
mod watch;

pub use alarm::{Alarm, Axis};
pub(super) use reaction::StopKind;
pub(super) use watch::{Observation, Supervision};
