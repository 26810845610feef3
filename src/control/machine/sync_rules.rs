//! The rules that the synchronizer's gains follow from the rest of the machine file.

use super::spec::{MachineSpec, SyncSpec};
use crate::control::units::{mm_per_s_from_mm_per_min, um_from_mm};

/// Lost motion is crossed in this share of the table's period on its screw: slower than the table's own swing would be
/// felt as error, faster would start that swing.
const CROSSING_PERIODS: f64 = 0.8;
/// Share of the crossing that lies before the reversal: until the table's friction has turned round, most of the way is
/// still to go.
const CROSSING_LEAD: f64 = 0.1875;
/// A force interpolated over a period acts in its mean a quarter of a period after where a step would.
const FRICTION_LEAD_PERIODS: f64 = 0.25;
/// Poles of the deviation's filter times the period: two periods of memory average the readings' noise.
const DEVIATION_POLES: f64 = 0.5;
/// Readings' noise at the greatest tapping speed, in widths of the latch jitter.
const NOISE_WIDTHS: f64 = 4.0;
/// Pitch of the tap that the noise is taken for, in mm: that of M6, the middle of the coarse series.
const PITCH_MM: f64 = 1.0;
/// The path slows to a pace in a second at most: then the slowing itself takes a few percent of the motor.
const GOVERNOR_PER_S: f64 = 1.0;
/// A third of a hole's error is taken up by the next: holes differ by noise and friction, and what is common adds up.
const LEARNING_GAIN: f64 = 0.3;
/// An old correction halves in some 140 holes.
const LEARNING_FORGETTING: f64 = 0.995;
/// Smoothing along the path, in periods: what is narrower, the drive cannot follow.
const LEARNING_SMOOTHING_PERIODS: f64 = 2.0;
/// Delay of a correction, beside the setpoint's own, in time constants of Z's velocity loop.
const LEARNING_LEAD_LOOPS: f64 = 1.0;
/// Corrections grow from nothing over the crossing of the lost motion and a little more.
const LEARNING_TAPER_CROSSINGS: f64 = 1.25;

impl SyncSpec {
    /// The gains for a machine, from its data alone.
    ///
    /// ```
    /// use rigidtap::control::machine::{MachineSpec, SyncSpec};
    /// let mut spec = MachineSpec::reference();
    /// assert_eq!(SyncSpec::by_rules(&spec), spec.sync);
    /// spec.z_axis.resonance_hz = 50.0;
    /// assert_eq!(SyncSpec::by_rules(&spec).lost_motion_s, 2.0 * spec.sync.lost_motion_s);
    /// ```
    #[must_use]
    pub fn by_rules(spec: &MachineSpec) -> Self {
        let period_s = spec.control.period_s;
        let lost_motion_s = CROSSING_PERIODS / spec.z_axis.resonance_hz;
        let fastest_mm_per_s = mm_per_s_from_mm_per_min(spec.spindle.max_rpm * PITCH_MM);
        let noise_um = um_from_mm(fastest_mm_per_s * spec.drive.encoder_jitter_s);
        Self {
            lost_motion_s,
            lost_motion_lead_s: CROSSING_LEAD * lost_motion_s,
            friction_lead_s: FRICTION_LEAD_PERIODS * period_s,
            deviation_rad_per_s: DEVIATION_POLES / period_s,
            deviation_lead_s: 0.0,
            dead_zone_um: NOISE_WIDTHS * noise_um,
            governor_per_s: GOVERNOR_PER_S,
            learning_gain: LEARNING_GAIN,
            learning_forgetting: LEARNING_FORGETTING,
            learning_smoothing_s: LEARNING_SMOOTHING_PERIODS * period_s,
            learning_lead_s: spec.drive.latency_periods * period_s
                + LEARNING_LEAD_LOOPS / spec.drive.z_velocity_gain_per_s,
            learning_taper_s: LEARNING_TAPER_CROSSINGS * lost_motion_s,
        }
    }
}
