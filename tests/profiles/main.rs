//! Every time law against checkers that share no formula with it.

mod cases;
mod improved_s_curve;
mod motors;
mod oracle;
mod properties;
mod random;
mod ruckig;
mod special;
mod trapezoid_jerk;
mod under_the_curve;
