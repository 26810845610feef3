//! The motor's torque–speed curve, and the acceleration it leaves for a stroke.

use arrayvec::ArrayVec;

use crate::control::math::{list::copied, quadrature::integrate, root};
use crate::control::units::{RAD_PER_REV, rev_per_s_from_rpm, rpm_from_rev_per_s};

/// Most points that a torque curve can have.
pub const MAX_POINTS: usize = 16;

/// One point of a torque–speed curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TorquePoint {
    /// Motor speed, 0 or more.
    pub speed_rpm: f64,
    /// Greatest torque there, positive.
    pub torque_nm: f64,
}

/// Why a list of points is no torque curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TorqueCurveError {
    /// Fewer than two points, or more than [`MAX_POINTS`].
    Count {
        /// Points given.
        count: usize,
    },
    /// The first point is not at 0 rpm.
    FirstSpeed {
        /// Speed of the first point.
        speed_rpm: f64,
    },
    /// Speeds do not rise from point to point.
    SpeedOrder {
        /// Index of the offending point.
        point: usize,
        /// Its speed.
        speed_rpm: f64,
        /// The speed of the point before it.
        previous_rpm: f64,
    },
    /// A torque is not a positive number.
    Torque {
        /// Index of the offending point.
        point: usize,
        /// Its torque.
        torque_nm: f64,
    },
    /// Power is linear in speed between points, so from standstill torque is constant; two differing torques contradict.
    StandstillTorque {
        /// Torque at 0 rpm.
        first_nm: f64,
        /// Torque at the second point.
        second_nm: f64,
    },
}

/// Torque over speed; power is linear in speed between points, so that two points of equal power span constant power.
///
/// The paper's figure 2: constant torque to the rated speed, constant power above it.
#[derive(Debug, PartialEq)]
pub struct TorqueCurve {
    points: ArrayVec<TorquePoint, MAX_POINTS>,
}

impl Clone for TorqueCurve {
    fn clone(&self) -> Self {
        Self { points: copied(&self.points) }
    }
}

impl TorqueCurve {
    /// A curve through `points`, in rising order of speed from 0 rpm.
    ///
    /// # Errors
    /// See [`TorqueCurveError`].
    ///
    /// ```
    /// use rigidtap::control::motor::{TorqueCurve, TorquePoint};
    /// let point = |speed_rpm, torque_nm| TorquePoint { speed_rpm, torque_nm };
    /// let curve = TorqueCurve::new(&[point(0.0, 20.0), point(3000.0, 20.0), point(8000.0, 7.5)]).unwrap();
    /// assert_eq!(curve.torque_nm(1000.0), 20.0);
    /// assert_eq!(curve.torque_nm(6000.0), 10.0);
    /// ```
    pub fn new(points: &[TorquePoint]) -> Result<Self, TorqueCurveError> {
        let count = points.len();
        let [first, second, ..] = points else { return Err(TorqueCurveError::Count { count }) };
        let Ok(stored) = ArrayVec::try_from(points) else {
            return Err(TorqueCurveError::Count { count });
        };
        if first.speed_rpm != 0.0 {
            return Err(TorqueCurveError::FirstSpeed { speed_rpm: first.speed_rpm });
        }
        for (index, point) in points.iter().enumerate() {
            if !(point.torque_nm > 0.0 && point.torque_nm.is_finite()) {
                return Err(TorqueCurveError::Torque { point: index, torque_nm: point.torque_nm });
            }
        }
        for (index, (left, right)) in points.iter().zip(points.iter().skip(1)).enumerate() {
            if !(right.speed_rpm > left.speed_rpm && right.speed_rpm.is_finite()) {
                return Err(TorqueCurveError::SpeedOrder {
                    point: index + 1,
                    speed_rpm: right.speed_rpm,
                    previous_rpm: left.speed_rpm,
                });
            }
        }
        if first.torque_nm != second.torque_nm {
            return Err(TorqueCurveError::StandstillTorque { first_nm: first.torque_nm, second_nm: second.torque_nm });
        }
        Ok(Self { points: stored })
    }

