//! How a hole is synchronised: what Z follows, and how it is corrected.

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
    /// Not at all.
    None,
    /// The paper's section I.B: each period Z's increment is corrected by gain × e(k) × period, within a limit.
    Paper,
    /// By all that is known of the machine, see [`super`].
    #[default]
    Full,
}

impl Compensation {
    /// Every compensation, in the order of documentation.
    pub const ALL: [Self; 3] = [Self::None, Self::Paper, Self::Full];

    /// Name on the command line and in reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Paper => "paper",
            Self::Full => "full",
        }
    }
}

/// How a hole is synchronised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// What Z follows.
    pub mode: Mode,
    /// How Z is corrected.
    pub compensation: Compensation,
    /// `full` takes what the machine shows of itself in place of what its file says. The governor looks at what a motor
    /// gives in any case: a thread is not lost for want of a switch.
    pub identify: bool,
    /// `full` learns over holes of the same kind.
    pub learn: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { mode: Mode::default(), compensation: Compensation::default(), identify: true, learn: false }
    }
}
