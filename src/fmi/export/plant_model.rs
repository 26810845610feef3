//! Our machine.

use super::model::{Model, check_step};
use super::numbers::place;
use super::stored::Stored;
use crate::config::MachineFile;
use crate::control::cycle::{Hand, TapCycle};
use crate::control::math::poly::State;
use crate::control::port::{DriveState, Port, Setpoint};
use crate::fmi::variables::{BOTTOM, HAND, HOLE, INPUT_COUNT, OUTPUT_COUNT, PARAMETERS, PITCH, POWER_ON, R_PLANE};
use crate::run::RunSettings;
use crate::sim::{Effects, MOST_FAULTS, Plant, PlantOptions};

/// Our machine with its inputs and outputs.
pub(super) struct PlantModel {
    file: MachineFile,
    effects: Effects,
    inputs: [f64; INPUT_COUNT],
    outputs: [f64; OUTPUT_COUNT],
    /// Seed, and where Z stands at first.
    parameters: [f64; PARAMETERS.len()],
    plant: Option<Plant>,
    hole: f64,
    powered: bool,
    periods: u64,
}

impl PlantModel {
    pub(super) fn new(stored: &Stored) -> Result<Self, String> {
        let mut inputs = [0.0; INPUT_COUNT];
        (inputs[POWER_ON], inputs[HAND], inputs[PITCH]) = (1.0, 1.0, 1.0);
        Ok(Self {
            file: stored.machine_file()?,
            effects: stored.effects,
            inputs,
            outputs: [0.0; OUTPUT_COUNT],
            parameters: [1.0, RunSettings::default().start_mm[2]],
            plant: None,
            hole: 0.0,
            powered: true,
            periods: 0,
        })
    }

    fn setpoint(&self) -> Setpoint {
        let [rev, rev_per_s, rev_per_s2, rev_per_s3, mm, mm_per_s, mm_per_s2, mm_per_s3, x, y, torque_nm, force_n, ..] =
            self.inputs;
        let still = |position| State { position, ..State::default() };
        Setpoint {
            spindle: State { position: rev, velocity: rev_per_s, acceleration: rev_per_s2, jerk: rev_per_s3 },
            x: still(x),
            y: still(y),
            z: State { position: mm, velocity: mm_per_s, acceleration: mm_per_s2, jerk: mm_per_s3 },
            spindle_torque_nm: torque_nm,
            z_force_n: force_n,
        }
    }

    fn cycle(&self) -> TapCycle {
        let [r_plane_mm, bottom_mm, pitch_mm] = [R_PLANE, BOTTOM, PITCH].map(|place| self.inputs[place]);
        let hand = if self.inputs[HAND] < 0.0 { Hand::Left } else { Hand::Right };
        TapCycle { hand, ..TapCycle::right_hand(r_plane_mm, bottom_mm, pitch_mm, 1.0) }
    }

    /// What the machine tells at the beginning of the next period.
    fn tell(&mut self) {
        let now_s = self.periods as f64 * self.file.machine.spec().control.period_s;
        let Some(plant) = &mut self.plant else { return };
        let clock_s = plant.clock_s(now_s);
        let told = plant.read(now_s);
        let truth = plant.truth().unwrap_or_default();
        let switch = |on: bool| f64::from(u8::from(on));
        let ready = |drive: Option<DriveState>| switch(drive != Some(DriveState::NotReady));
        self.outputs = [
            told.spindle_counts as f64,
            told.z_counts as f64,
            told.z_motor_counts.unwrap_or(0) as f64,
            told.spindle_torque_nm.unwrap_or(0.0),
            told.z_force_n.unwrap_or(0.0),
            switch(told.spindle.sample_valid),
            switch(told.z.sample_valid),
            ready(told.spindle.drive),
            ready(told.z.drive),
            switch(told.spindle.saturated == Some(true)),
            switch(told.z.saturated == Some(true)),
            truth.spindle_rev,
            truth.z_mm,
            truth.spindle_rpm,
            truth.spindle_torque_nm,
            truth.z_force_n,
            clock_s,
        ];
    }
}

impl Model for PlantModel {
    fn set(&mut self, number: u32, value: f64) -> bool {
        match place(number) {
            Some((0, index)) => self.inputs[index] = value,
            Some((2, index)) => self.parameters[index] = value,
            _ => return false,
        }
        true
    }

    fn get(&self, number: u32) -> Option<f64> {
        match place(number)? {
            (0, index) => Some(self.inputs[index]),
            (1, index) => Some(self.outputs[index]),
            (2, index) => Some(self.parameters[index]),
            _ => None,
        }
    }

    fn begin(&mut self) -> Result<(), String> {
        let [seed, z_start_mm] = self.parameters;
        let options = PlantOptions {
            actual: self.file.actual,
            effects: self.effects,
            seed: seed as u64,
            z_start_mm,
            faults: [None; MOST_FAULTS],
        };
        self.plant = Some(Plant::new(&self.file.machine, &options));
        (self.hole, self.powered, self.periods) = (0.0, true, 0);
        self.tell();
        Ok(())
    }

    /// In the order of the only loop: the setpoint, a hole that begins with the next period, and what that period reads.
    fn step(&mut self, step_s: f64) -> Result<(), String> {
        let period_s = self.file.machine.spec().control.period_s;
        check_step(step_s, period_s)?;
        let (setpoint, cycle) = (self.setpoint(), self.cycle());
        let now_s = self.periods as f64 * period_s;
        let powered = self.inputs[POWER_ON] != 0.0;
        if let Some(plant) = &mut self.plant {
            if powered != self.powered {
                self.powered = powered;
                plant.set_power(powered);
            }
            plant.write(now_s, &setpoint);
            if self.inputs[HOLE] != self.hole {
                self.hole = self.inputs[HOLE];
                plant.begin_hole(&cycle);
            }
        }
        self.periods += 1;
        self.tell();
        Ok(())
    }
}
