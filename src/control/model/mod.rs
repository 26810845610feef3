//! Nominal equations of the machine: what the synchronizer predicts with and what the plant is built from.
//!
//! Inside these models effort is torque in N·m or force in N, and motion is in the axis's own unit (rev or mm);
//! `effort_per_acceleration` carries the unit between them: 2π·inertia for the spindle, mass/1000 for Z.

pub mod cascade;
pub mod closed_loop;
pub mod cutting;
pub mod drive_response;
pub mod friction;
pub mod two_mass;
pub mod washout;
