//! The simulated machine: plant models with their own parameters, assembled as a [`Port`](crate::control::port::Port).

mod actual;

pub use actual::Actual;
