//! The plant as a port: setpoints in, encoder counts out.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

use crate::control::cycle::TapCycle;
use crate::control::machine::{Machine, Takes};
use crate::control::port::{AxisStatus, DriveState, Feedback, Port, Setpoint, Truth};

use super::actual::Actual;
use super::effects::{Effect, Effects};
use super::fault::{Axis, AxisFault, Fault, Injection};
use super::host::{Host, stream};
use super::injector::{Injector, MOST_FAULTS};
use super::interpolator::Interpolator;
use super::spindle::Spindle;
use super::work_piece::{TapState, WorkPiece};
use super::z_axis::ZAxis;

/// Longest plant step: a fortieth of a period of the highest default resonance.
const MAX_STEP_S: f64 = 25e-6;

/// Time in which Z comes to rest under its weight before the program's start: six time constants of its position loop.
const SETTLE_S: f64 = 0.15;
/// Force of what pushes Z: a fault.
const PUSH_N: f64 = -5_000.0;

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
    /// What goes wrong, and when.
    pub faults: [Option<Injection>; MOST_FAULTS],
}

impl Default for PlantOptions {
    fn default() -> Self {
        Self {
            actual: Actual::default(),
            effects: Effects::FULL,
            seed: 1,
            z_start_mm: 0.0,
            faults: [None; MOST_FAULTS],
        }
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
    host: Host,
    faults: Injector,
    tick_s: f64,
    ticks_per_period: u32,
    steps_per_tick: u32,
    /// Periods since the start, those that the host missed too.
    periods: u64,
    /// Those that the host missed.
    missed_periods: u64,
    period_s: f64,
    /// The drives have power.
    powered: bool,
    /// Z's setpoints carry no velocity, so that the drive does not know its direction.
    z_takes_position: bool,
    /// Velocity of the last setpoint of Z.
    z_velocity: f64,
    /// The thread's hand: sign of the spindle's turning on the way in.
    hand: f64,
    effort_resolution: f64,
    reports_effort: bool,
    torque_saturated: bool,
    z_saturated: bool,
    /// Over the last period, as the drives know them.
    mean_torque_nm: f64,
    mean_force_n: f64,
    /// The last reading, which a stale one repeats.
    last: Option<Feedback>,
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
        let PlantOptions { actual, effects, seed, z_start_mm, faults } = options;
        let actual = &actual.under(*effects);
        let (control, drive) = (machine.spec().control, machine.spec().drive);
        let mut random = Pcg64Mcg::seed_from_u64(*seed);
        let tick_s = drive.period_s;
        let steps_per_tick = (tick_s / MAX_STEP_S - 1e-9).ceil().max(1.0) as u32;
        let phase_turns = |effect| stream(*seed, effect).random::<f64>();
        let latency_periods =
            drive.latency_periods + actual.setpoint_latency_periods + actual.setpoint_latency_s / control.period_s;
        let interpolator = |start, takes| Interpolator::at_rest(start, takes, control.period_s, latency_periods);
        let eccentricity_turns = phase_turns(Effect::Eccentricity);
        let mut z = ZAxis::new(machine, actual, *effects, tick_s, steps_per_tick, *z_start_mm, &mut random);
        z.set_screw_phase(phase_turns(Effect::ScrewError));
        let mut plant = Self {
            spindle: Spindle::new(machine, actual, *effects, tick_s, steps_per_tick, eccentricity_turns),
            spindle_command: interpolator(0.0, drive.spindle_takes),
            z,
            z_command: interpolator(*z_start_mm, drive.z_takes),
            work_piece: WorkPiece::new(machine, actual, *effects, tick_s),
            random,
            host: Host::new(actual, *seed),
            faults: Injector::new(*faults, control.period_s),
            tick_s,
            ticks_per_period: (control.period_s / tick_s).round() as u32,
            steps_per_tick,
            periods: 0,
            missed_periods: 0,
            period_s: control.period_s,
            powered: true,
            z_takes_position: drive.z_takes == Takes::Position,
            z_velocity: 0.0,
            hand: 1.0,
            effort_resolution: actual.effort_resolution,
            reports_effort: actual.reports_effort,
            torque_saturated: false,
            z_saturated: false,
            mean_torque_nm: 0.0,
            mean_force_n: 0.0,
            last: None,
        };
        if actual.z_weight_n != 0.0 || actual.screw_error_um != 0.0 {
            plant.settle();
        }
        plant
    }

