#![doc = include_str!("README.md")]
//!
//! # This module
//!
//! | file | is |
//! |---|---|
//! | [`frame`] | one reading on the wire: layout, encoder, decoder |
//! | [`receiver`] | any bytes → samples, each fault counted |
//! | [`serial`] | a port read by a thread of its own into a ring buffer; reconnects |
//! | [`board`] | a stand-in for the board: sends samples in real time |
//! | [`recording`] | CSV and halsampler files → samples, by a [`map`] of their columns |
//! | [`plausibility`] | what spindle and Z can do between two readings |
//! | [`sample`] | what all of these yield |

pub mod board;
pub mod frame;
pub mod map;
pub mod plausibility;
pub mod receiver;
pub mod recording;
pub mod sample;
pub mod serial;
