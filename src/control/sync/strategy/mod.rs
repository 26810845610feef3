//! How a hole is synchronised: what Z follows, how it is corrected, and the strategy that does it.

mod direct;
mod model_based;
mod settings;
mod synchronise;

pub use settings::{Compensation, Mode, Settings};
pub(super) use synchronise::{Command, Inputs, Synchronise};

use crate::control::cycle::CyclePlan;
use crate::control::machine::Machine;

use self::direct::{Direct, Integral};
use self::model_based::ModelBased;

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
            Compensation::Integral => Self::Direct(Direct::new(machine, settings.mode, Some(Integral::PAPER))),
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