    /// The machine's own time, s from its start: ahead of a host that has missed periods.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.periods as f64 * self.period_s
    }

    /// Z hangs on its drive before the program starts: its brake was released at rest.
    fn settle(&mut self) {
        for _ in 0..(SETTLE_S / self.tick_s) as u32 {
            let command = self.z_command.at(0.0);
            let _saturated = self.z.tick(command);
            (0..self.steps_per_tick).for_each(|_| self.z.step());
        }
        self.z.measure_tool();
    }

    fn axis_status(saturated: bool) -> AxisStatus {
        AxisStatus { saturated: Some(saturated), drive: Some(DriveState::Ready), ..AxisStatus::default() }
    }

    /// An effort as a drive reports it, in steps of its resolution.
    fn reported(&self, effort: f64, most: f64) -> Option<f64> {
        let step = self.effort_resolution * most;
        let value = if step > 0.0 { (effort / step).round() * step } else { effort };
        self.reports_effort.then_some(value)
    }

    fn measure(&mut self, late_s: f64) -> Feedback {
        let (spindle_rev, spindle_speed) = self.spindle.at_encoder();
        let (z_mm, z_speed) = self.z.at_encoder();
        let (motor_mm, motor_speed) = self.z.at_motor();
        Feedback {
            spindle_counts: self.spindle.encoder.counts(spindle_rev, spindle_speed, late_s, &mut self.random),
            z_counts: self.z.encoder.counts(z_mm, z_speed, late_s, &mut self.random),
            z_motor_counts: Some(self.z.motor_encoder.counts(motor_mm, motor_speed, late_s, &mut self.random)),
            spindle_torque_nm: self.reported(self.mean_torque_nm, self.spindle.rated_nm()),
            z_force_n: self.reported(self.mean_force_n, self.z.force_limit_n()),
            spindle: Self::axis_status(self.torque_saturated),
            z: Self::axis_status(self.z_saturated),
        }
    }

    /// Faults that lie in the machine itself.
    fn break_machine(&mut self) {
        let faults = &self.faults;
        let on = |axis, fault| faults.is_axis_on(axis, fault);
        let enabled = |axis| self.powered && !on(axis, AxisFault::Trip) && !on(axis, AxisFault::Coast);
        self.spindle.set_power(enabled(Axis::Spindle), on(Axis::Spindle, AxisFault::Weak));
        self.z.set_power(enabled(Axis::Z), on(Axis::Z, AxisFault::Weak), faults.is_on(Fault::ZCaught));
        let frozen = |is_on: bool, held: Option<f64>, position: f64| is_on.then(|| held.unwrap_or(position));
        let (spindle_frozen, z_frozen) =
            (on(Axis::Spindle, AxisFault::EncoderFrozen), on(Axis::Z, AxisFault::EncoderFrozen));
        self.spindle.encoder.frozen = frozen(spindle_frozen, self.spindle.encoder.frozen, self.spindle.at_encoder().0);
        self.z.encoder.frozen = frozen(z_frozen, self.z.encoder.frozen, self.z.at_encoder().0);
    }

    fn tap_state(&self) -> TapState {
        if self.faults.is_on(Fault::TapJam) {
            TapState::Jammed
        } else if self.faults.is_on(Fault::TapBroken) {
            TapState::Broken
        } else {
            TapState::Whole
        }
    }

    /// Moves on by one interpolation period. Setpoints came so late as the host was.
    fn run_period(&mut self, late_s: f64) {
        let tap_state = if self.faults.is_idle() { TapState::Whole } else { self.tap_state() };
        let pushed_n = if self.faults.is_on(Fault::ZPushed) { PUSH_N } else { 0.0 };
        (self.torque_saturated, self.z_saturated) = (false, false);
        let (mut torque_nm, mut force_n) = (0.0, 0.0);
        for tick in 0..self.ticks_per_period {
            let since_s = f64::from(tick) * self.tick_s - late_s;
            self.torque_saturated |= self.spindle.tick(self.spindle_command.at(since_s));
            let z_command = self.z_command.at(since_s);
            self.z_saturated |= self.z.tick(z_command);
            let velocity = if self.z_takes_position { self.z_velocity } else { z_command.0.velocity };
            let inwards = velocity <= 0.0;
            let cut = self.work_piece.cut(self.z.tip_mm(), inwards, tap_state, &mut self.random);
            self.z.push(pushed_n - cut.along_n * self.hand * self.spindle.turning());
            self.run_tick(cut.torque_nm);
            torque_nm += self.spindle.current_nm();
            force_n += self.z.force_n();
        }
        let ticks = f64::from(self.ticks_per_period);
        (self.mean_torque_nm, self.mean_force_n) = (torque_nm / ticks, force_n / ticks);
        self.periods += 1;
    }
}

