//! What Z's motor has to do beyond its share of the acceleration, so that the table moves as wanted: friction, the
//! screw's stretch, its play.
//!
//! Z's mechanics backwards, from the table to the motor. The table's motion and friction say what force the screw carries,
//! that force how far the motor leads the table, and the motor's own motion and friction what it has to give. The screw's
//! force is worked out ahead of when it acts: where it turns round, the motor has to be on its way through the play.

use crate::control::machine::Machine;
use crate::control::math::{filter_share, poly::State, sign};
use crate::control::model::friction::preslide_one_way;

use super::history::History;
use super::identify::Identified;
use super::play::Play;
use super::z_model::ZModel;

/// A force at rest beyond this ratio of the greatest friction known is something else.
const HELD_RATIO: f64 = 2.5;
/// Time over which the friction of here is averaged: long against the force's noise, short against a stroke's end.
const HERE_S: f64 = 0.02;

/// Instants of Z after the plan's own.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct When {
    /// A force commanded now acts.
    pub(super) acting_s: f64,
    /// What the velocity loop sees when it does what is commanded now.
    pub(super) seen_s: f64,
}

/// What the motor's command needs beyond the table's motion, positive into the hole.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct ZExtra {
    /// Motor's speed beyond the table's.
    pub(super) motor_velocity_mm_per_s: f64,
    /// Acceleration of the whole mass that the motor's own extra acceleration is worth.
    pub(super) acceleration_mm_per_s2: f64,
    /// Friction to overcome, beyond what holds Z at the hole's start.
    pub(super) friction_n: f64,
}

/// Friction and lost motion along a hole, with where they stand.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ZFeedforward {
    model: ZModel,
    period_s: f64,
    file_compliance_mm_per_n: f64,
    play: Play,
    /// Sliding friction of motor and table together, here.
    friction_n: f64,
    /// The same at the hole's start. It alone says how the screw is loaded: were it what is seen on the way, a loop would
    /// close through the play.
    start_friction_n: f64,
    /// What the drive's integral holds already.
    held_n: f64,
    /// Pre-sliding states, −1…1: the table's ahead, the motor's when it acts.
    table_contact: f64,
    motor_contact: f64,
    /// Travel of both one period ago.
    table_mm: f64,
    motor_mm: f64,
    /// Ahead: the table's friction over the whole, the screw's force.
    table_friction_ratio: History,
    screw_n: History,
    /// Friction over [`Self::friction_n`] when the last command acts.
    friction_ratio: f64,
}

impl ZFeedforward {
    pub(super) fn new(machine: &Machine) -> Self {
        let (model, period_s) = (ZModel::new(machine), machine.spec().control.period_s);
        let friction_n = machine.spec().z_axis.coulomb_n;
        Self {
            model,
            period_s,
            file_compliance_mm_per_n: model.compliance_mm_per_n,
            play: Play::new(period_s, machine.spec().sync.play_crossing_s),
            friction_n,
            start_friction_n: friction_n,
            held_n: 0.0,
            table_contact: 0.0,
            motor_contact: 0.0,
            table_mm: 0.0,
            motor_mm: 0.0,
            table_friction_ratio: History::smoothed(period_s, 0.0),
            screw_n: History::smoothed(period_s, 0.0),
            friction_ratio: 0.0,
        }
    }

    /// By so much the table's motion has to be known before the motor acts.
    pub(super) fn lead_s(&self) -> f64 {
        self.play.lead_s()
    }

    /// The same in periods.
    pub(super) fn lead_periods(&self) -> u32 {
        self.play.lead_periods()
    }

    /// Before the first step: the table's motion from when its command acts on, one period after the other, up to
    /// [`Self::lead_s`] after that.
    pub(super) fn prime(&mut self, table: &State) {
        self.load_screw(table);
    }

