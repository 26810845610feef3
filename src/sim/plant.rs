//! The plant as a port: setpoints in, encoder counts out.

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;

use crate::control::cycle::TapCycle;
use crate::control::machine::Machine;
use crate::control::port::{AxisStatus, DriveState, Feedback, Port, Setpoint, Truth};

use super::effects::Effects;
use super::interpolator::Interpolator;
use super::spindle::Spindle;
use super::work_piece::WorkPiece;
use super::z_axis::ZAxis;
use super::{Actual, MAX_STEP_S};

/// What a plant is, beyond its machine file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlantOptions {
    /// How it differs from the file.
    pub actual: Actual,
    /// Which imperfections it has.
    pub effects: Effects,
    /// Seed of everything random; the same seed gives the same bits.
    pub seed: u64,
    /// Where Z stands at first.
    pub z_start_mm: f64,
}

impl Default for PlantOptions {
    fn default() -> Self {
        Self { actual: Actual::default(), effects: Effects::FULL, seed: 1, z_start_mm: 0.0 }
    }
}

/// A simulated machine.
#[derive(Clone, Debug)]
pub struct Plant {
    spindle: Spindle,
    spindle_command: Interpolator,
    z: ZAxis,
    z_command: Interpolator,
    work_piece: WorkPiece,
    random: Pcg64Mcg,
    tick_s: f64,
    ticks_per_period: u32,
    steps_per_tick: u32,
    torque_saturated: bool,
    /// Over the last period, as the drives know them.
    mean_torque_nm: f64,
    mean_force_n: f64,
}

impl Plant {
    /// A machine at rest, with its spindle at 0.
    ///
    /// ```
    /// use rigidtap::control::{machine::Machine, port::{Port, Setpoint}};
    /// use rigidtap::sim::{Plant, PlantOptions};
    /// let mut plant = Plant::new(&Machine::reference(), &PlantOptions::default());
    /// plant.write(0.0, &Setpoint::default());
    /// assert_eq!(plant.read(0.001).spindle_counts, 0);
    /// ```
    #[must_use]
    pub fn new(machine: &Machine, options: &PlantOptions) -> Self {
        let PlantOptions { actual, effects, seed, z_start_mm } = options;
        let (control, drive) = (machine.spec().control, machine.spec().drive);
        let mut random = Pcg64Mcg::seed_from_u64(*seed);
        let tick_s = drive.period_s;
        let steps_per_tick = (tick_s / MAX_STEP_S - 1e-9).ceil().max(1.0);
        let step_s = tick_s / steps_per_tick;
        let interpolator = |start| Interpolator::at_rest(start, control.period_s, drive.latency_periods);
        Self {
            spindle: Spindle::new(machine, actual, *effects, tick_s, step_s),
            spindle_command: interpolator(0.0),
            z: ZAxis::new(machine, actual, *effects, tick_s, step_s, *z_start_mm, &mut random),
            z_command: interpolator(*z_start_mm),
            work_piece: WorkPiece::new(machine, actual.cutting_torque, *effects, tick_s),
            random,
            tick_s,
            ticks_per_period: (control.period_s / tick_s).round() as u32,
            steps_per_tick: steps_per_tick as u32,
            torque_saturated: false,
            mean_torque_nm: 0.0,
            mean_force_n: 0.0,
        }
    }
}

impl Plant {
    /// The drives are enabled as long as the machine runs.
    fn reported_state(&self) -> AxisStatus {
        AxisStatus { drive: Some(DriveState::Ready), ..AxisStatus::default() }
    }
}

impl Port for Plant {
    fn read(&mut self, _now_s: f64) -> Feedback {
        let (spindle_rev, spindle_speed) = self.spindle.at_encoder();
        let (z_mm, z_speed) = self.z.at_encoder();
        let (motor_mm, motor_speed) = self.z.at_motor();
        Feedback {
            spindle_counts: self.spindle.encoder.counts(spindle_rev, spindle_speed, &mut self.random),
            z_counts: self.z.encoder.counts(z_mm, z_speed, &mut self.random),
            z_motor_counts: Some(self.z.motor_encoder.counts(motor_mm, motor_speed, &mut self.random)),
            spindle_torque_nm: Some(self.mean_torque_nm),
            z_force_n: Some(self.mean_force_n),
            spindle: AxisStatus { saturated: Some(self.torque_saturated), ..self.reported_state() },
            z: self.reported_state(),
        }
    }

    fn write(&mut self, _now_s: f64, setpoint: &Setpoint) {
        self.spindle_command.push(setpoint.spindle, setpoint.spindle_torque_nm);
        self.z_command.push(setpoint.z, setpoint.z_force_n);
        self.torque_saturated = false;
        let (mut torque_nm, mut force_n) = (0.0, 0.0);
        for tick in 0..self.ticks_per_period {
            let since_s = f64::from(tick) * self.tick_s;
            self.torque_saturated |= self.spindle.tick(self.spindle_command.at(since_s));
            let z_command = self.z_command.at(since_s);
            // The force limit is far above what tapping takes; the report speaks of the spindle's torque alone.
            let _z_saturated = self.z.tick(z_command);
            let inwards = z_command.0.velocity <= 0.0;
            let cutting_nm = self.work_piece.torque_nm(self.z.table_mm(), inwards, &mut self.random);
            for _ in 0..self.steps_per_tick {
                self.spindle.step(cutting_nm);
                self.z.step();
            }
            torque_nm += self.spindle.current_nm();
            force_n += self.z.force_n();
        }
        let ticks = f64::from(self.ticks_per_period);
        (self.mean_torque_nm, self.mean_force_n) = (torque_nm / ticks, force_n / ticks);
    }

    fn begin_hole(&mut self, cycle: &TapCycle) {
        self.work_piece.begin_hole(cycle);
        self.z.begin_hole(&mut self.random);
    }

    fn truth(&self) -> Option<Truth> {
        Some(Truth {
            spindle_rev: self.spindle.tool_rev(),
            z_mm: self.z.table_mm(),
            spindle_rpm: self.spindle.speed_rpm(),
            spindle_torque_nm: self.spindle.torque_nm(),
            z_force_n: self.z.force_n(),
        })
    }
}