    /// The curve of points that [`TorqueCurve::new`] would take.
    pub(crate) fn of_checked(points: ArrayVec<TorquePoint, MAX_POINTS>) -> Self {
        Self { points }
    }

    /// The points, in rising order of speed.
    #[must_use]
    pub fn points(&self) -> &[TorquePoint] {
        &self.points
    }

    /// Greatest torque in N·m at a speed of either direction; above the last point its power is held.
    #[must_use]
    pub fn torque_nm(&self, speed_rpm: f64) -> f64 {
        let speed_rpm = speed_rpm.abs();
        self.piece_at(speed_rpm).torque_nm(speed_rpm)
    }

    /// Between each two points: both speeds in rpm, and the constants a and b of torque = a + b/speed there.
    pub(crate) fn pieces(&self) -> impl DoubleEndedIterator<Item = ([f64; 2], f64, f64)> + Clone {
        self.points.iter().zip(self.points.iter().skip(1)).map(|(left, right)| {
            let (slope_nm, power_nm_rpm) = constants(left, right);
            ([left.speed_rpm, right.speed_rpm], slope_nm, power_nm_rpm)
        })
    }

    /// The piece that holds a speed of 0 or more: for whoever asks again and again at speeds that change little.
    ///
    /// ```
    /// use rigidtap::control::machine::Machine;
    /// let curve = Machine::reference().motor().curve.clone();
    /// let piece = curve.piece_at(6000.0);
    /// assert!(piece.holds(6001.0) && !piece.holds(2000.0));
    /// assert_eq!(piece.torque_nm(6001.0), curve.torque_nm(6001.0));
    /// ```
    #[must_use]
    pub fn piece_at(&self, speed_rpm: f64) -> CurvePiece {
        let found = self.pieces().find(|([_, high_rpm], ..)| speed_rpm <= *high_rpm);
        match found {
            Some((range_rpm, slope_nm, power_nm_rpm)) => CurvePiece { range_rpm, slope_nm, power_nm_rpm },
            None => {
                let (last_rpm, power_nm_rpm) =
                    self.points.last().map_or((0.0, 0.0), |last| (last.speed_rpm, last.speed_rpm * last.torque_nm));
                CurvePiece { range_rpm: [last_rpm, f64::INFINITY], slope_nm: 0.0, power_nm_rpm }
            }
        }
    }
}

/// A torque curve between two of its points: torque = slope + power/speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePiece {
    /// From above the first speed up to the second.
    range_rpm: [f64; 2],
    slope_nm: f64,
    power_nm_rpm: f64,
}

impl CurvePiece {
    /// Whether it holds a speed, 0 or more; between pieces any neighbour may answer.
    #[must_use]
    pub fn holds(&self, speed_rpm: f64) -> bool {
        let [low_rpm, high_rpm] = self.range_rpm;
        speed_rpm > low_rpm && speed_rpm <= high_rpm
    }

    /// Greatest torque in N·m at a speed that it holds.
    #[must_use]
    pub fn torque_nm(&self, speed_rpm: f64) -> f64 {
        self.slope_nm + if speed_rpm > 0.0 { self.power_nm_rpm / speed_rpm } else { 0.0 }
    }
}

/// The two constants a and b of torque = a + b/speed between two points: power is linear in speed.
fn constants(left: &TorquePoint, right: &TorquePoint) -> (f64, f64) {
    let (left_power, right_power) = (left.speed_rpm * left.torque_nm, right.speed_rpm * right.torque_nm);
    let slope_nm = (right_power - left_power) / (right.speed_rpm - left.speed_rpm);
    (slope_nm, left_power - slope_nm * left.speed_rpm)
}

/// Friction of the spindle: it hinders speeding up and helps braking.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Coulomb friction, 0 or more.
    pub coulomb_nm: f64,
    /// Viscous friction, 0 or more.
    pub viscous_nm_per_rpm: f64,
}

