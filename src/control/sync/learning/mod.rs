//! Iterative learning control over holes of one kind (Bristow, Tharayil and Alleyne, A survey of iterative learning control,
//! IEEE Control Systems Magazine 26(3), 2006): what was wrong at a point of the path is put right there in the next hole.
//!
//! A kind is shape, tool, height and time law, and what is cut: a tool change begins anew, and what the tool before it taught
//! is there again once it is back. Several kinds are kept, the least lately used one gives way. A hole that is off by far more
//! than holes mostly are, in all or in places, teaches little: chips, a missed period, a hard spot are not what comes again.
//! A host keeps [`Learning::save`]'s bytes over a restart.

mod correction;
mod ilc;
#[cfg(test)]
mod ilc_tests;
mod kind;
mod learned_error;
mod record;
mod usual;

pub(super) use ilc::Learning;
pub use learned_error::LearnedError;
pub use record::LEARNED_BYTES;
