//! What Z's motor has to do beyond its share of the acceleration, so that the load moves as planned.
//!
//! Z's mechanics backwards, from the load to the motor (two-mass feed drive after Erkorkmaz and Altintas, High speed CNC
//! system design, 2001). The load's motion and friction say what force the screw carries, that force how far the motor
//! leads the load, and the motor's own motion and friction what its drive has to give. The screw's force is worked out
//! ahead of when it acts: where it turns round, the motor has to be on its way through the backlash.

use crate::control::math::{filter_share, poly::State, sign};
use crate::control::model::friction::preslide_one_way;
use crate::control::sync::plant_model::{Cut, IdentifiedZ, PitchError};

use super::axial::AxialFeedforward;
use super::backlash::Backlash;
use super::delay_line::DelayLine;
use super::z_config::ZConfig;

/// The force at rest that is taken over from the drive's integrator, in breakaway forces: beyond it, it is no friction.
const HELD_BREAKAWAYS: f64 = 2.5;
/// By how much friction changes along the way, as a share of it.
const CHANGES_SHARE: f64 = 0.15;
/// Time over which friction along the way is averaged: long against the force's noise, short against a stroke's end.
const FRICTION_S: f64 = 0.02;

/// What Z's command needs beyond the load's motion, positive into the hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::control::sync) struct ZExtra {
    /// Motor's speed beyond the load's.
    pub(in crate::control::sync) motor_velocity_mm_per_s: f64,
    /// Acceleration of the whole mass that the motor's own extra acceleration is worth.
    pub(in crate::control::sync) acceleration_mm_per_s2: f64,
    /// Friction to overcome, beyond what holds Z at the hole's start.
    pub(in crate::control::sync) friction_n: f64,
    /// What Z's position encoder reads beyond the load's motion when the command acts, and its rate: nothing by a scale.
    pub(in crate::control::sync) encoder_mm: f64,
    pub(in crate::control::sync) encoder_mm_per_s: f64,
}

/// Z at rest before a hole, positive into it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::control::sync) struct ZRest {
    /// What its drive's integrator holds beyond the weight, and what of it is fed forward still.
    pub(in crate::control::sync) held_n: f64,
    pub(in crate::control::sync) fed_n: f64,
    /// How far the motor leads the load from the middle of the backlash, where that is known.
    pub(in crate::control::sync) lead_mm: Option<f64>,
    /// Where the load rests, from the hole's start and by its encoder.
    pub(in crate::control::sync) load_mm: f64,
    pub(in crate::control::sync) encoder_mm: f64,
}

/// Friction and lost motion along a hole, with their states.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync) struct ZFeedforward {
    config: ZConfig,
    look_ahead_s: f64,
    pub(super) backlash: Backlash,
    /// Sliding friction of motor and load together, at the present place.
    pub(super) friction_n: f64,
    /// The same at the hole's start. It alone says how the screw is loaded: were it the friction along the way, a loop would
    /// close through the backlash.
    start_friction_n: f64,
    viscous_n_s_per_mm: f64,
    /// Of the load, which the screw carries.
    weight_n: f64,
    /// What the drive's integrator holds already.
    held_n: f64,
    /// Pre-sliding states, −1…1: the load's ahead, the motor's when it acts.
    load_contact: f64,
    motor_contact: f64,
    /// Travel of both one period ago.
    load_mm: f64,
    motor_mm: f64,
    /// Z's encoder less the load's travel, both positive into the hole: the screw's pitch error is one of the place.
    encoder_less_travel_mm: f64,
    pitch_error: PitchError,
    /// Ahead: the load's friction over the whole; how far the screw's force and pitch error make the motor lead the load.
    load_friction_ratio: DelayLine,
    wind_up_mm: DelayLine,
    /// Friction over [`Self::friction_n`] when the last command acts.
    friction_ratio: f64,
    axial: AxialFeedforward,
    /// How far the motor led the load at the hole's start.
    start_lead_mm: f64,
}

