//! What tests hold the monitors to.

use super::seen::{Followed, FollowingLimits, SpindleEffort};
use crate::control::machine::Machine;

pub(super) const PERIOD_S: f64 = 0.001;
pub(super) const SPINDLE_LIMIT_REV: f64 = 0.25;
pub(super) const Z_LIMIT_MM: f64 = 0.2;
pub(super) const FAST_REV_PER_S: f64 = 50.0;
pub(super) const UNTOLD: SpindleEffort = effort(0.0, None);

pub(super) const fn effort(commanded_nm: f64, reported_nm: Option<f64>) -> SpindleEffort {
    SpindleEffort { reported_nm, commanded_nm: [commanded_nm; 2] }
}

pub(super) fn limits() -> FollowingLimits {
    let machine = Machine::reference();
    let drive = &machine.spec().drive;
    FollowingLimits {
        motor: machine.motor().clone(),
        coulomb_nm: machine.spec().spindle.coulomb_nm,
        spindle_rev: SPINDLE_LIMIT_REV,
        z_mm: Z_LIMIT_MM,
        position_gain_per_s: drive.spindle_position_gain_per_s,
        velocity_gain_per_s: drive.spindle_velocity_gain_per_s,
        delay_s: PERIOD_S,
        count_rev: 1.0 / machine.spec().spindle.encoder_counts_per_rev,
        period_s: PERIOD_S,
    }
}

pub(super) fn good() -> Followed {
    Followed { is_trusted: true, ..Followed::default() }
}

/// At constant commanded speed, some of it missing.
pub(super) fn slower(lag_rev_per_s: f64) -> Followed {
    Followed { speed: FAST_REV_PER_S - lag_rev_per_s, expected_speed: FAST_REV_PER_S, ..good() }
}
