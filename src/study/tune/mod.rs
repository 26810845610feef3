//! The speed bands of `torque-curve`, tuned: from the motor's torque curve and the strokes that matter to band tops and
//! accelerations, with their price against the fastest stroke there is.
//!
//! A band's acceleration is the least that the share of the motor leaves anywhere in the band, so the staircase of the
//! bands lies under the curve everywhere. (Straight lines between points *on* the curve would not: a curve of constant
//! power is convex.) What is free is where the bands end.

mod estimate;
mod run_up;
#[cfg(test)]
mod run_up_tests;
mod search;
#[cfg(test)]
mod tests;

pub use run_up::{RunUp, RunUpError, RunUpFault};

use core::fmt;

use crate::control::machine::{BandSpec, Machine, MachineError, Ramp};
use crate::control::motor::{Motor, TorqueCurve};
use crate::control::profile::{MAX_BANDS, SpeedBand, StrokeRequest, TorqueCurveLaw};
use crate::control::units::{rev_per_s_from_rpm, rpm_from_rev_per_s};

/// Strokes that bands are tuned for unless others are asked for, in rev: figures.md, "Segmentation".
pub const STROKES_REV: [f64; 4] = [5.0, 10.0, 25.0, 50.0];

/// Why no bands can be tuned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TuneError {
    /// No band, or more than [`MAX_BANDS`].
    BandCount {
        /// Bands asked for.
        count: usize,
    },
    /// No stroke to tune for.
    NoStrokes,
    /// A stroke that is not positive and finite.
    Stroke {
        /// Its distance.
        distance_rev: f64,
    },
    /// A motor share outside (0, 1].
    Share {
        /// The share.
        share: f64,
    },
    /// A greatest speed that is not positive and finite.
    Speed {
        /// The speed.
        max_rpm: f64,
    },
    /// Band tops that do not rise from zero to the greatest speed.
    Tops,
    /// The machine does not take the bands.
    Machine(MachineError),
}

impl fmt::Display for TuneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BandCount { count } => write!(f, "the number of bands is {count}, expected 1 to {MAX_BANDS}"),
            Self::NoStrokes => f.write_str("no stroke to tune for"),
            Self::Stroke { distance_rev } => write!(f, "a stroke of {distance_rev} rev, expected more than 0"),
            Self::Share { share } => write!(f, "the motor share is {share}, expected above 0 up to 1"),
            Self::Speed { max_rpm } => write!(f, "the greatest speed is {max_rpm} rpm, expected more than 0"),
            Self::Tops => f.write_str("band tops have to rise from above 0 to the greatest speed"),
            Self::Machine(error) => write!(f, "{error}"),
        }
    }
}

/// A stroke with what the motor could do at best.
#[derive(Clone, Copy, Debug)]
struct Target {
    request: StrokeRequest,
    bound_s: f64,
    peak_rev_per_s: f64,
}

/// What bands are tuned for: a motor, the share of it that may be used, and strokes at the greatest speed.
#[derive(Clone, Debug)]
pub struct TuneTask {
    motor: Motor,
    max_rpm: f64,
    share: f64,
    targets: Vec<Target>,
}

/// One tuned band; it starts where the band below it ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TunedBand {
    /// Its top.
    pub to_rpm: f64,
    /// Acceleration and deceleration throughout.
    pub rate_rpm_per_s: f64,
    /// Torque that this takes at the top, of what the whole motor has there; the share, unless the curve rises in the band.
    pub motor_ratio_at_top: f64,
}

/// Tuned bands with their price.
#[derive(Clone, Debug, PartialEq)]
pub struct Staircase {
    /// The bands, in rising order.
    pub bands: Vec<TunedBand>,
    /// Mean over the strokes of stroke time over the bound at the same motor share.
    pub stroke_over_bound: f64,
}

/// What tuning came to, for reports.
#[derive(Clone, Debug, PartialEq)]
pub struct Tuning {
    /// The bands.
    pub best: Staircase,
    /// The bands as a machine file has them.
    pub specs: Vec<BandSpec>,
    /// Price of the best 1, 2, … bands.
    pub prices: Vec<f64>,
    /// Share of the motor that they use.
    pub motor_share: f64,
    /// Commanded speed of the strokes.
    pub max_rpm: f64,
    /// The strokes.
    pub strokes_rev: Vec<f64>,
    /// The torque curve where it was measured.
    pub measured: Option<TorqueCurve>,
}

