//! What Z's motor has to do beyond its share of the acceleration, so that the load moves as planned.
//!
//! Z's mechanics backwards, from the load to the motor (two-mass feed drive after Erkorkmaz and Altintas, High speed CNC
//! system design, 2001). The load's motion and friction say what force the screw carries, that force how far the motor
//! leads the load, and the motor's own motion and friction what its drive has to give. The screw's force is worked out
//! ahead of when it acts: where it turns round, the motor has to be on its way through the backlash.

use crate::control::math::{filter_share, poly::State, sign};
use crate::control::model::friction::preslide_one_way;
use crate::control::sync::plant_model::IdentifiedZ;

use super::backlash::Backlash;
use super::delay_line::DelayLine;
use super::z_config::ZConfig;

/// The force at rest that is taken over from the drive's integrator, in breakaway forces: beyond it, it is no friction.
const HELD_BREAKAWAYS: f64 = 2.5;
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
}

/// Friction and lost motion along a hole, with their states.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::control::sync) struct ZFeedforward {
    config: ZConfig,
    look_ahead_s: f64,
    backlash: Backlash,
    /// Sliding friction of motor and load together, at the present place.
    friction_n: f64,
    /// The same at the hole's start. It alone says how the screw is loaded: were it the friction along the way, a loop would
    /// close through the backlash.
    start_friction_n: f64,
    /// What the drive's integrator holds already.
    held_n: f64,
    /// Pre-sliding states, −1…1: the load's ahead, the motor's when it acts.
    load_contact: f64,
    motor_contact: f64,
    /// Travel of both one period ago.
    load_mm: f64,
    motor_mm: f64,
    /// Ahead: the load's friction over the whole, the screw's force.
    load_friction_ratio: DelayLine,
    screw_n: DelayLine,
    /// Friction over [`Self::friction_n`] when the last command acts.
    friction_ratio: f64,
}

impl ZFeedforward {
    /// For a hole that begins with Z at rest. Its drive's integrator holds `held_n`, of which `fed_n` is fed forward still;
    /// `flank` is where in the lost motion the motor stands, −1…1, where that is known; `load_mm` is where the load rests.
    pub(in crate::control::sync) fn new(
        config: ZConfig,
        z: &IdentifiedZ,
        held_n: f64,
        fed_n: f64,
        flank: Option<f64>,
        load_mm: f64,
    ) -> Self {
        let model = config.model.with_compliance_ratio(z.compliance_ratio);
        let ZConfig { period_s, crossing_s, .. } = config;
        let friction_n = z.friction_n;
        let backlash_mm = (z.lost_motion_mm - model.friction_deflection_mm(friction_n)).max(0.0);
        let greatest_ratio = model.contact.level(0.0);
        let greatest_n = friction_n * greatest_ratio;
        let load_share = model.load_friction_share;
        let (screw_n, flank) = match flank {
            Some(flank) => at_deflection(backlash_mm, model.compliance_mm_per_n, 0.5 * z.lost_motion_mm * flank),
            // Not measured yet: what is held lies on both alike, and the backlash wholly on its flank.
            None => (held_n * load_share, sign(held_n)),
        };
        let load_most_n = load_share * greatest_n;
        let screw_n = screw_n.max(-load_most_n).min(load_most_n);
        let load_contact = ratio(screw_n, load_most_n);
        let start = Self {
            config: ZConfig { model, ..config },
            look_ahead_s: config.look_ahead_s(),
            backlash: Backlash::new(period_s, crossing_s, backlash_mm, flank),
            friction_n,
            start_friction_n: friction_n,
            // Takes over the integrator's force, clamped.
            held_n: held_n.max(-HELD_BREAKAWAYS * greatest_n).min(HELD_BREAKAWAYS * greatest_n) - fed_n,
            load_contact,
            motor_contact: ratio(held_n - screw_n, greatest_n - load_most_n),
            load_mm,
            motor_mm: 0.0,
            load_friction_ratio: DelayLine::constant(load_share * greatest_ratio * load_contact, period_s, 0.0),
            screw_n: DelayLine::constant(screw_n, period_s, 0.0),
            friction_ratio: 0.0,
        };
        Self { motor_mm: load_mm + start.motor_deflection(0.0).position, ..start }
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
        ZExtra {
            motor_velocity_mm_per_s: late.velocity,
            acceleration_mm_per_s2: early.acceleration * (1.0 - model.load_mass_share),
            friction_n: self.friction_n * self.friction_ratio - self.held_n,
        }
    }

