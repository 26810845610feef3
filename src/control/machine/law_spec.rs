//! `[law]` and its tables.

use arrayvec::ArrayVec;

use crate::control::math::list::copied;
use crate::control::profile::MAX_BANDS;

/// How fast a band of `torque-curve` is crossed: one of the two ways of the paper, section II.A.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ramp {
    /// Time constant T_iac, T_ide: the whole band in this time.
    Time {
        /// Acceleration.
        accel_s: f64,
        /// Deceleration.
        decel_s: f64,
    },
    /// Direct accelerations A_iac, A_ide, magnitudes.
    Rate {
        /// Acceleration.
        accel_rpm_per_s: f64,
        /// Deceleration.
        decel_rpm_per_s: f64,
    },
}

/// One speed band of `torque-curve`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BandSpec {
    /// Top V_i of the band.
    pub to_rpm: f64,
    /// How fast it is crossed.
    pub ramp: Ramp,
}

impl BandSpec {
    /// Times in which the whole band from `bottom_rpm` up is crossed, speeding up and slowing down, s.
    ///
    /// ```
    /// use rigidtap::control::machine::{BandSpec, Ramp};
    /// let ramp = Ramp::Rate { accel_rpm_per_s: 10_000.0, decel_rpm_per_s: 5000.0 };
    /// assert_eq!(BandSpec { to_rpm: 3000.0, ramp }.times_s(1000.0), (0.2, 0.4));
    /// ```
    #[must_use]
    pub fn times_s(&self, bottom_rpm: f64) -> (f64, f64) {
        match self.ramp {
            Ramp::Time { accel_s, decel_s } => (accel_s, decel_s),
            Ramp::Rate { accel_rpm_per_s, decel_rpm_per_s } => {
                let height_rpm = self.to_rpm - bottom_rpm;
                (height_rpm / accel_rpm_per_s, height_rpm / decel_rpm_per_s)
            }
        }
    }
}

/// `[law]`
#[derive(Clone, Debug, PartialEq)]
pub struct LawSpec {
    /// Share of the motor's torque that `torque-limit`, `torque-curve-smooth` and tuned bands may use.
    pub motor_share: f64,
    /// `[law.torque_curve]`
    pub torque_curve: TorqueCurveLawSpec,
    /// `[law.s_curve]`
    pub s_curve: SCurveLawSpec,
    /// `[law.linear]`
    pub linear: LinearLawSpec,
    /// `[law.torque_curve_smooth]`
    pub torque_curve_smooth: TorqueCurveSmoothLawSpec,
    /// `[law.trapezoid_jerk]`
    pub trapezoid_jerk: TrapezoidJerkLawSpec,
    /// `[law.improved_s_curve]`
    pub improved_s_curve: ImprovedSCurveLawSpec,
}

impl LawSpec {
    /// Slows every law down: torque utilisation, accelerations, jerks and snap take this factor, between 0 and 1.
    pub fn slow_down(&mut self, factor: f64) {
        let Self { motor_share, torque_curve, s_curve, linear, torque_curve_smooth, trapezoid_jerk, improved_s_curve } =
            self;
        for band in &mut torque_curve.bands {
            match &mut band.ramp {
                Ramp::Time { accel_s, decel_s } => (*accel_s, *decel_s) = (*accel_s / factor, *decel_s / factor),
                Ramp::Rate { accel_rpm_per_s, decel_rpm_per_s } => {
                    (*accel_rpm_per_s, *decel_rpm_per_s) = (*accel_rpm_per_s * factor, *decel_rpm_per_s * factor);
                }
            }
        }
        for value in [
            motor_share,
            &mut s_curve.accel_rpm_per_s,
            &mut s_curve.jerk_rpm_per_s2,
            &mut linear.accel_rpm_per_s,
            &mut torque_curve_smooth.jerk_rpm_per_s2,
            &mut trapezoid_jerk.accel_rpm_per_s,
            &mut trapezoid_jerk.jerk_rpm_per_s2,
            &mut trapezoid_jerk.snap_rpm_per_s3,
            &mut improved_s_curve.accel_rpm_per_s,
        ] {
            *value *= factor;
        }
    }
}

/// `[law.torque_curve]`
#[derive(Debug, PartialEq)]
pub struct TorqueCurveLawSpec {
    /// Start speed Vs.
    pub start_rpm: f64,
    /// End speed Ve.
    pub end_rpm: f64,
    /// V1…V4 with their time constants, in rising order.
    pub bands: ArrayVec<BandSpec, MAX_BANDS>,
}

impl Clone for TorqueCurveLawSpec {
    fn clone(&self) -> Self {
        Self { bands: copied(&self.bands), ..*self }
    }
}

/// `[law.s_curve]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SCurveLawSpec {
    /// Greatest acceleration A.
    pub accel_rpm_per_s: f64,
    /// Jerk J.
    pub jerk_rpm_per_s2: f64,
}

/// `[law.linear]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearLawSpec {
    /// The one acceleration.
    pub accel_rpm_per_s: f64,
}

/// `[law.torque_curve_smooth]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueCurveSmoothLawSpec {
    /// Jerk j.
    pub jerk_rpm_per_s2: f64,
}

/// `[law.trapezoid_jerk]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrapezoidJerkLawSpec {
    /// Greatest acceleration a_max.
    pub accel_rpm_per_s: f64,
    /// Greatest jerk j_max.
    pub jerk_rpm_per_s2: f64,
    /// Slope l of the jerk.
    pub snap_rpm_per_s3: f64,
    /// Whether each phase takes a whole number of interpolation periods.
    pub quantised: bool,
}

/// `[law.improved_s_curve]`
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImprovedSCurveLawSpec {
    /// Acceleration a_max that each change of speed peaks at.
    pub accel_rpm_per_s: f64,
}