impl TuneTask {
    /// Strokes of `strokes_rev` commanded at `max_rpm`, with `share` of the motor in (0, 1].
    ///
    /// # Errors
    /// [`TuneError`] for a number outside its range, or no stroke.
    pub fn new(motor: Motor, max_rpm: f64, share: f64, strokes_rev: &[f64]) -> Result<Self, TuneError> {
        if !(max_rpm > 0.0 && max_rpm.is_finite()) {
            return Err(TuneError::Speed { max_rpm });
        }
        if !(share > 0.0 && share <= 1.0) {
            return Err(TuneError::Share { share });
        }
        if strokes_rev.is_empty() {
            return Err(TuneError::NoStrokes);
        }
        let command = rev_per_s_from_rpm(max_rpm);
        let target = |&distance_rev: &f64| {
            if !(distance_rev > 0.0 && distance_rev.is_finite()) {
                return Err(TuneError::Stroke { distance_rev });
            }
            let bound = motor.fastest_stroke(distance_rev, command, share);
            let request = StrokeRequest { distance: distance_rev, command };
            Ok(Target { request, bound_s: bound.duration_s, peak_rev_per_s: bound.peak_rev_per_s })
        };
        let targets = strokes_rev.iter().map(target).collect::<Result<_, _>>()?;
        Ok(Self { motor, max_rpm, share, targets })
    }

    /// The bands with the least price there is for their number, 1 to [`MAX_BANDS`].
    ///
    /// Within 0.5 % of the best staircase of as many bands; tops are rounded to a thousandth of the greatest speed's
    /// decade (1 rpm for 8000 rpm), except where they stand on a point of the torque curve.
    ///
    /// # Errors
    /// [`TuneError::BandCount`].
    ///
    /// ```
    /// use rigidtap::{control::machine::Machine, study::{STROKES_REV, TuneTask}};
    /// let task = TuneTask::new(Machine::reference().motor().clone(), 8000.0, 0.8, &STROKES_REV).unwrap();
    /// let tuned = task.best(2).unwrap();
    /// // The first band ends where constant torque does.
    /// assert_eq!(tuned.bands[0].to_rpm, 3000.0);
    /// assert!((tuned.stroke_over_bound - 1.072).abs() < 0.002);
    /// ```
    pub fn best(&self, count: usize) -> Result<Staircase, TuneError> {
        self.best_up_to(count)?.pop().ok_or(TuneError::BandCount { count })
    }

    /// The best bands for every number from 1 to `most`, in this order.
    ///
    /// # Errors
    /// [`TuneError::BandCount`].
    pub fn best_up_to(&self, most: usize) -> Result<Vec<Staircase>, TuneError> {
        if !(1..=MAX_BANDS).contains(&most) {
            return Err(TuneError::BandCount { count: most });
        }
        search::tops_up_to(self, most).iter().map(|tops_rpm| self.with_tops(tops_rpm)).collect()
    }

    /// The staircase under the curve with band tops of one's own.
    ///
    /// # Errors
    /// [`TuneError::BandCount`]; [`TuneError::Tops`] unless they rise from above 0 to the greatest speed.
    pub fn with_tops(&self, tops_rpm: &[f64]) -> Result<Staircase, TuneError> {
        if !(1..=MAX_BANDS).contains(&tops_rpm.len()) {
            return Err(TuneError::BandCount { count: tops_rpm.len() });
        }
        let stroke_over_bound =
            self.price(tops_rpm).filter(|_| tops_rpm.last() == Some(&self.max_rpm)).ok_or(TuneError::Tops)?;
        let mut below_rpm = 0.0;
        let bands = tops_rpm.iter().map(|&to_rpm| {
            let rate_rpm_per_s = rpm_from_rev_per_s(self.least_acceleration(below_rpm, to_rpm));
            below_rpm = to_rpm;
            let motor = rpm_from_rev_per_s(self.motor.acceleration_rev_per_s2(rev_per_s_from_rpm(to_rpm), 1.0));
            TunedBand { to_rpm, rate_rpm_per_s, motor_ratio_at_top: rate_rpm_per_s / motor }
        });
        Ok(Staircase { bands: bands.collect(), stroke_over_bound })
    }