    /// What the screw carries ahead, and on which flank.
    fn load_screw(&mut self, load: &State) {
        let model = self.config.model;
        self.load_contact = self.preslide(self.load_contact, load.position - self.load_mm);
        self.load_mm = load.position;
        let load_share = model.load_friction_share;
        let friction_ratio = load_share * model.contact.level(load.velocity) * self.load_contact;
        let screw_n = self.start_friction_n * friction_ratio + model.load_n(load.acceleration);
        self.load_friction_ratio.push(friction_ratio);
        self.screw_n.push(screw_n);
        self.backlash.load(screw_n, load_share * self.start_friction_n);
    }

    fn preslide(&self, contact: f64, travel_mm: f64) -> f64 {
        preslide_one_way(contact, travel_mm / self.config.model.contact.presliding)
    }

    /// How far the motor leads the load, so long before what is known ahead.
    fn motor_deflection(&self, ago_s: f64) -> State {
        let wind_up = self.screw_n.at(ago_s).scaled(self.config.model.compliance_mm_per_n);
        let backlash = self.backlash.sent_mm(ago_s);
        State {
            position: wind_up.position + backlash.position,
            velocity: wind_up.velocity + backlash.velocity,
            acceleration: wind_up.acceleration + backlash.acceleration,
            jerk: 0.0,
        }
    }