    /// A hole begins: Z rests, friction held by its drive's integral and by what is fed forward still. All into the hole;
    /// `side` is where in the lost motion the motor stands, −1…1, where that is known.
    pub(super) fn begin(&mut self, identified: &Identified, held_n: f64, fed_n: f64, side: Option<f64>) {
        self.model.compliance_mm_per_n = self.file_compliance_mm_per_n * identified.z_compliance_ratio;
        self.friction_n = identified.z_friction_n;
        self.start_friction_n = identified.z_friction_n;
        let play_mm = (identified.z_lost_motion_mm - self.model.twist_mm(self.friction_n)).max(0.0);
        let greatest_ratio = self.model.contact.level(0.0);
        let greatest_n = self.friction_n * greatest_ratio;
        // All of it is handed over, more than the greatest friction known too: here it is greater, then.
        self.held_n = held_n.max(-HELD_RATIO * greatest_n).min(HELD_RATIO * greatest_n) - fed_n;
        let table_share = self.model.table_friction_share;
        let (screw_n, play_side) = match side {
            Some(side) => self.at_lead(play_mm, 0.5 * identified.z_lost_motion_mm * side),
            // Not shown yet: what is held lies on both alike, and the play wholly on its side.
            None => (held_n * table_share, sign(held_n)),
        };
        let table_most_n = table_share * greatest_n;
        let screw_n = screw_n.max(-table_most_n).min(table_most_n);
        self.table_contact = share(screw_n, table_most_n);
        self.motor_contact = share(held_n - screw_n, greatest_n - table_most_n);
        self.table_friction_ratio.fill(table_share * greatest_ratio * self.table_contact);
        self.screw_n.fill(screw_n);
        self.play.begin(play_mm, play_side);
        (self.table_mm, self.motor_mm) = (0.0, self.lead(0.0).position);
    }

    /// The screw's force and the side of its play, with the motor so far ahead of the table.
    fn at_lead(&self, play_mm: f64, lead_mm: f64) -> (f64, f64) {
        let half_mm = 0.5 * play_mm;
        let stretch_mm = (lead_mm.abs() - half_mm).max(0.0).copysign(lead_mm);
        let side = if half_mm > 0.0 { (lead_mm / half_mm).clamp(-1.0, 1.0) } else { sign(lead_mm) };
        let compliance = self.model.compliance_mm_per_n;
        (if compliance > 0.0 { stretch_mm / compliance } else { 0.0 }, side)
    }

    /// One period of a hole: the table's motion when a force commanded now acts, and [`Self::lead_s`] after that.
    pub(super) fn step(&mut self, acting: &State, ahead: &State, when: When) -> ZExtra {
        self.load_screw(ahead);
        let lead_s = self.lead_s();
        let (early, late) = (self.lead(lead_s), self.lead(lead_s + when.acting_s - when.seen_s));
        let motor_mm = acting.position + early.position;
        self.motor_contact = self.preslide(self.motor_contact, motor_mm - self.motor_mm);
        self.motor_mm = motor_mm;
        let motor_level = self.model.contact.level(acting.velocity + early.velocity);
        self.friction_ratio = (1.0 - self.model.table_friction_share) * motor_level * self.motor_contact
            + self.table_friction_ratio.at(lead_s).position;
        ZExtra {
            motor_velocity_mm_per_s: late.velocity,
            acceleration_mm_per_s2: early.acceleration * (1.0 - self.model.table_mass_share),
            friction_n: self.friction_n * self.friction_ratio - self.held_n,
        }
    }

    /// What the screw carries ahead, and on which side.
    fn load_screw(&mut self, table: &State) {
        self.table_contact = self.preslide(self.table_contact, table.position - self.table_mm);
        self.table_mm = table.position;
        let table_share = self.model.table_friction_share;
        let friction_ratio = table_share * self.model.contact.level(table.velocity) * self.table_contact;
        let screw_n = self.start_friction_n * friction_ratio + self.model.table_n(table.acceleration);
        self.table_friction_ratio.push(friction_ratio);
        self.screw_n.push(screw_n);
        self.play.load(screw_n, table_share * self.start_friction_n);
    }

    fn preslide(&self, contact: f64, travel_mm: f64) -> f64 {
        preslide_one_way(contact, travel_mm / self.model.contact.presliding)
    }

    /// How far the motor leads the table, so long before what is known ahead.
    fn lead(&self, ago_s: f64) -> State {
        let stretch = self.screw_n.at(ago_s).scaled(self.model.compliance_mm_per_n);
        let play = self.play.sent_mm(ago_s);
        State {
            position: stretch.position + play.position,
            velocity: stretch.velocity + play.velocity,
            acceleration: stretch.acceleration + play.acceleration,
            jerk: 0.0,
        }
    }

    /// By how much motor and scale show that the motor led the table, so long before a force commanded now acts.
    pub(super) fn show(&mut self, lead_mm: f64, ago_s: f64) {
        let stretch_mm = self.model.compliance_mm_per_n * self.screw_n.at(self.lead_s() + ago_s).position;
        self.play.show(lead_mm - stretch_mm);
    }