impl Plant {
    /// The steps of one drive tick under a cutting torque.
    #[inline(always)]
    fn run_tick(&mut self, cutting_nm: f64) {
        let Self { spindle, z, .. } = self;
        if let (Some(commanded_nm), Some(mut z)) = (spindle.commanded_of_tick_nm(), z.plain_steps()) {
            for _ in 0..self.steps_per_tick {
                spindle.step(commanded_nm, cutting_nm);
                z.step();
            }
            return;
        }
        for _ in 0..self.steps_per_tick {
            let commanded_nm = spindle.commanded_nm();
            spindle.step(commanded_nm, cutting_nm);
            z.step();
        }
    }
}

impl Port for Plant {
    fn read(&mut self, _now_s: f64) -> Feedback {
        let late_s = self.host.begin_period();
        self.faults.set_time(self.time_s());
        let mut read = self.measure(late_s);
        if !self.faults.is_idle() {
            let most = [self.spindle.rated_nm(), self.z.force_limit_n()];
            read = self.faults.distort(read, most);
        }
        let read = self.last.filter(|_| self.host.is_stale).unwrap_or(read);
        self.last = Some(read);
        read
    }

    fn write(&mut self, _now_s: f64, setpoint: &Setpoint) {
        self.faults.set_time(self.time_s());
        if !self.faults.is_idle() {
            self.break_machine();
        }
        if self.faults.is_on(Fault::SetpointLost) {
            self.spindle_command.push_missing();
            self.z_command.push_missing();
        } else {
            self.spindle_command.push(setpoint.spindle, setpoint.spindle_torque_nm);
            self.z_command.push(setpoint.z, setpoint.z_force_n);
        }
        self.z_velocity = setpoint.z.velocity;
        self.host.command(setpoint.z.position);
        self.run_period(self.host.late_s());
        if self.host.misses_next {
            // The machine goes on; the host, which counts its own periods, does not know.
            self.spindle_command.push_missing();
            self.z_command.push_missing();
            self.run_period(0.0);
            self.missed_periods += 1;
        }
    }

    fn set_power(&mut self, is_on: bool) {
        if is_on && !self.powered {
            let spindle_rev = self.spindle.restart_drive();
            let z_mm = self.z.restart_drive();
            self.spindle_command.hold(spindle_rev);
            self.z_command.hold(z_mm);
        }
        self.powered = is_on;
        self.break_machine();
    }

    fn clock_s(&mut self, now_s: f64) -> f64 {
        self.faults.set_time(self.time_s());
        self.faults.clock_s(now_s + self.missed_periods as f64 * self.period_s)
    }

    fn begin_hole(&mut self, cycle: &TapCycle) {
        self.hand = cycle.hand.sign();
        self.work_piece.begin_hole(cycle);
        self.z.begin_hole(&mut self.random);
        self.host.begin_hole(cycle);
    }

    fn truth(&self) -> Option<Truth> {
        Some(Truth {
            spindle_rev: self.spindle.tool_rev(),
            z_mm: self.z.tip_mm(),
            spindle_rpm: self.spindle.speed_rpm(),
            spindle_torque_nm: self.spindle.torque_nm(),
            z_force_n: self.z.force_n(),
        })
    }
}
