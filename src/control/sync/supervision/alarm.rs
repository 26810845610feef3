//! The alarms, each with its code and its numbers.

use core::fmt;

/// An encoder that counts nothing while so many counts are expected has come to a halt.
pub(super) const FROZEN_COUNTS: f64 = 8.0;
/// Settle timeout: a machine that is not in position by then has a fault.
pub(in crate::control::sync) const SETTLE_TIMEOUT_S: f64 = 3.0;

/// A fault at run time. It is latched: the hole does not go on, and never ends as done.
///
/// Lengths are revolutions of the spindle and mm of Z.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Alarm {
    /// A101: no sample of an axis that counts for longer than the model may stand in.
    SampleLost {
        /// Which axis.
        axis: Axis,
        /// Periods without a sample.
        periods: u32,
        /// Most that are bridged.
        limit: u32,
    },
    /// A102: an axis moved further in a period than anything could move it.
    CountJump {
        /// Which axis.
        axis: Axis,
        /// How far it seems to have moved.
        travel: f64,
        /// The furthest that it could.
        limit: f64,
    },
    /// A103: an encoder stands still while its axis is commanded.
    EncoderFrozen {
        /// Which axis.
        axis: Axis,
        /// Periods in which nothing was counted.
        periods: u32,
        /// Counts that the axis should have moved in them.
        expected_counts: f64,
    },
    /// A104: an encoder counts backwards, or not as the axis travels.
    TravelMismatch {
        /// Which axis.
        axis: Axis,
        /// What was counted from what was commanded.
        deviation: f64,
        /// Most that drive and scale explain.
        limit: f64,
    },
    /// A105: the spindle does not follow its command.
    SpindleFollowing {
        /// Measured less commanded angle.
        error_rev: f64,
        /// Most that it may be.
        limit_rev: f64,
    },
    /// A105: the spindle's drive is told to push, and gives nothing.
    SpindleTorque {
        /// What it gives.
        torque_nm: f64,
        /// What it is told to give.
        commanded_nm: f64,
    },
    /// A105 or A106: a drive is not ready.
    DriveNotReady {
        /// Which axis.
        axis: Axis,
        /// Periods for which it was not.
        periods: u32,
    },
    /// A106: Z does not follow its command.
    ZFollowing {
        /// Measured less commanded position.
        error_mm: f64,
        /// Most that it may be.
        limit_mm: f64,
    },
    /// A107: spindle and Z left the thread.
    SynchronisationError {
        /// e(k).
        error_um: f64,
        /// Most that it may be.
        limit_um: f64,
    },
    /// A108: the tap is held fast.
    Jam {
        /// How much slower than commanded the spindle turns.
        lag_rpm: f64,
        /// What its motor alone explains.
        limit_rpm: f64,
    },
    /// A109: the tap cut next to nothing, where earlier holes took torque.
    TapBroken {
        /// Mean cutting torque of this hole.
        torque_nm: f64,
        /// The least that a whole tap takes.
        limit_nm: f64,
    },
    /// A110: a drive reported an effort that it cannot have.
    EffortImplausible {
        /// Which axis.
        axis: Axis,
        /// What it reported, N·m or N.
        effort: f64,
        /// The greatest that it can have.
        limit: f64,
    },
    /// A111: the host's clock fell, is no number, or left out more periods than the model may stand in for.
    Clock {
        /// From the last period to this one.
        elapsed_s: f64,
        /// Most that it may be.
        limit_s: f64,
    },
    /// A112: spindle or Z did not come into position at the start or the end of a hole.
    NotInPosition {
        /// Seconds waited.
        waited_s: f64,
        /// The spindle's distance from its rest angle.
        spindle_rev: f64,
        /// Z's distance from its target, positive above it.
        z_mm: f64,
    },
}

/// Which axis an alarm is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The spindle.
    Spindle,
    /// Z.
    Z,
}

