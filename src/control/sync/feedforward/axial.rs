//! The force with which the tap draws Z along, ahead of when it acts.

use crate::control::math::standing_out::standing_out;
use crate::control::math::{filter_share, poly::State, sign};
use crate::control::sync::plant_model::{AxialForce, Cut};

use super::delay_line::DelayLine;

/// Time over which a force is attributed to the tap: no loop may close through the screw and its backlash.
const SEEN_S: f64 = 0.03;

/// Axial force along a hole, positive into it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct AxialFeedforward {
    force: AxialForce,
    cut: Cut,
    ahead_n: DelayLine,
    /// What of the force was seen in this hole, on the way in.
    seen_n: f64,
    attributing_share: f64,
}

impl AxialFeedforward {
    /// For a hole; places are the load's travel in it.
    pub(super) fn new(force: AxialForce, cut: Cut, period_s: f64) -> Self {
        Self {
            force,
            cut,
            ahead_n: DelayLine::constant(0.0, period_s, 0.0),
            seen_n: 0.0,
            attributing_share: filter_share(period_s, SEEN_S),
        }
    }

    /// One period: where the load will be, and its contact, which turns round with it.
    pub(super) fn look_ahead(&mut self, load_mm: f64, contact: f64) -> f64 {
        let drawing_n = self.force.on_z_n(contact, self.cut.engagement_at(load_mm));
        self.ahead_n.push(drawing_n);
        drawing_n
    }

    /// The same so long before what is known ahead.
    pub(super) fn drawing_n(&self, ago_s: f64) -> f64 {
        self.ahead_n.at(ago_s).position
    }

    /// One period of a sliding load against which the drive gives so much less than friction: what of it is the tap's, from now
    /// on, N more. On the way out the tap of a first hole is taken to draw as much less as its torque is less.
    pub(super) fn attribute(&mut self, less_n: f64, changes_n: f64, load: &State) -> f64 {
        if load.velocity < 0.0 || self.cut.engagement_at(load.position) < 1.0 {
            return 0.0;
        }
        let more_n = self.attributing_share * (standing_out(less_n + self.seen_n, changes_n) - self.seen_n);
        self.seen_n += more_n;
        self.force.in_n += more_n;
        self.force.out_n += self.cut.out_ratio * more_n;
        more_n
    }

    /// What of it was seen in this hole alone.
    pub(super) fn seen_along_n(&self, load_mm: f64, contact: f64) -> f64 {
        let seen = AxialForce { in_n: self.seen_n, out_n: self.cut.out_ratio * self.seen_n };
        seen.on_z_n(contact, self.cut.engagement_at(load_mm))
    }

    /// Where the load slides.
    pub(super) fn drawing_along_n(&self, load: &State) -> f64 {
        self.force.on_z_n(sign(load.velocity), self.cut.engagement_at(load.position))
    }
}
