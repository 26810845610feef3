//! Rigid tapping: one *master* coordinate follows a *time law*, everything else follows the master through a *coupling*.
//!
//! The spindle angle is the master, Z follows at pitch × angle. The folders show the data flow; a module imports only
//! from strictly lower ranks (held by `tests/layering.rs`):
//!
//! | rank | module | is |
//! |---|---|---|
//! | 0 | [`control`] | all that a CNC kernel embeds: laws, couplings, cycles, synchronizer. `no_std`, no heap, no panic |
#![cfg_attr(feature = "std", doc = "| 1 | [`gcode`] | text → typed commands with their place in the text |")]
#![cfg_attr(
    feature = "std",
    doc = "| 1 | [`sim`] | the plant: spindle, Z axis, drives, cutting, encoders, assembled as a port |"
)]
#![cfg_attr(
    feature = "std",
    doc = "| 1 | [`link`] | real encoders: frames from a serial line, recordings from files |"
)]
#![cfg_attr(
    feature = "std",
    doc = "| 1 | [`laws`] | time laws that follow from a motor: speed bands by search, accelerations, jerks |"
)]
#![cfg_attr(
    feature = "std",
    doc = "| 2 | [`config`] | machine file: TOML → checked [`control::machine::Machine`], and back |"
)]
#![cfg_attr(
    feature = "std",
    doc = "| 2 | [`run`] | the only loop: a program through the synchronizer against a port; trace and monitor |"
)]
#![cfg_attr(
    feature = "std",
    doc = "| 3 | [`study`] | the same program under many settings and on many machines; the law tuned for the machine |"
)]
#![cfg_attr(feature = "std", doc = "| 4 | [`report`] | tables, JSON, plots: one file per format |")]
#![cfg_attr(all(feature = "fmi", unix), doc = "| 4 | [`fmi`] | other people's plants: co-simulation FMUs |")]
#![cfg_attr(feature = "cli", doc = "| 5 | [`cli`] | the command line |")]
#![cfg_attr(feature = "std", doc = "| – | [`guide`] | pages: commissioning, embedding, results, formats, changelog |")]
#![cfg_attr(
    feature = "capi",
    doc = "| 5 | [`capi`] | the control core for hosts in C; with std, the simulated machine for them in `capi::sim` |"
)]
//!
//! ```text
//! text ─► gcode ─► control::cycle ─► control::sync ◄─► a port: sim
//!         config ─► control::machine, sim │
//!                               run: the only loop ─► trace, monitor ─► study ─► report ─► cli
//! serial line, recording ─► link ─► run: analysis ─────┘
//! ```
#![cfg_attr(not(feature = "std"), no_std)]
#![cfg_attr(all(doctest, feature = "std"), doc = include_str!("../README.md"))]

pub mod control;

#[cfg(feature = "capi")]
pub mod capi;
#[cfg(feature = "cli")]
pub mod cli;
#[cfg(feature = "std")]
pub mod config;
#[cfg(all(feature = "fmi", unix))]
pub mod fmi;
#[cfg(feature = "std")]
pub mod gcode;
#[cfg(feature = "std")]
pub mod guide;
#[cfg(feature = "std")]
pub mod laws;
#[cfg(feature = "std")]
pub mod link;
#[cfg(feature = "std")]
pub mod report;
#[cfg(feature = "std")]
pub mod run;
#[cfg(feature = "std")]
pub mod sim;
#[cfg(feature = "std")]
pub mod study;