impl ZFeedforward {
    /// For a hole that begins with Z at rest.
    pub(in crate::control::sync) fn new(config: ZConfig, z: &IdentifiedZ, rest: &ZRest, cut: Cut) -> Self {
        let ZRest { held_n, fed_n, lead_mm, load_mm, encoder_mm } = *rest;
        let model = config.model.with_compliance_ratio(z.compliance_ratio);
        let ZConfig { period_s, crossing_s, .. } = config;
        let friction_n = z.friction_n;
        let backlash_mm = (z.lost_motion_mm - model.friction_deflection_mm(friction_n)).max(0.0);
        let greatest_ratio = model.contact.level(0.0);
        let greatest_n = friction_n * greatest_ratio;
        let load_share = model.load_friction_share;
        let (screw_n, flank) = match lead_mm {
            Some(lead_mm) => {
                at_deflection(backlash_mm, model.compliance_mm_per_n, lead_mm - z.pitch_error.at(encoder_mm))
            }
            // Not measured yet: what is held lies on both alike, and the backlash wholly on its flank.
            None => {
                let screw_n = held_n * load_share - z.weight_n;
                (screw_n, sign(screw_n))
            }
        };
        // What holds the load beside its weight is friction.
        let load_most_n = load_share * greatest_n;
        let load_held_n = (screw_n + z.weight_n).max(-load_most_n).min(load_most_n);
        let screw_n = load_held_n - z.weight_n;
        let load_contact = ratio(load_held_n, load_most_n);
        let start = Self {
            config: ZConfig { model, ..config },
            look_ahead_s: config.look_ahead_s(),
            backlash: Backlash::new(period_s, crossing_s, backlash_mm, flank),
            friction_n,
            start_friction_n: friction_n,
            viscous_n_s_per_mm: z.viscous_n_s_per_mm,
            weight_n: z.weight_n,
            // Takes over the integrator's force, clamped.
            held_n: held_n.max(-HELD_BREAKAWAYS * greatest_n).min(HELD_BREAKAWAYS * greatest_n) - fed_n,
            load_contact,
            motor_contact: ratio(held_n - load_held_n, greatest_n - load_most_n),
            load_mm,
            motor_mm: 0.0,
            load_friction_ratio: DelayLine::constant(load_share * greatest_ratio * load_contact, period_s, 0.0),
            encoder_less_travel_mm: encoder_mm - load_mm,
            pitch_error: z.pitch_error,
            wind_up_mm: DelayLine::constant(
                model.compliance_mm_per_n * screw_n + z.pitch_error.at(encoder_mm),
                period_s,
                0.0,
            ),
            friction_ratio: 0.0,
            axial: AxialFeedforward::new(z.axial, cut, period_s),
            start_lead_mm: 0.0,
        };
        let start_lead_mm = start.motor_deflection(0.0).position;
        Self { motor_mm: load_mm + start_lead_mm, start_lead_mm, ..start }
    }

    /// Before the first step: the load's motion from when its command acts on, one period after the other, up to
    /// [`ZConfig::look_ahead_s`] after that.
    pub(in crate::control::sync) fn prime(&mut self, load: &State) {
        self.load_screw(load);
    }

    /// One period of a hole: the load's motion when a force commanded now acts, and [`ZConfig::look_ahead_s`] after that.
    pub(in crate::control::sync) fn step(&mut self, acting: &State, ahead: &State) -> ZExtra {
        self.load_screw(ahead);
        let ZConfig { model, delays, .. } = self.config;
        let early = self.motor_deflection(self.look_ahead_s);
        let late = self.motor_deflection(self.look_ahead_s + delays.acting_s - delays.read_s);
        let motor_mm = acting.position + early.position;
        self.motor_contact = self.preslide(self.motor_contact, motor_mm - self.motor_mm);
        self.motor_mm = motor_mm;
        let motor_level = model.contact.level(acting.velocity + early.velocity);
        self.friction_ratio = (1.0 - model.load_friction_share) * motor_level * self.motor_contact
            + self.load_friction_ratio.at(self.look_ahead_s).position;
        let read = self.unseen(self.look_ahead_s + delays.acting_s - delays.position_s);
        ZExtra {
            encoder_mm: read.position,
            encoder_mm_per_s: read.velocity,
            motor_velocity_mm_per_s: late.velocity,
            acceleration_mm_per_s2: early.acceleration * (1.0 - model.load_mass_share),
            friction_n: self.friction_n * self.friction_ratio + self.viscous_n_s_per_mm * acting.velocity
                - self.held_n
                - self.axial.drawing_n(self.look_ahead_s),
        }
    }