    /// Share of an error that the next hole will show again, so long before a force commanded now acts.
    pub(super) fn repeats(&self, ago_s: f64) -> f64 {
        self.play.repeats(self.lead_s() + ago_s)
    }

    /// What the drive gave a moment ago, when the table moved so. Friction changes along the way: what it is here counts
    /// at the next reversal, and until then the drive's integral holds the difference.
    pub(super) fn observe(&mut self, force_n: f64, table: &State) {
        if table.velocity.abs() <= self.model.sliding_mm_per_s() {
            return;
        }
        let against_n = sign(table.velocity) * (force_n - self.model.inertia_n(table.acceleration));
        let change_n = filter_share(self.period_s, HERE_S) * (against_n.max(0.0) - self.friction_n);
        self.friction_n += change_n;
        self.held_n += change_n * self.friction_ratio;
    }
}

/// Share of the greatest, −1…1.
fn share(force_n: f64, most_n: f64) -> f64 {
    if most_n > 0.0 { (force_n / most_n).clamp(-1.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::{When, ZExtra, ZFeedforward};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::sync::Identified;

    const PERIOD_S: f64 = 0.001;
    const WHEN: When = When { acting_s: -0.0002, seen_s: -0.001 };
    const LOST_MM: f64 = 0.008;
    const ACCELERATION: f64 = 637.0;
    /// To 32 mm/s.
    const RAMP_S: f64 = 0.05;
    /// The reference machine's, sliding and before it does.
    const COULOMB_N: f64 = 300.0;
    const STATIC_N: f64 = 390.0;

    fn begun_with(known: Identified, held_n: f64, side: Option<f64>) -> ZFeedforward {
        let mut z = ZFeedforward::new(&Machine::reference());
        z.begin(&known, held_n, 0.0, side);
        z
    }

    fn nominal() -> Identified {
        Identified { z_lost_motion_mm: LOST_MM, ..Identified::nominal(&Machine::reference()) }
    }

    fn begun(held_n: f64, side: Option<f64>) -> ZFeedforward {
        begun_with(nominal(), held_n, side)
    }

    /// Speeds up, cruises for as long, turns round as it sped up, and cruises back.
    fn table(t_s: f64) -> State {
        let legs = [(RAMP_S, ACCELERATION), (RAMP_S, 0.0), (2.0 * RAMP_S, -ACCELERATION), (f64::INFINITY, 0.0)];
        let mut state = State::default();
        let mut left_s = t_s.max(0.0);
        for (length_s, acceleration) in legs {
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

    /// Instants of [`table`] at which everything has settled.
    const SPEEDING: f64 = 0.045;
    const CRUISING: f64 = 0.09;
    const SLOWING: f64 = 0.145;
    const SPEEDING_BACK: f64 = 0.19;
    const CRUISING_BACK: f64 = 0.25;

    fn moved(z: &mut ZFeedforward, (from_s, to_s): (f64, f64)) -> Vec<ZExtra> {
        let periods = (from_s / PERIOD_S).round() as u32..(to_s / PERIOD_S).round() as u32;
        let lead_s = z.lead_s();
        periods.map(|k| f64::from(k) * PERIOD_S).map(|t_s| z.step(&table(t_s), &table(t_s + lead_s), WHEN)).collect()
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
    fn motor_crosses_all_that_is_lost() {
        for (side, first_mm) in [(1.0, 0.0), (0.0, 0.5 * LOST_MM), (-0.5, 0.75 * LOST_MM), (-1.0, LOST_MM)] {
            assert_leads(&mut begun(0.0, Some(side)), [CRUISING, CRUISING_BACK], [first_mm, -LOST_MM]);
        }
    }

    #[test]
    fn screw_is_stretched_while_the_table_speeds_up() {
        let mut z = begun(COULOMB_N, Some(1.0));
        // ω² of 100 Hz.
        let stretch_mm = ACCELERATION / 394_784.176_043_574_3;
        assert_leads(&mut z, [SPEEDING, CRUISING], [stretch_mm, -stretch_mm]);
        let soft = Identified { z_compliance_ratio: 1.5, ..nominal() };
        assert_leads(&mut begun_with(soft, COULOMB_N, Some(1.0)), [SPEEDING], [1.5 * stretch_mm]);
    }

    /// The table's friction, 50 N, slows 200 kg less than 637 mm/s² do: it runs against the motor before it turns round.
    #[test]
    fn play_is_crossed_where_the_screws_force_turns_round() {
        let light = Identified { z_friction_n: 100.0, ..nominal() };
        let mut z = begun_with(light, 0.0, Some(1.0));
        let stretch_mm = ACCELERATION / 394_784.176_043_574_3;
        let friction_mm = 50.0 / 78_956.835_208_714_86;
        let play_mm = LOST_MM - 2.0 * friction_mm;
        let expected_mm = [0.0, -play_mm - stretch_mm, -2.0 * friction_mm];
        assert_leads(&mut z, [CRUISING, SLOWING, SPEEDING_BACK], expected_mm);
    }

    #[test]
    fn motor_does_not_wander_through_the_play_without_force() {
        let free = Identified { z_friction_n: 0.0, z_lost_motion_mm: 0.005, ..nominal() };
        let mut z = begun_with(free, 0.0, Some(1.0));
        let [speeding_mm, cruising_mm] = leads_mm(&mut z, [SPEEDING, CRUISING]);
        assert!((speeding_mm + cruising_mm).abs() < 1e-9 && z.play.standing() == 1.0);
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
            let first_n = z.step(&State::default(), &State::default(), WHEN).friction_n;
            assert!(first_n.abs() < 1e-9, "{held_n}: {first_n}");
            let (inwards_n, outwards_n) =
                (last_n(&moved(&mut z, (0.0, CRUISING))), last_n(&moved(&mut z, (CRUISING, CRUISING_BACK))));
            assert!((inwards_n - (COULOMB_N - held_n)).abs() < 1e-6, "{held_n}: {inwards_n}");
            assert!((outwards_n - (-COULOMB_N - held_n)).abs() < 1e-6, "{held_n}: {outwards_n}");
        }
    }

    #[test]
    fn what_is_fed_forward_still_goes_on() {
        let mut z = begun(0.0, None);
        z.begin(&nominal(), 200.0, 150.0, None);
        let first_n = z.step(&State::default(), &State::default(), WHEN).friction_n;
        assert!((first_n - 150.0).abs() < 1e-9, "{first_n}");
    }

    #[test]
    fn more_than_friction_is_handed_over_up_to_a_limit() {
        for (held_n, taken_n) in [(600.0, 600.0), (5000.0, 2.5 * STATIC_N), (-5000.0, -2.5 * STATIC_N)] {
            let first = begun(held_n, None).step(&State::default(), &State::default(), WHEN);
            assert!((first.friction_n - (STATIC_N.copysign(held_n) - taken_n)).abs() < 1e-9, "{held_n}: {first:?}");
        }
    }

    /// The drive's integral holds what differs on the way in; the way out differs by as much again.
    #[test]
    fn friction_that_is_seen_counts_at_the_reversal() {
        let (mut z, seen_n) = (begun(0.0, Some(1.0)), 1.2 * COULOMB_N);
        let before_n = last_n(&moved(&mut z, (0.0, CRUISING)));
        (0..500).for_each(|_| z.observe(seen_n, &table(CRUISING)));
        let after_n = z.step(&table(CRUISING), &table(CRUISING), WHEN).friction_n;
        assert!((after_n - before_n).abs() < 1e-6, "{before_n} {after_n}");
        let back_n = last_n(&moved(&mut z, (CRUISING, CRUISING_BACK)));
        assert!((back_n - (before_n - 2.0 * seen_n)).abs() < 1e-6, "{back_n}");
    }

    #[test]
    fn friction_is_seen_in_sliding_alone_and_without_inertia() {
        let mut z = begun(0.0, Some(1.0));
        let state = z.clone();
        z.observe(900.0, &State { velocity: 7.9, ..State::default() });
        assert_eq!(z, state);
        // 600 kg.
        let slowing = State { velocity: -50.0, acceleration: 500.0, ..State::default() };
        (0..500).for_each(|_| z.observe(300.0 - COULOMB_N, &slowing));
        assert!((z.friction_n - COULOMB_N).abs() < 1e-9, "{}", z.friction_n);
    }

    #[test]
    fn held_force_says_where_the_motor_stands() {
        let side = |held_n, side| begun(held_n, side).play.standing();
        assert_eq!((side(300.0, None), side(-300.0, None), side(0.0, None)), (1.0, -1.0, 0.0));
        assert_eq!(side(300.0, Some(-1.0)), -1.0, "what was seen says it better");
    }
}