impl Axis {
    /// Name in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Spindle => "spindle",
            Self::Z => "z",
        }
    }

    /// Unit of its travel.
    const fn unit(self) -> &'static str {
        match self {
            Self::Spindle => "rev",
            Self::Z => "mm",
        }
    }

    /// Unit of its drive's effort.
    const fn effort_unit(self) -> &'static str {
        match self {
            Self::Spindle => "N·m",
            Self::Z => "N",
        }
    }
}

/// Beyond this share of a revolution it is the spindle that is not in position.
const SPINDLE_OFF_REV: f64 = 0.001;
/// So many periods a drive may be not ready.
pub(super) const NOT_READY_PERIODS: u32 = 3;

impl Alarm {
    /// The axis that it is of. Of e(k) and the clock it is the spindle, which Z follows.
    #[must_use]
    pub fn axis(&self) -> Axis {
        match *self {
            Self::SampleLost { axis, .. }
            | Self::CountJump { axis, .. }
            | Self::EncoderFrozen { axis, .. }
            | Self::TravelMismatch { axis, .. }
            | Self::DriveNotReady { axis, .. }
            | Self::EffortImplausible { axis, .. } => axis,
            Self::SpindleFollowing { .. }
            | Self::SpindleTorque { .. }
            | Self::SynchronisationError { .. }
            | Self::Jam { .. }
            | Self::TapBroken { .. }
            | Self::Clock { .. } => Axis::Spindle,
            Self::ZFollowing { .. } => Axis::Z,
            Self::NotInPosition { spindle_rev, .. } if spindle_rev.abs() > SPINDLE_OFF_REV => Axis::Spindle,
            Self::NotInPosition { .. } => Axis::Z,
        }
    }

    /// What was measured and the limit that it broke, in the units of its fields.
    #[must_use]
    pub fn value_and_limit(&self) -> (f64, f64) {
        match *self {
            Self::SampleLost { periods, limit, .. } => (periods.into(), limit.into()),
            Self::CountJump { travel, limit, .. } => (travel, limit),
            Self::EncoderFrozen { expected_counts, .. } => (expected_counts, FROZEN_COUNTS),
            Self::TravelMismatch { deviation, limit, .. } => (deviation, limit),
            Self::SpindleFollowing { error_rev, limit_rev } => (error_rev, limit_rev),
            Self::SpindleTorque { torque_nm, commanded_nm } => (torque_nm, commanded_nm),
            Self::DriveNotReady { periods, .. } => (periods.into(), NOT_READY_PERIODS.into()),
            Self::ZFollowing { error_mm, limit_mm } => (error_mm, limit_mm),
            Self::SynchronisationError { error_um, limit_um } => (error_um, limit_um),
            Self::Jam { lag_rpm, limit_rpm } => (lag_rpm, limit_rpm),
            Self::TapBroken { torque_nm, limit_nm } => (torque_nm, limit_nm),
            Self::EffortImplausible { effort, limit, .. } => (effort, limit),
            Self::Clock { elapsed_s, limit_s } => (elapsed_s, limit_s),
            Self::NotInPosition { waited_s, .. } => (waited_s, SETTLE_TIMEOUT_S),
        }
    }

    /// The number that C hosts, HAL and `check --explain` know it by.
    ///
    /// ```
    /// use rigidtap::control::sync::Alarm;
    /// let alarm = Alarm::NotInPosition { waited_s: 3.001, spindle_rev: 0.0, z_mm: -0.5 };
    /// assert_eq!(alarm.code(), 112);
    /// assert_eq!(
    ///     alarm.to_string(),
    ///     "A112: not in position after 3.0 s: spindle 0.0000 rev, Z -0.5000 mm from where they are to rest",
    /// );
    /// ```
    #[must_use]
    pub const fn code(&self) -> u32 {
        match self {
            Self::SampleLost { .. } => 101,
            Self::CountJump { .. } => 102,
            Self::EncoderFrozen { .. } => 103,
            Self::TravelMismatch { .. } => 104,
            Self::SpindleFollowing { .. }
            | Self::SpindleTorque { .. }
            | Self::DriveNotReady { axis: Axis::Spindle, .. } => 105,
            Self::ZFollowing { .. } | Self::DriveNotReady { axis: Axis::Z, .. } => 106,
            Self::SynchronisationError { .. } => 107,
            Self::Jam { .. } => 108,
            Self::TapBroken { .. } => 109,
            Self::EffortImplausible { .. } => 110,
            Self::Clock { .. } => 111,
            Self::NotInPosition { .. } => 112,
        }
    }

