//! What Z's feedforward is made of, derived once from the machine.

use crate::control::machine::Machine;
use crate::control::sync::plant_model::ZModel;

use super::delay_line::half_width_periods;

/// Instants after the one that the plan is commanded for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync) struct ZDelays {
    /// A force commanded now acts.
    pub(in crate::control::sync) acting_s: f64,
    /// The velocity loop reads what is commanded now, and the position loop.
    pub(in crate::control::sync) read_s: f64,
    pub(in crate::control::sync) position_s: f64,
}

/// What a Z feedforward is made of, for any hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync) struct ZConfig {
    pub(super) model: ZModel,
    pub(super) period_s: f64,
    pub(super) crossing_s: f64,
    pub(super) delays: ZDelays,
}

impl ZConfig {
    pub(in crate::control::sync) fn new(machine: &Machine, delays: ZDelays) -> Self {
        let spec = machine.spec();
        Self {
            model: ZModel::new(machine),
            period_s: spec.control.period_s,
            crossing_s: spec.sync.backlash_crossing_s,
            delays,
        }
    }

    /// So many periods before the motor acts the load's motion has to be known.
    pub(in crate::control::sync) fn look_ahead_periods(&self) -> u32 {
        half_width_periods(self.period_s, self.crossing_s)
    }

    /// The same in seconds.
    pub(in crate::control::sync) fn look_ahead_s(&self) -> f64 {
        f64::from(self.look_ahead_periods()) * self.period_s
    }
}
