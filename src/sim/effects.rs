//! The plant's effects by name, so that each can be switched off and its share in the error seen.

/// One imperfection of the plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Torsion between spindle motor and tool.
    SpindleResonance,
    /// Current-loop lag of both drives.
    TorqueLag,
    /// Coulomb and viscous friction of the spindle.
    SpindleFriction,
    /// Torque ripple of the spindle motor.
    TorqueRipple,
    /// The supply's sag under load.
    SupplySag,
    /// Elasticity of Z's screw.
    ZResonance,
    /// All of Z's friction.
    ZFriction,
    /// Friction's change over position, direction and from hole to hole.
    FrictionRipple,
    /// Backlash of Z.
    Backlash,
    /// Tapping torque.
    Cutting,
    /// The tapping torque's noise.
    ChipNoise,
    /// Interpolation errors of both encoders.
    Interpolation,
    /// Age of encoder readings.
    EncoderLatency,
    /// Jitter of the latching instant.
    EncoderJitter,
    /// Damping that decays inside the backlash.
    BacklashDamping,
    /// Setpoints that act later or earlier than the file says.
    SetpointLatency,
    /// Jitter of the host's period.
    HostJitter,
    /// Weight of the head that nothing balances.
    ZWeight,
    /// Viscous friction of Z.
    ZViscous,
    /// Difference of Z's friction between up and down, beside the standard one.
    FrictionAsymmetry,
    /// A friction law of Z other than the standard one.
    FrictionModel,
    /// Pitch error of Z's screw.
    ScrewError,
    /// Second axial resonance of Z.
    SecondResonance,
    /// Axial force of the tap.
    TapAxial,
    /// Eccentricity of the spindle's encoder.
    Eccentricity,
    /// Torque per current that falls with speed.
    TorqueConstantFall,
    /// Readings that come twice.
    StaleSamples,
    /// Periods that the host misses.
    MissedPeriods,
    /// Drive gains other than the file says.
    DriveGain,
    /// Computing delay of the drives.
    DriveDelay,
    /// Growth of Z's screw as it warms.
    ThermalGrowth,
    /// Reported efforts in coarse steps.
    QuantisedEffort,
    /// Drives that report no effort.
    AbsentEffort,
}

impl Effect {
    /// Every effect, in the order of documentation.
    pub const ALL: [Self; 33] = [
        Self::SpindleResonance,
        Self::TorqueLag,
        Self::SpindleFriction,
        Self::TorqueRipple,
        Self::SupplySag,
        Self::ZResonance,
        Self::ZFriction,
        Self::FrictionRipple,
        Self::Backlash,
        Self::Cutting,
        Self::ChipNoise,
        Self::Interpolation,
        Self::EncoderLatency,
        Self::EncoderJitter,
        Self::BacklashDamping,
        Self::SetpointLatency,
        Self::HostJitter,
        Self::ZWeight,
        Self::ZViscous,
        Self::FrictionAsymmetry,
        Self::FrictionModel,
        Self::ScrewError,
        Self::SecondResonance,
        Self::TapAxial,
        Self::Eccentricity,
        Self::TorqueConstantFall,
        Self::StaleSamples,
        Self::MissedPeriods,
        Self::DriveGain,
        Self::DriveDelay,
        Self::ThermalGrowth,
        Self::QuantisedEffort,
        Self::AbsentEffort,
    ];

    /// How many of them, the first ones, every plant has. The others are the hard spread's, each from a key of `[actual]`.
    const STANDARD: usize = 14;

    /// Whether every plant has it; the others only where a key of [`Actual`](super::Actual) asks for them.
    #[must_use]
    pub const fn is_standard(self) -> bool {
        (self as usize) < Self::STANDARD
    }

    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::SpindleResonance => "spindle-resonance",
            Self::TorqueLag => "torque-lag",
            Self::SpindleFriction => "spindle-friction",
            Self::TorqueRipple => "torque-ripple",
            Self::SupplySag => "supply-sag",
            Self::ZResonance => "z-resonance",
            Self::ZFriction => "z-friction",
            Self::FrictionRipple => "friction-ripple",
            Self::Backlash => "backlash",
            Self::Cutting => "cutting",
            Self::ChipNoise => "chip-noise",
            Self::Interpolation => "interpolation",
            Self::EncoderLatency => "encoder-latency",
            Self::EncoderJitter => "encoder-jitter",
            Self::BacklashDamping => "backlash-damping",
            Self::SetpointLatency => "setpoint-latency",
            Self::HostJitter => "host-jitter",
            Self::ZWeight => "z-weight",
            Self::ZViscous => "z-viscous",
            Self::FrictionAsymmetry => "friction-asymmetry",
            Self::FrictionModel => "friction-model",
            Self::ScrewError => "screw-error",
            Self::SecondResonance => "second-resonance",
            Self::TapAxial => "tap-axial",
            Self::Eccentricity => "eccentricity",
            Self::TorqueConstantFall => "torque-constant-fall",
            Self::StaleSamples => "stale-samples",
            Self::MissedPeriods => "missed-periods",
            Self::DriveGain => "drive-gain",
            Self::DriveDelay => "drive-delay",
            Self::ThermalGrowth => "thermal-growth",
            Self::QuantisedEffort => "quantised-effort",
            Self::AbsentEffort => "absent-effort",
        }
    }
}

/// Which effects the plant has. What no plant can lose, such as an encoder's whole counts, is not among them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effects {
    off: u64,
}

impl Effects {
    /// All effects: the default.
    pub const FULL: Self = Self { off: 0 };
    /// No effect at all: `--ideal`.
    pub const IDEAL: Self = Self { off: (1 << Effect::ALL.len()) - 1 };

    /// The same without one effect.
    ///
    /// ```
    /// use rigidtap::sim::{Effect, Effects};
    /// let effects = Effects::FULL.without(Effect::Backlash);
    /// assert!(!effects.has(Effect::Backlash) && effects.has(Effect::Cutting));
    /// ```
    #[must_use]
    pub const fn without(self, effect: Effect) -> Self {
        Self { off: self.off | 1 << effect as u64 }
    }

    /// The effects that are off.
    pub fn off(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.into_iter().filter(move |effect| !self.has(*effect))
    }

    /// Whether an effect is on.
    #[must_use]
    pub const fn has(self, effect: Effect) -> bool {
        self.off & (1 << effect as u64) == 0
    }

    /// The value where the effect is on, else 0.
    pub(crate) fn or_zero(self, effect: Effect, value: f64) -> f64 {
        if self.has(effect) { value } else { 0.0 }
    }
}