    /// By how much the motor was measured to lead the load, so long before a force commanded now acts.
    pub(in crate::control::sync) fn observe_deflection(&mut self, deflection_mm: f64, ago_s: f64) {
        let wind_up_mm = self.config.model.compliance_mm_per_n * self.screw_n.at(self.look_ahead_s + ago_s).position;
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
        let against_n = sign(load.velocity) * (force_n - model.inertia_n(load.acceleration));
        let change_n = filter_share(self.config.period_s, FRICTION_S) * (against_n.max(0.0) - self.friction_n);
        self.friction_n += change_n;
        self.held_n += change_n * self.friction_ratio;
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

#[cfg(test)]
mod tests {
    use super::{ZConfig, ZExtra, ZFeedforward};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::sync::feedforward::z_config::ZDelays;
    use crate::control::sync::plant_model::{Identified, IdentifiedZ};

    const PERIOD_S: f64 = 0.001;
    const DELAYS: ZDelays = ZDelays { acting_s: -0.0002, read_s: -0.001 };
    const LOST_MM: f64 = 0.008;
    const ACCELERATION: f64 = 637.0;
    /// To 32 mm/s.
    const RAMP_S: f64 = 0.05;
    /// The reference machine's, sliding and before it does.
    const COULOMB_N: f64 = 300.0;
    const STATIC_N: f64 = 390.0;

    fn config() -> ZConfig {
        ZConfig::new(&Machine::reference(), DELAYS)
    }

    fn begun_with(known: IdentifiedZ, held_n: f64, flank: Option<f64>) -> ZFeedforward {
        ZFeedforward::new(config(), &known, held_n, 0.0, flank, 0.0)
    }

    fn nominal() -> IdentifiedZ {
        IdentifiedZ { lost_motion_mm: LOST_MM, ..Identified::nominal(&Machine::reference()).z }
    }

    fn begun(held_n: f64, flank: Option<f64>) -> ZFeedforward {
        begun_with(nominal(), held_n, flank)
    }

    /// Speeds up, cruises for as long, turns round as it sped up, and cruises back.
    fn load(t_s: f64) -> State {
        let parts = [(RAMP_S, ACCELERATION), (RAMP_S, 0.0), (2.0 * RAMP_S, -ACCELERATION), (f64::INFINITY, 0.0)];
        let mut state = State::default();
        let mut left_s = t_s.max(0.0);
        for (length_s, acceleration) in parts {
            let step_s = left_s.min(length_s);
            state = State {
                position: state.position + step_s * (state.velocity + 0.5 * step_s * acceleration),
                velocity: state.velocity + step_s * acceleration,
                acceleration: if t_s > 0.0 { acceleration } else { 0.0 },
                jerk: 0.0,
            };
            left_s -= step_s;
            if left_s <= 0.0 {
                break;
            }
        }
        state
    }

    /// Instants of [`load`] at which everything has settled.
    const SPEEDING: f64 = 0.045;
    const CRUISING: f64 = 0.09;
    const SLOWING: f64 = 0.145;
    const SPEEDING_BACK: f64 = 0.19;
    const CRUISING_BACK: f64 = 0.25;

    fn moved(z: &mut ZFeedforward, (from_s, to_s): (f64, f64)) -> Vec<ZExtra> {
        let periods = (from_s / PERIOD_S).round() as u32..(to_s / PERIOD_S).round() as u32;
        let ahead_s = config().look_ahead_s();
        periods.map(|k| f64::from(k) * PERIOD_S).map(|t_s| z.step(&load(t_s), &load(t_s + ahead_s))).collect()
    }

    /// By how much the motor's lead over the table grows from each instant to the next.
    fn leads_mm<const N: usize>(z: &mut ZFeedforward, to_s: [f64; N]) -> [f64; N] {
        let mut from_s = 0.0;
        to_s.map(|to_s| {
            let extras = moved(z, (from_s, to_s));
            from_s = to_s;
            extras.iter().map(|extra| extra.motor_velocity_mm_per_s * PERIOD_S).sum()
        })
    }

    fn assert_leads<const N: usize>(z: &mut ZFeedforward, to_s: [f64; N], expected_mm: [f64; N]) {
        let found_mm = leads_mm(z, to_s);
        for (found, expected) in found_mm.iter().zip(expected_mm) {
            assert!((found - expected).abs() < 1e-5, "{found_mm:?} {expected_mm:?}");
        }
    }

    #[test]
    fn motor_crosses_all_of_the_lost_motion() {
        for (flank, first_mm) in [(1.0, 0.0), (0.0, 0.5 * LOST_MM), (-0.5, 0.75 * LOST_MM), (-1.0, LOST_MM)] {
            assert_leads(&mut begun(0.0, Some(flank)), [CRUISING, CRUISING_BACK], [first_mm, -LOST_MM]);
        }
    }

    #[test]
    fn screw_winds_up_while_the_load_speeds_up() {
        let mut z = begun(COULOMB_N, Some(1.0));
        // ω² of 100 Hz.
        let wind_up_mm = ACCELERATION / 394_784.176_043_574_3;
        assert_leads(&mut z, [SPEEDING, CRUISING], [wind_up_mm, -wind_up_mm]);
        let soft = IdentifiedZ { compliance_ratio: 1.5, ..nominal() };
        assert_leads(&mut begun_with(soft, COULOMB_N, Some(1.0)), [SPEEDING], [1.5 * wind_up_mm]);
    }

    /// The load's friction, 50 N, slows 200 kg less than 637 mm/s² do: it runs against the motor before it turns round.
    #[test]
    fn backlash_is_crossed_where_the_screws_force_turns_round() {
        let light = IdentifiedZ { friction_n: 100.0, ..nominal() };
        let mut z = begun_with(light, 0.0, Some(1.0));
        let wind_up_mm = ACCELERATION / 394_784.176_043_574_3;
        let friction_mm = 50.0 / 78_956.835_208_714_86;
        let backlash_mm = LOST_MM - 2.0 * friction_mm;
        let expected_mm = [0.0, -backlash_mm - wind_up_mm, -2.0 * friction_mm];
        assert_leads(&mut z, [CRUISING, SLOWING, SPEEDING_BACK], expected_mm);
    }

    #[test]
    fn motor_does_not_wander_through_the_backlash_without_force() {
        let free = IdentifiedZ { friction_n: 0.0, lost_motion_mm: 0.005, ..nominal() };
        let mut z = begun_with(free, 0.0, Some(1.0));
        let [speeding_mm, cruising_mm] = leads_mm(&mut z, [SPEEDING, CRUISING]);
        assert!((speeding_mm + cruising_mm).abs() < 1e-9 && z.backlash.flank() == 1.0);
    }

    #[test]
    fn crossing_starts_and_ends_without_speed() {
        let extras = moved(&mut begun(0.0, Some(-1.0)), (0.0, CRUISING_BACK));
        let greatest =
            |extras: &[ZExtra]| extras.iter().map(|extra| extra.motor_velocity_mm_per_s.abs()).fold(0.0, f64::max);
        assert!(greatest(&extras[..1]) < 0.05 * greatest(&extras), "{:?}", extras[0]);
        let last = extras[extras.len() - 1];
        assert!(last.motor_velocity_mm_per_s.abs() < 1e-9 && last.acceleration_mm_per_s2.abs() < 1e-6, "{last:?}");
    }

    fn last_n(extras: &[ZExtra]) -> f64 {
        extras[extras.len() - 1].friction_n
    }

    #[test]
    fn friction_counts_from_what_holds_z_already() {
        for held_n in [0.0, 100.0, -200.0] {
            let mut z = begun(held_n, None);
            let first_n = z.step(&State::default(), &State::default()).friction_n;
            assert!(first_n.abs() < 1e-9, "{held_n}: {first_n}");
            let (inwards_n, outwards_n) =
                (last_n(&moved(&mut z, (0.0, CRUISING))), last_n(&moved(&mut z, (CRUISING, CRUISING_BACK))));
            assert!((inwards_n - (COULOMB_N - held_n)).abs() < 1e-6, "{held_n}: {inwards_n}");
            assert!((outwards_n - (-COULOMB_N - held_n)).abs() < 1e-6, "{held_n}: {outwards_n}");
        }
    }

    #[test]
    fn a_force_that_is_fed_forward_goes_on() {
        let mut z = ZFeedforward::new(config(), &nominal(), 200.0, 150.0, None, 0.0);
        let first_n = z.step(&State::default(), &State::default()).friction_n;
        assert!((first_n - 150.0).abs() < 1e-9, "{first_n}");
    }

    #[test]
    fn more_than_friction_is_handed_over_up_to_a_limit() {
        for (held_n, taken_n) in [(600.0, 600.0), (5000.0, 2.5 * STATIC_N), (-5000.0, -2.5 * STATIC_N)] {
            let first = begun(held_n, None).step(&State::default(), &State::default());
            assert!((first.friction_n - (STATIC_N.copysign(held_n) - taken_n)).abs() < 1e-9, "{held_n}: {first:?}");
        }
    }

    /// The drive's integral holds what differs on the way in; the way out differs by as much again.
    #[test]
    fn measured_friction_counts_at_the_reversal() {
        let (mut z, measured_n) = (begun(0.0, Some(1.0)), 1.2 * COULOMB_N);
        let before_n = last_n(&moved(&mut z, (0.0, CRUISING)));
        (0..500).for_each(|_| z.observe_force(measured_n, &load(CRUISING)));
        let after_n = z.step(&load(CRUISING), &load(CRUISING)).friction_n;
        assert!((after_n - before_n).abs() < 1e-6, "{before_n} {after_n}");
        let back_n = last_n(&moved(&mut z, (CRUISING, CRUISING_BACK)));
        assert!((back_n - (before_n - 2.0 * measured_n)).abs() < 1e-6, "{back_n}");
    }

    #[test]
    fn friction_is_measured_in_sliding_alone_and_without_inertia() {
        let mut z = begun(0.0, Some(1.0));
        let state = z.clone();
        z.observe_force(900.0, &State { velocity: 7.9, ..State::default() });
        assert_eq!(z, state);
        // 600 kg.
        let slowing = State { velocity: -50.0, acceleration: 500.0, ..State::default() };
        (0..500).for_each(|_| z.observe_force(300.0 - COULOMB_N, &slowing));
        assert!((z.friction_n - COULOMB_N).abs() < 1e-9, "{}", z.friction_n);
    }

    #[test]
    fn held_force_says_on_which_flank_the_motor_stands() {
        let flank = |held_n, flank| begun(held_n, flank).backlash.flank();
        assert_eq!((flank(300.0, None), flank(-300.0, None), flank(0.0, None)), (1.0, -1.0, 0.0));
        assert_eq!(flank(300.0, Some(-1.0)), -1.0, "what was measured says it better");
    }
}
