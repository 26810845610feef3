//! Z: motor and screw, table, friction on both, backlash between them, and its drive.

use std::f64::consts::TAU;

use rand::{Rng, RngExt};

use crate::control::machine::{Machine, ZEncoderAt};
use crate::control::math::poly::State;
use crate::control::model::cascade::{Cascade, CascadeGains, Measured};
use crate::control::model::two_mass::TwoMass;
use crate::control::units::{MM_PER_M, UM_PER_MM, m_from_mm, mm_from_m, mm_from_um};

use super::actual::Actual;
use super::effects::{Effect, Effects};
use super::effort_delay::EffortDelay;
use super::encoder::Encoder;
use super::friction::{Contact, ContactSpec, Presliding, preslide};
use super::gap::Gap;
use super::inertias::Inertias;
use super::screw::Screw;
use super::spindle::lag_share;
use super::transmission::Transmission;
use super::wave::sin_turns;

/// Signal period of the scale: a usual 20 µm grating.
const SCALE_PERIOD_MM: f64 = 0.02;
/// Travel over which the friction's ripple repeats: the lead of a BT30 centre's screw.
const RIPPLE_MM: f64 = 16.0;
/// Resonance and damping that stand for a rigid screw.
const RIGID: (f64, f64) = (2000.0, 1.0);
/// What of the force limit a weak drive has left: a fault.
const WEAK: f64 = 0.05;
/// Force and travel of a table that is caught on something: a fault.
const GRIP_N: f64 = 20_000.0;
const GRIP_M: f64 = 50e-6;

/// Z with its state.
#[derive(Clone, Debug)]
pub(crate) struct ZAxis {
    drive: Cascade,
    pub(crate) encoder: Encoder,
    pub(crate) motor_encoder: Encoder,
    encoder_at: ZEncoderAt,
    inertias: Transmission,
    screw: Screw,
    force_limit_n: f64,
    lag_share: f64,
    motor_contact: Contact,
    table_contact: Contact,
    ripple: f64,
    ripple_phase: f64,
    direction: f64,
    hole_spread: f64,
    hole_factor: f64,
    position_factor: f64,
    commanded_n: EffortDelay,
    force_n: f64,
    weight_n: f64,
    /// How far the tip stands above the table where the tool was measured: weight pulls it below.
    tool_mm: f64,
    /// Force on the tip from outside, upwards, its weight among it.
    outside_n: f64,
    /// State of the table's being caught, −1…1; none while it is free.
    grip: Option<f64>,
    enabled: bool,
    weak: bool,
    step_s: f64,
    /// Neither an error of the screw nor something that holds the table.
    is_plain: bool,
}

/// Z through the steps of one tick, with all that does not change in them looked up once: most of a sweep's time is
/// spent here.
pub(crate) struct PlainSteps<'a> {
    inertias: &'a mut Inertias,
    motor_contact: &'a mut Presliding,
    table_contact: &'a mut Presliding,
    force_n: &'a mut f64,
    commanded_n: f64,
    lag_share: f64,
    position_factor: f64,
    direction: f64,
    outside_n: f64,
}

impl PlainSteps<'_> {
    /// One plant step.
    #[inline(always)]
    pub(crate) fn step(&mut self) {
        *self.force_n += self.lag_share * (self.commanded_n - *self.force_n);
        let Self { inertias, motor_contact, table_contact, .. } = self;
        let motor_n = motor_contact.force(inertias.motor_speed(), self.position_factor, self.direction);
        let table_n = table_contact.force(inertias.load_speed(), self.position_factor, self.direction);
        inertias.step_plain(*self.force_n - motor_n, self.outside_n - table_n);
    }
}

