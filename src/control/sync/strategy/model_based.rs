//! Both axes commanded by the model of the plant, so that spindle and Z move as one without a correction.
//!
//! A setpoint commanded now acts `latency` later, and its effort moves the spindle an effort lag after that. Everything is laid
//! to the instant at which the spindle moves: Z's force is commanded as much earlier as Z's own lag asks, and both drives'
//! references say what their encoders will then read, so that no loop sees an error where there is none.

use crate::control::cycle::CyclePlan;
use crate::control::machine::{DriveSpec, Machine, SyncSpec, Takes};
use crate::control::math::poly::State;
use crate::control::sync::adaptation::Adaptation;
use crate::control::sync::feedforward::{
    PositionLoopInverse, SpindleFeedforward, ZConfig, ZDelays, ZFeedforward, ZRest,
};
use crate::control::sync::frame::{AxisCommands, Measured};
use crate::control::sync::in_position::{START_WITH_OFFSET, Window};
use crate::control::sync::observer::SpindleObserver;
use crate::control::sync::plant_model::{Cut, Identified, IdentifiedDrives, IdentifiedLatency, IdentifiedZ};
use crate::control::sync::trajectory::{CommandedMotion, TimeScaling, TorqueDemand, Trajectory};
use crate::control::units::mm_from_um;

use super::settings::{Mode, Settings};
use super::synchronise::{Command, Inputs, Synchronise};

/// Delays of the drives and encoders, all against the instant that the plan is commanded for.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Delays {
    /// From the newest commanded period back to what the spindle did when its newest sample was taken.
    measured_s: f64,
    /// To what the spindle's position loop reads when the command acts.
    position_s: f64,
    /// To what its velocity loop reads then.
    velocity_s: f64,
    /// The same two for Z, whose command may act at another time.
    z_position_s: f64,
    z_velocity_s: f64,
    /// To what Z did in the middle of the period that its newest force is the mean of.
    force_s: f64,
    z: ZDelays,
    /// From a sample to the instant that a command made from it acts.
    horizon_s: f64,
}

impl Delays {
    fn new(machine: &Machine, latency: &IdentifiedLatency) -> Self {
        let spec = machine.spec();
        let (drive, period_s) = (&spec.drive, spec.control.period_s);
        let IdentifiedLatency { spindle_s: latency_s, z_s: z_latency_s } = *latency;
        let z_later_s = z_latency_s - latency_s;
        let half_tick_s = drive.period_s / 2.0;
        let (spindle_effort_s, z_effort_s) =
            (spec.spindle.torque_lag_s + half_tick_s, spec.z_axis.torque_lag_s + half_tick_s);
        let velocity_s = spindle_effort_s + drive.velocity_filter_s + half_tick_s;
        let position_s = spindle_effort_s + drive.encoder_latency_s;
        let measured_s = latency_s + spindle_effort_s + drive.encoder_latency_s;
        Self {
            measured_s,
            position_s,
            velocity_s,
            z_position_s: position_s - z_later_s,
            z_velocity_s: velocity_s - z_later_s,
            force_s: latency_s + spindle_effort_s + 0.5 * period_s,
            z: ZDelays {
                acting_s: z_later_s + z_effort_s - spindle_effort_s,
                read_s: z_later_s - velocity_s,
                position_s: z_later_s - position_s,
            },
            horizon_s: z_latency_s + drive.encoder_latency_s,
        }
    }
}

/// What is the same for every hole of a plan.
#[derive(Clone, Debug, PartialEq)]
struct Config {
    settings: Settings,
    drive: DriveSpec,
    sync: SyncSpec,
    period_s: f64,
    delays: Delays,
    z: ZConfig,
    demand: TorqueDemand,
}

/// The blocks of a hole under way.
#[derive(Clone, Debug, PartialEq)]
struct Active {
    /// Z as it was known at the hole's start.
    z_known: IdentifiedZ,
    time_scaling: TimeScaling,
    commanded: CommandedMotion,
    observer: SpindleObserver,
    spindle: SpindleFeedforward,
    spindle_inverse: PositionLoopInverse,
    z: ZFeedforward,
    z_inverse: PositionLoopInverse,
    /// Whether the hole's first period is over.
    moving: bool,
}

/// One hole by the model of the plant.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync) struct ModelBased {
    config: Config,
    active: Option<Active>,
}

impl ModelBased {
    pub(super) fn new(plan: &CyclePlan, machine: &Machine, settings: Settings) -> Self {
        let spec = machine.spec();
        let delays = Delays::new(machine, &IdentifiedLatency::nominal(machine));
        let config = Config {
            settings,
            drive: spec.drive,
            sync: spec.sync,
            period_s: spec.control.period_s,
            delays,
            z: ZConfig::new(machine, delays.z),
            demand: TorqueDemand::of(plan, machine),
        };
        Self { config, active: None }
    }
}

