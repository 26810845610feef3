//! What Z's motor has to do beyond its share of the acceleration: friction, lost motion, the screw's stretch.

use crate::control::machine::Machine;
use crate::control::math::poly::State;
use crate::control::model::friction::Stribeck;
use crate::control::model::two_mass::TwoMass;
use crate::control::units::{mm_from_m, mm_from_um};

use super::identify::Identified;

/// A force at rest beyond this ratio of the greatest friction known is something else.
const HELD_RATIO: f64 = 2.5;

/// A side of the lost motion, ±1, counts as reached this near.
const SIDE_REACHED: f64 = 1e-3;

/// Z's mechanics as the machine file says, in mm and N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZModel {
    pub(super) mass_kg: f64,
    motor_share: f64,
    /// Stretch of the screw per acceleration of the table: m₂/k.
    stretch_s2: f64,
    /// Of a friction of 1.
    contact: Stribeck,
}

impl ZModel {
    pub(super) fn new(machine: &Machine) -> Self {
        let spec = &machine.spec().z_axis;
        let screw = TwoMass::of_z(spec);
        Self {
            mass_kg: spec.mass_kg,
            motor_share: 1.0 - spec.table_share,
            stretch_s2: screw.load_inertia / screw.stiffness,
            contact: Stribeck {
                coulomb: 1.0,
                static_ratio: spec.static_ratio,
                stribeck_speed: spec.stribeck_mm_per_s,
                presliding: mm_from_um(spec.presliding_um),
            },
        }
    }

    /// Motor less table at constant speed, one direction less the other: backlash and the friction's twist.
    pub(super) fn nominal_lost_motion_mm(machine: &Machine) -> f64 {
        let spec = &machine.spec().z_axis;
        let table_n = spec.coulomb_n * spec.friction_table_share;
        mm_from_um(spec.backlash_um) + mm_from_m(2.0 * table_n / TwoMass::of_z(spec).stiffness)
    }

    /// Backlash's share of that.
    fn play_share(machine: &Machine) -> f64 {
        let lost_mm = Self::nominal_lost_motion_mm(machine);
        if lost_mm > 0.0 { mm_from_um(machine.spec().z_axis.backlash_um) / lost_mm } else { 0.0 }
    }

    /// Stretch of the screw in mm under an acceleration of the table.
    pub(super) fn stretch_mm(&self, acceleration_mm_per_s2: f64) -> f64 {
        self.stretch_s2 * acceleration_mm_per_s2
    }
}

/// A step that starts and ends with neither speed nor acceleration: 6u⁵ − 15u⁴ + 10u³.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SoftStep {
    from: f64,
    to: f64,
    start_s: f64,
    duration_s: f64,
}

impl SoftStep {
    fn at(&self, t_s: f64) -> State {
        let u = ((t_s - self.start_s) / self.duration_s).clamp(0.0, 1.0);
        let rest = 1.0 - u;
        let rate = (self.to - self.from) / self.duration_s;
        State {
            position: self.from + (self.to - self.from) * u * u * u * (10.0 - 15.0 * u + 6.0 * u * u),
            velocity: rate * 30.0 * u * u * rest * rest,
            acceleration: rate / self.duration_s * 60.0 * u * rest * (1.0 - 2.0 * u),
            jerk: 0.0,
        }
    }
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZFeedforward {
    pub(super) model: ZModel,
    period_s: f64,
    /// Sliding friction.
    friction_n: f64,
    lost_motion_mm: f64,
    /// Backlash's share of the lost motion, by the file.
    play_share: f64,
    /// Pre-sliding state, −1…1.
    contact_state: f64,
    /// Friction at the hole's start: the drive's integral holds it already.
    held_n: f64,
    /// Direction that Z last moved in, 1 into the hole.
    direction: f64,
    /// Side of the play that the motor pushes on, −1…1.
    side: SoftStep,
}

impl ZFeedforward {
    pub(super) fn new(machine: &Machine) -> Self {
        let model = ZModel::new(machine);
        Self {
            model,
            period_s: machine.spec().control.period_s,
            friction_n: machine.spec().z_axis.coulomb_n,
            lost_motion_mm: ZModel::nominal_lost_motion_mm(machine),
            play_share: ZModel::play_share(machine),
            contact_state: 0.0,
            held_n: 0.0,
            direction: 0.0,
            side: SoftStep { from: 0.0, to: 0.0, start_s: 0.0, duration_s: machine.spec().sync.lost_motion_s },
        }
    }

