//! Z: motor and screw, table, friction on both, backlash between them, and its drive.

use std::f64::consts::TAU;

use rand::{Rng, RngExt};

use crate::control::machine::{Machine, ZEncoderAt};
use crate::control::math::poly::State;
use crate::control::model::cascade::{Cascade, CascadeGains, Measured};
use crate::control::model::friction::{Stribeck, preslide};
use crate::control::model::two_mass::TwoMass;
use crate::control::units::{MM_PER_M, UM_PER_MM, m_from_mm, mm_from_m, mm_from_um};

use super::Actual;
use super::effects::{Effect, Effects};
use super::encoder::Encoder;
use super::inertias::Inertias;
use super::spindle::lag_share;
use super::wave::sin_turns;

/// Signal period of the scale: a usual 20 µm grating.
const SCALE_PERIOD_MM: f64 = 0.02;
/// Travel over which the friction's ripple repeats: the lead of a BT30 centre's screw.
const RIPPLE_MM: f64 = 16.0;
/// Resonance and damping that stand for a rigid screw.
const RIGID: (f64, f64) = (2000.0, 1.0);

/// Z with its state.
#[derive(Clone, Debug)]
pub(crate) struct ZAxis {
    drive: Cascade,
    pub(crate) encoder: Encoder,
    pub(crate) motor_encoder: Encoder,
    encoder_at: ZEncoderAt,
    inertias: Inertias,
    force_limit_n: f64,
    lag_share: f64,
    motor_contact: Stribeck,
    table_contact: Stribeck,
    motor_friction: f64,
    table_friction: f64,
    ripple: f64,
    ripple_phase: f64,
    direction: f64,
    hole_spread: f64,
    hole_factor: f64,
    position_factor: f64,
    commanded_n: f64,
    force_n: f64,
    /// Share of the pre-sliding travel that one step at 1 m/s covers.
    presliding_s_per_m: f64,
}

impl ZAxis {
    pub(crate) fn new(
        machine: &Machine,
        actual: &Actual,
        effects: Effects,
        tick_s: f64,
        step_s: f64,
        start_mm: f64,
        random: &mut impl Rng,
    ) -> Self {
        let (spec, drive) = (&machine.spec().z_axis, &machine.spec().drive);
        let (resonance_hz, damping) = if effects.has(Effect::ZResonance) {
            (spec.resonance_hz * actual.z_resonance, spec.damping_ratio)
        } else {
            RIGID
        };
        let table_kg = spec.mass_kg * spec.table_share;
        let model = TwoMass::motor_held(spec.mass_kg - table_kg, table_kg, resonance_hz, damping);
        let backlash_mm = mm_from_um(effects.or_zero(Effect::Backlash, actual.backlash_um.unwrap_or(spec.backlash_um)));
        let gains = CascadeGains {
            period_s: tick_s,
            position_gain_per_s: drive.z_position_gain_per_s,
            velocity_gain_per_s: drive.z_velocity_gain_per_s,
            integral_s: drive.z_integral_s,
            velocity_filter_s: drive.velocity_filter_s,
            effort_per_acceleration: spec.mass_kg / MM_PER_M,
        };
        let presliding = m_from_mm(mm_from_um(spec.presliding_um));
        let contact = |share: f64| Stribeck {
            coulomb: effects.or_zero(Effect::ZFriction, spec.coulomb_n * actual.friction * share),
            static_ratio: spec.static_ratio,
            stribeck_speed: m_from_mm(spec.stribeck_mm_per_s),
            presliding,
        };
        let latency_s = actual.encoder_latency_s.unwrap_or(drive.encoder_latency_s);
        let encoder = |counts_per_mm: f64| Encoder {
            counts_per_unit: counts_per_mm,
            latency_s: effects.or_zero(Effect::EncoderLatency, latency_s),
            jitter_s: effects.or_zero(Effect::EncoderJitter, drive.encoder_jitter_s * actual.encoder_error),
            interpolation_counts: effects.or_zero(
                Effect::Interpolation,
                drive.z_interpolation_um / UM_PER_MM * counts_per_mm * actual.encoder_error,
            ),
            period_counts: SCALE_PERIOD_MM * counts_per_mm,
        };
        Self {
            drive: Cascade::new(gains, start_mm),
            encoder: encoder(spec.encoder_counts_per_mm),
            motor_encoder: encoder(spec.motor_counts_per_mm),
            encoder_at: spec.encoder_at,
            inertias: Inertias::new(model, m_from_mm(backlash_mm), step_s, m_from_mm(start_mm)),
            force_limit_n: spec.force_limit_n,
            lag_share: lag_share(effects.or_zero(Effect::TorqueLag, spec.torque_lag_s), step_s),
            motor_contact: contact(1.0 - spec.friction_table_share),
            table_contact: contact(spec.friction_table_share),
            motor_friction: 0.0,
            table_friction: 0.0,
            ripple: effects.or_zero(Effect::FrictionRipple, spec.friction_ripple),
            ripple_phase: random.random_range(0.0..TAU) / TAU,
            direction: effects.or_zero(Effect::FrictionRipple, spec.friction_direction),
            hole_spread: effects.or_zero(Effect::FrictionRipple, spec.friction_hole_spread),
            hole_factor: 1.0,
            position_factor: 1.0,
            commanded_n: 0.0,
            force_n: 0.0,
            presliding_s_per_m: step_s / presliding,
        }
    }

