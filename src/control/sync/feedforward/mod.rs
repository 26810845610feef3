//! What both axes need beyond their plan, so that as little as can be is left to correct.

mod axial;
mod backlash;
mod delay_line;
mod drive_inverse;
mod position_loop_inverse;
mod spindle;
mod z;
mod z_config;
#[cfg(test)]
mod z_tests;

pub(super) use drive_inverse::DriveInverse;
pub(super) use position_loop_inverse::PositionLoopInverse;
pub(super) use spindle::SpindleFeedforward;
pub(super) use z::{ZFeedforward, ZRest};
pub(super) use z_config::{ZConfig, ZDelays};