    /// A hole begins: Z rests, and its drive's integral holds what friction is left. All into the hole; `side` is where
    /// in the lost motion the motor stands, −1…1, where that is known.
    pub(super) fn begin(&mut self, identified: &Identified, held_n: f64, side: Option<f64>) {
        self.friction_n = identified.z_friction_n;
        self.lost_motion_mm = identified.z_lost_motion_mm;
        let greatest_n = self.friction_n * self.model.contact.level(0.0);
        self.contact_state = if greatest_n > 0.0 { (held_n / greatest_n).clamp(-1.0, 1.0) } else { 0.0 };
        // All of it is handed over, more than the greatest friction known too: here it is greater, then.
        self.held_n = held_n.max(-HELD_RATIO * greatest_n).min(HELD_RATIO * greatest_n);
        // Not shown yet: the play lies wholly on one side, the friction's twist is as great as what is held.
        let play = if self.contact_state == 0.0 { 0.0 } else { 1f64.copysign(self.contact_state) };
        let guess = self.play_share * play + (1.0 - self.play_share) * self.contact_state;
        let side = side.unwrap_or(guess).clamp(-1.0, 1.0);
        self.direction = 1f64.copysign(side);
        self.side = SoftStep { from: side, to: side, start_s: 0.0, ..self.side };
    }

    /// Whether Z's motor stands on the side of the lost motion that pushes into the hole.
    pub(super) fn pushes_inwards(&self) -> bool {
        self.direction > 0.0
    }

    fn friction_n(&self, velocity: f64) -> f64 {
        self.friction_n * self.model.contact.level(velocity) * self.contact_state
    }

    /// One period of a hole, at an instant of its plan and the pace at which that runs. `sliding` is Z's state when a force commanded now will
    /// act, with friction's lead, `soon` the velocity that decides on which side the motor has to push, `seen` the
    /// table's state as old as the velocity that the loop will see.
    pub(super) fn step(
        &mut self,
        (now_s, pace): (f64, f64),
        lags: ZLags,
        sliding: &State,
        soon: f64,
        seen: &State,
    ) -> ZExtra {
        self.contact_state = self.model.contact.preslide(self.contact_state, sliding.velocity, self.period_s);
        let on_its_way = (self.side.to - self.direction).abs() <= SIDE_REACHED;
        if soon != 0.0 && (soon * self.direction <= 0.0 || !on_its_way) {
            self.direction = 1f64.copysign(soon);
            let from = self.side.at(now_s).position;
            self.side = SoftStep { from, to: self.direction, start_s: now_s, ..self.side };
        }
        let half_mm = self.lost_motion_mm / 2.0;
        // The crossing runs on the plan's time, as its path does.
        let late = self.side.at(now_s - pace * lags.velocity_s);
        let early = self.side.at(now_s + pace * lags.force_s);
        ZExtra {
            motor_velocity_mm_per_s: pace * half_mm * late.velocity + self.model.stretch_s2 * seen.jerk,
            acceleration_mm_per_s2: pace * pace * half_mm * early.acceleration * self.model.motor_share,
            friction_n: self.friction_n(sliding.velocity) - self.held_n,
        }
    }
}

/// How late Z's loops see and act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ZLags {
    /// From a commanded force to the force.
    pub(super) force_s: f64,
    /// From a speed to its reading in the velocity loop.
    pub(super) velocity_s: f64,
}

#[cfg(test)]
mod tests {
    use super::{ZExtra, ZFeedforward, ZLags};
    use crate::control::machine::Machine;
    use crate::control::math::poly::State;
    use crate::control::sync::Identified;

    const LAGS: ZLags = ZLags { force_s: 0.0005, velocity_s: 0.0003 };
    /// Fine steps: sums stand for integrals.
    const STEP_S: f64 = 1e-4;
    const LOST_MM: f64 = 0.008;
    /// The reference machine's, sliding and before it does.
    const COULOMB_N: f64 = 300.0;
    const STATIC_N: f64 = 390.0;

    fn begun(held_n: f64, side: Option<f64>) -> ZFeedforward {
        let machine = Machine::reference();
        let mut z = ZFeedforward::new(&machine);
        let known = Identified { z_lost_motion_mm: LOST_MM, ..Identified::nominal(&machine) };
        z.begin(&known, held_n, side);
        z
    }

    /// Moves at a velocity for 50 ms from an instant on.
    fn moved(z: &mut ZFeedforward, from_s: f64, velocity: f64) -> Vec<ZExtra> {
        let state = State { velocity, ..State::default() };
        (0..500).map(|k| z.step((from_s + f64::from(k) * STEP_S, 1.0), LAGS, &state, velocity, &state)).collect()
    }

