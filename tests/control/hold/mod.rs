//! `compensation = full` against simulated machines: those that are as their file says, and those that are not.

mod bench;
mod hand_over;
mod identification;
mod learning;
mod nominal;
mod other_machines;
mod single_effects;
mod takes;
