//! Plants: our simulated machine, or someone else's.

use std::fmt;

use crate::control::cycle::TapCycle;
use crate::control::port::{Feedback, Port, Setpoint, Truth};
use crate::sim::{Actual, Plant};

/// Someone else's plants, as many as are asked for. A plant that fails gives no samples any more, which ends its run, and
/// the source says why.
pub trait PlantSource: fmt::Debug + Send + Sync {
    /// A fresh plant at rest, which steps by this period. It is told what a sweep draws, and may make nothing of it.
    fn start(&self, actual: &Actual, seed: u64, z_start_mm: f64, period_s: f64) -> Box<dyn Port>;

    /// The first thing that failed in any of its plants.
    fn error(&self) -> Option<String>;
}

/// The plant of one run.
pub(super) enum RunPlant {
    Ours(Box<Plant>),
    Other(Box<dyn Port>),
}

impl RunPlant {
    fn port(&mut self) -> &mut dyn Port {
        match self {
            Self::Ours(plant) => &mut **plant,
            Self::Other(plant) => &mut **plant,
        }
    }
}

impl Port for RunPlant {
    fn read(&mut self, now_s: f64) -> Feedback {
        self.port().read(now_s)
    }

    fn write(&mut self, now_s: f64, setpoint: &Setpoint) {
        self.port().write(now_s, setpoint);
    }

    fn clock_s(&mut self, now_s: f64) -> f64 {
        self.port().clock_s(now_s)
    }

    fn set_power(&mut self, is_on: bool) {
        self.port().set_power(is_on);
    }

    fn begin_hole(&mut self, cycle: &TapCycle) {
        self.port().begin_hole(cycle);
    }

    fn truth(&self) -> Option<Truth> {
        match self {
            Self::Ours(plant) => plant.truth(),
            Self::Other(plant) => plant.truth(),
        }
    }
}