    fn way_mm(extras: &[ZExtra]) -> f64 {
        extras.iter().map(|extra| extra.motor_velocity_mm_per_s * STEP_S).sum()
    }

    #[test]
    fn motor_crosses_the_whole_lost_motion_at_a_reversal() {
        for (side, first_mm) in [(1.0, 0.0), (0.0, 0.5 * LOST_MM), (-0.5, 0.75 * LOST_MM), (-1.0, LOST_MM)] {
            let mut z = begun(0.0, Some(side));
            for (from_s, velocity, expected_mm) in [(0.0, 50.0, first_mm), (0.1, -50.0, -LOST_MM), (0.2, 50.0, LOST_MM)]
            {
                let crossed_mm = way_mm(&moved(&mut z, from_s, velocity));
                assert!((crossed_mm - expected_mm).abs() < 1e-7, "from {side} at {from_s} s: {crossed_mm}");
            }
        }
    }

    #[test]
    fn slowed_path_crosses_the_whole_lost_motion_too() {
        let (pace, state) = (0.6, State { velocity: 50.0, ..State::default() });
        let mut z = begun(0.0, Some(-1.0));
        let extras: Vec<_> = (0..500)
            .map(|k| z.step((pace * f64::from(k) * STEP_S, pace), LAGS, &state, state.velocity, &state))
            .collect();
        assert!((way_mm(&extras) - LOST_MM).abs() < 1e-7, "{}", way_mm(&extras));
    }

    #[test]
    fn crossing_starts_and_ends_without_speed_or_acceleration() {
        let mut z = begun(0.0, Some(-1.0));
        let extras = moved(&mut z, 0.0, 50.0);
        let share = 1.0 - Machine::reference().spec().z_axis.table_share;
        let speed: f64 = extras.iter().map(|extra| extra.acceleration_mm_per_s2 / share * STEP_S).sum();
        let greatest = extras.iter().map(|extra| extra.motor_velocity_mm_per_s).fold(0.0, f64::max);
        assert!(speed.abs() < 0.1 * greatest, "{speed} {greatest}");
        let last = extras[extras.len() - 1];
        assert_eq!((last.motor_velocity_mm_per_s, last.acceleration_mm_per_s2), (0.0, 0.0));
    }

    #[test]
    fn screw_is_stretched_as_the_table_accelerates() {
        let mut z = begun(0.0, Some(1.0));
        let seen = State { jerk: 1e5, ..State::default() };
        let extra = z.step((0.0, 1.0), LAGS, &State::default(), 0.0, &seen);
        assert!(extra.motor_velocity_mm_per_s > 0.0);
        assert_eq!(extra.motor_velocity_mm_per_s, z.model.stretch_mm(1e5));
    }

    #[test]
    fn friction_counts_from_what_holds_z_already() {
        for held_n in [0.0, 100.0, -200.0] {
            let mut z = begun(held_n, None);
            let first = z.step((0.0, 1.0), LAGS, &State::default(), 0.0, &State::default());
            assert!(first.friction_n.abs() < 1e-9, "{held_n}: {first:?}");
            let sliding = |extras: Vec<ZExtra>| extras[extras.len() - 1].friction_n;
            let [inwards_n, outwards_n] =
                [(0.1, 50.0), (0.2, -50.0)].map(|(from_s, velocity)| sliding(moved(&mut z, from_s, velocity)));
            assert!((inwards_n - (COULOMB_N - held_n)).abs() < 1e-6, "{held_n}: {inwards_n}");
            assert!((outwards_n - (-COULOMB_N - held_n)).abs() < 1e-6, "{held_n}: {outwards_n}");
        }
    }

    #[test]
    fn more_than_friction_is_handed_over_up_to_a_limit() {
        for (held_n, taken_n) in [(600.0, 600.0), (5000.0, 2.5 * STATIC_N), (-5000.0, -2.5 * STATIC_N)] {
            let first = begun(held_n, None).step((0.0, 1.0), LAGS, &State::default(), 0.0, &State::default());
            assert!((first.friction_n - (STATIC_N.copysign(held_n) - taken_n)).abs() < 1e-9, "{held_n}: {first:?}");
        }
    }

    #[test]
    fn held_force_says_where_the_motor_stands() {
        assert!(begun(300.0, None).pushes_inwards() && !begun(-300.0, None).pushes_inwards());
        assert!(!begun(300.0, Some(-1.0)).pushes_inwards(), "what was seen says it better");
    }
}
