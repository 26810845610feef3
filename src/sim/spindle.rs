//! The spindle: a motor that cannot pass its torque–speed curve, two inertias, friction, and its drive.

use crate::control::machine::{Machine, SpindleEncoderAt, Takes};
use crate::control::math::{exp, poly::State};
use crate::control::model::cascade::{Cascade, CascadeGains, Measured};
use crate::control::model::two_mass::TwoMass;
use crate::control::motor::{CurvePiece, TorqueCurve};
use crate::control::units::{RAD_PER_REV, rev_from_rad, rpm_from_rev_per_s};

use super::actual::Actual;
use super::effects::{Effect, Effects};
use super::effort_delay::EffortDelay;
use super::encoder::{Eccentricity, Encoder};
use super::friction::preslide;
use super::gap::Gap;
use super::inertias::Inertias;
use super::wave::sin_turns;

/// Counts of one signal period: a 1024-line encoder at the reference machine's 16384 counts.
const COUNTS_PER_LINE: f64 = 16.0;
/// Periods of the torque ripple per revolution: six for each of four pole pairs.
const RIPPLE_PER_REV: f64 = 24.0;
/// Angle over which friction and cutting torque turn round with the direction: a smooth sign.
const REVERSAL_REV: f64 = 0.001;
/// Resonance and damping that stand for a rigid shaft.
const RIGID: (f64, f64) = (5000.0, 1.0);

/// Seconds of arc in a revolution.
const ARCSEC_PER_REV: f64 = 1_296_000.0;
/// What is left of the torque when the motor has lost half of it: a fault.
const WEAK: f64 = 0.5;

/// Share of a tick's limit below which the torque cannot meet the curve within that tick.
const NEAR_LIMIT: f64 = 0.8;

/// The spindle with its state.
#[derive(Clone, Debug)]
pub(crate) struct Spindle {
    drive: Cascade,
    pub(crate) encoder: Encoder,
    encoder_at: SpindleEncoderAt,
    inertias: Inertias,
    curve: TorqueCurve,
    /// The curve where the speed was last.
    piece: CurvePiece,
    limit_factor: f64,
    full_power_nm_rpm: f64,
    torque_constant: f64,
    /// What of it is lost for each rpm.
    torque_constant_fall_per_rpm: f64,
    /// The constant at the tick's speed.
    torque_factor: f64,
    ripple: f64,
    lag_share: f64,
    coulomb_nm: f64,
    viscous_nm_s_per_rad: f64,
    sag_ratio: f64,
    sag_share: f64,
    /// Share of a reversal that one step at 1 rad/s covers.
    reversal_s_per_rad: f64,
    sag: f64,
    commanded_nm: EffortDelay,
    enabled: bool,
    weak: bool,
    limit_nm: f64,
    /// Torque as the current loop's lag leaves it of the command.
    lagged_nm: f64,
    /// What the motor really gives.
    torque_nm: f64,
    friction_state: f64,
    cutting_state: f64,
}

