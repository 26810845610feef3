//! What spindle and Z can do between two readings: a reading beyond it is corrupt, whatever it says.
//!
//! The limits are the machine's, with much to spare, since they only have to tell a torn cable, a flipped bit or a
//! driver's error value from a movement. A position may deviate from where the last speed would have taken it by
//!
//! - a·t², where `a` is what the motor's greatest torque, or Z's greatest force, gives the inertia, five times over
//!   (a machine half of whose inertia is the tool's, friction and the tap's torque brake with it);
//! - two periods of travel at the speed of the last readings: they may be late, and one may be stale;
//! - some counts.
//!
//! And no axis goes further than at 1.25 times its greatest speed. What passes all of these and is wrong nevertheless is
//! less than a fifth of a revolution, and shows in e(k).

use super::sample::Scale;
use crate::control::machine::Machine;
use crate::control::units::{RAD_PER_REV, rev_per_s_from_rpm};

/// What an axis may have beyond its greatest speed.
const SPEED_SPARE: f64 = 1.25;
/// What an axis may have beyond the acceleration that its motor gives it.
const ACCELERATION_SPARE: f64 = 5.0;
/// Periods of travel by which a reading may be off.
const OFF_PERIODS: f64 = 2.0;
/// Counts by which any reading may be off.
const OFF_COUNTS: f64 = 4.0;
/// Readings whose speeds count as the last ones.
const LAST: usize = 4;
/// mm in a metre: N/kg are m/s².
const MM_PER_M: f64 = 1000.0;

/// What the machine's axes can do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Spindle.
    pub max_rev_per_s: f64,
    /// Spindle.
    pub max_rev_per_s2: f64,
    /// Z.
    pub max_mm_per_s: f64,
    /// Z.
    pub max_mm_per_s2: f64,
}

impl Limits {
    /// The machine's greatest speeds, and its greatest torque and force on its inertia and mass.
    #[must_use]
    pub fn of(machine: &Machine) -> Self {
        let spec = machine.spec();
        let torque_nm = spec.spindle.torque_curve.iter().map(|point| point.torque_nm).fold(0.0, f64::max);
        let max_mm_per_s2 = (MM_PER_M * spec.z_axis.force_limit_n / spec.z_axis.mass_kg).max(spec.z.max_mm_per_s2);
        Self {
            max_rev_per_s: rev_per_s_from_rpm(spec.spindle.max_rpm),
            max_rev_per_s2: torque_nm / spec.spindle.inertia_kg_m2 / RAD_PER_REV,
            max_mm_per_s: spec.z.max_mm_per_s,
            max_mm_per_s2,
        }
    }
}

/// An axis of a reading.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Spindle.
    Spindle,
    /// Z.
    Z,
}

/// A movement that no machine of these limits makes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jump {
    /// The axis.
    pub axis: Axis,
    /// Its travel since the reading before, in counts; infinite where it is no number.
    pub counts: f64,
    /// The most that it can have travelled.
    pub most_counts: f64,
    /// The time between.
    pub seconds: f64,
}

/// One axis' last readings.
#[derive(Clone, Copy, Debug)]
struct Track {
    axis: Axis,
    max_per_s: f64,
    max_per_s2: f64,
    counts: f64,
    /// Speeds of the last readings, the newest first.
    per_s: [f64; LAST],
    /// The time that the newest of them was taken over.
    over_s: f64,
}

impl Track {
    fn new(axis: Axis, max_per_s: f64, max_per_s2: f64) -> Self {
        Self { axis, max_per_s, max_per_s2, counts: 0.0, per_s: [0.0; LAST], over_s: 0.0 }
    }