impl ZAxis {
    pub(crate) fn new(
        machine: &Machine,
        actual: &Actual,
        effects: Effects,
        tick_s: f64,
        steps_per_tick: u32,
        start_mm: f64,
        random: &mut impl Rng,
    ) -> Self {
        let step_s = tick_s / f64::from(steps_per_tick);
        let (spec, drive) = (&machine.spec().z_axis, &machine.spec().drive);
        let (resonance_hz, damping) = if effects.has(Effect::ZResonance) {
            (spec.resonance_hz * actual.z_resonance, spec.damping_ratio)
        } else {
            RIGID
        };
        let table_kg = spec.mass_kg * spec.table_share;
        let model = TwoMass::motor_held(spec.mass_kg - table_kg, table_kg, resonance_hz, damping);
        let backlash_mm = mm_from_um(effects.or_zero(Effect::Backlash, actual.backlash_of_um(spec.backlash_um)));
        let gap = Gap::new(&model, m_from_mm(backlash_mm)).with_damping(actual.backlash_damping);
        let viscous = actual.z_viscous_n_per_mm_s * MM_PER_M;
        let viscous = [viscous * (1.0 - spec.friction_table_share), viscous * spec.friction_table_share];
        let second = actual.z_second_resonance_hz.map(|hz| (hz, spec.damping_ratio));
        let gains = CascadeGains {
            period_s: tick_s,
            position_gain_per_s: drive.z_position_gain_per_s * actual.drive_gain,
            velocity_gain_per_s: drive.z_velocity_gain_per_s * actual.drive_gain,
            integral_s: drive.z_integral_s,
            velocity_filter_s: drive.velocity_filter_s,
            effort_per_acceleration: spec.mass_kg / MM_PER_M,
        };
        let presliding = m_from_mm(mm_from_um(spec.presliding_um));
        let contact = |share: f64, mass: f64| {
            let spec = ContactSpec {
                coulomb: effects.or_zero(Effect::ZFriction, spec.coulomb_n * actual.friction * share),
                static_ratio: spec.static_ratio,
                stribeck_speed: m_from_mm(spec.stribeck_mm_per_s),
                presliding,
                mass,
            };
            Contact::new(actual.z_friction_model, spec, step_s)
        };
        let latency_s = actual.encoder_latency_of_s(drive.encoder_latency_s);
        let encoder = |counts_per_mm: f64| Encoder {
            counts_per_unit: counts_per_mm,
            latency_s: effects.or_zero(Effect::EncoderLatency, latency_s),
            jitter_s: effects.or_zero(Effect::EncoderJitter, drive.encoder_jitter_s * actual.encoder_error),
            interpolation_counts: effects.or_zero(
                Effect::Interpolation,
                drive.z_interpolation_um / UM_PER_MM * counts_per_mm * actual.encoder_error,
            ),
            period_counts: SCALE_PERIOD_MM * counts_per_mm,
            eccentricity: None,
            frozen: None,
        };
        let screw = Screw::of(actual);
        Self {
            is_plain: !screw.is_imperfect(),
            drive: Cascade::new(gains, start_mm),
            encoder: encoder(spec.encoder_counts_per_mm),
            motor_encoder: encoder(spec.motor_counts_per_mm),
            encoder_at: spec.encoder_at,
            inertias: Transmission::new(model, second, gap, viscous, step_s, m_from_mm(start_mm)),
            screw,
            force_limit_n: spec.force_limit_n,
            lag_share: lag_share(effects.or_zero(Effect::TorqueLag, spec.torque_lag_s), step_s),
            motor_contact: contact(1.0 - spec.friction_table_share, spec.mass_kg - table_kg),
            table_contact: contact(spec.friction_table_share, table_kg),
            ripple: effects.or_zero(Effect::FrictionRipple, spec.friction_ripple),
            ripple_phase: random.random_range(0.0..TAU) / TAU,
            direction: effects.or_zero(Effect::FrictionRipple, spec.friction_direction) + actual.z_friction_asymmetry,
            hole_spread: effects.or_zero(Effect::FrictionRipple, spec.friction_hole_spread),
            hole_factor: 1.0,
            position_factor: 1.0,
            commanded_n: EffortDelay::new(actual.drive_delay_periods, steps_per_tick),
            force_n: 0.0,
            weight_n: actual.z_weight_n,
            tool_mm: 0.0,
            outside_n: -actual.z_weight_n,
            grip: None,
            enabled: true,
            weak: false,
            step_s,
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
        let limit_n = if self.weak { WEAK * self.force_limit_n } else { self.force_limit_n };
        let answer = self.drive.step(&command, feedforward_n, measured, limit_n);
        self.commanded_n.push(if self.enabled { answer.effort } else { 0.0 });
        self.screw.tick(motor_mm, self.inertias.gap());
        self.position_factor =
            self.hole_factor * (1.0 + self.ripple * sin_turns(motor_mm / RIPPLE_MM + self.ripple_phase));
        answer.saturated
    }

    /// The steps of this tick where Z has nothing of the hard spread.
    #[inline(always)]
    pub(crate) fn plain_steps(&mut self) -> Option<PlainSteps<'_>> {
        let commanded_n = self.commanded_n.of_tick()?;
        let Self { inertias, motor_contact, table_contact, .. } = self;
        match (inertias, motor_contact, table_contact, self.is_plain) {
            (Transmission::Two(inertias), Contact::Stribeck(motor_contact), Contact::Stribeck(table_contact), true)
                if inertias.is_plain() =>
            {
                Some(PlainSteps {
                    inertias,
                    motor_contact,
                    table_contact,
                    force_n: &mut self.force_n,
                    commanded_n,
                    lag_share: self.lag_share,
                    position_factor: self.position_factor,
                    direction: self.direction,
                    outside_n: self.outside_n,
                })
            }
            _ => None,
        }
    }

