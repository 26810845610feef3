//! Time laws of one coordinate: a [`Profile`] is a list of constant-snap segments, planned by one file per law.
//!
//! Laws do not know their coordinate's unit: velocity is in units/s, acceleration in units/s² and so on, where the unit
//! is rev for the spindle and mm for a path.
//!
//! # Numerical contract
//! For a distance in 1e-3…1e4 units, speeds in 1e-2…1e4 units/s, accelerations in 1…1e6 units/s², jerks in
//! 1…1e9 units/s³, snaps in 1…1e12 units/s⁴ and periods in 1e-5…0.1 s, a planned profile ends within 1e-9 units of its
//! distance, and position and velocity are continuous across segments to 1e-9. Limits are kept to a relative 1e-9. Two
//! products bound what f64 can hold to this: start and end speed are such that stopping from them takes up to 1e5 units,
//! and duration × acceleration is up to 1e6 units/s (beyond it, a time's own last bit moves the speed by more).
//! [`verify::verify`] checks this by means of its own; the tests hold every law against it.

mod ceiling;
mod error;
mod improved_s_curve;
mod linear;
pub mod press;
mod quantise;
mod s_curve;
mod segments;
mod stroke_request;
mod tangents;
mod torque_curve;
mod torque_curve_smooth;
mod torque_limit;
mod trapezoid_jerk;
pub mod verify;

pub use error::ProfileError;
pub use improved_s_curve::{ImprovedSCurveLaw, TenPhases};
pub use linear::LinearLaw;
pub use s_curve::SCurveLaw;
pub use segments::{MAX_SEGMENTS, Profile, Segment};
pub use stroke_request::{StrokeRequest, Turns};
pub use torque_curve::{MAX_BANDS, SpeedBand, TorqueCurveLaw};
pub use torque_curve_smooth::TorqueCurveSmoothLaw;
pub use torque_limit::TorqueLimitLaw;
pub use trapezoid_jerk::TrapezoidJerkLaw;