    fn judge(&self, counts: f64, seconds: f64, period_s: f64, free: bool) -> Option<Jump> {
        let way = counts - self.counts;
        let off_s = OFF_PERIODS * period_s;
        let most = SPEED_SPARE * self.max_per_s * (seconds + off_s) + OFF_COUNTS;
        let [newest, ..] = self.per_s;
        let fastest = self.per_s.iter().map(|per_s| per_s.abs()).fold(0.0, f64::max);
        let off = ACCELERATION_SPARE * self.max_per_s2 * seconds * (seconds + self.over_s);
        let off = if free { f64::INFINITY } else { off + fastest * off_s + OFF_COUNTS };
        let expected = newest * seconds;
        // Not a number is no way either.
        let possible = way.abs() <= most && (way - expected).abs() <= off;
        (!possible).then(|| {
            let most_counts = most.min(expected.abs() + off);
            Jump { axis: self.axis, counts: way, most_counts, seconds }
        })
    }

    fn take(&mut self, counts: f64, seconds: f64) {
        let per_s = if seconds > 0.0 { (counts - self.counts) / seconds } else { 0.0 };
        self.per_s.rotate_right(1);
        if let Some(newest) = self.per_s.first_mut() {
            *newest = per_s;
        }
        (self.counts, self.over_s) = (counts, seconds);
    }
}

/// Compares each reading with those before it.
///
/// ```
/// use rigidtap::control::machine::Machine;
/// use rigidtap::link::{plausibility::{Limits, Plausibility}, sample::Scale};
/// let machine = Machine::reference();
/// let mut plausibility = Plausibility::new(&Limits::of(&machine), &Scale::of(&machine), 0.001);
/// assert_eq!(plausibility.judge(0.000, 100.0, 50_000.0), None);
/// assert_eq!(plausibility.judge(0.001, 103.0, 49_999.0), None);
/// let jump = plausibility.judge(0.002, 103.0, -2_147_483_648.0).unwrap();
/// assert!(jump.most_counts < 6000.0);
/// // A reading that is judged corrupt is none: the next one is compared with what was before it.
/// assert_eq!(plausibility.judge(0.003, 104.0, 49_999.0), None);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Plausibility {
    spindle: Track,
    z: Track,
    period_s: f64,
    last_s: Option<f64>,
    /// Readings since the beginning: of one alone no speed is known.
    readings: u32,
}

impl Plausibility {
    /// For counts of this scale, some `period_s` apart.
    #[must_use]
    pub fn new(limits: &Limits, scale: &Scale, period_s: f64) -> Self {
        let (per_rev, per_mm) = (scale.counts_per_rev, scale.counts_per_mm);
        Self {
            spindle: Track::new(Axis::Spindle, limits.max_rev_per_s * per_rev, limits.max_rev_per_s2 * per_rev),
            z: Track::new(Axis::Z, limits.max_mm_per_s * per_mm, limits.max_mm_per_s2 * per_mm),
            period_s,
            last_s: None,
            readings: 0,
        }
    }

    /// The next reading begins anew: the time went back, or the counts did.
    pub fn forget(&mut self) {
        self.last_s = None;
        self.readings = 0;
    }

    /// Takes a reading, or says why it cannot be one.
    pub fn judge(&mut self, now_s: f64, spindle_counts: f64, z_counts: f64) -> Option<Jump> {
        let finite = |counts: f64| counts.is_finite();
        let Some(last_s) = self.last_s else {
            for (track, counts) in [(&self.spindle, spindle_counts), (&self.z, z_counts)] {
                if !finite(counts) {
                    return Some(Jump { axis: track.axis, counts, most_counts: f64::MAX, seconds: 0.0 });
                }
            }
            (self.spindle.counts, self.z.counts) = (spindle_counts, z_counts);
            (self.spindle.per_s, self.z.per_s) = ([0.0; LAST], [0.0; LAST]);
            (self.last_s, self.readings) = (Some(now_s), 1);
            return None;
        };
        let seconds = now_s - last_s;
        let free = self.readings < 2;
        let jump = self.spindle.judge(spindle_counts, seconds, self.period_s, free);
        let jump = jump.or_else(|| self.z.judge(z_counts, seconds, self.period_s, free));
        if jump.is_none() {
            self.spindle.take(spindle_counts, seconds);
            self.z.take(z_counts, seconds);
            self.last_s = Some(now_s);
            self.readings = self.readings.saturating_add(1);
        }
        jump
    }
}
