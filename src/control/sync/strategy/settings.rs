//! What a host chooses: what Z follows, and how it is corrected.

/// What Z follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Mode {
    /// The command that the spindle has, too: FANUC, Siemens, Mitsubishi.
    #[default]
    Commanded,
    /// The measured spindle as it was measured: LinuxCNC.
    Following,
    /// The measured spindle, its phase predicted to the instant that Z acts.
    FollowingPredicted,
}

impl Mode {
    /// Every mode, in the order of documentation.
    pub const ALL: [Self; 3] = [Self::Commanded, Self::Following, Self::FollowingPredicted];

    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Commanded => "commanded",
            Self::Following => "following",
            Self::FollowingPredicted => "following-predicted",
        }
    }
}

/// How Z is corrected by e(k).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Compensation {
    /// Not at all: `none`.
    Uncompensated,
    /// The torque-curve paper's section I.B, `paper`: each period Z's increment is corrected by gain × e(k) × period, within
    /// a limit. It is cross-coupling by an integrator (Koren 1980).
    Integral,
    /// By the model of the plant and all that is measured of it, `full`; see [`sync`](crate::control::sync).
    #[default]
    ModelBased,
}

impl Compensation {
    /// Every compensation, in the order of documentation.
    pub const ALL: [Self; 3] = [Self::Uncompensated, Self::Integral, Self::ModelBased];

    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uncompensated => "none",
            Self::Integral => "paper",
            Self::ModelBased => "full",
        }
    }

    /// Whether a hole leaves a [`ResidualFeedforward`](crate::control::sync::ResidualFeedforward), and takes over that of the hole before.
    #[must_use]
    pub(crate) const fn leaves_residual(self) -> bool {
        matches!(self, Self::ModelBased)
    }
}

/// How a hole is synchronised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// What Z follows.
    pub mode: Mode,
    /// How Z is corrected.
    pub compensation: Compensation,
    /// Model-based compensation takes what was measured of the machine in place of what its file says. Time scaling looks at
    /// what the motor gives in any case: a thread is not lost for want of a switch.
    pub identify: bool,
    /// Model-based compensation learns over holes of the same kind.
    pub learn: bool,
    /// Faults are looked for and answered. Without it the control believes what it is told, as the papers' does.
    pub supervise: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            mode: Mode::default(),
            compensation: Compensation::default(),
            identify: true,
            learn: false,
            supervise: true,
        }
    }
}
