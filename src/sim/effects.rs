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
}

impl Effect {
    /// Every effect, in the order of documentation.
    pub const ALL: [Self; 14] = [
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
    ];

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
        }
    }
}

/// Which effects the plant has. What no plant can lose, such as an encoder's whole counts, is not among them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Effects {
    off: u16,
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
        Self { off: self.off | 1 << effect as u16 }
    }

    /// The effects that are off.
    pub fn off(self) -> impl Iterator<Item = Effect> {
        Effect::ALL.into_iter().filter(move |effect| !self.has(*effect))
    }

    /// Whether an effect is on.
    #[must_use]
    pub const fn has(self, effect: Effect) -> bool {
        self.off & (1 << effect as u16) == 0
    }

    /// The value where the effect is on, else 0.
    pub(crate) fn or_zero(self, effect: Effect, value: f64) -> f64 {
        if self.has(effect) { value } else { 0.0 }
    }
}