impl Spindle {
    pub(crate) fn new(
        machine: &Machine,
        actual: &Actual,
        effects: Effects,
        tick_s: f64,
        steps_per_tick: u32,
        eccentricity_phase_turns: f64,
    ) -> Self {
        let step_s = tick_s / f64::from(steps_per_tick);
        let (spec, drive) = (&machine.spec().spindle, &machine.spec().drive);
        let (resonance_hz, damping) = if effects.has(Effect::SpindleResonance) {
            (spec.resonance_hz * actual.spindle_resonance, spec.damping_ratio)
        } else {
            RIGID
        };
        let tool = spec.tool_inertia_kg_m2 * actual.inertia;
        let motor = spec.inertia_kg_m2 * actual.inertia - tool;
        let gains = CascadeGains {
            period_s: tick_s,
            position_gain_per_s: match drive.spindle_takes {
                Takes::Speed => 0.0,
                _ => drive.spindle_position_gain_per_s * actual.drive_gain,
            },
            velocity_gain_per_s: drive.spindle_velocity_gain_per_s * actual.drive_gain,
            integral_s: drive.spindle_integral_s,
            velocity_filter_s: drive.velocity_filter_s,
            effort_per_acceleration: spec.inertia_kg_m2 * RAD_PER_REV,
        };
        let model = TwoMass::free_free(motor, tool, resonance_hz, damping);
        let curve = machine.motor().curve.clone();
        let full_power_nm_rpm =
            curve.points().iter().map(|point| point.speed_rpm * point.torque_nm).fold(0.0, f64::max);
        Self {
            drive: Cascade::new(gains, 0.0),
            encoder: Encoder {
                counts_per_unit: spec.encoder_counts_per_rev,
                latency_s: effects
                    .or_zero(Effect::EncoderLatency, actual.encoder_latency_of_s(drive.encoder_latency_s)),
                jitter_s: effects.or_zero(Effect::EncoderJitter, drive.encoder_jitter_s * actual.encoder_error),
                interpolation_counts: effects
                    .or_zero(Effect::Interpolation, drive.spindle_interpolation_counts * actual.encoder_error),
                period_counts: COUNTS_PER_LINE,
                eccentricity: (actual.spindle_eccentricity_arcsec != 0.0).then_some(Eccentricity {
                    amplitude: actual.spindle_eccentricity_arcsec / ARCSEC_PER_REV,
                    phase_turns: eccentricity_phase_turns,
                }),
                frozen: None,
            },
            encoder_at: spec.encoder_at,
            inertias: Inertias::new(model, Gap::new(&model, 0.0), [0.0; 2], step_s, 0.0),
            piece: curve.piece_at(0.0),
            curve,
            limit_factor: actual.torque_limit,
            full_power_nm_rpm,
            torque_constant: actual.torque_constant,
            torque_constant_fall_per_rpm: actual.torque_constant_fall / spec.max_rpm,
            torque_factor: actual.torque_constant,
            ripple: effects.or_zero(Effect::TorqueRipple, spec.torque_ripple),
            lag_share: lag_share(effects.or_zero(Effect::TorqueLag, spec.torque_lag_s), step_s),
            coulomb_nm: effects.or_zero(Effect::SpindleFriction, spec.coulomb_nm * actual.friction),
            viscous_nm_s_per_rad: rpm_from_rev_per_s(rev_from_rad(
                effects.or_zero(Effect::SpindleFriction, spec.viscous_nm_per_rpm * actual.friction),
            )),
            sag_ratio: effects.or_zero(Effect::SupplySag, spec.supply_sag_ratio),
            sag_share: lag_share(spec.supply_sag_s, tick_s),
            reversal_s_per_rad: step_s / (REVERSAL_REV * RAD_PER_REV),
            sag: 0.0,
            commanded_nm: EffortDelay::new(actual.drive_delay_periods, steps_per_tick),
            enabled: true,
            weak: false,
            limit_nm: 0.0,
            lagged_nm: 0.0,
            torque_nm: 0.0,
            friction_state: 0.0,
            cutting_state: 0.0,
        }
    }

    /// The greatest torque at a speed: the motor's curve, or the power that the supply still gives.
    fn limit_at_nm(&mut self, speed_rpm: f64) -> f64 {
        let speed_rpm = speed_rpm.abs();
        if !self.piece.holds(speed_rpm) {
            self.piece = self.curve.piece_at(speed_rpm);
        }
        let limit_factor = if self.weak { WEAK * self.limit_factor } else { self.limit_factor };
        let by_power = limit_factor * self.full_power_nm_rpm * (1.0 - self.sag) / speed_rpm.max(1.0);
        (limit_factor * self.piece.torque_nm(speed_rpm)).min(by_power)
    }

    /// The drive's tick: a new torque command. True where the curve cut it.
    pub(crate) fn tick(&mut self, (command, feedforward_nm): (State, f64)) -> bool {
        let speed_rpm = self.speed_rpm();
        let full_power = self.limit_factor * self.full_power_nm_rpm;
        let used = (self.torque_nm * speed_rpm).abs() / full_power;
        self.sag += self.sag_share * (self.sag_ratio * used.min(1.0) - self.sag);
        self.limit_nm = self.limit_at_nm(speed_rpm);

        let (position, velocity) = self.at_encoder();
        let measured = Measured {
            position: self.encoder.signal(position, velocity),
            // A frozen encoder on the motor holds the velocity loop's signal, too.
            motor_position: match (self.encoder_at, self.encoder.frozen) {
                (SpindleEncoderAt::Motor, Some(frozen)) => frozen,
                _ => rev_from_rad(self.inertias.motor_position()),
            },
        };
        if self.torque_constant_fall_per_rpm > 0.0 {
            let left = 1.0 - self.torque_constant_fall_per_rpm * speed_rpm.abs();
            self.torque_factor = self.torque_constant * left.max(0.0);
        }
        let answer = self.drive.step(&command, feedforward_nm, measured, self.limit_nm);
        self.commanded_nm.push(if self.enabled { answer.effort } else { 0.0 });
        answer.saturated && self.enabled
    }