    /// The next hole's friction differs a little from the last one's.
    pub(crate) fn begin_hole(&mut self, random: &mut impl Rng) {
        self.hole_factor = 1.0 + self.hole_spread * random.random_range(-1.0..=1.0);
    }

    /// The drive's tick: a new force command. True where the limit cut it.
    pub(crate) fn tick(&mut self, (command, feedforward_n): (State, f64)) -> bool {
        let (position, velocity) = self.at_encoder();
        let motor_mm = self.motor_mm();
        let measured = Measured { position: self.encoder.signal(position, velocity), motor_position: motor_mm };
        let answer = self.drive.step(&command, feedforward_n, measured, self.force_limit_n);
        self.commanded_n = answer.effort;
        self.position_factor =
            self.hole_factor * (1.0 + self.ripple * sin_turns(motor_mm / RIPPLE_MM + self.ripple_phase));
        answer.saturated
    }

    /// One plant step.
    #[inline]
    pub(crate) fn step(&mut self) {
        self.force_n += self.lag_share * (self.commanded_n - self.force_n);
        let (motor_speed, table_speed) = (self.inertias.motor_speed(), self.inertias.load_speed());
        self.motor_friction = preslide(self.motor_friction, motor_speed * self.presliding_s_per_m);
        self.table_friction = preslide(self.table_friction, table_speed * self.presliding_s_per_m);
        let direction = |state: f64| state * (1.0 + self.direction / 2.0 * state.signum());
        let motor_n = self.motor_contact.level(motor_speed) * self.position_factor * direction(self.motor_friction);
        let table_n = self.table_contact.level(table_speed) * self.position_factor * direction(self.table_friction);
        self.inertias.step(self.force_n - motor_n, -table_n);
    }

    /// Position and velocity where the position encoder sits, mm and mm/s.
    pub(crate) fn at_encoder(&self) -> (f64, f64) {
        match self.encoder_at {
            ZEncoderAt::Table => (self.table_mm(), mm_from_m(self.inertias.load_speed())),
            ZEncoderAt::Motor => self.at_motor(),
        }
    }

    pub(crate) fn at_motor(&self) -> (f64, f64) {
        (self.motor_mm(), mm_from_m(self.inertias.motor_speed()))
    }

    fn motor_mm(&self) -> f64 {
        mm_from_m(self.inertias.motor_position())
    }

    pub(crate) fn table_mm(&self) -> f64 {
        mm_from_m(self.inertias.load_position())
    }

    pub(crate) fn force_n(&self) -> f64 {
        self.force_n
    }
}
