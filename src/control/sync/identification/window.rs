//! What a short time of motion sums up to.

use crate::control::sync::frame::Measured;

/// Speeds of one period, Z positive into the hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Speeds {
    pub(super) spindle_rev_per_s: f64,
    pub(super) load_mm_per_s: f64,
    pub(super) motor_mm_per_s: f64,
}

/// One window: its first period's speeds, and sums since. An effort that was absent in any period is absent in the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Window {
    pub(super) periods: u32,
    pub(super) first: Speeds,
    pub(super) torque_nm: Option<f64>,
    /// The spindle's drive stood at its limit in every period.
    pub(super) saturated: bool,
    pub(super) friction_nm: f64,
    pub(super) force_n: Option<f64>,
    pub(super) first_force_n: Option<f64>,
    pub(super) deflection_mm: Option<f64>,
    /// Where the load was at first.
    pub(super) from_mm: f64,
}

impl Window {
    /// Half of the first period belongs to the window before.
    pub(super) fn opened(now: &Measured, first: Speeds, friction_nm: f64) -> Self {
        let half = |value: Option<f64>| value.map(|value| 0.5 * value);
        Self {
            periods: 0,
            first,
            torque_nm: half(now.spindle_torque_nm),
            saturated: now.torque_saturated,
            friction_nm: 0.5 * friction_nm,
            force_n: half(now.z_force_n),
            first_force_n: now.z_force_n,
            deflection_mm: now.deflection_mm(),
            from_mm: now.load_mm,
        }
    }

    /// One more period. The last one's mean speed stands for its middle, so half of its effort belongs to this window.
    pub(super) fn add(&mut self, now: &Measured, friction_nm: f64, ends: bool) {
        let sum = |sum: Option<f64>, value: Option<f64>| sum.zip(value).map(|(sum, value)| sum + value);
        let share = if ends { 0.5 } else { 1.0 };
        let shared = |value: Option<f64>| value.map(|value| share * value);
        self.periods += 1;
        self.torque_nm = sum(self.torque_nm, shared(now.spindle_torque_nm));
        self.saturated &= now.torque_saturated;
        self.force_n = sum(self.force_n, shared(now.z_force_n));
        self.friction_nm += share * friction_nm;
        if !ends {
            self.deflection_mm = sum(self.deflection_mm, now.deflection_mm());
        }
    }
}
