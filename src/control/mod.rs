//! What a CNC kernel embeds: time laws, couplings, tapping cycles and the synchronizer.
//!
//! `no_std`, without heap, panic, lock or unbounded loop; all mathematics goes through [`math`] so that every host
//! computes the same bits. A plan is made outside the interpolation period, [`sync`] runs inside it.
//!
//! In order, each module importing only from those above it:
//!
//! 1. [`units`], [`math`]: the unit legend; polynomial pieces, roots, elementary functions
//! 2. [`motor`], [`coupling`], [`thread`]: what the motor can, how a follower moves, what a thread allows
//! 3. [`profile`]: time laws of one coordinate, and their independent checker
//! 4. [`machine`]: what the control knows of the machine, checked once
//! 5. [`model`]: the drive's and the machine's nominal equations
//! 6. [`cycle`], [`port`]: one hole, feasible or refused before anything moves; the boundary to a machine, which is told of it
//! 7. [`sync`]: feedback → setpoint each period of a hole, and the only definition of e(k)
//! 8. [`tapping`]: what hosts call, hole after hole or a whole block

mod bytes;
pub mod coupling;
pub mod cycle;
pub mod machine;
pub mod math;
pub mod model;
pub mod motor;
pub mod port;
pub mod profile;
pub mod sync;
pub mod tapping;
pub mod thread;
pub mod units;
