//! The plan sent to both axes as it is, or Z by the measured spindle; e(k) corrected by an integrator or not at all.

use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::sync::adaptation::Adaptation;
use crate::control::sync::frame::{AxisCommands, Measured};
use crate::control::sync::in_position::{START, Window};
use crate::control::sync::observer::SpindleObserver;
use crate::control::sync::trajectory::Trajectory;
use crate::control::units::mm_from_um;

use super::settings::Mode;
use super::synchronise::{Command, Inputs, Synchronise};

/// The torque-curve paper's correction of Z by e(k), section I.B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Integral {
    gain_per_s: f64,
    /// Most that is corrected in one period.
    limit_um: f64,
}

impl Integral {
    /// The paper gives no numbers. These are fixed, so that the regression stands on them.
    pub(super) const PAPER: Self = Self { gain_per_s: 50.0, limit_um: 5.0 };
}

/// One hole without a model.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync) struct Direct {
    mode: Mode,
    integral: Option<Integral>,
    period_s: f64,
    latency_s: f64,
    /// From a reading of the spindle to the instant that Z's setpoint for it acts.
    horizon_s: f64,
    observer: SpindleObserver,
    correction_mm: f64,
}

impl Direct {
    pub(super) fn new(machine: &Machine, mode: Mode, integral: Option<Integral>) -> Self {
        let spec = machine.spec();
        let period_s = spec.control.period_s;
        let latency_s = spec.drive.latency_periods * period_s;
        Self {
            mode,
            integral,
            period_s,
            latency_s,
            horizon_s: latency_s + spec.drive.encoder_latency_s,
            observer: SpindleObserver::of_angle(period_s, spec.sync.observer_rad_per_s),
            correction_mm: 0.0,
        }
    }

    /// What Z follows, of the planned and the measured spindle.
    fn master(&mut self, planned: &State, inputs: &Inputs<'_>) -> State {
        let position = inputs.travel.spindle_rev;
        match self.mode {
            Mode::Commanded => *planned,
            // Measured twice over, an acceleration would be mostly count noise: Z gets none.
            Mode::Following => State { position, velocity: inputs.spindle_rev_per_s, ..State::default() },
            Mode::FollowingPredicted => {
                self.observer.update(position, false);
                // Nor here: what is observed of an acceleration is mostly noise, too.
                State { acceleration: 0.0, ..self.observer.predict(self.horizon_s) }
            }
        }
    }
}

impl Synchronise for Direct {
    fn tail_s(&self) -> f64 {
        self.latency_s
    }

    fn start(&self) -> (Window, bool) {
        (START, false)
    }

    fn begin(&mut self, plan_s: f64, trajectory: &mut Trajectory, _: &Measured, adaptation: &mut Adaptation) {
        self.observer.rest_at(trajectory.at(plan_s).spindle.position);
        adaptation.begin_hole(trajectory.plan());
    }

    fn step(&mut self, trajectory: &mut Trajectory, inputs: &Inputs<'_>, _adaptation: &mut Adaptation) -> Command {
        if let Some(Integral { gain_per_s, limit_um }) = self.integral {
            let limit_mm = mm_from_um(limit_um);
            // Not `clamp`, which can panic.
            self.correction_mm -= (gain_per_s * inputs.error_mm * self.period_s).max(-limit_mm).min(limit_mm);
        }
        let plan_s = trajectory.plan_s(inputs.now_s);
        let planned = trajectory.at(plan_s);
        let master = self.master(&planned.spindle, inputs);
        let z = trajectory.plan().thread().follow(&master);
        Command {
            axes: AxisCommands { spindle: planned.spindle, z, ..AxisCommands::default() },
            z_offset_mm: self.correction_mm,
            correction_mm: self.correction_mm,
            unseen_mm: 0.0,
            plan_s,
            planned,
            path_rate: 1.0,
        }
    }

    fn finish(&self, _adaptation: &mut Adaptation, _interrupted: bool, _z_mm: f64, _z_force_n: f64) {}
}
