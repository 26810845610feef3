//! `tune --identify`.

use schemars::JsonSchema;
use serde::Serialize;

use crate::report::identification::Source;
use crate::study::Findings;

/// What a machine's motion shows; null is what it did not show.
#[derive(Clone, Debug, JsonSchema, PartialEq, Serialize)]
pub struct IdentifyAnswer {
    /// Z's sliding friction, mean of both directions.
    friction_n: Option<f64>,
    /// Breakaway over sliding friction.
    static_ratio: Option<f64>,
    /// Speed over which the Stribeck effect decays.
    stribeck_mm_per_s: Option<f64>,
    /// Travel over which friction builds up after a reversal.
    presliding_um: Option<f64>,
    /// Reversal value of motor against scale: backlash and wind-up.
    lost_motion_um: Option<f64>,
    /// Backlash: the reversal value less the wind-up by friction.
    backlash_um: Option<f64>,
    /// Resonance of the load on the screw.
    resonance_hz: Option<f64>,
    /// The spindle's inertia per torque constant, over the file's.
    inertia_ratio: Option<f64>,
    /// The motor's torque limit over the file's.
    torque_limit_ratio: Option<f64>,
    /// Torque against the spindle's turning beyond the file's friction.
    spindle_drag_nm: Option<f64>,
    /// Where the readings come from.
    source: String,
    /// Periods that were used.
    periods: usize,
    /// Readings beyond a gap or a restart, which were not.
    readings_left_out: usize,
}

impl IdentifyAnswer {
    /// Of what was found, and where.
    #[must_use]
    pub fn new(found: &Findings, source: &Source) -> Self {
        Self {
            friction_n: found.friction_n,
            static_ratio: found.static_ratio,
            stribeck_mm_per_s: found.stribeck_mm_per_s,
            presliding_um: found.presliding_um,
            lost_motion_um: found.lost_motion_um,
            backlash_um: found.backlash_um,
            resonance_hz: found.resonance_hz,
            inertia_ratio: found.inertia_ratio,
            torque_limit_ratio: found.torque_limit_ratio,
            spindle_drag_nm: found.spindle_drag_nm,
            source: source.name.clone(),
            periods: source.periods,
            readings_left_out: source.left_out,
        }
    }
}
