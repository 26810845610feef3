//! The time laws by name.

/// The time laws that a stroke can follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Law {
    /// Speed bands under the motor's torque curve.
    #[default]
    TorqueCurve,
    /// Seven segments of constant jerk.
    SCurve,
    /// One acceleration.
    Linear,
    /// All that the motor's torque curve, its share and friction allow.
    TorqueLimit,
    /// Under the motor's torque curve with bounded jerk.
    TorqueCurveSmooth,
    /// Fifteen phases of constant snap.
    TrapezoidJerk,
    /// Ten phases without constant acceleration, the cusp rounded.
    ImprovedSCurve,
}

impl Law {
    /// Every law, in the order of documentation.
    pub const ALL: [Self; 7] = [
        Self::TorqueCurve,
        Self::SCurve,
        Self::Linear,
        Self::TrapezoidJerk,
        Self::ImprovedSCurve,
        Self::TorqueLimit,
        Self::TorqueCurveSmooth,
    ];

    /// Whether `law.motor_share`, or retuning to one, changes its strokes.
    #[must_use]
    pub const fn follows_motor_share(self) -> bool {
        matches!(self, Self::TorqueCurve | Self::TorqueLimit | Self::TorqueCurveSmooth)
    }

    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::TorqueCurve => "torque-curve",
            Self::SCurve => "s-curve",
            Self::Linear => "linear",
            Self::TorqueLimit => "torque-limit",
            Self::TorqueCurveSmooth => "torque-curve-smooth",
            Self::TrapezoidJerk => "trapezoid-jerk",
            Self::ImprovedSCurve => "improved-s-curve",
        }
    }
}
