//! How a hole is synchronised: what Z follows, how it is corrected, and the strategy that does it.

mod direct;
mod model_based;

use crate::control::cycle::{CyclePlan, LegState};
use crate::control::machine::Machine;

use self::direct::Direct;
use self::model_based::ModelBased;
use super::adaptation::Adaptation;
use super::frame::{AxisCommands, Measured, Travel};
use super::in_position::Window;
use super::trajectory::Trajectory;

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
    /// By the model of the plant and all that is measured of it, `full`; see [`super`].
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

    /// Whether a hole leaves a [`ResidualFeedforward`](super::ResidualFeedforward), and takes over that of the hole before.
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

/// What one period of a hole is computed from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Inputs<'a> {
    pub(super) now_s: f64,
    /// Travels since the hole's zero, and e(k) from them.
    pub(super) travel: Travel,
    /// The spindle's speed over the last period.
    pub(super) spindle_rev_per_s: f64,
    pub(super) error_mm: f64,
    pub(super) measured: &'a Measured,
}

/// What one period of a hole yields, positive into the hole.
#[derive(Clone, Copy, Debug)]
pub(super) struct Command {
    pub(super) axes: AxisCommands,
    /// What Z's command is still to be deeper by.
    pub(super) z_offset_mm: f64,
    /// Correction in force on Z, this one or part of `axes`.
    pub(super) correction_mm: f64,
    /// The plan's time, what it says of the spindle there, and how fast it runs against the clock.
    pub(super) plan_s: f64,
    pub(super) planned: LegState,
    pub(super) path_rate: f64,
}

/// What every strategy does.
pub(super) trait Synchronise {
    /// How long after the plan's end the axes still move.
    fn tail_s(&self) -> f64;

    /// When spindle and Z are in position for the start, and whether the hole is tapped with a start offset.
    fn start(&self) -> (Window, bool);

    /// Spindle and Z rest where the plan has them at a time, and the next [`Synchronise::step`] is the first from there.
    fn begin(&mut self, plan_s: f64, trajectory: &mut Trajectory, measured: &Measured, adaptation: &mut Adaptation);

    /// One synchronous period.
    fn step(&mut self, trajectory: &mut Trajectory, inputs: &Inputs<'_>, adaptation: &mut Adaptation) -> Command;

    /// The hole is done with Z commanded so far above R, and with such a force, in machine coordinates. One that was
    /// interrupted teaches nothing.
    fn finish(&self, adaptation: &mut Adaptation, interrupted: bool, z_mm: f64, z_force_n: f64);
}

/// The strategy of a hole.
#[expect(clippy::large_enum_variant, reason = "without a heap the larger one has its room in any case")]
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Strategy {
    /// The plan, or the measured spindle, sent to both axes; with an integral correction or without.
    Direct(Direct),
    /// Both axes commanded by the model of the plant.
    ModelBased(ModelBased),
}

impl Strategy {
    pub(super) fn new(plan: &CyclePlan, machine: &Machine, settings: Settings) -> Self {
        match settings.compensation {
            Compensation::Uncompensated => Self::Direct(Direct::new(machine, settings.mode, None)),
            Compensation::Integral => Self::Direct(Direct::new(machine, settings.mode, Some(direct::Integral::PAPER))),
            Compensation::ModelBased => Self::ModelBased(ModelBased::new(plan, machine, settings)),
        }
    }

    pub(super) fn inner(&self) -> &dyn Synchronise {
        match self {
            Self::Direct(direct) => direct,
            Self::ModelBased(model_based) => model_based,
        }
    }

    pub(super) fn inner_mut(&mut self) -> &mut dyn Synchronise {
        match self {
            Self::Direct(direct) => direct,
            Self::ModelBased(model_based) => model_based,
        }
    }
}