impl Config {
    /// Delays and gains as they were found.
    fn take_drives(&mut self, machine: &Machine, known: &Identified) {
        self.delays = Delays::new(machine, &known.latency);
        self.z = ZConfig::new(machine, self.delays.z);
        let IdentifiedDrives { spindle, z } = known.drives;
        self.drive.spindle_position_gain_per_s = spindle.position_gain_per_s;
        self.drive.spindle_velocity_gain_per_s = spindle.velocity_gain_per_s;
        self.drive.z_position_gain_per_s = z.position_gain_per_s;
        self.drive.z_velocity_gain_per_s = z.velocity_gain_per_s;
    }

    /// The blocks, for a spindle that rests at an angle of the plan.
    fn activate(
        &self,
        known: &Identified,
        measured: &Measured,
        adaptation: &Adaptation,
        plan: &CyclePlan,
        rest_rev: f64,
    ) -> Active {
        let Self { drive, sync, period_s, .. } = self;
        let machine = plan.machine();
        let residual = adaptation.residual();
        let held_n = match measured.z_force_n {
            Some(force_n) => known.z.weight_n + force_n,
            None => adaptation.identification.resting_friction_n(known.z.friction_n),
        };
        let inertia_ratio = known.spindle.inertia_ratio;
        Active {
            z_known: known.z,
            time_scaling: TimeScaling::new(
                sync.governor_per_s,
                machine.spec().spindle.supply_sag_ratio,
                self.demand,
                &known.spindle,
            ),
            commanded: CommandedMotion::at_rest(*period_s, rest_rev),
            observer: SpindleObserver::of_tracking_error(drive, *period_s, sync.observer_rad_per_s, inertia_ratio),
            spindle: SpindleFeedforward::new(machine, plan.cycle(), inertia_ratio),
            spindle_inverse: PositionLoopInverse::new(drive.spindle_position_gain_per_s, *period_s, 0.0),
            z: ZFeedforward::new(
                self.z,
                &known.z,
                &ZRest {
                    held_n,
                    fed_n: -residual.z_force_n,
                    lead_mm: known.z.deflection_from_middle_mm(measured.deflection_mm()),
                    load_mm: plan.thread().pitch_mm * rest_rev,
                    encoder_mm: measured.load_mm,
                },
                Cut::of(plan, 0.0),
            ),
            z_inverse: PositionLoopInverse::new(drive.z_position_gain_per_s, *period_s, -residual.z.position),
            moving: false,
        }
    }

    /// What Z takes over of the spindle's tracking error at the instant that Z acts; `measured` and `planned` are the
    /// spindle's.
    fn coupled(&self, observer: &SpindleObserver, measured: &State, planned: &State, pitch_mm: f64) -> State {
        let ahead = observer.predict(self.delays.horizon_s);
        match self.settings.mode {
            Mode::Commanded => {
                // d³/(d² + z²): nothing of the noise, all of what counts, and smooth between.
                let zone_rev = mm_from_um(self.sync.dead_zone_um) / pitch_mm;
                let square = ahead.position * ahead.position;
                let share = if zone_rev > 0.0 { square / (square + zone_rev * zone_rev) } else { 1.0 };
                let slope = share * (3.0 - 2.0 * share);
                State { position: share * ahead.position, velocity: slope * ahead.velocity, ..State::default() }
            }
            Mode::FollowingPredicted => State { acceleration: 0.0, ..ahead },
            // As it was measured: what the plan knows of the time since is taken back.
            Mode::Following => State {
                position: measured.position - planned.position,
                velocity: measured.velocity - planned.velocity,
                ..State::default()
            },
        }
    }
}

impl Synchronise for ModelBased {
    /// The latency, the spindle's effort, and Z's motor perhaps still crossing its backlash.
    fn tail_s(&self) -> f64 {
        self.config.delays.measured_s - self.config.drive.encoder_latency_s + self.config.z.look_ahead_s()
    }

    fn start(&self) -> (Window, bool) {
        (START_WITH_OFFSET, true)
    }

    fn begin(&mut self, plan_s: f64, trajectory: &mut Trajectory, measured: &Measured, adaptation: &mut Adaptation) {
        let rest_rev = trajectory.at(plan_s).spindle.position;
        let pitch_mm = trajectory.plan().thread().pitch_mm;
        adaptation.identification.note_tap(trajectory.plan(), measured.load_mm - pitch_mm * rest_rev);
        let known = adaptation.known(self.config.settings.identify);
        self.config.take_drives(trajectory.plan().machine(), &known);
        let mut active = self.config.activate(&known, measured, adaptation, trajectory.plan(), rest_rev);
        adaptation.begin_hole(trajectory.plan());
        let (thread, acting_s) = (trajectory.plan().thread(), self.config.delays.z.acting_s);
        for periods in 0..self.config.z.look_ahead_periods() {
            let ahead_s = active.time_scaling.rate() * (acting_s + f64::from(periods) * self.config.period_s);
            let planned = active.time_scaling.on_the_clock(&trajectory.at(plan_s + ahead_s).spindle);
            active.z.prime(&thread.follow(&planned));
        }
        self.active = Some(active);
    }