    /// What the screw carries ahead, and on which flank.
    fn load_screw(&mut self, load: &State) {
        let model = self.config.model;
        self.load_contact = self.preslide(self.load_contact, load.position - self.load_mm);
        self.load_mm = load.position;
        let load_share = model.load_friction_share;
        let friction_ratio = load_share * model.contact.level(load.velocity) * self.load_contact;
        let viscous_n = load_share * self.viscous_n_s_per_mm * load.velocity;
        let drawn_n = self.axial.look_ahead(load.position, self.load_contact);
        let screw_n = self.start_friction_n * friction_ratio + viscous_n + model.load_n(load.acceleration)
            - self.weight_n
            - drawn_n;
        self.load_friction_ratio.push(friction_ratio);
        let pitch_error_mm = self.pitch_error.at(load.position + self.encoder_less_travel_mm);
        self.wind_up_mm.push(model.compliance_mm_per_n * screw_n + pitch_error_mm);
        let without_seen_n = screw_n + self.axial.seen_along_n(load.position, self.load_contact);
        self.backlash.load(without_seen_n, load_share * self.start_friction_n);
    }

    fn preslide(&self, contact: f64, travel_mm: f64) -> f64 {
        preslide_one_way(contact, travel_mm / self.config.model.contact.presliding)
    }

    /// How far the motor leads the load, so long before what is known ahead.
    fn motor_deflection(&self, ago_s: f64) -> State {
        let wind_up = self.wind_up_mm.at(ago_s);
        let backlash = self.backlash.sent_mm(ago_s);
        State {
            position: wind_up.position + backlash.position,
            velocity: wind_up.velocity + backlash.velocity,
            acceleration: wind_up.acceleration + backlash.acceleration,
            jerk: 0.0,
        }
    }

    /// What an encoder on the motor reads beyond the load's motion, so long before what is known ahead; none by a scale.
    fn unseen(&self, ago_s: f64) -> State {
        if !self.config.model.unseen {
            return State::default();
        }
        let lead = self.motor_deflection(ago_s);
        State { position: lead.position - self.start_lead_mm, ..lead }
    }

    /// The same so long before a force commanded now acts, mm.
    pub(in crate::control::sync) fn unseen_mm(&self, ago_s: f64) -> f64 {
        self.unseen(self.look_ahead_s + ago_s).position
    }

    /// By how much the motor was measured to lead the load, so long before a force commanded now acts.
    pub(in crate::control::sync) fn observe_deflection(&mut self, deflection_mm: f64, ago_s: f64) {
        let wind_up_mm = self.wind_up_mm.at(self.look_ahead_s + ago_s).position;
        self.backlash.correct(deflection_mm - wind_up_mm);
    }

    /// Share of an error that the next hole will repeat, so long before a force commanded now acts.
    pub(in crate::control::sync) fn repeatable_share(&self, ago_s: f64) -> f64 {
        self.backlash.repeatable_share(self.look_ahead_s + ago_s)
    }

    /// What the drive gave a moment ago, when the load moved so. Friction changes along the way: what it is here counts at the
    /// next reversal, and until then the drive's integrator holds the difference.
    pub(in crate::control::sync) fn observe_force(&mut self, force_n: f64, load: &State) {
        let model = &self.config.model;
        if load.velocity.abs() <= model.sliding_mm_per_s() {
            return;
        }
        let drawn_n = self.axial.drawing_along_n(load);
        let beside_n = model.inertia_n(load.acceleration) + self.viscous_n_s_per_mm * load.velocity - drawn_n;
        let against_n = sign(load.velocity) * (force_n - beside_n);
        let change_n = filter_share(self.config.period_s, FRICTION_S) * (against_n - self.friction_n);
        self.friction_n += change_n;
        self.held_n += change_n * self.friction_ratio;
        // What friction is less than anywhere before, beyond what it changes along the way, is a tap that draws in.
        let changes_n = CHANGES_SHARE * self.start_friction_n;
        self.friction_n += self.axial.attribute(self.start_friction_n - self.friction_n, changes_n, load);
    }
}

/// The screw's force and the flank, with the motor so far ahead of the load.
fn at_deflection(backlash_mm: f64, compliance_mm_per_n: f64, deflection_mm: f64) -> (f64, f64) {
    let half_mm = 0.5 * backlash_mm;
    let wind_up_mm = (deflection_mm.abs() - half_mm).max(0.0).copysign(deflection_mm);
    let flank = if half_mm > 0.0 { (deflection_mm / half_mm).clamp(-1.0, 1.0) } else { sign(deflection_mm) };
    (if compliance_mm_per_n > 0.0 { wind_up_mm / compliance_mm_per_n } else { 0.0 }, flank)
}

/// A force over the greatest, −1…1.
fn ratio(force_n: f64, most_n: f64) -> f64 {
    if most_n > 0.0 { (force_n / most_n).clamp(-1.0, 1.0) } else { 0.0 }
}
