//! What is known beforehand of how both axes follow.

use crate::control::machine::{Machine, Takes};
use crate::control::model::closed_loop::ClosedLoop;
use crate::control::sync::plant_model::{IdentifiedLatency, ZModel};

use super::inertia::TURNING_REV_PER_S;
use super::tracking_fit::TrackingSpec;

/// Standard deviations of the file's spindle inertia and Z mass, as ratios: chucks and tools differ.
const INERTIA_DEVIATION: f64 = 0.3;
const MASS_DEVIATION: f64 = 0.02;

/// Spindle and Z.
pub(super) fn tracking_specs(machine: &Machine, z: &ZModel) -> [TrackingSpec; 2] {
    let spec = machine.spec();
    let period_s = spec.control.period_s;
    let velocity_age_s = spec.drive.velocity_filter_s + 0.5 * spec.drive.period_s;
    let file_s = IdentifiedLatency::nominal(machine).spindle_s;
    let spindle = TrackingSpec {
        closed_loop: ClosedLoop::of_spindle(&spec.drive),
        feeds_acceleration: spec.drive.spindle_takes == Takes::Torque,
        period_s,
        file_s,
        sliding_speed: TURNING_REV_PER_S,
        least_speed: TURNING_REV_PER_S,
        velocity_age_s,
        inertia_deviation: INERTIA_DEVIATION,
        coulomb: 0.0,
        acceleration: machine.motor().acceleration_rev_per_s2(0.0, 1.0),
        count: 1.0 / spec.spindle.encoder_counts_per_rev,
    };
    let z_axis = TrackingSpec {
        closed_loop: ClosedLoop::of_z(&spec.drive),
        feeds_acceleration: spec.drive.z_takes == Takes::Torque,
        period_s,
        file_s,
        sliding_speed: z.sliding_mm_per_s(),
        least_speed: z.sliding_mm_per_s(),
        velocity_age_s,
        inertia_deviation: MASS_DEVIATION,
        coulomb: spec.z_axis.coulomb_n / z.inertia_n(1.0),
        acceleration: spec.z.max_mm_per_s2,
        count: 1.0 / spec.z_axis.encoder_counts_per_mm,
    };
    [spindle, z_axis]
}
