//! The rules that the synchronizer's gains follow from the rest of the machine file.

use super::spec::{MachineSpec, SyncSpec};
use crate::control::units::{mm_per_s_from_mm_per_min, um_from_mm};

/// The backlash is crossed in this share of the load's period on its screw: slower, the load would drift meanwhile; faster
/// takes force for nothing.
const CROSSING_PERIODS: f64 = 0.4;
/// Poles of the observer times the period: two periods of memory average the readings' noise.
const OBSERVER_POLES: f64 = 0.5;
/// Readings' noise at the greatest tapping speed, in widths of the latch jitter.
const NOISE_WIDTHS: f64 = 4.0;
/// Pitch of the tap that the noise is taken for, in mm: that of M6, the middle of the coarse series.
const PITCH_MM: f64 = 1.0;
/// The path rate falls by this much in a second at most: then the slowing itself takes a few percent of the motor.
const GOVERNOR_PER_S: f64 = 1.0;
/// A third of a hole's error is taken up by the next: holes differ by noise and friction, and what is common adds up.
const LEARNING_GAIN: f64 = 0.3;
/// An old correction halves in some 140 holes.
const LEARNING_FORGETTING: f64 = 0.995;
/// Smoothing along the path, in periods: what is narrower, the drive cannot follow.
const LEARNING_SMOOTHING_PERIODS: f64 = 2.0;
/// Delay of a correction, beside the setpoint's own, in time constants of Z's velocity loop.
const LEARNING_LEAD_LOOPS: f64 = 1.0;
/// Corrections grow from nothing while friction builds up at the start, and no faster than a reversal is crossed.
const LEARNING_TAPER_CROSSINGS: f64 = 2.5;

impl SyncSpec {
    /// The gains for a machine, from its data alone.
    ///
    /// ```
    /// use rigidtap::control::machine::{MachineSpec, SyncSpec};
    /// let mut spec = MachineSpec::reference();
    /// assert_eq!(SyncSpec::by_rules(&spec), spec.sync);
    /// spec.z_axis.resonance_hz = 50.0;
    /// assert_eq!(SyncSpec::by_rules(&spec).backlash_crossing_s, 2.0 * spec.sync.backlash_crossing_s);
    /// ```
    #[must_use]
    pub fn by_rules(spec: &MachineSpec) -> Self {
        let period_s = spec.control.period_s;
        let backlash_crossing_s = CROSSING_PERIODS / spec.z_axis.resonance_hz;
        let fastest_mm_per_s = mm_per_s_from_mm_per_min(spec.spindle.max_rpm * PITCH_MM);
        let noise_um = um_from_mm(fastest_mm_per_s * spec.drive.encoder_jitter_s);
        Self {
            backlash_crossing_s,
            observer_rad_per_s: OBSERVER_POLES / period_s,
            dead_zone_um: NOISE_WIDTHS * noise_um,
            governor_per_s: GOVERNOR_PER_S,
            learning_gain: LEARNING_GAIN,
            learning_forgetting: LEARNING_FORGETTING,
            learning_smoothing_s: LEARNING_SMOOTHING_PERIODS * period_s,
            learning_lead_s: spec.drive.latency_periods * period_s
                + LEARNING_LEAD_LOOPS / spec.drive.z_velocity_gain_per_s,
            learning_taper_s: LEARNING_TAPER_CROSSINGS * backlash_crossing_s,
        }
    }
}