    /// Mean over the strokes of stroke time over the bound; none where the tops do not rise.
    fn price(&self, tops_rpm: &[f64]) -> Option<f64> {
        let mut below_rpm = 0.0;
        let bands: arrayvec::ArrayVec<SpeedBand, MAX_BANDS> = tops_rpm
            .iter()
            .take(MAX_BANDS)
            .map(|&to_rpm| {
                let rate = self.least_acceleration(below_rpm, to_rpm);
                below_rpm = to_rpm;
                SpeedBand { to_rev_per_s: rev_per_s_from_rpm(to_rpm), accel_rev_per_s2: rate, decel_rev_per_s2: rate }
            })
            .collect();
        let law = TorqueCurveLaw { start_rev_per_s: 0.0, end_rev_per_s: 0.0, bands };
        let mut sum = 0.0;
        for target in &self.targets {
            sum += law.plan(target.request).ok()?.duration_s() / target.bound_s;
        }
        Some(sum / self.targets.len() as f64)
    }

    /// Least acceleration in rev/s² that the share leaves between two speeds. The curve is monotonic between its points.
    fn least_acceleration(&self, low_rpm: f64, high_rpm: f64) -> f64 {
        let inside = self.motor.curve.points().iter().map(|point| point.speed_rpm);
        let inside = inside.filter(|speed_rpm| (low_rpm..high_rpm).contains(speed_rpm));
        [low_rpm, high_rpm]
            .into_iter()
            .chain(inside)
            .map(|rpm| self.motor.acceleration_rev_per_s2(rev_per_s_from_rpm(rpm), self.share))
            .fold(f64::INFINITY, f64::min)
    }
}

impl Staircase {
    /// The bands as a machine file has them: by time constants, which count from the law's start and end speed (both in
    /// rpm, usually 0). Rounded up to five digits, so that the rounding never asks for more than the motor's share.
    ///
    /// ```
    /// use rigidtap::{config, control::machine::Machine, study::{STROKES_REV, TuneTask}};
    /// let task = TuneTask::new(Machine::reference().motor().clone(), 8000.0, 0.8, &STROKES_REV).unwrap();
    /// assert_eq!(
    ///     config::bands_to_toml(&task.best(2).unwrap().time_constants(0.0, 0.0)).lines().nth(2).unwrap(),
    ///     "  { to_rpm = 3000, accel_s = 0.07854, decel_s = 0.07854 },"
    /// );
    /// ```
    #[must_use]
    pub fn time_constants(&self, start_rpm: f64, end_rpm: f64) -> Vec<BandSpec> {
        let first_top = self.bands.first().map_or(0.0, |band| band.to_rpm);
        // As the machine resolves them: a speed above the first band leaves that band's constant counting from rest.
        let mut below = [start_rpm, end_rpm].map(|rpm| if rpm < first_top { rpm } else { 0.0 });
        let spec = |band: &TunedBand| {
            let [accel_s, decel_s] = below.map(|rpm| rounded_up((band.to_rpm - rpm) / band.rate_rpm_per_s));
            below = [band.to_rpm; 2];
            BandSpec { to_rpm: band.to_rpm, ramp: Ramp::Time { accel_s, decel_s } }
        };
        self.bands.iter().map(spec).collect()
    }
}

/// The next number up with five digits.
fn rounded_up(value: f64) -> f64 {
    const ULPS: f64 = 1e-12;
    let scale = 10f64.powf(4.0 - value.log10().floor());
    (value * scale * (1.0 - ULPS)).ceil() / scale
}

/// The machine with `torque-curve`'s bands tuned anew, as many as it has, for `share` of the motor and [`STROKES_REV`];
/// `law.motor_share` becomes the share, too.
///
/// # Errors
/// [`TuneError::Machine`] for a share that a machine file could not have either.
///
/// ```
/// use rigidtap::{control::machine::Machine, study::retuned};
/// let machine = retuned(&Machine::reference(), 0.6).unwrap();
/// assert_eq!((machine.torque_curve().bands.len(), machine.spec().law.motor_share), (4, 0.6));
/// ```
pub fn retuned(machine: &Machine, share: f64) -> Result<Machine, TuneError> {
    let machine = machine.with_motor_share(share).map_err(TuneError::Machine)?;
    let task = TuneTask::new(machine.motor().clone(), machine.spec().spindle.max_rpm, share, &STROKES_REV)?;
    let tuned = task.best(machine.torque_curve().bands.len())?;
    let specs = tuned.bands.iter().map(|&TunedBand { to_rpm, rate_rpm_per_s: rate, .. }| BandSpec {
        to_rpm,
        ramp: Ramp::Rate { accel_rpm_per_s: rate, decel_rpm_per_s: rate },
    });
    machine.with(|spec| spec.law.torque_curve.bands = specs.collect()).map_err(TuneError::Machine)
}