/// A motor with the inertia it turns.
#[derive(Clone, Debug, PartialEq)]
pub struct Motor {
    /// Torque over speed.
    pub curve: TorqueCurve,
    /// Total inertia at the spindle, positive.
    pub inertia_kg_m2: f64,
}

/// The fastest stroke a motor allows, see [`Motor::fastest_stroke`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FastestStroke {
    /// Time from rest to rest.
    pub duration_s: f64,
    /// Greatest speed on the way.
    pub peak_rev_per_s: f64,
}

impl Motor {
    /// Acceleration at a speed under `share` of the torque, without friction.
    #[must_use]
    pub fn acceleration_rev_per_s2(&self, speed_rev_per_s: f64, share: f64) -> f64 {
        share * self.curve.torque_nm(rpm_from_rev_per_s(speed_rev_per_s)) / (self.inertia_kg_m2 * RAD_PER_REV)
    }

    /// Torque in N·m that an acceleration takes.
    #[must_use]
    pub fn torque_for_nm(&self, acceleration_rev_per_s2: f64) -> f64 {
        acceleration_rev_per_s2 * RAD_PER_REV * self.inertia_kg_m2
    }

    /// Time from rest to a speed with `share` of the torque in (0, 1], without friction.
    ///
    /// ```
    /// let machine = rigidtap::control::machine::Machine::reference();
    /// assert!((machine.motor().run_up_s(8000.0 / 60.0, 1.0) - 0.2548).abs() < 1e-4);
    /// ```
    #[must_use]
    pub fn run_up_s(&self, speed_rev_per_s: f64, share: f64) -> f64 {
        self.run_up(speed_rev_per_s, share).0
    }

    /// Time and distance from rest to a speed under `share` of the torque, without friction.
    fn run_up(&self, speed_rev_per_s: f64, share: f64) -> (f64, f64) {
        let (mut time_s, mut distance_rev, mut low) = (0.0, 0.0, 0.0);
        // A last piece without an end covers speeds above the last point.
        let tops = self.curve.points.iter().skip(1).map(|point| rev_per_s_from_rpm(point.speed_rpm));
        for top in tops.chain(core::iter::once(f64::INFINITY)) {
            let high = speed_rev_per_s.min(top);
            if high > low {
                let slowness = |v: f64| 1.0 / self.acceleration_rev_per_s2(v, share);
                time_s += integrate(low, high, 4, slowness);
                distance_rev += integrate(low, high, 4, |v| v * slowness(v));
                low = high;
            }
        }
        (time_s, distance_rev)
    }

    /// "The bound": the fastest frictionless stroke from rest to rest with `share` of the motor, no faster than the command.
    ///
    /// Integrates dv/a(v); the distances of run-up and run-down are equal. `share` in (0, 1].
    ///
    /// ```
    /// use rigidtap::control::machine::Machine;
    /// let bound = Machine::reference().motor().fastest_stroke(25.0, 7000.0 / 60.0, 1.0);
    /// assert!((bound.duration_s - 0.3818).abs() < 5e-5);
    /// assert!((bound.peak_rev_per_s * 60.0 - 6759.0).abs() < 1.0);
    /// ```
    #[must_use]
    pub fn fastest_stroke(&self, distance_rev: f64, command_rev_per_s: f64, share: f64) -> FastestStroke {
        let half_rev = distance_rev / 2.0;
        let peak_rev_per_s = root::increasing(0.0, command_rev_per_s, |speed| self.run_up(speed, share).1 - half_rev);
        let (ramp_s, ramp_rev) = self.run_up(peak_rev_per_s, share);
        let cruise_s = if peak_rev_per_s > 0.0 { (distance_rev - 2.0 * ramp_rev) / peak_rev_per_s } else { 0.0 };
        FastestStroke { duration_s: 2.0 * ramp_s + cruise_s, peak_rev_per_s }
    }
}