    fn step(&mut self, trajectory: &mut Trajectory, inputs: &Inputs<'_>, adaptation: &mut Adaptation) -> Command {
        let (config, delays) = (&self.config, &self.config.delays);
        let measured = inputs.measured;
        adaptation.observe_measured(measured);
        let Some(active) = &mut self.active else {
            let plan_s = trajectory.plan_s(inputs.now_s);
            let planned = trajectory.at(plan_s);
            let axes = AxisCommands::default();
            return Command {
                axes,
                z_offset_mm: 0.0,
                correction_mm: 0.0,
                unseen_mm: 0.0,
                plan_s,
                planned,
                path_rate: 1.0,
            };
        };
        let Active { time_scaling, commanded, observer, z, .. } = active;
        if active.moving {
            time_scaling.step(&adaptation.identification.spindle(), config.period_s);
            trajectory.scale_time(time_scaling.rate());
        }
        active.moving = true;

        // The plan is looked at four times a period. What need not be exact where an acceleration steps is read from what was
        // commanded, and so is everything before the plan's last change.
        let plan_s = trajectory.joint_safe_plan_s(inputs.now_s);
        let planned = trajectory.at(plan_s);
        let now = time_scaling.on_the_clock(&planned.spindle);
        commanded.push(&now);
        let mut at = |after_s: f64| {
            let t_s = plan_s + time_scaling.rate() * after_s;
            let state = if after_s < 0.0 { trajectory.past(t_s) } else { Some(trajectory.at(t_s).spindle) };
            state.map_or_else(|| commanded.at(-after_s), |state| time_scaling.on_the_clock(&state))
        };
        let (acting, ahead) = (at(delays.z.acting_s), at(delays.z.acting_s + config.z.look_ahead_s()));
        let position_read = at(-delays.position_s);
        let velocity_read = commanded.at(delays.velocity_s).velocity;
        // A Z that acts as late as it reads, and later, is commanded from what the plan has ahead.
        let mut z_at = |ago_s: f64| if ago_s < 0.0 { at(-ago_s) } else { commanded.at(ago_s) };
        let (z_position_read, z_velocity_read) = (z_at(delays.z_position_s), z_at(delays.z_velocity_s).velocity);

        let travel = inputs.travel;
        observer.update(travel.spindle_rev - commanded.at(delays.measured_s).position, measured.torque_saturated);
        let (spindle_position, spindle_velocity) =
            active.spindle_inverse.command(position_read.position, position_read.velocity, velocity_read);

        let thread = trajectory.plan().thread();
        let measured_ago_s = delays.z.acting_s + delays.measured_s;
        if let Some(deflection_mm) = active.z_known.deflection_from_middle_mm(measured.deflection_mm()) {
            z.observe_deflection(deflection_mm, measured_ago_s);
        }
        // What an encoder on the motor sees beside the load is no error of the thread.
        let unseen_mm = z.unseen_mm(measured_ago_s);
        let repeatable_mm = z.repeatable_share(measured_ago_s) * (inputs.error_mm - unseen_mm);
        adaptation.learning.observe(plan_s - time_scaling.rate() * delays.measured_s, repeatable_mm);
        let extra = z.step(&thread.follow(&acting), &thread.follow(&ahead));
        if let Some(force_n) = measured.z_force_n.filter(|_| config.settings.identify) {
            z.observe_force(active.z_known.weight_n + force_n, &thread.follow(&commanded.at(delays.force_s)));
        }
        let load = thread.follow(&z_position_read);
        let motor_velocity = thread.pitch_mm * z_velocity_read + extra.motor_velocity_mm_per_s;
        let (z_position, z_velocity) = active.z_inverse.command(
            load.position + extra.encoder_mm,
            load.velocity + extra.encoder_mm_per_s,
            motor_velocity,
        );

        // The position loop that a drive of a speed alone does not have.
        let looped = match config.drive.spindle_takes {
            Takes::Speed => config.drive.spindle_position_gain_per_s * observer.predict(delays.measured_s).position,
            _ => 0.0,
        };
        let spindle_measured =
            State { position: travel.spindle_rev, velocity: inputs.spindle_rev_per_s, ..State::default() };
        let coupled = thread.follow(&config.coupled(observer, &spindle_measured, &position_read, thread.pitch_mm));
        let learned = if config.settings.learn { adaptation.learning.correction(plan_s) } else { State::default() };
        let correction_mm = coupled.position + learned.position;
        Command {
            unseen_mm,
            axes: AxisCommands {
                spindle: State { position: spindle_position, velocity: spindle_velocity - looped, ..now },
                z: State {
                    position: z_position + correction_mm,
                    velocity: z_velocity + coupled.velocity + learned.velocity * time_scaling.rate(),
                    acceleration: thread.pitch_mm * acting.acceleration + extra.acceleration_mm_per_s2,
                    jerk: 0.0,
                },
                spindle_torque_nm: active.spindle.torque_nm(&now),
                z_force_n: extra.friction_n,
            },
            z_offset_mm: 0.0,
            correction_mm,
            plan_s,
            planned,
            path_rate: time_scaling.rate(),
        }
    }

    fn finish(&self, adaptation: &mut Adaptation, interrupted: bool, z_mm: f64, z_force_n: f64) {
        adaptation.hand_over.leave(z_mm, z_force_n);
        if self.config.settings.learn && !interrupted {
            adaptation.learning.finish();
        }
    }
}
