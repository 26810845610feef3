//! Every time law against checkers that share no formula with it.

mod cases;
mod motors;
mod oracle;
mod properties;
mod random;
mod special;
mod under_the_curve;