    /// One plant step with whatever the machine has of the hard spread.
    #[inline(never)]
    pub(crate) fn step(&mut self) {
        self.force_n += self.lag_share * (self.commanded_n.next() - self.force_n);
        let (motor_speed, table_speed) = (self.inertias.motor_speed(), self.inertias.load_speed());
        let outside_n = if self.grip.is_some() { self.outside_n - self.gripped(table_speed) } else { self.outside_n };
        let Self { inertias, force_n, position_factor: factor, direction, .. } = self;
        let stopping = |side: usize| inertias.stopping(*force_n, 0.0, outside_n)[side];
        let motor_n = self.motor_contact.force(motor_speed, *factor, *direction, || stopping(0));
        let table_n = self.table_contact.force(table_speed, *factor, *direction, || stopping(1));
        self.inertias.step(self.force_n - motor_n, -table_n, outside_n);
        if self.screw.is_imperfect() {
            self.screw.step(motor_speed * self.step_s, self.step_s, self.inertias.gap());
        }
    }

    #[inline]
    fn gripped(&mut self, table_speed: f64) -> f64 {
        match &mut self.grip {
            None => 0.0,
            Some(state) => {
                *state = preslide(*state, table_speed * self.step_s / GRIP_M);
                GRIP_N * *state
            }
        }
    }

    /// A force on the tip from outside, upwards, until the next one.
    pub(crate) fn push(&mut self, force_n: f64) {
        self.outside_n = force_n - self.weight_n;
    }

    /// Faults: whether the drive is on, whether it has all of its force, and whether something holds the table.
    pub(crate) fn set_power(&mut self, enabled: bool, weak: bool, gripped: bool) {
        (self.enabled, self.weak) = (enabled, weak);
        self.grip = gripped.then(|| self.grip.unwrap_or(0.0));
        self.is_plain = self.grip.is_none() && !self.screw.is_imperfect();
    }

    /// The drive is switched on at rest; returns the position that it holds.
    pub(crate) fn restart_drive(&mut self) -> f64 {
        self.drive.restart(self.motor_mm());
        self.at_encoder().0
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

    fn table_mm(&self) -> f64 {
        mm_from_m(self.inertias.load_position())
    }

    /// The tool's tip: beyond the second spring where there is one.
    pub(crate) fn tip_mm(&self) -> f64 {
        mm_from_m(self.inertias.tip_position()) - self.tool_mm
    }

    /// The tool is measured where it hangs: its length has the tip's sag in it.
    pub(crate) fn measure_tool(&mut self) {
        self.tool_mm = mm_from_m(self.inertias.tip_position()) - self.table_mm();
    }

    pub(crate) fn force_limit_n(&self) -> f64 {
        self.force_limit_n
    }

    /// The screw's pitch error begins anywhere.
    pub(crate) fn set_screw_phase(&mut self, turns: f64) {
        self.screw.set_phase(turns);
    }

    pub(crate) fn force_n(&self) -> f64 {
        self.force_n
    }
}
