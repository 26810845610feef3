//! The governor: a motor weaker than its file takes the same path in more time.

use crate::control::machine::SyncSpec;
use crate::control::math::sqrt;

use super::identify::Identified;

/// Share of the motor's torque left to the control itself.
const RESERVE: f64 = 0.03;
/// Slowest pace that a path is taken at: below it something else is wrong.
const SLOWEST: f64 = 0.3;

/// What a plan asks of the motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Load {
    /// Greatest share of the motor's torque that accelerates the file's inertia.
    pub(super) inertia_share: f64,
    /// The motor's torque at the plan's greatest speed, and the file's friction there.
    pub(super) top_nm: f64,
    pub(super) friction_nm: f64,
}

/// How fast the plan's time runs against the clock's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Governor {
    sync: SyncSpec,
    sag: f64,
    load: Load,
    pace: f64,
    /// Change of pace per second.
    slope: f64,
}

impl Governor {
    pub(super) fn new(sync: SyncSpec, supply_sag_ratio: f64, load: Load) -> Self {
        Self { sync, sag: supply_sag_ratio, load, pace: 1.0, slope: 0.0 }
    }

    /// The pace at which the plan stays within the motor: accelerations grow with its square.
    fn wanted(&self, known: &Identified) -> f64 {
        let drag_share = (self.load.friction_nm + known.spindle_drag_nm).max(0.0) / self.load.top_nm;
        let left = (known.torque_limit_ratio * (1.0 - self.sag) - drag_share - RESERVE).max(0.0);
        let asked = self.load.inertia_share * known.inertia_ratio;
        if asked <= left { 1.0 } else { sqrt(left / asked).max(SLOWEST) }
    }

    /// A hole begins at rest: any pace can be taken at once.
    pub(super) fn begin(&mut self, identified: &Identified) {
        (self.pace, self.slope) = (self.wanted(identified), 0.0);
    }

    /// One period on the way: never faster, since what a stroke has shown stays true in it.
    pub(super) fn step(&mut self, identified: &Identified, period_s: f64) {
        let slowest_slope = -self.sync.governor_per_s;
        let wanted = self.wanted(identified).min(self.pace);
        self.slope = ((wanted - self.pace) / period_s).max(slowest_slope);
        self.pace += self.slope * period_s;
    }

    pub(super) fn pace(&self) -> f64 {
        self.pace
    }

    /// Change of pace per second.
    pub(super) fn slope_per_s(&self) -> f64 {
        self.slope
    }
}