    /// The torque that the drive asks for in all steps of this tick, where it is one.
    #[inline(always)]
    pub(crate) fn commanded_of_tick_nm(&self) -> Option<f64> {
        self.commanded_nm.of_tick()
    }

    /// The torque that the drive asks for in the next step.
    #[inline]
    pub(crate) fn commanded_nm(&mut self) -> f64 {
        self.commanded_nm.next()
    }

    /// One plant step under a torque that the drive asks for, and a cutting torque of this magnitude.
    #[inline(always)]
    pub(crate) fn step(&mut self, commanded_nm: f64, cutting_nm: f64) {
        self.lagged_nm += self.lag_share * (commanded_nm - self.lagged_nm);
        let ripple = if self.ripple > 0.0 {
            self.ripple * sin_turns(self.inertias.motor_position() * (RIPPLE_PER_REV / RAD_PER_REV))
        } else {
            0.0
        };
        self.torque_nm = self.lagged_nm * self.torque_factor * (1.0 + ripple);
        self.keep_under_curve();
        let (motor_speed, tool_speed) = (self.inertias.motor_speed(), self.inertias.load_speed());
        self.friction_state = preslide(self.friction_state, motor_speed * self.reversal_s_per_rad);
        self.cutting_state = preslide(self.cutting_state, tool_speed * self.reversal_s_per_rad);
        let friction_nm = self.coulomb_nm * self.friction_state + self.viscous_nm_s_per_rad * motor_speed;
        // Its shaft has no backlash.
        self.inertias.step_tight(self.torque_nm - friction_nm, -cutting_nm * self.cutting_state);
        self.keep_under_curve();
    }

    /// The curve holds for what the motor gives, whatever its ripple, its constant, and the lag that still carries the
    /// torque of a lower speed.
    fn keep_under_curve(&mut self) {
        if self.torque_nm.abs() > NEAR_LIMIT * self.limit_nm {
            let limit_nm = self.limit_at_nm(self.speed_rpm());
            self.torque_nm = self.torque_nm.max(-limit_nm).min(limit_nm);
        }
    }

    /// Position and velocity where the encoder sits, rev and rev/s.
    pub(crate) fn at_encoder(&self) -> (f64, f64) {
        let (position, speed) = match self.encoder_at {
            SpindleEncoderAt::Motor => (self.inertias.motor_position(), self.inertias.motor_speed()),
            SpindleEncoderAt::Tool => (self.inertias.load_position(), self.inertias.load_speed()),
        };
        (rev_from_rad(position), rev_from_rad(speed))
    }

    pub(crate) fn tool_rev(&self) -> f64 {
        rev_from_rad(self.inertias.load_position())
    }

    pub(crate) fn speed_rpm(&self) -> f64 {
        rpm_from_rev_per_s(rev_from_rad(self.inertias.motor_speed()))
    }

    /// Sign of the tool's turning, smooth where it reverses.
    pub(crate) fn turning(&self) -> f64 {
        self.cutting_state
    }

    /// Faults: whether the drive is on, and whether the motor has all of its torque.
    pub(crate) fn set_power(&mut self, enabled: bool, weak: bool) {
        (self.enabled, self.weak) = (enabled, weak);
    }

    /// The drive is switched on at rest; returns the angle that it holds.
    pub(crate) fn restart_drive(&mut self) -> f64 {
        self.drive.restart(rev_from_rad(self.inertias.motor_position()));
        self.at_encoder().0
    }

    /// The greatest torque of the motor at any speed, by its file.
    pub(crate) fn rated_nm(&self) -> f64 {
        self.curve.points().iter().map(|point| point.torque_nm).fold(0.0, f64::max)
    }

    /// Torque as the drive knows it, from its current.
    pub(crate) fn current_nm(&self) -> f64 {
        self.lagged_nm
    }

    pub(crate) fn torque_nm(&self) -> f64 {
        self.torque_nm
    }
}

/// Share of the way that a first-order lag covers in one step.
pub(crate) fn lag_share(lag_s: f64, step_s: f64) -> f64 {
    if lag_s > 0.0 { 1.0 - exp(-step_s / lag_s) } else { 1.0 }
}