    /// What it means, why it comes, and what to do: `rigidtap check --explain A112`. None for a number that no alarm has.
    #[must_use]
    pub const fn explanation(code: u32) -> Option<&'static str> {
        super::explanation::of(code)
    }
}

impl fmt::Display for Alarm {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "A{}: ", self.code())?;
        match *self {
            Self::SampleLost { axis, periods, limit } => {
                write!(f, "no valid sample of {} for {periods} periods, and {limit} are bridged", axis.name())
            }
            Self::CountJump { axis, travel, limit } => write!(
                f,
                "counts of {} jumped: {travel:.4} {unit} in one period, where {limit:.4} {unit} is the most",
                axis.name(),
                unit = axis.unit()
            ),
            Self::EncoderFrozen { axis, periods, expected_counts } => write!(
                f,
                "encoder of {} stood still for {periods} periods in which its axis was to move {expected_counts:.0} counts",
                axis.name()
            ),
            Self::TravelMismatch { axis, deviation, limit } => write!(
                f,
                "encoder of {} counts backwards or off its scale: {deviation:.4} {unit} from what was commanded, and \
                 {limit:.4} {unit} is the most",
                axis.name(),
                unit = axis.unit()
            ),
            Self::SpindleFollowing { error_rev, limit_rev } => {
                write!(f, "spindle is {error_rev:.4} rev off its command, and {limit_rev:.4} rev is the most")
            }
            Self::SpindleTorque { torque_nm, commanded_nm } => {
                write!(f, "spindle's drive gives {torque_nm:.2} N·m, and {commanded_nm:.2} N·m are commanded")
            }
            Self::DriveNotReady { axis, periods } => {
                write!(f, "drive of {} has not been ready for {periods} periods", axis.name())
            }
            Self::ZFollowing { error_mm, limit_mm } => {
                write!(f, "Z is {error_mm:.4} mm off its command, and {limit_mm:.4} mm is the most")
            }
            Self::SynchronisationError { error_um, limit_um } => {
                write!(f, "synchronisation error {error_um:.1} µm, and {limit_um:.1} µm is the most")
            }
            Self::Jam { lag_rpm, limit_rpm } => write!(
                f,
                "tap jams: the spindle turns {lag_rpm:.0} rpm slower than commanded, and its motor explains {limit_rpm:.0} rpm"
            ),
            Self::TapBroken { torque_nm, limit_nm } => {
                write!(
                    f,
                    "tap is broken or gone: it cut with {torque_nm:.2} N·m, and a whole one takes {limit_nm:.2} N·m"
                )
            }
            Self::EffortImplausible { axis, effort, limit } => write!(
                f,
                "drive of {} reports {effort:.1} {unit}, and {limit:.1} {unit} is the most",
                axis.name(),
                unit = axis.effort_unit()
            ),
            Self::Clock { elapsed_s, limit_s } => {
                write!(f, "clock went on by {elapsed_s:.4} s in one period, and {limit_s:.4} s is the most")
            }
            Self::NotInPosition { waited_s, spindle_rev, z_mm } => write!(
                f,
                "not in position after {waited_s:.1} s: spindle {spindle_rev:.4} rev, Z {z_mm:.4} mm from where they are to rest"
            ),
        }
    }
}

impl core::error::Error for Alarm {}
